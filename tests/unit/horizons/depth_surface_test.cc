#include "simulator/horizons/depth_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

double depth_at(const DepthOverMap& depth, const Vector2d& place) {
  std::vector<Problem> problems;
  const DepthSurface surface(depth, "/horizons/0", problems);
  EXPECT_TRUE(problems.empty()) << problems.front().what;
  return surface.at(place);
}

std::string refusal(const DepthOverMap& depth) {
  std::vector<Problem> problems;
  const DepthSurface surface(depth, "/horizons/0", problems);
  return problems.empty() ? "" : problems.front().what;
}

TEST(DepthSurface, APlaneFollowsItsSlope) {
  EXPECT_EQ(depth_at(ConstantDepth{-2000}, {3, 4}), -2000);
  const PlaneDepth plane{-2000, {100, 50}, {0.1, -0.02}};
  EXPECT_NEAR(depth_at(plane, {200, 150}), -2000 + 10 - 2, 1e-12);
}

TEST(DepthSurface, AGridIsBilinearAndKeepsItsEdgeOutside) {
  const GridDepth grid{{10, 20}, {100, 50}, 3, 2, {-1, -2, -4, -10, -20, -40}};
  EXPECT_EQ(depth_at(grid, {10, 20}), -1);
  EXPECT_EQ(depth_at(grid, {210, 70}), -40);
  EXPECT_NEAR(depth_at(grid, {160, 20}), -3, 1e-12) << "half way along x";
  EXPECT_NEAR(depth_at(grid, {110, 45}), -11, 1e-12) << "half way along y";
  EXPECT_NEAR(depth_at(grid, {60, 32.5}), 0.75 * -1.5 + 0.25 * -15, 1e-12);
  EXPECT_EQ(depth_at(grid, {-500, -500}), -1);
  EXPECT_EQ(depth_at(grid, {900, 45}), -22);
  EXPECT_EQ(depth_at(GridDepth{{0, 0}, {1, 1}, 1, 1, {-7}}, {5, -5}), -7);
}

TEST(DepthSurface, ScatteredPointsOfAPlaneAreThatPlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1000);
  PointDepth scattered;
  const auto plane = [](double x, double y) { return -2000 + 0.1 * x - 0.3 * y; };
  for (const double x : {0., 1000.})
    for (const double y : {0., 1000.}) scattered.points.emplace_back(x, y, plane(x, y));
  for (int k = 0; k < 300; ++k) {
    const double x = place(random), y = place(random);
    scattered.points.emplace_back(x, y, plane(x, y));
  }
  for (int k = 0; k < 300; ++k) {
    const double x = place(random), y = place(random);
    EXPECT_NEAR(depth_at(scattered, {x, y}), plane(x, y), 1e-9);
  }
  EXPECT_NEAR(depth_at(scattered, {1500, 400}), plane(1000, 400), 1e-9)
      << "the nearest of the edge";
}

TEST(DepthSurface, ScatteredPointsAreMet) {
  const PointDepth scattered{{{0, 0, -1}, {10, 0, -2}, {0, 10, -3}, {10, 10, -9}, {5, 5, -20}}};
  for (const Vector3d& p : scattered.points)
    EXPECT_NEAR(depth_at(scattered, p.head<2>()), p.z(), 1e-9);
  EXPECT_NEAR(depth_at(scattered, {2.5, 2.5}), -10.5, 1e-9);
}

TEST(DepthSurface, FewPointsDo) {
  EXPECT_EQ(depth_at(PointDepth{{{0, 0, -5}}}, {100, 100}), -5);
  const PointDepth line{{{0, 0, -1}, {10, 10, -3}, {5, 5, -7}}};
  EXPECT_NEAR(depth_at(line, {2.5, 2.5}), -4, 1e-12);
  EXPECT_NEAR(depth_at(line, {10, 0}), -7, 1e-12) << "constant across";
  EXPECT_NEAR(depth_at(line, {50, 50}), -3, 1e-12);
}

TEST(DepthSurface, HangsFromPointsWhateverTheirOrder) {
  LayeredBody body;
  const std::vector<Vector3d> points = {{10, 0, -5}, {0, 0, -1}, {0, 10, -2}, {10, 10, -6}};
  body.horizons = {{"top", PointDepth{points}},
                   {"middle", HungDepth{{4, 1, 2, 3}}},
                   {"base", HungDepth{{10, 20, 30, 40}}}};
  std::vector<Problem> problems;
  const std::vector<DepthSurface> all = depth_surfaces(body, problems);
  ASSERT_TRUE(problems.empty());
  const std::array<double, 4> middle = {4, 1, 2, 3}, base = {14, 21, 32, 43};
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(all[1].at(points[k].head<2>()), points[k].z() - middle[k], 1e-12);
    EXPECT_NEAR(all[2].at(points[k].head<2>()), points[k].z() - base[k], 1e-12);
  }
  body.horizons[2].depth = HungDepth{{10, 20, 30}};
  depth_surfaces(body, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("3 thicknesses for 4 points of the horizon above"));
  body.horizons = {{"top", ConstantDepth{-1}}, {"base", HungDepth{{1}}}};
  problems.clear();
  depth_surfaces(body, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("the horizon above has none"));
  body.horizons = {{"top", PointDepth{{points[0]}}}, {"base", HungDepth{{0}}}};
  problems.clear();
  depth_surfaces(body, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("a thickness is not above 0"));
}

TEST(DepthSurface, WhatIsNoSurfaceIsRefused) {
  EXPECT_THAT(refusal(ConstantDepth{std::nan("")}), HasSubstr("not a number"));
  EXPECT_THAT(refusal(GridDepth{{0, 0}, {1, 1}, 2, 2, {1, 2, 3}}), HasSubstr("has 3 depths"));
  EXPECT_THAT(refusal(GridDepth{{0, 0}, {0, 1}, 2, 2, {1, 2, 3, 4}}), HasSubstr("no spacing"));
  EXPECT_THAT(refusal(GridDepth{{5, 6}, {10, 20}, 2, 2, {1, 2, 3, std::nan("")}}),
              HasSubstr("x 15, y 26 m"));
  EXPECT_THAT(refusal(PointDepth{}), HasSubstr("no points"));
  EXPECT_THAT(refusal(PointDepth{{{1, 2, -3}, {1, 2, -4}}}), HasSubstr("x 1, y 2 m"));
}

TEST(Delaunay, CirclesOfTrianglesAreEmptyAndTheHullIsFull) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, 100);
  std::vector<Vector2d> points = {{0, 0}, {100, 0}, {0, 100}, {100, 100}};
  for (int k = 1; k < 10; ++k) points.emplace_back(10 * k, 0);
  for (int k = 0; k < 200; ++k) points.emplace_back(place(random), place(random));
  double area = 0;
  for (const std::array<int, 3>& t : delaunay(points)) {
    const Vector2d &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    EXPECT_GT(cross_of(a, b, c), 0);
    area += cross_of(a, b, c) / 2;
    for (const Vector2d& p : points) {
      Eigen::Matrix3d in_circle;
      int row = 0;
      for (const Vector2d* q : {&a, &b, &c})
        in_circle.row(row++) << (*q - p).x(), (*q - p).y(), (*q - p).squaredNorm();
      EXPECT_LE(in_circle.determinant(), 1e-2);
    }
  }
  EXPECT_NEAR(area, 100 * 100, 1e-9);
  EXPECT_TRUE(delaunay({{0, 0}, {1, 1}, {2, 2}}).empty());
}

}  // namespace
}  // namespace faultsim::horizons
