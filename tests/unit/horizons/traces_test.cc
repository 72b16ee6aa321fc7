#include "simulator/horizons/traces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using test::dipping_fault;
using test::reservoir_body;
using testing::Contains;
using testing::HasSubstr;

LayeredFault branch(const Vector2d& from, const Vector2d& to) {
  LayeredFault fault;
  fault.name = "B";
  fault.trace = {from, to};
  fault.first_end = TraceEnd::at_fault;
  return fault;
}

MapLines joined(const LayeredBody& body) {
  std::vector<Problem> problems;
  MapLines lines = meeting_lines(body, problems);
  for (const Problem& one : problems) ADD_FAILURE() << one.pointer << ": " << one.what;
  return lines;
}

std::string refusal(const LayeredBody& body) {
  std::vector<Problem> problems;
  meeting_lines(body, problems);
  return problems.empty() ? "" : problems.front().pointer + ": " + problems.front().what;
}

TEST(Traces, PointsAreACellApart) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{100, -1950}, {0, 0}, {0, 1900}};
  const MapLine line = joined(body).lines[0];
  EXPECT_EQ(line.points.front(), Vector2d(100, -2000)) << "pulled to the edge";
  EXPECT_EQ(line.points.back(), Vector2d(0, 2000));
  EXPECT_THAT(line.points, Contains(Vector2d(0, 0)).Times(0)) << "bends by 3 degrees";
  ASSERT_EQ(line.points.size(), 21u);
  for (std::size_t k = 1; k < line.points.size(); ++k)
    EXPECT_NEAR((line.points[k] - line.points[k - 1]).norm(), 200, 2);
}

TEST(Traces, ABendStays) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace = {{500, -2000}, {0, 130}, {0, 2000}};
  EXPECT_THAT(joined(body).lines[0].points, Contains(Vector2d(0, 130)));
}

TEST(Traces, AnEndAtAFaultIsAPointOfBoth) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), branch({-60, 310}, {1500, 400})};
  const MapLines lines = joined(body);
  EXPECT_EQ(lines.lines[1].points.front(), Vector2d(0, 310));
  EXPECT_THAT(lines.lines[0].points, Contains(Vector2d(0, 310)));
}

/// Two points beyond the other fault, or four on both of its sides, at either end.
TEST(Traces, AnEndThatOvershootsByPointsIsMovedBack) {
  const std::vector<Vector2d> two = {{-80, 430}, {-60, 420}, {1500, 420}},
                              four = {{40, 430}, {-50, 425}, {30, 415}, {-60, 420}, {1500, 420}};
  for (const bool is_last : {false, true}) {
    for (std::vector<Vector2d> trace : {two, four}) {
      LayeredBody body = reservoir_body();
      if (is_last) std::ranges::reverse(trace);
      LayeredFault fault = branch(trace.front(), trace.back());
      fault.trace = trace;
      if (is_last) std::swap(fault.first_end, fault.last_end);
      body.faults = {dipping_fault(), fault};
      MapLines lines = joined(body);
      std::vector<Vector2d>& points = lines.lines[1].points;
      if (is_last) std::ranges::reverse(points);
      EXPECT_EQ(points.front(), Vector2d(0, 430));
      for (std::size_t k = 1; k < points.size(); ++k) EXPECT_GT(points[k].x(), 50);
      EXPECT_THAT(lines.lines[0].points, Contains(Vector2d(0, 430)));
    }
  }
}

TEST(Traces, CrossingFaultsShareAPoint) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), branch({-1500, -300}, {1500, 700})};
  body.faults[1].first_end = TraceEnd::in_rock;
  const MapLines lines = joined(body);
  int n_shared = 0;
  for (const Vector2d& p : lines.lines[0].points)
    n_shared += static_cast<int>(std::ranges::count(lines.lines[1].points, p));
  EXPECT_EQ(n_shared, 1);
}

TEST(Traces, WhatDoesNotFitIsRefusedWithItsPlace) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace.back() = {0, 2500};
  EXPECT_THAT(refusal(body),
              HasSubstr("/faults/0/trace: the trace of \"F\" leaves the box at x 0, y 2500"));
  body.faults[0].trace.back() = {0, 1500};
  EXPECT_THAT(refusal(body), HasSubstr("ends 500 m short of it, at x 0, y 1500 m"));
  body.faults[0].trace = {{1, 1}, {1, 1}};
  EXPECT_THAT(refusal(body), HasSubstr("has no length"));
  body.faults = {dipping_fault(), branch({400, 300}, {1500, 300})};
  EXPECT_THAT(refusal(body), HasSubstr("/faults/1/trace: \"B\" is to end at another fault but ends "
                                       "at x 400, y 300 m, near none"));
  body.faults[1] = branch({0, 300}, {1500, 1000});
  body.faults[1].trace.back() = {300, 1900};
  EXPECT_THAT(refusal(body), HasSubstr("meets \"F\" at 11 degrees at x 0, y 300 m"));
  body.faults[1] = branch({60, 300}, {1500, 300});
  body.faults[1].first_end = TraceEnd::in_rock;
  EXPECT_THAT(refusal(body),
              HasSubstr("ends in the rock at x 60, y 300 m, less than half a cell from \"F\""));
  body.faults[1] = branch({0, 300}, {1500, 1950});
  EXPECT_THAT(refusal(body), HasSubstr("half a cell from the edge"));
}

/// Whichever comes first: it is no meeting of the two.
TEST(Traces, AnEndInTheRockOnAnotherTraceIsRefusedAsThat) {
  LayeredFault stem = branch({0, 420}, {1500, 420});
  stem.first_end = TraceEnd::in_rock;
  for (const bool is_first : {false, true}) {
    LayeredBody body = reservoir_body();
    body.faults = {dipping_fault(), stem};
    if (is_first) std::swap(body.faults[0], body.faults[1]);
    std::vector<Problem> problems;
    meeting_lines(body, problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].pointer, is_first ? "/faults/0/trace" : "/faults/1/trace");
    EXPECT_THAT(problems[0].what, HasSubstr("\"B\" ends in the rock at x 0, y 420 m, less than "
                                            "half a cell from \"F\""));
    EXPECT_THAT(problems[0].cure, HasSubstr("let it end at \"F\""));
  }
}

TEST(Traces, ADividerMayEndAtATip) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].trace.back() = {0, 1000};
  body.faults[0].last_end = TraceEnd::in_rock;
  body.dividers = {{"D", {{-3000, 1000}, {0, 1000}}}};
  EXPECT_EQ(joined(body).lines[1].points.back(), Vector2d(0, 1000));
}

TEST(Traces, TwoThatEndAtEachOtherAreAV) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), branch({0, 500}, {1500, 500})};
  body.faults[0].trace.back() = {0, 550};
  body.faults[0].last_end = TraceEnd::in_rock;
  EXPECT_THAT(refusal(body), HasSubstr("end at each other at x 0, y 500 m (a V)"));
}

TEST(Traces, MeetingsCloserThanHalfACellAreRefused) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault(), branch({0, 300}, {1500, 300}), branch({0, 380}, {-1500, 380})};
  EXPECT_THAT(refusal(body), HasSubstr("meets two others within half a cell at x 0, y 300 m"));
}

}  // namespace
}  // namespace faultsim::horizons
