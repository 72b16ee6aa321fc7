#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/unit/condensation/test_problem.h"
#include "tests/unit/mesh/cut_body.h"

/// Faults that end, meet and cross in quadratic tetrahedra, by problems with exact answers.
namespace faultsim {
namespace {

using Eigen::Vector3d;
using test::PlanePart;

constexpr int kCubes = 4;
const std::vector<PlanePart> kFaults = {
    {"A", {1, 0, 0}, 2},
    {"B", {0, 1, 0}, 2, [](const Vector3d& x) { return x.x() > 2; }},
    {"C", {0, 0, 1}, 2}};

Eigen::Matrix3d some_stress() {
  Eigen::Matrix3d stress;
  stress << -20, 3, 2, 3, -25, 1, 2, 1, -30;
  return 1e6 * stress;
}

/// Bends the planes of the faults and all else with them.
Vector3d curved(const Vector3d& x) {
  return {x.x() + 0.15 * std::sin(0.8 * x.y() + 0.5 * x.z()), x.y() + 0.1 * std::sin(0.9 * x.z()),
          x.z() + 0.12 * std::sin(0.7 * x.x() + 0.3 * x.y())};
}

BulkProblem cube(const std::vector<PlanePart>& faults, bool is_curved) {
  UncutMesh body = test::body_of(test::made_of(kCubes, 3), kCubes, faults);
  test::distort(body, kCubes, 0.12);
  for (Vector3d& x : body.nodes) x = is_curved ? curved(x) : x;
  BulkProblem problem;
  problem.mesh = cut(body, "");
  problem.materials = {{11e9, 0.15}};
  return problem;
}

/// Locked tractions less σ n, the largest; nodes that a condition leaves out do not count.
template <typename Condition>
double largest_error(const FaultOperator& op, const Condition& counts) {
  double largest = 0;
  for (const OperatorNode& node : op.geometry.nodes) {
    if (!counts(node)) continue;
    const Vector3d traction = some_stress() * node.normal;
    const std::array<Vector3d, 3> axes = {node.normal, node.strike, node.dip};
    for (std::size_t c = 0; c < 3; ++c)
      largest =
          std::max(largest, std::abs(op.loads.traction(node.dof[c], 0) - axes[c].dot(traction)));
  }
  return largest / 30e6;
}

TEST(Tetrahedra, LockedTractionsAreSigmaNAtEndsMeetingsAndCrossings) {
  for (const bool mean_dilatation : {true, false}) {
    BulkProblem problem = cube(kFaults, false);
    problem.mean_dilatation = mean_dilatation;
    problem.loads = {test::stress_case(some_stress(), test::all_sides())};
    const FaultOperator op = test::condense(problem);
    EXPECT_EQ(op.geometry.nodes.size(), 25u + 15 + 25 + 5 + 3);
    // Where three faults meet the jumps of the last are within sides of both others, whose
    // tractions cannot be kept out of them all.
    const auto is_triple = [](const OperatorNode& node) {
      return node.position == Vector3d(2, 2, 2);
    };
    EXPECT_LT(largest_error(op, [&](const OperatorNode& node) { return !is_triple(node); }), 1e-10);
    EXPECT_LT(largest_error(op, is_triple), 0.5);
  }
}

TEST(Tetrahedra, CurvedFaultsKeepTheNetTractionOfTheirFacets) {
  BulkProblem problem = cube({kFaults[0]}, true);
  problem.loads = {test::stress_case(some_stress(), test::all_sides())};
  const FaultOperator op = test::condense(problem);
  // The force on a node is σ times the sum of its facets' area vectors, whichever way they look.
  const FaultSurface& fault = problem.mesh.faults[0];
  std::vector<Vector3d> area(fault.nodes.size(), Vector3d::Zero());
  for (const FaultFace& face : fault.faces) {
    const auto at = [&](std::size_t v) { return fault.points[face.points[v]]; };
    for (std::size_t v = 0; v < 3; ++v)
      area[static_cast<std::size_t>(face.nodes[v])] += (at(1) - at(0)).cross(at(2) - at(0)) / 6;
  }
  for (std::size_t k = 0; k < area.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const Vector3d force = some_stress() * area[k] / node.area;
    EXPECT_NEAR(op.loads.traction(node.dof[0], 0), force.dot(node.normal), 1e-10 * 30e6);
    EXPECT_NEAR(op.loads.traction(node.dof[2], 0), force.dot(node.dip), 1e-10 * 30e6);
  }
}

/// What the mean of the two blocks before A is made of where B ends: the jump of A is the mean's.
std::pair<double, double> shares_of_mean(const Mesh& mesh, const Vector3d& at) {
  double below = 0, above = 0;
  for (const NodeCopy& copy : mesh.copies)
    for (const JumpShare& share : copy.shares) {
      if (share.fault != 1 || mesh.nodes[static_cast<std::size_t>(copy.node)] != at) continue;
      (share.weight < 0 ? above : below) = std::abs(share.weight);
    }
  return {below, above};
}

TEST(Tetrahedra, RigidMotionsOfThreeBlocksAtATCostNothing) {
  BulkProblem problem = cube({kFaults[0], kFaults[1]}, false);
  problem.loads = {test::stress_case(some_stress(), test::all_sides())};
  const FaultOperator op = test::condense(problem);
  const Eigen::MatrixXd h = dynamic_cast<const DenseCompliance&>(*op.compliance).matrix();
  const double scale = h.norm();
  for (int block = 0; block < 3; ++block) {
    for (int motion = 0; motion < 6; ++motion) {
      const auto moved = [&](const Vector3d& x, int of) -> Vector3d {
        if (of != block) return Vector3d::Zero();
        return motion < 3 ? Vector3d(Vector3d::Unit(motion)) : Vector3d::Unit(motion - 3).cross(x);
      };
      Eigen::VectorXd g = Eigen::VectorXd::Zero(op.geometry.n_dofs);
      for (const OperatorNode& node : op.geometry.nodes) {
        const Vector3d& x = node.position;
        const bool on_a = std::abs(node.normal.x()) > 0.5;
        Vector3d jump = moved(x, 2) - moved(x, 1);
        if (on_a) {
          auto [below, above] = shares_of_mean(problem.mesh, x);
          if (x.y() < 2) below = 1;
          if (x.y() > 2) above = 1;
          jump = below * moved(x, 1) + above * moved(x, 2) - moved(x, 0);
        }
        const std::array<Vector3d, 3> axes = {node.normal, node.strike, node.dip};
        for (std::size_t c = 0; c < 3; ++c) g[node.dof[c]] = axes[c].dot(jump);
      }
      EXPECT_LT((h * g).norm(), 1e-12 * scale * g.norm()) << block << ' ' << motion;
    }
  }
}

}  // namespace
}  // namespace faultsim
