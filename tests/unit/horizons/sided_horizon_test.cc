#include "simulator/horizons/sided_horizon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>

#include "tests/unit/horizons/ground.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::dipping;
using test::dipping_fault;
using test::FaultedDome;
using test::Ground;
using test::kDegree;
using test::reservoir_body;
using testing::HasSubstr;

/// −1 and 1 beside the trace along y at x = 0 (by what the place's triangles are), 0 at its ends.
std::vector<int> sides_of_places(const Ground& ground, const SidedHorizon& sided) {
  std::vector<int> side(sided.cut().n_places(), 0);
  for (std::size_t t = 0; t < ground.map.triangles.size(); ++t)
    for (std::size_t v = 0; v < 3; ++v) {
      double x = 0;
      for (const int corner : ground.map.triangles[t]) x += ground.map.vertices[corner].x();
      const int vertex = ground.map.triangles[t][v];
      if (sided.cut().at[vertex].size() < 2 && ground.map.vertices[vertex].x() == 0) continue;
      side[sided.cut().places[t][v]] = x > 0 ? 1 : -1;
    }
  return side;
}

struct WorstErrors {
  double of_throw = 0, near_tip = 0, elsewhere = 0;
};

/// Against the dome, at all places: of throws along the trace, and within 300 m of tips; of depths
/// of all others that are inside of the box.
WorstErrors errors_of(const FaultedDome& dome, const PointDepth& points) {
  const Ground ground(dome.body());
  std::vector<Problem> problems;
  const PointSurface surface(points.points);
  const SidedHorizon sided = ground.horizon(surface, problems);
  EXPECT_TRUE(problems.empty());
  const std::vector<int> side = sides_of_places(ground, sided);
  WorstErrors worst;
  std::vector<std::array<double, 3>> off(ground.map.vertices.size(), {0, 0, 0});
  for (std::size_t p = 0; p < side.size(); ++p) {
    const int vertex = sided.cut().vertex[p];
    const double z = sided.depth(static_cast<int>(p));
    const Vector2d at = ground.pillars.in_map(vertex, z);
    const double error = z - dome.z(at.x(), at.y(), side[p] > 0);
    if (sided.cut().at[vertex].size() == 2)
      off[vertex][side[p] + 1] = error;
    else if (side[p] != 0 && at.cwiseAbs().maxCoeff() < 2700)
      worst.elsewhere = std::max(worst.elsewhere, std::abs(error));
  }
  for (std::size_t v = 0; v < off.size(); ++v) {
    const double of_throw = std::abs(off[v][2] - off[v][0]);
    const bool is_near_tip = dome.half - std::abs(ground.map.vertices[v].y()) < 300;
    double& one = is_near_tip ? worst.near_tip : worst.of_throw;
    one = std::max(one, of_throw);
  }
  std::cout << points.points.size() << " points: throw off by " << worst.of_throw
            << " m, near tips " << worst.near_tip << " m, depths elsewhere " << worst.elsewhere
            << " m\n";
  return worst;
}

TEST(SidedHorizon, FindsTheThrowOfADomeBetweenItsPoints) {
  const FaultedDome dome;
  const WorstErrors worst = errors_of(dome, dome.points(128, 0));
  EXPECT_LT(worst.of_throw, 0.3);
  EXPECT_LT(worst.near_tip, 0.6);
  EXPECT_LT(worst.elsewhere, 0.6) << "linear between points of curved rock";
}

TEST(SidedHorizon, FindsTheThrowOfPointsWithErrors) {
  const FaultedDome dome;
  const WorstErrors worst = errors_of(dome, dome.points(128, 0.02));
  EXPECT_LT(worst.of_throw, 0.3);
}

TEST(SidedHorizon, HonoursPointsAMetreBesideTheFaultOnTheirOwnSide) {
  const FaultedDome dome;
  PointDepth points = dome.points(128, 0);
  dome.add_chain(128, points);
  const WorstErrors worst = errors_of(dome, points);
  EXPECT_LT(worst.of_throw, 0.1);
  EXPECT_LT(worst.near_tip, 0.3);
}

/// Depth of a side's plane, 80 m lower on the right.
double stepped_plane(double x, double y, bool is_right) {
  return -2000 + 0.08 * x - 0.05 * y - (is_right ? 80 : 0);
}

/// Of the plane, on both sides of a fault along y that dips.
PointDepth points_of_plane(double dip, double spacing) {
  PointDepth points;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.4, 0.4);
  for (double gx = -3000; gx <= 3000; gx += spacing)
    for (double gy = -2000; gy <= 2000; gy += spacing)
      for (const bool is_right : {false, true}) {
        const double x = gx + spacing * jitter(random), y = gy + spacing * jitter(random);
        const double z = stepped_plane(x, y, is_right);
        const bool lies_right = x > (-2000 - z) / std::tan(dip * kDegree);
        if (lies_right == is_right) points.points.emplace_back(x, y, z);
      }
  return points;
}

