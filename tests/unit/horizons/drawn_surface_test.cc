#include "simulator/horizons/drawn_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulator/horizons/fault_shape.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kTraceZ = -2000, kCellSize = 100;

/// A grid of triangles: points at(u, z) with u along the fault from 0 to 1.
template <typename At>
DrawnSurface triangulated(double low, double high, const At& at) {
  constexpr int kAlong = 12, kDown = 9;
  DrawnSurface surface;
  for (int j = 0; j <= kDown; ++j)
    for (int i = 0; i <= kAlong; ++i) {
      const double z = high + (low - high) * j / kDown;
      const Vector2d place = at(static_cast<double>(i) / kAlong, z);
      surface.points.emplace_back(place.x(), place.y(), z);
    }
  for (int j = 0; j < kDown; ++j)
    for (int i = 0; i < kAlong; ++i) {
      const int a = j * (kAlong + 1) + i, b = a + kAlong + 1;
      surface.triangles.push_back({a, a + 1, b});
      surface.triangles.push_back({b, a + 1, b + 1});
    }
  return surface;
}

/// The same as sticks, from top to bottom.
DrawnSurface as_sticks(const DrawnSurface& surface, int n_along) {
  DrawnSurface sticks{surface.points, {}, {}};
  for (int i = 0; i <= n_along; ++i) {
    std::vector<int>& stick = sticks.sticks.emplace_back();
    for (std::size_t p = static_cast<std::size_t>(i); p < surface.points.size();
         p += static_cast<std::size_t>(n_along) + 1)
      stick.push_back(static_cast<int>(p));
  }
  return sticks;
}

/// A plane that leans by 0.5 to larger x, along y from -1000 to 1000.
Vector2d on_plane(double u, double z) { return {0.5 * (kTraceZ - z), -1000 + 2000 * u}; }

SurfaceLines drawn(const DrawnSurface& surface, const std::vector<Vector2d>& trace = {}) {
  std::vector<Problem> problems;
  SurfaceLines lines = lines_of(surface, trace, kTraceZ, kCellSize, "/at", "F", problems);
  for (const Problem& one : problems) ADD_FAILURE() << one.what;
  return lines;
}

std::string refused(const DrawnSurface& surface, const std::vector<Vector2d>& trace = {}) {
  std::vector<Problem> problems;
  lines_of(surface, trace, kTraceZ, kCellSize, "/at", "F", problems);
  std::string said;
  for (const Problem& one : problems) said += one.pointer + ": " + one.what + "\n";
  return said;
}

/// What FaultShape makes of it, at a point of its trace.
double shift(const SurfaceLines& lines, std::size_t point, double z) {
  LayeredBody body;
  body.base = -5000;
  body.trace_depth = kTraceZ;
  LayeredFault fault;
  fault.trace = lines.trace;
  fault.profiles = lines.profiles;
  fault.top = lines.top;
  fault.bottom = lines.bottom;
  return FaultShape(body, fault, lines.trace).shift_at(point, z);
}

/// Three quarters of a cone that narrows downwards: across each place of it lies another part.
TEST(DrawnSurface, ThatBendsRoundDoesNotFoldBack) {
  const auto cone = [](double u, double z) {
    const double radius = 800 - 0.2 * (kTraceZ - z), angle = 1.5 * std::numbers::pi * u;
    return Vector2d(radius * std::cos(angle), radius * std::sin(angle));
  };
  const SurfaceLines lines = drawn(triangulated(-2900, -1300, cone));
  ASSERT_GT(lines.profiles.size(), 20u);
  for (const DipProfile& profile : lines.profiles)
    for (const DipPoint& point : profile)
      EXPECT_NEAR(std::abs(point.shift), 0.2 * std::abs(point.z - kTraceZ), 15) << point.z;
}

TEST(DrawnSurface, OfAPlaneIsAPlane) {
  const DrawnSurface plane = triangulated(-2900, -1300, on_plane);
  for (const bool by_sticks : {false, true}) {
    const SurfaceLines lines = drawn(by_sticks ? as_sticks(plane, 12) : plane);
    ASSERT_EQ(lines.trace.size(), 21u) << "a cell apart";
    EXPECT_LT((lines.trace.front() - Vector2d(0, -1000)).norm(), 1e-9) << "dips to its right";
    EXPECT_LT((lines.trace.back() - Vector2d(0, 1000)).norm(), 1e-9);
    EXPECT_EQ(lines.top, -1300);
    EXPECT_EQ(lines.bottom, -2900);
    for (const std::size_t k : {0u, 7u, 20u})
      for (const double z : {-1300., -1777., -2000., -2899., -2900.})
        EXPECT_NEAR(shift(lines, k, z), 0.5 * (kTraceZ - z), 1e-7) << k << " at " << z;
  }
}

