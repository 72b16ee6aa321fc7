#include "simulator/scene/offset_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/scene/field_depths.h"

namespace faultsim {
namespace {

/// Reservoir 2000 to 2200 m, faults 150 m beyond its edges: lines meet at offsets of the east block
/// of 0 m, 150 m (a tip and an edge) and 200 m (top and base).
FieldGeometry field() {
  FieldGeometry f;
  f.depth = 5000;
  f.layers = {
      {"overburden", "", 0}, {"salt", "", 1500}, {"reservoir", "", 2000}, {"rock", "", 2200}};
  f.reservoir_layer = "reservoir";
  f.blocks = {{.name = "west", .from = -2000, .to = 0}, {.name = "east", .from = 0, .to = 2000}};
  f.fault_overshoot = 150;
  return f;
}

/// Depths of lines that bound gaps, by hand: those of layers, of both reservoirs and of the tips of
/// F1, F2 and F3, for 0 < offset < 200 m.
std::vector<double> lines_at(double offset) {
  std::vector<double> z = {0, 1500, 1850, 2000, 2200, 2350, 5000};
  for (const double moved : {1850, 2000, 2200, 2350}) z.push_back(moved + offset);
  std::ranges::sort(z);
  return z;
}

TEST(OffsetIntervals, CoverTheRangeButForWhereLinesMeet) {
  const std::vector<OffsetInterval> all = offset_intervals(field(), 1, 0, 200);
  ASSERT_GE(all.size(), 4u);
  const double keeps[] = {1.875, 148.125, 150.625, 199.375};  // an eightieth of 150 m, and of 50 m
  EXPECT_NEAR(all.front().from, keeps[0], 1e-9);
  EXPECT_NEAR(all.back().to, keeps[3], 1e-9);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const bool at_tip = std::abs(all[i].to - keeps[1]) < 1e-9;
    EXPECT_NEAR(all[i + 1].from, at_tip ? keeps[2] : all[i].to, 1e-9);
  }
  EXPECT_EQ(std::ranges::count_if(all, [](const auto& one) { return one.holds(149.9); }), 0);
}

TEST(OffsetIntervals, HaveLayoutsFromWhichLinesCanBeMovedToTheirEnds) {
  for (const OffsetInterval& one : offset_intervals(field(), 1, 0, 200)) {
    EXPECT_TRUE(one.holds(one.layout)) << one.layout;
    const std::vector<double> there = lines_at(one.layout);
    for (const double end : {one.from, one.to}) {
      const std::vector<double> here = lines_at(end);
      for (std::size_t i = 0; i + 1 < here.size(); ++i) {
        const double stretch = (here[i + 1] - here[i]) / (there[i + 1] - there[i]);
        EXPECT_GE(stretch, kLeastStretch) << one.layout << " to " << end;
        EXPECT_LE(stretch, kLargestStretch) << one.layout << " to " << end;
      }
    }
  }
}

/// F3 has its lower tip 120 m below the east block, F1 150 m below the west one.
TEST(OffsetIntervals, KeepAwayFromWhereTipsOfFaultsOfOtherOvershootsMeet) {
  FieldGeometry other = field();
  other.fault_extents = {{}, {}, {.overshoot = 120}};
  const auto hold = [](const FieldGeometry& of, double offset) {
    return std::ranges::count_if(offset_intervals(of, 1, 0, 200),
                                 [&](const auto& one) { return one.holds(offset); });
  };
  EXPECT_EQ(hold(other, 30), 0);
  EXPECT_GT(hold(field(), 30), 0);
  for (const double beside : {25.0, 35.0, 60.0}) EXPECT_GT(hold(other, beside), 0) << beside;
}

TEST(OffsetIntervals, AreOneWhereOneLayoutServes) {
  const std::vector<OffsetInterval> all = offset_intervals(field(), 1, 60, 110);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].from, 60);
  EXPECT_EQ(all[0].to, 110);
}

TEST(OffsetIntervals, DoNotDependOnTheBlocksOwnOffset) {
  FieldGeometry other = field();
  other.blocks[1].offset = 73;
  const auto a = offset_intervals(field(), 1, -120, 180), b = offset_intervals(other, 1, -120, 180);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].from, b[i].from);
    EXPECT_EQ(a[i].layout, b[i].layout);
  }
}

TEST(OffsetIntervals, AreMirrorImagesOnTheOtherSideOfZero) {
  const auto up = offset_intervals(field(), 1, -140, -20),
             down = offset_intervals(field(), 1, 20, 140);
  double covered_up = 0, covered_down = 0;
  for (const auto& one : up) covered_up += one.to - one.from;
  for (const auto& one : down) covered_down += one.to - one.from;
  EXPECT_NEAR(covered_up, 120, 1e-9);
  EXPECT_NEAR(covered_down, 120, 1e-9);
}

}  // namespace
}  // namespace faultsim
