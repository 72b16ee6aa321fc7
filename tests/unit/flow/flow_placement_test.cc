// A field in the coordinates of a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

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

/// Boxes of 10 m in rows of ten, whose pressure is their number.
FlowField ten_by_ten() {
  FlowField field;
  field.date = {0};
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d low(10 * (k % 10), 10 * (k / 10), -100);
    field.cells.push_back({low, low + Eigen::Vector3d(10, 10, 10)});
  }
  field.value = Eigen::VectorXd::LinSpaced(100, 0, 99);
  return field;
}

TEST(FlowPlacement, OfAPartIsThatOfTheCellsThatReachIntoABox) {
  const Eigen::Vector3d low(20, 35, -95), high(40, 36, -92);
  for (const double azimuth : {0.0, 0.3}) {
    const FlowField all = placed(ten_by_ten(), {5, 0}, azimuth);
    const FlowField part = placed_within(ten_by_ten(), {5, 0}, azimuth, low, high);
    std::vector<double> expected;
    for (std::size_t f = 0; f < all.cells.size(); ++f) {
      const Eigen::Vector3d &from = all.cells[f].low, &to = all.cells[f].high;
      if (from.x() < 40 && to.x() > 20 && from.y() < 36 && to.y() > 35)
        expected.push_back(all.value(static_cast<Eigen::Index>(f), 0));
    }
    ASSERT_EQ(part.cells.size(), expected.size());
    EXPECT_GT(expected.size(), 2U);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(part.value(static_cast<Eigen::Index>(k), 0), expected[k]);
      EXPECT_EQ(part.cells[k].low, all.cells[static_cast<std::size_t>(expected[k])].low);
    }
  }
  EXPECT_TRUE(
      placed_within(ten_by_ten(), {0, 0}, 0, low, Eigen::Vector3d(40, 36, -200)).cells.empty());
}

}  // namespace
}  // namespace faultsim
