#include "simulator/horizons/map_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/horizons/cut_map.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using test::dipping_fault;
using test::kDegree;
using test::meshed;
using test::reservoir_body;

/// One through the box, one that ends at it, one that crosses it, all with tips.
LayeredBody crossed_body() {
  LayeredBody body = reservoir_body();
  LayeredFault ending = dipping_fault(), crossing = dipping_fault();
  ending.name = "T";
  ending.trace = {{0, -700}, {1500, -300}};
  ending.first_end = TraceEnd::at_fault;
  ending.last_end = TraceEnd::in_rock;
  crossing.name = "X";
  crossing.trace = {{-1300, 600}, {1400, 1100}};
  crossing.first_end = crossing.last_end = TraceEnd::in_rock;
  body.faults = {dipping_fault(), ending, crossing};
  return body;
}

double smallest_angle(const MapMesh& map) {
  double least = 3;
  for (const std::array<int, 3>& t : map.triangles)
    for (std::size_t v = 0; v < 3; ++v) {
      const Vector2d p = map.vertices[t[(v + 1) % 3]] - map.vertices[t[v]];
      const Vector2d q = map.vertices[t[(v + 2) % 3]] - map.vertices[t[v]];
      least = std::min(least, std::acos(p.dot(q) / (p.norm() * q.norm())));
    }
  return least;
}

TEST(MapMesh, TrianglesFillTheBoxAndKeepLines) {
  const MapMesh map = meshed(crossed_body());
  const std::vector<MapSide> sides = sides_of(map.triangles);
  double area = 0;
  for (const std::array<int, 3>& t : map.triangles)
    area += cross_of(map.vertices[t[0]], map.vertices[t[1]], map.vertices[t[2]]) / 2;
  EXPECT_NEAR(area, 6000.0 * 4000, 1e-3);
  ASSERT_EQ(map.lines.size(), 3u);
  for (const std::vector<int>& line : map.lines)
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const MapSide* side = find_side(sides, line[k], line[k + 1]);
      ASSERT_NE(side, nullptr);
      EXPECT_TRUE(side->left >= 0 && side->right >= 0);
    }
  EXPECT_GT(smallest_angle(map), 18 * kDegree);
}

TEST(MapMesh, TrianglesAreAsLargeAsSizesSay) {
  const MapMesh map = meshed(crossed_body());
  for (const MapSide& side : sides_of(map.triangles)) {
    const double length = (map.vertices[side.a] - map.vertices[side.b]).norm();
    const double size = (map.size[side.a] + map.size[side.b]) / 2;
    EXPECT_LT(length, 1.8 * size);
    EXPECT_GT(length, 0.35 * size);
  }
  EXPECT_GT(*std::ranges::max_element(map.size), 500);
}

TEST(MapMesh, EqualInputGivesEqualMeshes) {
  const MapMesh one = meshed(crossed_body()), other = meshed(crossed_body());
  EXPECT_EQ(one.triangles, other.triangles);
  EXPECT_EQ(one.vertices, other.vertices);
}

TEST(CutMap, ATipHasOnePlaceATThreeAndAnXFour) {
  const MapMesh map = meshed(crossed_body());
  const CutMap cut = cut_map(map);
  const std::vector<int>&through = map.lines[0], &ending = map.lines[1], &crossing = map.lines[2];
  EXPECT_EQ(cut.at[ending.front()].size(), 3u);
  EXPECT_EQ(cut.at[ending.back()].size(), 1u);
  EXPECT_EQ(cut.at[ending[2]].size(), 2u);
  EXPECT_EQ(cut.at[through.front()].size(), 2u) << "on the edge";
  std::size_t n_four = 0;
  for (const int v : crossing) n_four += cut.at[v].size() == 4;
  EXPECT_EQ(n_four, 1u);
}

