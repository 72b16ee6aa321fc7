// What a case starts with on its mesh is what the scene alone says of the fault's plane.
#include "simulator/loads/initial_traction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "simulator/initial_state/on_fault.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

/// A node of fault F2 between both blocks.
FaultGeometry node_of_second_fault(const Scene& scene, double depth) {
  const std::array<double, 3> normal = fault_normal(scene, 1);
  OperatorNode node;
  node.position = {0, 0, -depth};
  node.normal = {normal[0], normal[1], normal[2]};
  node.strike = {0, 1, 0};
  node.dip = node.normal.cross(node.strike);
  node.dof = {0, 1, 2};
  node.pressure = {{0, 1.0, 1, 1.0, 1.0}};
  FaultGeometry geometry;
  geometry.nodes = {node};
  geometry.faults.resize(2);
  geometry.faults[1].n_nodes = 1;
  geometry.n_dofs = 3;
  return geometry;
}

TEST(InitialTraction, IsThatOfTheScenesPlane) {
  for (const char* rule : {"mean", "max"}) {
    const Scene scene = varied(rotliegend(), {{"/faults/1/dip_from_vertical", "-25 deg"},
                                              {"/geometry/blocks/1/overpressure", "65 bar"},
                                              {"/geometry/blocks/1/offset", "50 m"},
                                              {"/fault_pressure/fault_biot", "0.9"},
                                              {"/fault_pressure/rule", rule}});
    const double depth = 2130;
    const InitialTraction mesh =
        initial_traction(scene, node_of_second_fault(scene, depth), {0, 1});
    const InitialOnFault plane = initial_on_fault(scene, 1, depth);
    EXPECT_NEAR(plane.normal, mesh.traction[0], 1e-6);
    EXPECT_NEAR(plane.shear, mesh.traction.tail(2).norm(), 1e-6);
    EXPECT_GT(plane.shear, 1e5);
    EXPECT_NEAR(plane.pressure, mesh.pressure[0], 1e-6) << rule;
  }
}

}  // namespace
}  // namespace faultsim
