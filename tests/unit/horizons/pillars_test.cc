#include "simulator/horizons/pillars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/horizons/ladders.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using test::dipping_fault;
using test::kDegree;
using test::meshed;
using test::reservoir_body;
using testing::HasSubstr;

struct MadePillars {
  LayeredBody body;
  MapMesh map;
  Pillars pillars;

  explicit MadePillars(const LayeredBody& from)
      : body(from), map(meshed(body)), pillars(body, map) {}
  std::vector<Problem> problems() const {
    std::vector<Problem> found;
    check_pillars(body, map, pillars, found);
    return found;
  }
};

LayeredFault oblique_branch() {
  LayeredFault fault = dipping_fault();
  fault.name = "B";
  fault.trace = {{0, -300}, {1500, 700}};
  fault.first_end = TraceEnd::at_fault;
  fault.last_end = TraceEnd::in_rock;
  fault.dip = 70 * kDegree;
  fault.dips_to = DipSide::left;
  fault.top = -1000;
  fault.bottom = -3000;
  return fault;
}

TEST(FaultShift, APlaneGoesToItsHangingWallDownwards) {
  LayeredFault fault = dipping_fault();
  fault.top = -1000;
  fault.bottom = -3000;
  const FaultShift shift(fault, 0, -4000, -2000);
  EXPECT_NEAR(shift.at(-2000), 0, 1e-9);
  EXPECT_NEAR(shift.at(-2500), 500 / std::tan(60 * kDegree), 1e-9);
  EXPECT_EQ(shift.at(-3000), shift.at(-4000)) << "straight down below its end";
  EXPECT_NEAR(shift.at(0), -1000 / std::tan(60 * kDegree), 1e-9);
}

TEST(FaultShift, AListricProfileIsTakenRelativeToTheDepthOfTraces) {
  LayeredFault fault = dipping_fault();
  fault.listric = {{-1000, 5}, {-2000, 105}, {-3000, 405}};
  const FaultShift shift(fault, 0, -4000, -2500);
  EXPECT_NEAR(shift.at(-2500), 0, 1e-9);
  EXPECT_NEAR(shift.at(-1000), -250, 1e-9);
  EXPECT_NEAR(shift.at(-3000), 150, 1e-9);
  EXPECT_NEAR(shift.at(-4000), 450, 1e-9) << "goes on as its last piece";
}

TEST(Pillars, OfAPlaneFaultStayOnItsPlane) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), oblique_branch()};
  // The T slides 2,000 / tan(80°) / sin(56°) = 424 m along a branch of 1,803 m: room for pillars.
  body.faults[0].dip = 80 * kDegree;
  const MadePillars made(body);
  for (const Problem& one : made.problems()) ADD_FAILURE() << one.what;
  const Vector2d n = Vector2d(-1000, 1500).normalized();  // of B, to its left
  for (const double z : {-4000., -2700., -2000., -1100., 0.}) {
    const double first = (-2000 - z) / std::tan(80 * kDegree);
    for (const int v : made.map.lines[0]) EXPECT_NEAR(made.pillars.in_map(v, z).x(), first, 1e-6);
    const double second = (-2000 - std::clamp(z, -3000., -1000.)) / std::tan(70 * kDegree);
    for (const int v : made.map.lines[1])
      EXPECT_NEAR((made.pillars.in_map(v, z) - Vector2d(0, -300)).dot(n), second, 1e-6)
          << "the T slides along both";
  }
}

