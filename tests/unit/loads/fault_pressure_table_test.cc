// Tables of fault pressure at nodes: linear in place and time, and where nodes are in them.
#include "simulator/loads/history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace faultsim {
namespace {

FaultPressureTable plane() {  // 2 dip + 3 strike + 5 time, which linear interpolation meets
  FaultPressureTable table;
  table.dip = {0, 1, 4};
  table.strike = {-2, 2};
  table.time = {0, 10};
  for (const double d : table.dip) {
    for (const double s : table.strike) {
      for (const double t : table.time) table.change.push_back(2 * d + 3 * s + 5 * t);
    }
  }
  return table;
}

TEST(FaultPressureTable, IsLinearInPlaceAndTime) {
  const FaultPressureTable table = plane();
  for (const double d : {0.0, 0.3, 1.0, 2.5, 4.0}) {
    for (const double s : {-2.0, 0.7, 2.0}) {
      for (const double t : {0.0, 3.0, 10.0})
        EXPECT_NEAR(table_pressure(table, d, s, t), 2 * d + 3 * s + 5 * t, 1e-12);
    }
  }
}

TEST(FaultPressureTable, IsConstantBeyondItsEnds) {
  FaultPressureTable table = plane();
  EXPECT_NEAR(table_pressure(table, 9, 7, 30), 2 * 4 + 3 * 2 + 5 * 10, 1e-12);
  EXPECT_NEAR(table_pressure(table, -9, -7, 0), -6, 1e-12);
  table.strike.clear();
  table.change = {0, 1, 0, 2, 0, 3};
  EXPECT_NEAR(table_pressure(table, 1, 123, 5), 1, 1e-12);
}

TEST(FaultPressureTable, CountsFromTheCentreOfAPatch) {
  Scene scene;
  scene.geometry_kind = GeometryKind::box;
  PatchGeometry patch;
  patch.center = {100, 200, -3000};
  patch.strike = std::numbers::pi / 2;             // along +x; dips to its right, −y
  patch.dip_from_vertical = std::numbers::pi / 6;  // down dip: (0, −sin 30°, −cos 30°)
  scene.box.patches = {patch};
  scene.faults.resize(1);
  OperatorNode node;
  node.position = {100 + 7, 200 - 4 * std::sin(std::numbers::pi / 6),
                   -3000 - 4 * std::cos(std::numbers::pi / 6)};
  const TablePlace by_depth = place_in_table(scene, 0, node);
  EXPECT_NEAR(by_depth.dip, -node.position.z(), 1e-9);
  EXPECT_NEAR(by_depth.strike, 7, 1e-9);
  scene.faults[0].pressure.profile.place = FaultPressureTable::Place::along_dip;
  EXPECT_NEAR(place_in_table(scene, 0, node).dip, 4, 1e-9);
}

}  // namespace
}  // namespace faultsim
