#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/unit/condensation/test_problem.h"

// Problems with exact answers: verification cases V1 and V2.
namespace faultsim {
namespace {

using test::condense;
using test::make_box;

constexpr double kMPa = 1e6;

Eigen::Matrix3d patch_stress() {
  Eigen::Matrix3d stress;
  stress << -20, 3, 2, 3, -25, 1, 2, 1, -30;
  return kMPa * stress;
}

struct PatchAnswer {
  double dip, normal, along_strike, down_dip;  // degrees, MPa
};

class PatchTest : public testing::TestWithParam<PatchAnswer> {};

// V1: all-traction body, sheared and distorted cells; one fault cuts it in two, one is embedded.
TEST_P(PatchTest, LockedTractionsAreSigmaN) {
  const PatchAnswer answer = GetParam();
  const std::array<int, 3> n = {6, 4, 5};
  BulkProblem problem;
  problem.mesh = make_box(n, {60, 40, 50}, {{2, 1, 3, 1, 4}, test::through(4, n)},
                          test::shear_to_dip(answer.dip));
  test::distort(problem.mesh, 10, 0.2);
  problem.materials = {{11e9, 0.15}};
  problem.loads = {test::stress_case(patch_stress(), test::all_sides())};
  for (bool swap : {false, true}) {
    if (swap) test::swap_sides(problem.mesh);
    test::RecordingMonitor monitor;
    const FaultOperator op = CondensedBulk(problem, monitor).condense();
    EXPECT_TRUE(monitor.notes.empty());
    for (const OperatorNode& node : op.geometry.nodes) {
      const Eigen::Vector3d traction = patch_stress() * node.normal;
      const std::array<Eigen::Vector3d, 3> axes = {node.normal, node.strike, node.dip};
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(op.loads.traction(node.dof[c], 0), axes[c].dot(traction), 1e-10 * 30 * kMPa);
      }
      EXPECT_NEAR(op.loads.traction(node.dof[0], 0) / kMPa, answer.normal, 1e-6);
      EXPECT_NEAR(std::abs(op.loads.traction(node.dof[1], 0)) / kMPa, answer.along_strike, 1e-6);
      EXPECT_NEAR(std::abs(op.loads.traction(node.dof[2], 0)) / kMPa, answer.down_dip, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(V1, PatchTest,
                         testing::Values(PatchAnswer{90, -20, 3, 2},
                                         PatchAnswer{65, -23.318151, 2.296305, 5.115797},
                                         PatchAnswer{45, -27, std::sqrt(2.0), 5}));

TEST(Patch, PlaneStrainGivesTheInPlaneTractions) {
  const std::array<int, 3> n = {6, 1, 5};
  BulkProblem problem;
  problem.mesh = make_box(n, {60, 7, 50}, {test::through(3, n)}, test::shear_to_dip(65));
  test::make_plane_strain(problem.mesh, 7);
  problem.materials = {{11e9, 0.15}};
  problem.loads = {test::stress_case(patch_stress(), test::all_sides())};
  const FaultOperator op = condense(problem);
  EXPECT_EQ(op.geometry.n_dofs, 2 * 6);
  for (const OperatorNode& node : op.geometry.nodes) {
    EXPECT_NEAR(op.loads.traction(node.dof[0], 0) / kMPa, -23.318151, 1e-6);
    EXPECT_EQ(node.dof[1], -1);
    EXPECT_NEAR(std::abs(op.loads.traction(node.dof[2], 0)) / kMPa, 5.115797, 1e-6);
  }
}

// V2: on depletion of a laterally confined layer the total horizontal stress rises by γ_h |Δp|.
TEST(Compaction, LockedNormalTractionIsGammaH) {
  const std::array<int, 3> n = {4, 2, 6};
  BulkProblem problem;
  problem.mesh = make_box(n, {400, 200, 600}, {test::through(2, n)});
  test::set_region(problem.mesh, 0, 1,
                   [](const auto& x) { return x.z() > -501 && x.z() < -201; });  // −500 … −200
  problem.materials = {{11e9, 0.15}};
  problem.conditions =
      test::rollers({Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min});
  problem.loads = {test::pressure_case(0)};
  problem.observation_points = {{"top", {0, 0, 0}}};
  const FaultOperator op = condense(problem);
  const double gamma = 0.82352941176470584, depletion = -20e6;
  for (const OperatorNode& node : op.geometry.nodes) {
    const double z = node.position.z();
    const double share = z > -450 && z < -250 ? 1 : z > -550 && z < -150 ? 0.5 : 0;
    EXPECT_NEAR(depletion * op.loads.traction(node.dof[0], 0), share * gamma * 20e6, 1e-9 * 20e6)
        << z;
    if (node.dof[2] < 0) continue;
    EXPECT_NEAR(op.loads.traction(node.dof[2], 0), 0, 1e-10);
  }
  EXPECT_NEAR(depletion * op.observed.per_load(2, 0), -0.34438503 * 1.5, 1e-8);
}

// A block that slides as a whole on a through-going fault meets no resistance: H c = 0 for it.
TEST(Patch, RigidSlidingOfALooseBlockCostsNothing) {
  const std::array<int, 3> n = {4, 3, 3};
  BulkProblem problem;
  problem.mesh = make_box(n, {40, 30, 30}, {test::through(2, n)}, test::shear_to_dip(65));
  problem.materials = {{11e9, 0.15}};
  problem.loads = {test::stress_case(patch_stress(), test::all_sides())};
  const FaultOperator op = condense(problem);
  for (std::size_t c = 0; c < 3; ++c) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    for (const OperatorNode& node : op.geometry.nodes) g[node.dof[c]] = 1;
    EXPECT_LT((op.h() * g).norm(), 1e-11 * op.h().norm() * g.norm());
  }
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(op.h()).eigenvalues();
  EXPECT_LT(std::abs(eigenvalues[5]), 1e-11 * eigenvalues.maxCoeff());
  EXPECT_GT(eigenvalues[6], 1e-4 * eigenvalues.maxCoeff());
}

}  // namespace
}  // namespace faultsim
