#include <gtest/gtest.h>

#include "simulator/condensation/condensation.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {
namespace {

/// A dipping fault that cuts a roller base: there the fixed vertical is neither strike nor dip.
TEST(LockedNodes, AreReportedAndLeftOutOfTheContactProblem) {
  BoxMeshSpec spec{};
  spec.from = {-100, 0, -100};
  spec.to = {100, 50, 0};
  spec.layer_materials = {0};
  spec.fault_names = {"F"};
  spec.patches.push_back({{0, 25, -50}, 0.0, 0.35, 1000, 1000});
  spec.sizes = {25, 25, 25, 1.3, 1e4, 0};
  BulkProblem problem;
  problem.mesh = make_mesh(spec);
  problem.materials = {{10e9, 0.2}};
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  for (const Side side : {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min}) {
    std::array<bool, 3> components = {false, false, false};
    components[static_cast<std::size_t>(side) / 2] = true;
    problem.conditions.push_back({side, components, Eigen::Vector3d::Zero(), none, -1});
  }
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(problem, monitor).condense();
  const OperatorFault& fault = op.geometry.faults.front();
  EXPECT_EQ(fault.n_nodes, static_cast<int>(op.geometry.nodes.size()));
  for (const OperatorNode& node : op.geometry.nodes) EXPECT_GE(node.dof[0], 0);
  std::size_t n_on_base = 0;
  for (std::size_t point = 0; point < fault.points.size(); ++point) {
    const bool on_base = std::abs(fault.points[point].z() + 100) < 1e-9;
    n_on_base += on_base;
    ASSERT_EQ(fault.node_of_point[point] < 0, on_base);
    if (on_base) continue;
    const OperatorNode& node =
        op.geometry.nodes[static_cast<std::size_t>(fault.node_of_point[point])];
    EXPECT_LT((node.position - fault.points[point]).norm(), 1e-9);
  }
  EXPECT_EQ(op.geometry.locked_positions.size(), n_on_base);
}

}  // namespace
}  // namespace faultsim
