#include <gtest/gtest.h>

#include <numeric>

#include "simulator/mesh/structured_grid.h"

namespace faultsim {
namespace {

/// Two blocks that meet in a fault, a trapezoid 1 m wide at the top, 3 m at 2 m depth.
StructuredGrid blocks_with_a_trapezoid_between(int n) {
  StructuredGrid grid;
  grid.lines[0] = {-1, 0, 1};
  for (const int axis : {1, 2}) {
    for (int i = 0; i <= n; ++i) grid.lines[axis].push_back(static_cast<double>(i) / n);
  }
  for (const double z : grid.lines[2]) {
    for (const double y : grid.lines[1]) {
      for (const double x : grid.lines[0])
        grid.position.emplace_back(x, y * (3 - 2 * z), 2 * z - 2);
    }
  }
  grid.material.assign(grid.n_cells(), 0);
  grid.region.assign(grid.n_cells(), -1);
  grid.region_fraction.assign(grid.n_cells(), 0);
  GridFault fault;
  fault.name = "F";
  fault.plane = 1;
  fault.normal = {1, 0, 0};
  fault.strike = {0, -1, 0};
  fault.dip = {0, 0, -1};
  fault.split.assign(grid.n_lines(1) * grid.n_lines(2), 1);
  grid.faults = {fault};
  return grid;
}

/// What uniform tractions on the nodes sum to: the area of the patch, and its first moment, since
/// Σ_k x_k ∫ N_k dA = ∫ x dA.
TEST(CutFaults, NodeAreasHaveTheAreaAndTheCentroidOfThePatch) {
  for (const int n : {1, 3}) {
    const Mesh mesh = cut_faults(blocks_with_a_trapezoid_between(n));
    ASSERT_EQ(mesh.faults.size(), 1u);
    double area = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (const FaultNode& node : mesh.faults[0].nodes) {
      area += node.area;
      moment += node.area * mesh.nodes[node.minus_node];
    }
    EXPECT_NEAR(area, 4, 1e-12) << n;
    EXPECT_NEAR(moment.y() / area, 13.0 / 12, 1e-12) << n;
    EXPECT_NEAR(moment.z() / area, -7.0 / 6, 1e-12) << n;
  }
}

}  // namespace
}  // namespace faultsim