/// Curved along and down, with a lean that changes: between points of level lines and of depths
/// chords are within a few cm of it.
TEST(DrawnSurface, OfACurvedOneIsThereWhereTheNormalMeetsIt) {
  const auto at = [](double u, double z) {
    const double down = kTraceZ - z;
    return Vector2d(60 * std::sin(3 * u) - (0.3 + 0.3 * u) * down - 1e-4 * down * down,
                    -1000 + 2000 * u);
  };
  const DrawnSurface curved = triangulated(-2800, -1500, at);
  for (const bool by_sticks : {false, true}) {
    const SurfaceLines lines = drawn(by_sticks ? as_sticks(curved, 12) : curved);
    EXPECT_GT(lines.trace.front().y(), lines.trace.back().y()) << "dips to the west, its right";
    LayeredBody body;
    LayeredFault fault;
    fault.trace = lines.trace;
    const FaultShape shape(body, fault, lines.trace);
    for (std::size_t k = 2; k + 2 < lines.trace.size(); ++k)
      for (const double z : {-1600., -2100., -2700.}) {
        const Vector2d there = lines.trace[k] + shape.across(k) * shift(lines, k, z);
        EXPECT_NEAR(there.x(), at((there.y() + 1000) / 2000, z).x(), 2.5) << k << " at " << z;
      }
  }
}

TEST(DrawnSurface, AVerticalOneRunsToTheNorth) {
  for (const double way : {-1., 1.}) {
    const SurfaceLines lines = drawn(triangulated(
        -2900, -1300, [&](double u, double) { return Vector2d(0, way * (900 * u - 450)); }));
    EXPECT_LT(lines.trace.front().y(), lines.trace.back().y()) << way;
  }
}

TEST(DrawnSurface, ATraceOfOnesOwnTakesHowItGoesDown) {
  const DrawnSurface plane = triangulated(-2900, -1300, on_plane);
  // A little beside, and the other way round.
  const SurfaceLines lines = drawn(plane, {{20, 900}, {20, -900}});
  ASSERT_EQ(lines.trace.size(), 19u) << "with points between";
  EXPECT_EQ(lines.trace.front(), Vector2d(20, 900));
  EXPECT_NEAR(shift(lines, 5, -2800), -400, 1e-6) << "to the left";
}

TEST(DrawnSurface, PointsOfATraceThatAreThereTwiceCountOnce) {
  const DrawnSurface plane = triangulated(-2900, -1300, on_plane);
  const SurfaceLines once = drawn(plane, {{0, -1000}, {0, 0}, {0, 1000}});
  const SurfaceLines twice = drawn(plane, {{0, -1000}, {0, 0}, {0, 0}, {0, 1000}});
  ASSERT_EQ(twice.trace, once.trace);
  for (std::size_t k = 0; k < once.trace.size(); ++k)
    EXPECT_EQ(shift(twice, k, -2800), shift(once, k, -2800)) << k;
  EXPECT_THAT(refused(plane, {{0, 10}, {0, 10}}), HasSubstr("is given a trace that has no length"));
}

/// Triangles without area, or there twice, part no line.
TEST(DrawnSurface, MayHaveTrianglesTwice) {
  DrawnSurface plane = triangulated(-2900, -1300, on_plane);
  const SurfaceLines before = drawn(plane);
  const std::vector<std::array<int, 3>> all = plane.triangles;
  for (std::size_t k = 0; k < all.size(); k += 5) {
    plane.triangles.push_back(all[k]);
    plane.triangles.push_back({all[k][0], all[k][0], all[k][2]});
  }
  EXPECT_EQ(drawn(plane).trace, before.trace);
}