TEST(SidedHorizon, APlaneWithAStepIsExactOnBothSides) {
  LayeredBody body = reservoir_body();
  for (const double dip : {50., 70., 90.}) {
    LayeredFault fault = dipping_fault();
    fault.profiles = dipping(dip);
    body.faults = {fault};
    const Ground ground(body);
    std::vector<Problem> problems;
    const PointSurface surface(points_of_plane(dip, 250).points);
    const SidedHorizon sided = ground.horizon(surface, problems);
    ASSERT_TRUE(problems.empty());
    const std::vector<int> side = sides_of_places(ground, sided);
    for (std::size_t p = 0; p < side.size(); ++p) {
      const double z = sided.depth(static_cast<int>(p));
      const Vector2d at = ground.pillars.in_map(sided.cut().vertex[p], z);
      if ((at.cwiseAbs() - Vector2d(2500, 1500)).maxCoeff() > 0) continue;
      EXPECT_NEAR(z, stepped_plane(at.x(), at.y(), side[p] > 0), 1e-9) << at.transpose();
    }
  }
}

TEST(SidedHorizon, AlongATraceThatBendsBothSidesAreExact) {
  LayeredBody body = reservoir_body();
  body.cells.at_faults = 60;
  LayeredFault fault = dipping_fault();
  fault.profiles.clear();
  fault.trace.clear();
  const auto bend = [](double y) { return 250 * std::cos(y / 700); };
  for (int k = -20; k <= 20; ++k) fault.trace.emplace_back(bend(100. * k), 100. * k);
  body.faults = {fault};
  PointDepth points;
  for (int k = -19; k < 19; ++k)  // beside the middle of each of its pieces
    for (const double off : {-1., 1., -130., 130., -260., 260., -500., 500., 1500., -1500.}) {
      const Vector2d a(bend(100. * k), 100. * k), b(bend(100. * k + 100), 100. * k + 100);
      const Vector2d right = Vector2d(b.y() - a.y(), a.x() - b.x()).normalized();
      const Vector2d at = (a + b) / 2 + off * right;
      points.points.emplace_back(at.x(), at.y(), stepped_plane(at.x(), at.y(), off > 0));
    }
  const Ground ground(body);
  std::vector<Problem> problems;
  const PointSurface surface(points.points);
  const SidedHorizon sided = ground.horizon(surface, problems);
  ASSERT_TRUE(problems.empty());
  for (std::size_t t = 0; t < ground.map.triangles.size(); ++t) {
    Vector2d middle = Vector2d::Zero();
    for (const int v : ground.map.triangles[t]) middle += ground.map.vertices[v] / 3;
    const NearestOnLine nearest = nearest_on_line(fault.trace, middle);
    const bool is_right =
        cross_of(fault.trace[nearest.segment], fault.trace[nearest.segment + 1], middle) < 0;
    for (std::size_t v = 0; v < 3; ++v) {
      const Vector2d& at = ground.map.vertices[ground.map.triangles[t][v]];
      if ((at.cwiseAbs() - Vector2d(1000, 1500)).maxCoeff() > 0) continue;
      EXPECT_NEAR(sided.depth(sided.cut().places[t][v]), stepped_plane(at.x(), at.y(), is_right),
                  1e-9)
          << at.transpose();
    }
  }
}

TEST(SidedHorizon, FarFromFaultsIsWhatPointsWithoutFaultsAre) {
  const FaultedDome dome;
  const PointDepth points = dome.points(300, 2);
  const Ground ground(dome.body());
  std::vector<Problem> problems;
  const PointSurface surface(points.points);
  const SidedHorizon sided = ground.horizon(surface, problems);
  std::size_t n_far = 0;
  for (std::size_t p = 0; p < sided.cut().n_places(); ++p) {
    const int vertex = sided.cut().vertex[p];
    const Vector2d& on_map = ground.map.vertices[vertex];
    if (std::abs(on_map.x()) < 700 && std::abs(on_map.y()) < dome.half + 700) continue;
    const double z = sided.depth(static_cast<int>(p));
    EXPECT_NEAR(z, surface.at(ground.pillars.in_map(vertex, z)), 1e-8);
    ++n_far;
  }
  EXPECT_GT(n_far, 100u);
}

TEST(SidedHorizon, ASideWithoutPointsIsRefusedWithItsPlace) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), dipping_fault()};
  for (LayeredFault& fault : body.faults) fault.profiles.clear();
  body.faults[1].name = "G";
  body.faults[1].trace = {{1500, -2000}, {1500, 2000}};
  PointDepth points;
  for (const double x : {-1500., 600.})
    for (const double y : {-1500., 0., 1500.}) points.points.emplace_back(x, y, -1900);
  body.horizons = {{"top", points}, {"bottom", ConstantDepth{-2300}}};
  const std::string said = test::refusal_of(body);
  EXPECT_THAT(said, HasSubstr("\"top\" has no point in the part of the map around x "));
  EXPECT_THAT(said, HasSubstr("which \"G\" without a throw cuts off"));
  EXPECT_THAT(said, HasSubstr("give the throw of one of these faults"));
  body.faults[1].moved = FaultThrow{};
  EXPECT_EQ(test::refusal_of(body), "");
}

