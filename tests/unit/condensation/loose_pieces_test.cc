#include "simulator/condensation/loose_pieces.h"

#include <gmock/gmock.h>

#include "simulator/common/errors.h"
#include "simulator/condensation/fault_geometry.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

using test::condense;
using test::make_box;

const std::array<int, 3> kCells = {4, 2, 2};

BulkProblem two_blocks(const std::vector<BoundaryGroup>& sides) {
  BulkProblem problem;
  problem.mesh = make_box(kCells, {40, 20, 20}, {test::through(3, kCells)});
  problem.materials = {{11e9, 0.15}};
  problem.conditions = test::rollers(sides);
  problem.loads = {test::stress_case(-1e6 * Eigen::Matrix3d::Identity(), {Side::x_max})};
  return problem;
}

std::string error_of(const BulkProblem& problem) {
  try {
    condense(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LoosePieces, ABlockHeldByTheFaultAloneTransmitsItsLoad) {
  // The right block may slide along x on its rollers; the fault must carry the load of its side.
  const FaultOperator op =
      condense(two_blocks({Side::x_min, Side::y_min, Side::y_max, Side::z_min}));
  for (const OperatorNode& node : op.geometry.nodes) {
    EXPECT_NEAR(op.loads.traction(node.dof[0], 0), -1e6, 1e-3);
  }
}

TEST(LoosePieces, SpringsStandOnlyWhereABlockIsLoose) {
  const std::array<int, 3> n = {6, 2, 2};
  BulkProblem problem;
  problem.mesh = make_box(n, {60, 20, 20}, {test::through(2, n), test::through(4, n)});
  problem.materials = {{11e9, 0.15}};
  problem.conditions = test::rollers({Side::x_min, Side::y_min, Side::z_min});
  const auto springs = [&] {
    const DofMap dofs(problem.mesh, problem.conditions, 0);
    const FaultGeometry geometry = fault_geometry(problem.mesh, problem.materials, dofs, false);
    return std::pair(loose_piece_springs(problem, dofs, geometry), geometry);
  };
  const auto [loose, geometry] = springs();
  EXPECT_GT(loose.minCoeff(), 0) << "both right blocks may slide along x";
  problem.conditions.push_back(test::rollers({Side::x_max})[0]);
  const auto [middle, same] = springs();
  EXPECT_GT(middle.minCoeff(), 0) << "the middle block touches both faults";
  problem.conditions = test::rollers(test::all_sides());
  problem.conditions.erase(problem.conditions.begin() + 1);
  problem.mesh = make_box(n, {60, 20, 20}, {test::through(2, n)});
  const DofMap dofs(problem.mesh, problem.conditions, 0);
  const Eigen::VectorXd some = loose_piece_springs(
      problem, dofs, fault_geometry(problem.mesh, problem.materials, dofs, false));
  EXPECT_GT(some.maxCoeff(), 0);
  problem.conditions = test::rollers(test::all_sides());
  const DofMap held(problem.mesh, problem.conditions, 0);
  EXPECT_EQ(loose_piece_springs(problem, held,
                                fault_geometry(problem.mesh, problem.materials, held, false))
                .maxCoeff(),
            0);
}

TEST(LoosePieces, ABodyThatNothingHoldsIsRefusedInWords) {
  EXPECT_EQ(
      error_of(two_blocks({Side::x_min, Side::z_min})),
      "scene: /geometry/boundary: the block x 0 to 40 m, y 0 to 20 m, z -20 to 0 m (16 cells) "
      "can move along y; fix displacement components on a side that the block touches (a "
      "roller or \"displacement\"), or prescribe no displacement anywhere: the body is then "
      "pinned at three points");
}

TEST(LoosePieces, ABlockWithoutAFaultIsRefused) {
  BulkProblem problem = two_blocks({Side::x_min, Side::y_min, Side::z_min});
  problem.mesh = test::without_faults(problem.mesh);
  EXPECT_THAT(error_of(problem),
              testing::HasSubstr("the block x 30 to 40 m, y 0 to 20 m, z -20 to 0 m (4 cells) can "
                                 "move along x"));
}

TEST(LoosePieces, AHingeIsRefusedWithItsPlace) {
  // Plane strain, the right block hangs on one fault node: it can still turn about it.
  const std::array<int, 3> n = {4, 1, 2};
  BulkProblem problem;
  problem.mesh = make_box(n, {40, 1, 20}, {test::through(2, n)});
  test::make_plane_strain(problem.mesh, 1);
  problem.mesh.faults[0].nodes.resize(1);
  for (int& node : problem.mesh.faults[0].node_of_point) node = node == 0 ? 0 : -1;
  for (FaultFace& face : problem.mesh.faults[0].faces) {
    for (int& node : face.nodes) node = node == 0 ? 0 : -1;
  }
  share_pairs(problem.mesh);
  problem.materials = {{11e9, 0.15}};
  problem.conditions = {
      {Side::x_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}};
  EXPECT_THAT(error_of(problem), testing::HasSubstr("the stiffness matrix is singular at x "));
  EXPECT_THAT(error_of(problem), testing::HasSubstr("is not held well enough"));
}

TEST(LoosePieces, AnUnbalancedLoadOnAPinnedBodyIsRemarked) {
  test::RecordingMonitor monitor;
  const BulkProblem problem = two_blocks({});
  CondensedBulk bulk(problem, monitor);
  ASSERT_EQ(monitor.notes.size(), 1u);
  EXPECT_THAT(monitor.notes[0], testing::HasSubstr("load boundary:0 alone is not in balance"));
}

}  // namespace
}  // namespace faultsim