/// Its dip changes along it, and its top edge goes down: above it each line goes on as it came.
TEST(DrawnSurface, AboveATopThatIsNotLevelLinesGoOnStraight) {
  DrawnSurface oblique = triangulated(-2900, -1300, on_plane);
  for (Vector3d& at : oblique.points) {
    const double u = (at.y() + 1000) / 2000, share = (at.z() + 2900) / 1600;
    const double top = -1300 - 500 * u;
    at.z() = -2900 + share * (top + 2900);
    at.x() = (0.3 + 0.9 * u) * (kTraceZ - at.z());
  }
  const SurfaceLines lines = drawn(oblique);
  for (const std::size_t k : {1u, 10u, 19u}) {
    const double top = -1300 - 500 * (lines.trace[k].y() + 1000) / 2000;
    EXPECT_GE(lines.reached[k][1], top);
    EXPECT_LT(lines.reached[k][1], top + 2.5 * kCellSize) << "with a cell beside it";
    EXPECT_EQ(lines.reached[k][0], -2900);
    const double below = shift(lines, k, -1850) - shift(lines, k, -1950);
    for (const double z : {-1700., -1500., -1350.})
      EXPECT_NEAR(shift(lines, k, z - 50) - shift(lines, k, z + 50), -below, 0.25 * std::abs(below))
          << k << " at " << z;
  }
}

TEST(DrawnSurface, BeyondItsSidesItGoesOnAsThere) {
  // 500 m long at its base, 2,000 m at its top.
  const DrawnSurface funnel = triangulated(-2900, -1300, [](double u, double z) {
    const double half = 250 + 750 * (z + 2900) / 1600;
    return Vector2d(0.5 * (kTraceZ - z), half * (2 * u - 1));
  });
  const SurfaceLines lines = drawn(funnel);
  EXPECT_NEAR(lines.trace.front().y(), -671.875, 1e-6);
  EXPECT_NEAR(shift(lines, 0, -2900), 450, 1e-6);
}

TEST(DrawnSurface, WhatIsNoFaultIsRefusedWithItsPlace) {
  EXPECT_THAT(refused(triangulated(-1900, -1300, on_plane)),
              HasSubstr("/at: the surface of \"F\" reaches from 1300 to 1900 m depth and is not "
                        "cut by the depth of traces, 2000 m"));
  EXPECT_THAT(refused(triangulated(-2040, -1990, on_plane)), HasSubstr("is lower than a cell"));
  const auto narrow = [](double u, double z) { return Vector2d(on_plane(u / 50, z)); };
  EXPECT_THAT(refused(triangulated(-2900, -1300, narrow)), HasSubstr("is less than a cell long"));
  // Down to -2,400 m and up again beside, in one piece.
  DrawnSurface fold = triangulated(
      -2900, -1300, [](double u, double z) { return Vector2d(-1300 - z, -1000 + 2000 * u); });
  for (Vector3d& at : fold.points) at.z() = at.x() < 1000 ? -1300 - at.x() : -3300 + at.x();
  EXPECT_THAT(refused(fold, {{700, -900}, {700, 900}}),
              HasSubstr("lies in two places at a depth of "));
  DrawnSurface two = triangulated(-2900, -1300, on_plane);
  std::erase_if(two.triangles,
                [&](const std::array<int, 3>& t) { return std::abs(two.points[t[0]].y()) < 100; });
  EXPECT_THAT(refused(two), HasSubstr("is cut along 2 lines at the depth of traces, 2000 m"));
  // A branch to the east from the middle.
  DrawnSurface branched = triangulated(-2900, -1300, on_plane);
  const auto n_first = static_cast<int>(branched.points.size());
  for (int j = 0; j < 10; ++j)
    branched.points.push_back(branched.points[13 * j + 6] + Vector3d(500, 0, 0));
  for (int j = 0; j < 9; ++j) {
    branched.triangles.push_back({13 * j + 6, n_first + j, 13 * j + 19});
    branched.triangles.push_back({13 * j + 19, n_first + j, n_first + j + 1});
  }
  EXPECT_THAT(refused(branched), HasSubstr("is cut along 3 lines at the depth of traces"));
  const auto around = [](double u, double) {
    return Vector2d(800 * std::cos(2 * std::numbers::pi * u),
                    800 * std::sin(2 * std::numbers::pi * u));
  };
  DrawnSurface ring = triangulated(-2900, -1300, around);
  for (std::array<int, 3>& t : ring.triangles)
    for (int& v : t) v = v % 13 == 12 ? v - 12 : v;
  EXPECT_THAT(refused(ring), HasSubstr("is a ring at the depth of traces"));
  EXPECT_THAT(refused(triangulated(-2900, -1300, on_plane), {{9000, -900}, {9000, 900}}),
              HasSubstr("is nowhere near the trace that is given"));
}

}  // namespace
}  // namespace faultsim::horizons
