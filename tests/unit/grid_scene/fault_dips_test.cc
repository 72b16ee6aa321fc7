#include "simulator/grid_scene/fault_dips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/line_check.h"
#include "tests/unit/grid_scene/made_scene.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::cross_product;
using Eigen::Vector2d;

TEST(ModelFault, LiesFurtherToTheSideThatItDipsToBelow) {
  ModelFault fault;
  fault.trace = {{0, 0}, {0, 100}, {100, 200}};
  fault.leans = {2};
  fault.top = 50;
  fault.bottom = -50;
  const Polyline below = fault.at(-10, 0);
  EXPECT_NEAR(below[0].x(), 20, 1e-9);
  EXPECT_NEAR(cross_product(fault.trace[2] - fault.trace[1], below[1] - fault.trace[1]),
              -20 * std::hypot(100, 100), 1e-6);
  EXPECT_NEAR(fault.at(-80, 0)[0].x(), 100, 1e-9) << "below its end it goes down upright";
  fault.leans = {2, 0, -1};
  const Polyline turned = fault.at(-10, 0);
  EXPECT_NEAR(turned[0].x(), 20, 1e-9);
  EXPECT_NEAR((turned[1] - fault.trace[1]).norm(), 0, 1e-9);
  EXPECT_NEAR(cross_product(fault.trace[2] - fault.trace[1], turned[2] - fault.trace[2]),
              10 * std::hypot(100, 100), 1e-6);
}

/// Pillars along y from 0 to 1,000 m that lean by 0.2 and by 0.001 more per metre; one of them is
/// far off.
std::vector<FaultPillar> leaning_pillars() {
  std::vector<FaultPillar> pillars;
  for (int k = 0; k <= 20; ++k) {
    const double y = 50 * k, lean = k == 10 ? 4 : 0.2 + 0.001 * y;
    pillars.push_back({{0, y}, lean, {-50 * lean, y}, {50 * lean, y}, -1950, -2050});
  }
  return pillars;
}

ModelFault model_fault() {
  ModelFault fault;
  fault.name = "F1";
  fault.trace = {{0, -200}, {0, 1000}};
  fault.top = -1500;
  fault.bottom = -2500;
  return fault;
}

TEST(FaultDips, AreMeansOfThePillarsNearby) {
  ModelFault fault = model_fault();
  take_dips(leaning_pillars(), 100, -2000, fault);
  ASSERT_EQ(fault.trace.size(), 13u) << "points 100 m apart";
  ASSERT_EQ(fault.leans.size(), 13u);
  EXPECT_EQ(fault.leans[0], fault.leans[2]) << "beyond the pillars as at the last one";
  EXPECT_NEAR(fault.leans[2], 0.25, 0.02) << "a mean of one side";
  EXPECT_NEAR(fault.leans[5], 0.5, 0.03);
  EXPECT_NEAR(fault.leans[10], 1, 0.03);
  EXPECT_NEAR(fault.leans[7], 0.7 + 3.3 * 50 / (100 * std::sqrt(std::numbers::pi)), 0.05)
      << "one of many";
}

TEST(FaultDips, WithoutAReachAreTheMedian) {
  ModelFault fault = model_fault();
  take_dips(leaning_pillars(), 0, -2000, fault);
  EXPECT_EQ(fault.trace.size(), 2u);
  ASSERT_EQ(fault.leans.size(), 1u);
  EXPECT_NEAR(fault.leans[0], 0.75, 1e-9) << "which the one far off moves by half a step";
}

TEST(FaultDips, TheReportSaysSpreadAndDistance) {
  ModelFault fault = model_fault();
  std::vector<FaultPillar> pillars = leaning_pillars();
  pillars.erase(pillars.begin() + 10);
  take_dips(pillars, 100, -2000, fault);
  EXPECT_EQ(dips_text(pillars, fault, 100, -2000),
            "F1 dips by 41 to 76 degrees along its trace, its pillars by 40 to 79 (means over 100 "
            "m); at the reservoir's top and base they are 1 m from it on average, with one dip "
            "14 m");
  ModelFault plain = model_fault();
  take_dips(pillars, 0, -2000, plain);
  EXPECT_NEAR(mean_distance(pillars, plain, -2000), 13.75, 1e-6) << "50 m of 0.275";
  EXPECT_THAT(dips_text(pillars, plain, 0, -2000),
              testing::StartsWith("F1 has one dip, 55 degrees, the median of its pillars' (40 to "
                                  "79), which are 14 m from it"));
  pillars[0].lean = -0.1;
  EXPECT_THAT(dips_text(pillars, plain, 0, -2000), testing::HasSubstr("(84 over 90 to 40)"));
}

