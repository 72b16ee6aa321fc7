#include "simulator/grid_scene/carried_heights.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace faultsim::grid_scene {
namespace {

using Eigen::Vector2d;

const std::vector<Moved> kSides = {{{-2000, {0.1, 0.02}}, {50, 0}, {1, 0}},
                                   {{-2060, {0.3, -0.04}}, {50, 0}, {1, 0}}};

template <typename Place>
std::vector<double> carried_all(const std::vector<Moved>& sides, const Place& place) {
  const CarriedHeights found = carried(sides, place);
  EXPECT_TRUE(found.is_found);
  return found.z;
}

TEST(CarriedHeights, GoAcrossAFaultByOneSlopeForBothSides) {
  const std::vector<double> z =
      carried_all(kSides, [](std::size_t, double) { return Vector2d(80, 0); });
  EXPECT_NEAR(z[0], -2000 + 0.2 * 30, 1e-9);
  EXPECT_NEAR(z[1], -2060 + 0.2 * 30, 1e-9);
}

TEST(CarriedHeights, GoAlongAFaultByTheirOwnSlopes) {
  const std::vector<double> z =
      carried_all(kSides, [](std::size_t, double) { return Vector2d(50, 100); });
  EXPECT_NEAR(z[0], -1998, 1e-9);
  EXPECT_NEAR(z[1], -2064, 1e-9);
}

TEST(CarriedHeights, OfASideThatIsOnNoFaultGoByItsOwnSlope) {
  std::vector<Moved> sides = kSides;
  sides[1].across = {0, 0};
  const std::vector<double> z =
      carried_all(sides, [](std::size_t, double) { return Vector2d(80, 0); });
  EXPECT_NEAR(z[0], -1997, 1e-9) << "and is none of those that have one slope";
  EXPECT_NEAR(z[1], -2051, 1e-9);
}

/// The fault is further to the left the higher its line is: 0.9 m for each metre.
TEST(CarriedHeights, AreThoseOfThePlaceAtTheirOwnHeight) {
  const auto place = [](std::size_t, double z) { return Vector2d(80 - 0.9 * (z + 2000), 0); };
  const Moved one = {{-2000, {0.4, 0}}, {50, 0}, {1, 0}};
  // z + 2000 = 0.4 (30 − 0.9 (z + 2000))
  EXPECT_NEAR(carried_all({one}, place).front(), -2000 + 12 / 1.36, 2e-4);
}

/// Columns that rise by 60 m against a fault of 45 degrees, where cells are 100 m long: the slope
/// between their leaning pillars is 1.5. Top and base are 40 m apart on every pillar.
TEST(CarriedHeights, KeepAThicknessThatIsConstantHoweverSteepTheSurfaceIs) {
  for (const double slope : {0.5, 1.5, 40.0}) {
    const Moved base = {{-2040, {slope, 0}}, {40, 0}};
    const double x = 10, top = -2000 + slope * x;  // a pillar of the model, 10 m beside
    const std::vector<double> z = carried_all(
        {base}, [&](std::size_t, double height) { return Vector2d(x + top - height, 0); });
    EXPECT_NEAR(z.front(), top - 40, 1e-5) << slope;
  }
}

/// Both walls rise against the fault, by 1.5 and by 2.5: each where its own height is.
TEST(CarriedHeights, KeepTheThrowHoweverSteepBothSidesAre) {
  const std::vector<Moved> sides = {{{-2000, {1.5, 0}}, {0, 0}, {1, 0}},
                                    {{-2060, {2.5, 0}}, {60, 0}, {1, 0}}};
  const std::vector<double> z = carried_all(
      sides, [](std::size_t, double height) { return Vector2d(12 - (height + 2000), 0); });
  // both ways are 12 − c, and c = 2 (12 − c)
  EXPECT_NEAR(z[0], -2000 + 8, 1e-5);
  EXPECT_NEAR(z[1], -2060 + 8, 1e-5);
}

/// Below its top the line leans steeply, above it stands upright: a secant through both misses.
TEST(CarriedHeights, AreFoundWherePlacesTurn) {
  const auto place = [](std::size_t, double z) {
    return Vector2d(60 - 8 * std::min(0.0, z + 1990), 0);
  };
  // the surface: 30 m above its level where z > −1990, else 30 − 4 (z + 1990)
  const Moved upright = {{-2000, {0.5, 0}}, {0, 0}};
  EXPECT_NEAR(carried_all({upright}, place).front(), -1970, 1e-5);
  const Moved leaning = {{-2030, {0.5, 0}}, {0, 0}};
  EXPECT_NEAR(carried_all({leaning}, place).front(), -2030 + 190. / 5, 1e-5);
}

TEST(CarriedHeights, StayWhereThePlaceLeapsOverThem) {
  // Moved by 100 m the surface is at −1990, where it is not moved; not moved at −2000, where it is.
  const auto place = [](std::size_t, double z) {
    return z < -1995 ? std::optional(Vector2d(100, 0)) : std::nullopt;
  };
  const CarriedHeights found = carried({{{-2000, {0.1, 0}}, {0, 0}}}, place);
  EXPECT_FALSE(found.is_found);
  EXPECT_EQ(found.z, std::vector<double>{-2000});
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

/// Pillars of a short fault may have places at the top, and none on one side at the base.
TEST(SideProfiles, HaveNothingOfASideWithoutPoints) {
  SideProfiles profiles;
  for (const double along : {0., 100.}) profiles.add(2, 1, along, -2000 + along / 10);
  EXPECT_EQ(profiles.at(2, 1, 50), -1995);
  EXPECT_EQ(profiles.at(2, 1, 101), std::nullopt);
  EXPECT_EQ(profiles.at(2, -1, 50), std::nullopt);
  EXPECT_EQ(profiles.at(0, 1, 50), std::nullopt);
}

}  // namespace
}  // namespace faultsim::grid_scene
