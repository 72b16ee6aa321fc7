#include "simulator/grid_scene/carried_heights.h"

#include <gtest/gtest.h>

namespace faultsim::grid_scene {
namespace {

using Eigen::Vector2d;

const std::vector<Moved> kSides = {{{-2000, {0.1, 0.02}}, {50, 0}, {1, 0}},
                                   {{-2060, {0.3, -0.04}}, {50, 0}, {1, 0}}};

TEST(CarriedHeights, GoAcrossAFaultByOneSlopeForBothSides) {
  const std::vector<double> z =
      carried(kSides, [](std::size_t, double) { return Vector2d(80, 0); });
  EXPECT_NEAR(z[0], -2000 + 0.2 * 30, 1e-9);
  EXPECT_NEAR(z[1], -2060 + 0.2 * 30, 1e-9);
}

TEST(CarriedHeights, GoAlongAFaultByTheirOwnSlopes) {
  const std::vector<double> z =
      carried(kSides, [](std::size_t, double) { return Vector2d(50, 100); });
  EXPECT_NEAR(z[0], -1998, 1e-9);
  EXPECT_NEAR(z[1], -2064, 1e-9);
}

TEST(CarriedHeights, OfASideThatIsOnNoFaultGoByItsOwnSlope) {
  std::vector<Moved> sides = kSides;
  sides[1].across = {0, 0};
  const std::vector<double> z = carried(sides, [](std::size_t, double) { return Vector2d(80, 0); });
  EXPECT_NEAR(z[0], -1997, 1e-9) << "and is none of those that have one slope";
  EXPECT_NEAR(z[1], -2051, 1e-9);
}

/// The fault is further to the left the higher its line is: 0.9 m for each metre.
TEST(CarriedHeights, AreThoseOfThePlaceAtTheirOwnHeight) {
  const auto place = [](std::size_t, double z) { return Vector2d(80 - 0.9 * (z + 2000), 0); };
  const Moved one = {{-2000, {0.4, 0}}, {50, 0}, {1, 0}};
  // z + 2000 = 0.4 (30 − 0.9 (z + 2000))
  EXPECT_NEAR(carried({one}, place).front(), -2000 + 12 / 1.36, 2e-4);
}

TEST(SideProfile, IsLinearBetweenItsPointsAndEndsWithThem) {
  SideProfile profile;
  EXPECT_EQ(profile.at(0), std::nullopt);
  for (const double along : {300., 0., 100.}) profile.add(along, -2000 + along / 10);
  profile.add(400, -2100);
  EXPECT_EQ(profile.at(-1), std::nullopt);
  EXPECT_EQ(profile.at(0), -2000);
  EXPECT_EQ(profile.at(250), -1975);
  EXPECT_EQ(profile.at(350), -2035);
  EXPECT_EQ(profile.at(400), -2100);
  EXPECT_EQ(profile.at(401), std::nullopt);
}

}  // namespace
}  // namespace faultsim::grid_scene