/// The pillars of one fault lean more and more along it.
corner_point::CornerPointGrid turning_grid(double first, double last) {
  corner_point::MadeGrid spec = grid_of_a_fault(0);
  spec.faults = {{{1500, -200}, {1500, 2600}, [](double) { return 60.0; }}};
  corner_point::CornerPointGrid grid = made(spec);
  for (corner_point::Pillar& pillar : grid.pillars) {
    const double lean = first + (last - first) * pillar.top.y() / 2400;
    const double height = pillar.top.z() - pillar.bottom.z();
    pillar.top.x() -= lean * height / 2;
    pillar.bottom.x() += lean * height / 2;
  }
  return grid;
}

TEST(FaultDips, OfAGridThatTurnsFollowItsPillars) {
  const MadeScene all = scene_of(turning_grid(0.2, 1));
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  const ModelFault& fault = all.made.lines.faults[0];
  const auto pillars = fault_pillars(corner_point::ColumnMap(all.grid), all.structure.faults[0],
                                     all.made.lines.reference_z);
  // The trace comes from the west, where it lies furthest at the reference height.
  const bool runs_north = fault.trace.back().y() > fault.trace.front().y();
  const double south = runs_north ? fault.leans.front() : -fault.leans.back();
  const double north = runs_north ? fault.leans.back() : -fault.leans.front();
  EXPECT_NEAR(south, 0.25, 0.15);
  EXPECT_NEAR(north, 0.95, 0.15);
  EXPECT_LT(mean_distance(pillars, fault, all.made.lines.reference_z), 3);
  ModelFault plain = fault;
  take_dips(pillars, 0, all.made.lines.reference_z, plain);
  EXPECT_GT(mean_distance(pillars, plain, all.made.lines.reference_z), 6);
  EXPECT_TRUE(says(all.made.remarks, "F1 dips by "));
  EXPECT_EQ(first_misfit(all.made.lines), std::nullopt);
}

/// Two thirds of the fault lean by 2.5 to one side, the rest as much to the other: dips over 2
/// cells let pillars cross.
TEST(FaultDips, AreMoreEvenUntilTheBodyCanBeBuilt) {
  corner_point::CornerPointGrid grid = turning_grid(0, 0);
  for (corner_point::Pillar& pillar : grid.pillars) {
    const double lean = pillar.top.y() < 1500 ? 2.5 : -2.5;
    pillar.top.x() -= 500 * lean;
    pillar.bottom.x() += 500 * lean;
  }
  const MadeScene all = scene_of(grid);
  EXPECT_EQ(first_misfit(all.made.lines), std::nullopt);
  EXPECT_TRUE(says(all.made.remarks, "(means over 320 m)")) << "4 cells of 80 m";
}

/// Pillars that turn back and forth, at 600 m.
TEST(FaultDips, OneDipIsTakenWhereMoreAreNoNearer) {
  corner_point::CornerPointGrid grid = turning_grid(0.2, 0.2);
  for (corner_point::Pillar& pillar : grid.pillars) {
    const double lean = std::fmod(pillar.top.y(), 1200) < 600 ? 3 : -3;
    pillar.top.x() -= 500 * lean;
    pillar.bottom.x() += 500 * lean;
  }
  const MadeScene all = scene_of(grid);
  ASSERT_EQ(all.made.lines.faults.size(), 1u);
  EXPECT_EQ(all.made.lines.faults[0].leans.size(), 1u);
  EXPECT_TRUE(says(all.made.remarks,
                   "F1 has one dip, 17 degrees, the median of its pillars' (20 "
                   "over 90 to 17)"));
}

}  // namespace
}  // namespace faultsim::grid_scene
