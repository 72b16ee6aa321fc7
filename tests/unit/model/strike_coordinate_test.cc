#include "simulator/model/strike_coordinate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace faultsim {
namespace {

using Eigen::Vector3d;

/// A sheet of points over (length along the trace, way down), in triangles of either orientation.
struct Sheet {
  template <typename Place>
  Sheet(int n_along, int n_down, Place place) {
    std::mt19937 draw(7);
    for (int c = 0; c <= n_along; ++c) {
      for (int r = 0; r <= n_down; ++r) {
        points.push_back(place(c, r));
        if (c == 0 || r == 0) continue;
        const int at = c * (n_down + 1) + r, before = at - n_down - 1;
        add({before - 1, before, at}, draw() % 2 == 0);
        add({before - 1, at, at - 1}, draw() % 2 == 0);
      }
    }
  }
  void add(const std::array<int, 3>& t, bool flipped) {
    faces.push_back({t[0], t[flipped ? 2 : 1], t[flipped ? 1 : 2], t[flipped ? 1 : 2]});
  }
  StrikeCoordinate solve() const { return strike_coordinate(points, faces); }

  std::vector<Vector3d> points;
  std::vector<std::array<int, 4>> faces;
};

TEST(StrikeCoordinate, OfAPlaneIsTheProjectionOntoItsStrike) {
  const Vector3d strike = Vector3d(0.6, 0.8, 0), dip(0.8 * 0.5, -0.6 * 0.5, -std::sqrt(0.75));
  const Sheet plane(7, 5, [&](int c, int r) -> Vector3d {
    return Vector3d(1e5, 2e5, -2000) + (40 * c + 7 * r) * strike + 25 * r * dip;
  });
  const StrikeCoordinate found = plane.solve();
  EXPECT_NEAR((found.mean - strike).norm(), 0, 1e-12);
  for (std::size_t i = 0; i < plane.points.size(); ++i)
    EXPECT_NEAR(found.along[i], plane.points[i].dot(strike), 1e-6);
}

TEST(StrikeCoordinate, IsTheLengthOfAVerticalTraceHoweverItBends) {
  // Legs of 30 m that turn by 40 degrees each, by 320 degrees in all.
  std::vector<Vector3d> trace{Vector3d::Zero()};
  for (int leg = 0; leg < 9; ++leg) {
    const double angle = (40 * leg - 160) * std::numbers::pi / 180;
    trace.push_back(trace.back() + 30 * Vector3d(std::sin(angle), std::cos(angle), 0));
  }
  const Sheet sheet(9, 4, [&](int c, int r) -> Vector3d {
    return trace[static_cast<std::size_t>(c)] - 20 * r * Vector3d::UnitZ();
  });
  const StrikeCoordinate found = sheet.solve();
  for (std::size_t i = 0; i < sheet.points.size(); ++i)
    EXPECT_NEAR(found.along[i] - found.along[0], 30. * static_cast<double>(i / 5), 1e-9);
}

/// A quarter of a cone that dips at 60 degrees: no function has the strike as its gradient. The
/// closest one's level line is down dip in the middle, by symmetry, and within 3 degrees at the
/// ends.
TEST(StrikeCoordinate, OfAConeIsNearlyConstantDownItsDip) {
  const double radius = 1000, step = 20;
  const Sheet cone(16, 8, [&](int c, int r) -> Vector3d {
    const double angle = 0.5 * std::numbers::pi * c / 16,
                 out = radius + r * step * std::cos(std::numbers::pi / 3);
    return {out * std::cos(angle), out * std::sin(angle),
            -r * step * std::sin(std::numbers::pi / 3)};
  });
  const StrikeCoordinate found = cone.solve();
  for (std::size_t i = 0; i < cone.points.size(); ++i) {
    const double leans = found.along[i] - found.along[i - i % 9];
    EXPECT_LT(std::abs(leans), i / 9 == 8 ? 1 : 160 * std::tan(3 * std::numbers::pi / 180)) << i;
  }
  const double length = std::abs(found.along.back() - found.along.front());
  EXPECT_NEAR(length, 0.5 * std::numbers::pi * (radius + 40), 10);  // of the middle
}

TEST(StrikeCoordinate, PartsAreNorthwardEachAndHaveTheirOwnMean) {
  Sheet two(3, 2, [](int c, int r) -> Vector3d { return {0, 10. * c, -10. * r}; });
  const Sheet south(3, 2, [](int c, int r) -> Vector3d { return {50, 100 - 10. * c, -10. * r}; });
  const int n = static_cast<int>(two.points.size());
  for (const Vector3d& point : south.points) two.points.push_back(point);
  for (std::array<int, 4> face : south.faces) {
    for (int& corner : face) corner += n;
    two.faces.push_back(face);
  }
  const StrikeCoordinate found = two.solve();
  for (std::size_t i = 0; i < two.points.size(); ++i) {
    EXPECT_EQ(found.part[i], static_cast<int>(i) < n ? 0 : 1);
    EXPECT_NEAR(found.along[i], two.points[i].y(), 1e-9);
  }
}

TEST(StrikeCoordinate, OfALineDownDipIsNothing) {
  const std::vector<Vector3d> points{{0, 5, 0}, {1, 5, -10}, {2, 5, -20}};
  const std::vector<std::array<int, 4>> faces{{0, 1, 1, 0}, {1, 2, 2, 1}};
  const StrikeCoordinate found = strike_coordinate(points, faces);
  EXPECT_EQ(found.along, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(found.part, (std::vector<int>{0, 0, 0}));
}

}  // namespace
}  // namespace faultsim
