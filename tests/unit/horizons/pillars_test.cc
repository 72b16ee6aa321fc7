#include "simulator/horizons/pillars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/horizons/ladders.h"
#include "simulator/horizons/pillar_check.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using test::dipping;
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
  fault.profiles = dipping(-70);
  fault.top = -1000;
  fault.bottom = -3000;
  return fault;
}

TEST(Pillars, OfAPlaneFaultStayOnItsPlane) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), oblique_branch()};
  // The T slides 2,000 / tan(80°) / sin(56°) = 424 m along a branch of 1,803 m: room for pillars.
  body.faults[0].profiles = dipping(80);
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
  body.faults[0].profiles = dipping(80);
  const MadePillars made(body);
  const std::vector<int>& line = made.map.lines[0];
  const auto bend =
      std::ranges::find_if(line, [&](int v) { return made.map.vertices[v].norm() < 1e-9; });
  ASSERT_NE(bend, line.end());
  const Vector2d at_bend =
      fault_shapes(body, made.map)[0].across(static_cast<std::size_t>(bend - line.begin()));
  EXPECT_NEAR(at_bend.dot(Vector2d(2000, 1000).normalized()), 1, 1e-9);
  EXPECT_NEAR(at_bend.dot(Vector2d(2000, -1000).normalized()), 1, 1e-9);
  // Traces run at 2 in 1: the corner moves by 1 / cos 26.6° = √5 / 2.
  EXPECT_NEAR(made.pillars.in_map(*bend, -3000).x(),
              1000 / std::tan(80 * kDegree) * std::sqrt(5.0) / 2, 1e-6);
}

/// Of a straight trace: how far a place lies from the ruled surface between two profiles, m.
double off_ruled_surface(const LayeredFault& fault, const Vector2d& at, double z,
                         double trace_depth) {
  const Vector2d &from = fault.trace.front(), &to = fault.trace.back();
  const Vector2d along = (to - from).normalized(), right(along.y(), -along.x());
  const double part = std::clamp((at - from).dot(along) / (to - from).norm(), 0.0, 1.0);
  const double first = fault.profiles.front()[1].shift, last = fault.profiles.back()[1].shift;
  const double down = trace_depth - std::clamp(z, *fault.bottom, *fault.top);
  return (at - from).dot(right) - (first + part * (last - first)) * down;
}

/// Leans of 0.1 to 0.55 along an oblique trace, which pillars slide along, and a branch whose lean
/// turns over: the T lies on both surfaces at every depth.
TEST(Pillars, OfADipThatChangesAlongTheTraceStayOnTheRuledSurface) {
  LayeredBody body = reservoir_body();
  LayeredFault main = dipping_fault(), branch = oblique_branch();
  main.trace = {{-250, -2000}, {250, 2000}};
  main.profiles = {straight_profile(0.1), straight_profile(0.55)};
  main.top = -500;
  main.bottom = -3500;
  branch.trace = {{-37.5, -300}, {1500, 700}};
  branch.profiles = {straight_profile(0.25), straight_profile(-0.1)};
  body.faults = {main, branch};
  const MadePillars made(body);
  for (const Problem& one : made.problems()) ADD_FAILURE() << one.what;
  double most_slid = 0;
  for (int f = 0; f < 2; ++f)
    for (const double z : {-4000., -3500., -2961.7, -2000., -1534.2, -1000., -333.3, 0.})
      for (const int v : made.map.lines[f]) {
        const Vector2d at = made.pillars.in_map(v, z);
        EXPECT_NEAR(off_ruled_surface(body.faults[f], at, z, body.trace_depth), 0, 1e-9)
            << body.faults[f].name << " at z " << z << ", vertex " << v;
        const Vector2d along = (body.faults[f].trace[1] - body.faults[f].trace[0]).normalized();
        most_slid = std::max(most_slid, std::abs((at - made.map.vertices[v]).dot(along)));
      }
  EXPECT_GT(most_slid, 100) << "the T slides along its faults";
}

TEST(Pillars, EqualDipsAreOneDip) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{-100, -2000}, {0, 0}, {-100, 2000}};
  body.faults[0].profiles = dipping(75);
  const BuiltBody one = build_body(body, "body");
  body.faults[0].profiles.resize(3, body.faults[0].profiles[0]);
  const BuiltBody many = build_body(body, "body");
  EXPECT_EQ(one.mesh.nodes, many.mesh.nodes) << "to the last bit";
  EXPECT_EQ(one.mesh.corners, many.mesh.corners);
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
  body.faults[0].profiles = dipping(30);
  const std::vector<Problem> problems = MadePillars(body).problems();
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/faults/0");
  EXPECT_THAT(problems[0].what, HasSubstr("pillars cross beside \"F\", worst at x "));
}

/// The lean of the main fault changes from 0 to -0.5 within 100 m, where the branch leans to: 1 km
/// down Newton's steps go from one side of that to the other for ever.
TEST(Pillars, OfTwoFaultsWhoseLineIsNotFoundAreRefusedWithPlace) {
  LayeredBody body = reservoir_body();
  LayeredFault main = dipping_fault(), branch = oblique_branch();
  main.trace = {{0, -2000}, {0, 0}, {0, 100}, {0, 2000}};
  main.profiles.clear();
  for (const double lean : {0.0, 0.0, -0.5, -0.5}) main.profiles.push_back(straight_profile(lean));
  branch.profiles = {straight_profile(-0.416)};
  body.faults = {main, branch};
  const MadePillars made(body);
  const std::vector<Problem> problems = made.problems();
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].pointer, "/faults/0");
  EXPECT_EQ(problems[1].pointer, "/faults/1");
  EXPECT_THAT(problems[0].what,
              HasSubstr("the line in which \"F\" meets another fault, at x 0, y -300 m at the "
                        "depth of traces, is not found at z "));
  const int meeting = made.map.lines[1].front();
  EXPECT_GT(made.pillars.off_faults(meeting, -3000), 1);
  EXPECT_LT(made.pillars.off_faults(meeting, -2000), 1e-9);
}

TEST(Pillars, DipsThatChangeTooFastAreRefusedWithPlace) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{0, -2000}, {0, -100}, {0, 100}, {0, 2000}};
  body.faults[0].profiles.clear();
  for (const double lean : {0.5, 0.5, -0.5, -0.5})
    body.faults[0].profiles.push_back(straight_profile(lean));
  const std::vector<Problem> problems = MadePillars(body).problems();
  ASSERT_EQ(problems.size(), 1u);
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
  body.faults[1].profiles = dipping(-60);
  problems.clear();
  check_faults_in_depth(body, meshed(body), problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].what, HasSubstr("\"G\" and \"F\" cut each other in depth, at x "));
}

}  // namespace
}  // namespace faultsim::horizons