TEST(Pillars, BothPiecesOfABendMoveAlike) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{1000, -2000}, {0, 0}, {1000, 2000}};
  body.faults[0].dip = 80 * kDegree;
  const MadePillars made(body);
  const std::vector<int>& line = made.map.lines[0];
  const auto bend =
      std::ranges::find_if(line, [&](int v) { return made.map.vertices[v].norm() < 1e-9; });
  ASSERT_NE(bend, line.end());
  const std::vector<Vector2d> along = hanging_directions(body.faults[0], made.map, 0);
  const Vector2d at_bend = along[static_cast<std::size_t>(bend - line.begin())];
  EXPECT_NEAR(at_bend.dot(Vector2d(2000, 1000).normalized()), 1, 1e-9);
  EXPECT_NEAR(at_bend.dot(Vector2d(2000, -1000).normalized()), 1, 1e-9);
  // Traces run at 2 in 1: the corner moves by 1 / cos 26.6° = √5 / 2.
  EXPECT_NEAR(made.pillars.in_map(*bend, -3000).x(),
              1000 / std::tan(80 * kDegree) * std::sqrt(5.0) / 2, 1e-6);
}

TEST(Pillars, OfSidesStayInThem) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{0, -2000}, {500, 2000}};
  const MadePillars made(body);
  for (std::size_t v = 0; v < made.map.vertices.size(); ++v)
    for (int axis = 0; axis < 2; ++axis)
      for (const double side : {body.low[axis], body.high[axis]}) {
        if (made.map.vertices[v][axis] != side) continue;
        for (const double z : {-4000., -1000.})
          EXPECT_NEAR(made.pillars.in_map(static_cast<int>(v), z)[axis], side, 1e-9);
      }
}

TEST(Ladders, TakeTheShorterDiagonalOfLeaningWalls) {
  LayeredBody body = reservoir_body();
  body.horizons.clear();
  body.layers = {{0}};
  body.faults = {dipping_fault()};
  const MadePillars made(body);
  std::vector<Problem> problems;
  const CutMap cut = cut_map(made.map);
  const Levels levels = find_levels(body, made.map, cut, made.pillars, {}, problems);
  const PillarNodes nodes = nodes_on_pillars(body, made.map, cut, levels);
  const std::vector<MapSide> sides = sides_of(made.map.triangles);
  const std::vector<Ladder> ladders =
      make_ladders(made.map, cut, sides, nodes, order_of_pillars(body, made.map, made.pillars));
  int n = 0, n_longer = 0;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const std::vector<double>&za = nodes.z[sides[s].a], &zb = nodes.z[sides[s].b];
    if (za.size() != zb.size()) continue;
    for (std::size_t k = 0; k + 1 < za.size(); ++k) {
      const auto length = [&](std::size_t on_a, std::size_t on_b) {
        return (made.pillars.at(sides[s].a, za[on_a]) - made.pillars.at(sides[s].b, zb[on_b]))
            .norm();
      };
      const double a_first = length(k + 1, k), b_first = length(k, k + 1);
      if (std::abs(a_first - b_first) < 0.05 * a_first) continue;  // along the fault
      ++n;
      n_longer += (ladders[s][2 * k] == 0) != (a_first < b_first);
    }
  }
  EXPECT_GT(n, 100) << "walls leave a choice";
  EXPECT_LT(n_longer, n / 20) << "of " << n;
}

TEST(Pillars, ThatCrossAreRefusedWithPlace) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].dip = 30 * kDegree;
  const std::vector<Problem> problems = MadePillars(body).problems();
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/faults/0");
  EXPECT_THAT(problems[0].what, HasSubstr("pillars cross beside \"F\", worst at x "));
}

TEST(Pillars, FaultsThatLeaveTheBoxOrCutEachOtherInDepthAreRefused) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{2000, -1000}, {2000, 1000}};
  body.faults[0].first_end = body.faults[0].last_end = TraceEnd::in_rock;
  std::vector<Problem> problems;
  check_faults_in_depth(body, meshed(body), problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("\"F\" leaves the box at x 3154.7"));
  body.faults = {dipping_fault(), dipping_fault()};
  body.faults[1].name = "G";
  body.faults[1].trace = {{800, -2000}, {800, 2000}};
  body.faults[1].dips_to = DipSide::left;
  problems.clear();
  check_faults_in_depth(body, meshed(body), problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("\"G\" and \"F\" cut each other in depth, at x "));
}

}  // namespace
}  // namespace faultsim::horizons
