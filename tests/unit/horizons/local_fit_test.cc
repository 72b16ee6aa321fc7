#include "simulator/horizons/local_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simulator/horizons/map_barriers.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

std::vector<SeenPoint> seen_from(const Vector2d& place, std::vector<Eigen::Vector3d> points) {
  std::vector<SeenPoint> seen;
  for (const Eigen::Vector3d& p : points) seen.push_back({p, (p.head<2>() - place).norm()});
  std::ranges::sort(seen, {}, &SeenPoint::away);
  return seen;
}

TEST(LocalFit, IsExactForWhatItsOrderHolds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0, 400);
  const auto curved = [](double x, double y) {
    return -2000 + 0.1 * x - 0.2 * y + 1e-4 * (x * x - 3 * x * y + 2 * y * y);
  };
  const auto plane = [](double x, double y) { return -2000 + 0.1 * x - 0.2 * y; };
  std::vector<Eigen::Vector3d> many, few;
  for (int k = 0; k < 14; ++k) {
    const double x = at(random), y = at(random);
    many.emplace_back(x, y, curved(x, y));
    if (k < 5) few.emplace_back(x, y, plane(x, y));
  }
  EXPECT_NEAR(LocalFit(seen_from({-50, 200}, many)).at({-50, 200}), curved(-50, 200), 1e-8);
  EXPECT_NEAR(LocalFit(seen_from({-50, 200}, few)).at({-50, 200}), plane(-50, 200), 1e-9);
}

/// Points thin out with their distance, so that R is no measure of how near one is.
TEST(LocalFit, GoesOnAsFarAsItIsToldTo) {
  std::vector<Eigen::Vector3d> slope;
  for (int k = 0; k < 16; ++k) slope.emplace_back(100 * (k % 4), 100 * (k / 4), 10 * (k % 4));
  const Vector2d far(-900, 100);
  const std::vector<SeenPoint> seen = seen_from(far, slope);
  EXPECT_NEAR(LocalFit(seen, 50).at(far), -5, 1e-6);
  EXPECT_NEAR(LocalFit(seen, 50).at({-20, 100}), -2, 1e-6);
}

TEST(LocalFit, OfPointsOnALineIsConstantAcrossAndOfOneConstant) {
  std::vector<Eigen::Vector3d> line;
  for (int k = 0; k < 5; ++k) line.emplace_back(30. * k, 40. * k, -1000 - 10. * k);
  const LocalFit fit(seen_from({0, 0}, line));
  EXPECT_NEAR(fit.at({15, 20}), -1005, 1e-9);
  EXPECT_NEAR(fit.at({15 - 40, 20 + 30}), -1005, 1e-9) << "across";
  for (int k = 0; k < 5; ++k) line[k] += (k % 2 == 0 ? 0.3 : -0.3) * Eigen::Vector3d(0.8, -0.6, 1);
  EXPECT_NEAR(LocalFit(seen_from({0, 0}, line)).at({15 - 40, 20 + 30}), -1005, 1)
      << "nearly on a line: what is across it says nothing";
  EXPECT_EQ(LocalFit(seen_from({0, 0}, {{100, 0, -7}})).at({0, 0}), -7);
}

TEST(LocalFit, MeetsAPointAtThePlaceAndDoesNotRunOff) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(-300, 300);
  std::vector<Eigen::Vector3d> points = {{0, 0, -2000}};
  for (int k = 0; k < 13; ++k) {
    const double x = at(random), y = at(random);
    points.emplace_back(x, y, -2000 + 0.1 * x + 5 * std::sin(x / 50));
  }
  EXPECT_NEAR(LocalFit(seen_from({0, 0}, points)).at({0, 0}), -2000, 1e-2);
  const LocalFit fit(seen_from({-5000, 0}, points));
  EXPECT_LT(std::abs(fit.at({-5000, 0}) + 2000), 200) << "by the slope to there it would be 500 m";
}

/// Rows of points 60, 160 and 260 m away, of which the first two are a slope and the last a level:
/// a parabola through them would be 32 m above the first at the place.
TEST(LocalFit, DoesNotFollowASharpBendOutOfThePoints) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 15; ++k) {
    const int row = k / 5;
    points.emplace_back(60 + 100 * row, 100 * (k % 5) - 200, row == 0 ? 0 : -29 - row);
  }
  const LocalFit fit(seen_from({0, 0}, points));
  EXPECT_GT(fit.at({0, 0}), 0);
  EXPECT_LT(fit.at({0, 0}), 27);
  EXPECT_NEAR(fit.at({60, 0}), 0, 1) << "within them nothing is cut";
}

/// By the signs of turns, nothing sorted into bins.
bool do_cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto turn = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x() > 0;
  };
  return turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b);
}

TEST(MapBarriers, CrossWhatCrosses) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(0, 1000), step(-60, 60);
  std::vector<MapBarriers::Stretch> stretches;
  for (int k = 0; k < 60; ++k) {
    const Vector2d from(at(random), at(random));
    stretches.push_back({from, from + Vector2d(step(random), step(random))});
  }
  const MapBarriers barriers(stretches);
  int n_crossing = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vector2d a(at(random), at(random));
    const Vector2d b = k % 2 == 0 ? Vector2d(at(random), at(random))
                                  : Vector2d(a + Vector2d(step(random), step(random)));
    const bool is_crossed = std::ranges::any_of(
        stretches, [&](const auto& one) { return do_cross(a, b, one[0], one[1]); });
    EXPECT_EQ(barriers.cross(a, b), is_crossed);
    n_crossing += is_crossed;
  }
  EXPECT_GT(n_crossing, 300);
}

TEST(MapBarriers, SeeRoundABendAndNotThroughATrace) {
  const MapBarriers barriers({{{{0, 0}, {100, 0}}}, {{{100, 0}, {200, -20}}}});
  EXPECT_TRUE(barriers.sees({50, 10}, {150, 20}));
  EXPECT_FALSE(barriers.sees({50, 10}, {50, -10}));
  EXPECT_FALSE(barriers.sees({30, 60}, {30, -60})) << "around the end, much further";
  EXPECT_TRUE(barriers.sees({-20, 60}, {-20, -60}));
  EXPECT_TRUE(barriers.sees({20, 1}, {190, -17})) << "along the outer side of the bend";
  EXPECT_TRUE(barriers.sees({20, -1}, {190, -19}));
  EXPECT_TRUE(barriers.is_within({50, 9}, 10));
  EXPECT_FALSE(barriers.is_within({50, 11}, 10));
  EXPECT_FALSE(barriers.is_within({150, 0}, 8)) << "of a slanting one, in whose box it is";
}

}  // namespace
}  // namespace faultsim::horizons