TEST(Compartments, AreFilledUpToFaultsAndDividers) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace.back() = {0, 500};
  body.faults[0].last_end = TraceEnd::in_rock;
  body.compartments = {{"west", {-1000, 0}, {-1, 0, -1}}, {"east", {1000, 0}, {-1, 1, -1}}};
  std::vector<Problem> problems;
  fill_compartments(meshed(body), body.compartments, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what,
              testing::HasSubstr("\"east\" and \"west\" are in one part of the map"));
  body.dividers = {{"on", {{0, 500}, {0, 2000}}}};
  problems.clear();
  const MapMesh map = meshed(body);
  const std::vector<int> filled = fill_compartments(map, body.compartments, problems);
  EXPECT_TRUE(problems.empty());
  for (std::size_t t = 0; t < filled.size(); ++t) {
    double x = 0;
    for (const int v : map.triangles[t]) x += map.vertices[v].x();
    EXPECT_EQ(filled[t], x < 0 ? 0 : 1);
  }
  EXPECT_EQ(cut_map(map).at[map.lines[1][2]].size(), 1u) << "a divider does not cut";
  fill_compartments(map, {{"far", {9000, 0}, {}}}, problems);
  EXPECT_THAT(problems.back().what, testing::HasSubstr("outside the box"));
}

TEST(Compartments, MayHaveSeveralParts) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.dividers = {{"across", {{500, -2000}, {500, 2000}}}};
  const MapMesh map = meshed(body);
  std::vector<Problem> problems;
  const std::vector<int> filled = fill_compartments(
      map, {{"middle", {250, 0}, {}}, {"beside", {-1000, 0}, {}, {{1000, 0}}}}, problems);
  EXPECT_TRUE(problems.empty());
  for (std::size_t t = 0; t < filled.size(); ++t) {
    double x = 0;
    for (const int v : map.triangles[t]) x += map.vertices[v].x() / 3;
    EXPECT_EQ(filled[t], x < 0 || x > 500 ? 1 : 0);
  }
  fill_compartments(map, {{"a", {250, 0}, {}}, {"b", {-1000, 0}, {}, {{300, 0}, {9000, 0}}}},
                    problems);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].pointer, "/compartments/1/also_inside/0");
  EXPECT_THAT(problems[0].what, testing::HasSubstr("\"b\" and \"a\" are in one part of the map"));
  EXPECT_EQ(problems[1].pointer, "/compartments/1/also_inside/1");
}

TEST(MapMesh, SaysWhichTriangleHoldsAPlace) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  const MapMesh map = meshed(body);
  std::vector<Eigen::Vector2d> places = {{9000, 0}};
  std::vector<int> of = {-1};
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    Eigen::Vector2d middle(0, 0);
    for (const int v : map.triangles[t]) middle += map.vertices[v] / 3;
    places.push_back(middle);
    of.push_back(static_cast<int>(t));
  }
  EXPECT_EQ(triangles_around(map, places), of);
}

/// Pressures end at a divider and no rock slides: cells there are larger than at faults, and of the
/// fault's size where it begins at one.
TEST(Dividers, HaveLargerCellsThanFaults) {
  LayeredBody body = reservoir_body();
  body.cells = {50, 800, 0.3, 300};
  body.faults = {dipping_fault()};
  body.dividers = {{"on", {{0, 0}, {1500, 100}, {1510, 101}, {3000, 200}}}};
  const MapMesh map = meshed(body);
  const std::vector<int>& line = map.lines[1];
  const auto length = [&](std::size_t k) {
    return (map.vertices[line[k + 1]] - map.vertices[line[k]]).norm();
  };
  EXPECT_LT(length(0), 100);
  for (std::size_t k = 0; k + 1 < line.size(); ++k) EXPECT_LT(length(k), 400) << k;
  EXPECT_GT(length(line.size() - 2), 200);
  EXPECT_LT(line.size(), 20u);
  EXPECT_EQ((BodyCells{.at_faults = 50}.beside_dividers()), 400);
}

}  // namespace
}  // namespace faultsim::horizons
