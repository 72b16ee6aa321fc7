// A field in the coordinates of a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/flow_field.h"

namespace faultsim {
namespace {

FlowField one_box() {
  FlowField field;
  field.cells = {{{1000, 2000, -110}, {1030, 2040, -100}}};
  field.date = {0};
  field.value = Eigen::MatrixXd::Constant(1, 1, 1e7);
  return field;
}

TEST(FlowPlacement, ShiftsBoxesAndLeavesThemBoxes) {
  const FlowField there = placed(one_box(), {990, 1980}, 0);
  EXPECT_FALSE(there.cells[0].corners);
  EXPECT_EQ(there.cells[0].low, Eigen::Vector3d(10, 20, -110));
  EXPECT_EQ(there.cells[0].high, Eigen::Vector3d(40, 60, -100));
}

/// With y of the scene towards the field's east, what was east is north and what was north is west.
TEST(FlowPlacement, TurnsWhatIsTowardsTheAzimuthAlongY) {
  const FlowField there = placed(one_box(), {1000, 2000}, std::numbers::pi / 2);
  EXPECT_NEAR((there.cells[0].low - Eigen::Vector3d(-40, 0, -110)).norm(), 0, 1e-9);
  EXPECT_NEAR((there.cells[0].high - Eigen::Vector3d(0, 30, -100)).norm(), 0, 1e-9);
  const FlowField oblique = placed(one_box(), {500, 500}, 0.3);
  EXPECT_NEAR(flow_cell_volume(oblique.cells[0]), 12000, 1e-6);
  const Eigen::Vector3d moved = oblique.cells[0].corners->at(0);
  EXPECT_NEAR(moved.y(), 500 * std::sin(0.3) + 1500 * std::cos(0.3), 1e-9);
}

}  // namespace
}  // namespace faultsim