TEST(SidedHorizon, AGivenThrowIsAddedToThatOfPoints) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), dipping_fault()};
  for (LayeredFault& fault : body.faults) fault.profiles.clear();
  body.faults[1].name = "G";
  body.faults[1].trace = {{1500, -2000}, {1500, 2000}};
  body.faults[1].moved = FaultThrow{50, 0.5, 250};
  body.horizons = {{"top", points_of_plane(90, 250)}, {"bottom", ConstantDepth{-2800}}};
  const std::vector<FoundThrow> throws = build_body(body, "body").throws;
  ASSERT_EQ(throws.size(), 4u);
  EXPECT_NEAR(throws[0].middle, 80, 0.5);
  EXPECT_NEAR(throws[2].middle, 50, 0.5);
  EXPECT_NEAR(throws[3].middle, 50, 0.5) << "a horizon that is no points";
}

TEST(SidedHorizon, PointsOnTheTraceSayNothing) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].profiles.clear();
  PointDepth points = points_of_plane(90, 250);
  for (double y = -1900; y < 2000; y += 100) points.points.emplace_back(0.01, y, -1000);
  const Ground ground(body);
  std::vector<Problem> problems;
  const PointSurface surface(points.points);
  const SidedHorizon sided = ground.horizon(surface, problems);
  ASSERT_TRUE(problems.empty());
  for (std::size_t p = 0; p < sided.cut().n_places(); ++p)
    EXPECT_LT(sided.depth(static_cast<int>(p)), -1500);
}

TEST(SidedHorizon, AboveTheTopOfAFaultThereIsNoStep) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].top = -2050;
  const PointDepth points = points_of_plane(60, 250);
  const Ground ground(body);
  std::vector<Problem> problems;
  const PointSurface surface(points.points);
  const SidedHorizon sided = ground.horizon(surface, problems);
  ASSERT_TRUE(problems.empty());
  std::size_t n_joined = 0, n_apart = 0;
  for (const int vertex : ground.map.lines[0]) {
    const double y = ground.map.vertices[vertex].y();
    const std::size_t n = sided.cut().at[vertex].size();
    // The left side lies at -2000 - 0.05 y, above the top where y < 1000.
    if (y < 700) {
      EXPECT_EQ(n, 1u) << y;
      ++n_joined;
    } else if (y > 1300) {
      EXPECT_EQ(n, 2u) << y;
      ++n_apart;
    }
  }
  EXPECT_GT(n_joined, 3u);
  EXPECT_GT(n_apart, 1u);
}

TEST(SidedHorizon, SlowNineOfTwentyThousandPoints) {
  const FaultedDome dome;
  const Ground ground(dome.body());
  const PointDepth points = dome.points(42, 0);
  const auto start = std::chrono::steady_clock::now();
  std::vector<Problem> problems;
  for (int k = 0; k < 9; ++k) {
    const PointSurface surface(points.points);
    ground.horizon(surface, problems);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::cout << points.points.size() << " points and " << ground.map.vertices.size()
            << " vertices nine times: " << seconds.count() << " s\n";
  EXPECT_TRUE(problems.empty());
  EXPECT_LT(seconds.count(), 10);
}

TEST(MapLocator, FindsThePillarOfAPoint) {
  LayeredBody body = test::random_body(1);
  const Ground ground(body);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0.05, 0.45), depth(-4500, -500);
  for (int k = 0; k < 300; ++k) {
    const auto t = random() % ground.map.triangles.size();
    const double z = depth(random), p = part(random), q = part(random);
    const std::array<double, 3> share = {p, q, 1 - p - q};
    Vector2d there = Vector2d::Zero(), on_map = Vector2d::Zero();
    for (std::size_t v = 0; v < 3; ++v) {
      there += share[v] * ground.pillars.in_map(ground.map.triangles[t][v], z);
      on_map += share[v] * ground.map.vertices[ground.map.triangles[t][v]];
    }
    const PlaceOnMap found = ground.locator.find({there.x(), there.y(), z});
    EXPECT_EQ(found.triangle, static_cast<int>(t));
    EXPECT_LT((found.at - on_map).norm(), 1e-6);
  }
  const PlaceOnMap outside = ground.locator.find({-6500, -6700, -2500});
  EXPECT_LT((outside.at - Vector2d(-6500, -6700)).norm(), 1e-9);
}

}  // namespace
}  // namespace faultsim::horizons
