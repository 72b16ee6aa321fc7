// What a reader reads off a chart by its own labels is what was given to it.
#include <gtest/gtest.h>

#include <cmath>

#include "simulator/figure/bar_chart.h"
#include "simulator/figure/depth_chart.h"
#include "simulator/figure/history_chart.h"
#include "simulator/figure/log_chart.h"
#include "simulator/figure/outcome_map.h"
#include "simulator/figure/palette.h"
#include "simulator/figure/panel.h"
#include "simulator/figure/section.h"
#include "simulator/figure/stress_path.h"
#include "tests/unit/figure/svg_reader.h"

namespace faultsim::figure {
namespace {

std::vector<SvgElement> of_colour(const std::string& svg, const std::string& name,
                                  const std::string& colour) {
  return elements_of(svg, name, "stroke", colour);
}

TEST(ReadOff, AHistoryHasItsValuesAtItsTimes) {
  const std::vector<double> time = {0, 2, 5, 9, 10}, values = {0, -3, 12.5, 40, 7};
  HistoryChart chart;
  chart.title = "history";
  chart.time = time;
  chart.stages = {{"one", 0, 5}, {"two", 5, 10}};
  chart.marks = {{2.5, "event"}};
  chart.panels = {{"a", {{"F1", 0, values}}, {{20, "level"}}}, {"b", {{"F2", 1, {1, 2, 3, 4, 5}}}}};
  chart.cursor = 7.5;
  const std::string svg = draw(chart);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  const auto lines = of_colour(svg, "polyline", fault_stroke(0).colour);
  ASSERT_EQ(lines.size(), 1U);
  const std::vector<Point> points = lines[0].points();
  ASSERT_EQ(points.size(), time.size());
  for (std::size_t k = 0; k < time.size(); ++k) {
    EXPECT_NEAR(x.value(points[k].x), time[k], 0.01) << k;
    EXPECT_NEAR(y.value(points[k].y), values[k], 0.01 * std::abs(y.per_px) + 1e-6) << k;
  }
  const std::vector<Point> second =
      of_colour(svg, "polyline", fault_stroke(1).colour).at(0).points();
  EXPECT_NEAR(read_scale(svg, false, 1).value(second[2].y), 3, 0.01) << "a panel has its own scale";
  EXPECT_NEAR(x.value(elements_of(svg, "rect", "fill", kShade).at(0).number("width")) - x.value(0),
              5, 0.01)
      << "the first stage is shaded";
  const SvgElement level = elements_of(svg, "line", "stroke-dasharray", "5 4").at(0);
  EXPECT_NEAR(y.value(level.number("y1")), 20, 0.05);
  const SvgElement event = elements_of(svg, "line", "stroke-dasharray", "2 2").at(0);
  EXPECT_NEAR(x.value(event.number("x1")), 2.5, 0.01);
  EXPECT_NEAR(x.value(of_colour(svg, "line", kInk).back().number("x1")), 7.5, 0.01) << "cursor";
}

/// Before the change there are other times, and values beyond those of now.
TEST(ReadOff, AHistoryHasWhatWasBeforeAChangeAsThinLinesOfTheSameHue) {
  HistoryChart chart;
  chart.time = {0, 1, 2};
  chart.panels = {{"a", {{"F1", 0, {0, 10, 20}}, {"gone", 1, {}}}}};
  const std::string without = draw(chart);
  chart.time_before = {0, 2, 3, 4};
  chart.panels[0].curves[0].before = {0, 30, -12, 50};
  chart.panels[0].curves[1].before = {5, 5, 5, 5};
  const std::string svg = draw(chart);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  const auto thin = of_colour(svg, "polyline", before_stroke(0).colour);
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_LT(thin[0].number("stroke-width"), fault_stroke(0).width);
  const std::vector<Point> points = thin[0].points();
  ASSERT_EQ(points.size(), 4U) << "whole: the axes hold it";
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(x.value(points[k].x), chart.time_before[k], 0.01) << k;
    EXPECT_NEAR(y.value(points[k].y), chart.panels[0].curves[0].before[k], 0.1) << k;
  }
  const auto now = of_colour(svg, "polyline", fault_stroke(0).colour).at(0).points();
  EXPECT_NEAR(x.value(now[2].x), 2, 0.01);
  EXPECT_NEAR(y.value(now[2].y), 20, 0.1);
  EXPECT_NE(svg.find(">gone<"), std::string::npos) << "named at the end of what is left of it";
  EXPECT_EQ(without.find(">gone<"), std::string::npos);
}

TEST(ReadOff, EqualRatiosAreEqualStepsOnLogarithmicAxes) {
  const LogChart chart{"trade",
                       "s",
                       "error",
                       {{"cells", {{1, 0.1, "40 m"}, {10, 0.01, "20 m"}, {1000, 1e-4, "10 m"}}}}};
  const std::string svg = draw(chart);
  const std::vector<Point> line = of_colour(svg, "polyline", fault_stroke(0).colour).at(0).points();
  ASSERT_EQ(line.size(), 3U);
  EXPECT_NEAR(line[2].x - line[1].x, 2 * (line[1].x - line[0].x), 0.05);
  EXPECT_NEAR(line[2].y - line[1].y, 2 * (line[1].y - line[0].y), 0.05);
  EXPECT_NE(svg.find(">20 m<"), std::string::npos) << "points have their names";
}

TEST(ReadOff, ColumnsAgainstDepthGrowDownwards) {
  const std::vector<double> depths = {2000, 2050, 2100, 2300}, chi = {0.1, 0.9, -0.4, 0.5};
  const DepthChart chart{
      "profiles",
      "",
      depths,
      {{"west", 2040, 2120, false}, {"east", 2080, 2200, true}},
      {{"chi", {{"", 0, chi}}, {{0.8, ""}}, {0, 1}}, {"slip", {{"", 1, {0, 5, 10, 20}}}, {}, {0}}}};
  const std::string svg = draw(chart);
  const ReadScale depth = read_scale(svg, false);
  EXPECT_GT(depth.per_px, 0);
  for (const std::size_t column : {0U, 1U}) {
    const ReadScale x = read_scale(svg, true, column);
    const std::vector<Point> points =
        of_colour(svg, "polyline", fault_stroke(column).colour).at(0).points();
    ASSERT_EQ(points.size(), depths.size());
    for (std::size_t k = 0; k < depths.size(); ++k) {
      EXPECT_NEAR(depth.value(points[k].y), depths[k], 0.02) << k;
      EXPECT_NEAR(x.value(points[k].x), chart.columns[column].curves[0].values[k],
                  0.02 * x.per_px + 1e-6)
          << k;
    }
  }
  const auto bands = elements_of(svg, "rect", "fill", kReservoir);
  ASSERT_EQ(bands.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(depth.value(bands[k].number("y")), chart.bands[k].top, 0.02);
    EXPECT_NEAR(depth.value(bands[k].number("y") + bands[k].number("height")), chart.bands[k].base,
                0.04);
  }
  EXPECT_LT(bands[0].number("x"), bands[1].number("x")) << "the plus side is right of the fault";
}

/// On another mesh there are other depths.
TEST(ReadOff, ColumnsHaveWhatWasBeforeAChangeAtDepthsOfItsOwn) {
  DepthChart chart;
  chart.depth = {2000, 2100};
  chart.depth_before = {1900, 2050, 2200};
  chart.columns = {{"a", {{"", 0, {1, 2}, {}, {}, {4, 5, 6}}}}};
  const std::string svg = draw(chart);
  const ReadScale x = read_scale(svg, true), depth = read_scale(svg, false);
  const std::vector<Point> points =
      of_colour(svg, "polyline", before_stroke(0).colour).at(0).points();
  ASSERT_EQ(points.size(), 3U) << "whole: the axes hold it";
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(depth.value(points[k].y), chart.depth_before[k], 1) << k;
    EXPECT_NEAR(x.value(points[k].x), 4.0 + static_cast<double>(k), 0.05) << k;
  }
}

TEST(ReadOff, AMapOfAFaultHasItsCellsWhereTheyAre) {
  FaultMap map;
  map.across = "along strike, m";
  map.cells = {{{{-50, 2000}, {0, 2000}, {0, 2030}, {-50, 2030}}, 0.25, false},
               {{{0, 2000}, {100, 2000}, {100, 2100}, {0, 2030}}, 0.75, true}};
  const std::string svg = draw(map);
  const ReadScale x = read_scale(svg, true), depth = read_scale(svg, false);
  const auto expect_at = [&](const SvgElement& drawn, const FaultCell& cell) {
    const std::vector<Point> points = drawn.points();
    ASSERT_EQ(points.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(x.value(points[k].x), cell.corners[k].x, 0.02) << k;
      EXPECT_NEAR(depth.value(points[k].y), cell.corners[k].y, 0.02) << k;
    }
  };
  for (const FaultCell& cell : map.cells)
    expect_at(elements_of(svg, "polygon", "fill", chi_colour(cell.value)).at(0), cell);
  const auto outlines = elements_of(svg, "polygon", "fill", "none");
  ASSERT_EQ(outlines.size(), 1U);
  expect_at(outlines[0], map.cells[1]);
}

TEST(ReadOff, BarsGoFromZeroToTheirValueOnEitherSide) {
  BarChart chart;
  chart.first_name = "alone", chart.second_name = "with all";
  chart.blocks = {
      {"chi",
       {{"a", {0.6, 0.5, 0.7}, {{0.9, 0.85, 0.95}}}, {"b", {-0.2, -0.3, -0.1}, {{0.1, 0, 0.2}}}}}};
  const std::string svg = draw(chart);
  const ReadScale x = read_scale(svg, true);
  const auto expect_bars = [&](std::size_t colour, const std::vector<double>& values) {
    auto bars = elements_of(svg, "rect", "fill", fault_stroke(colour).colour);
    bars.erase(bars.begin());  // of the key
    ASSERT_EQ(bars.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double left = x.value(bars[k].number("x"));
      const double right = x.value(bars[k].number("x") + bars[k].number("width"));
      EXPECT_NEAR(left, std::min(0.0, values[k]), 1e-4) << k;
      EXPECT_NEAR(right, std::max(0.0, values[k]), 1e-4) << k;
    }
  };
  expect_bars(0, {0.6, -0.2});
  expect_bars(4, {0.9, 0.1});
  std::vector<std::pair<double, double>> whiskers;
  for (const SvgElement& line : elements_of(svg, "line", "stroke-width", "1.25")) {
    if (line.has("y2", line.attributes.at("y1")))
      whiskers.emplace_back(x.value(line.number("x1")), x.value(line.number("x2")));
  }
  ASSERT_EQ(whiskers.size(), 4U);
  EXPECT_NEAR(whiskers[0].first, 0.5, 1e-4);
  EXPECT_NEAR(whiskers[0].second, 0.7, 1e-4);
  EXPECT_NEAR(whiskers[1].first, 0.85, 1e-4);
  EXPECT_NEAR(whiskers[2].second, -0.1, 1e-4);
}

TEST(ReadOff, IntervalsHaveTheirValueAndTheirEnds) {
  IntervalChart chart;
  chart.rows = {{"a", {0.3, 0.2, 0.45}, ""}, {"b", {0.7, 0.6, 0.9}, ""}};
  const std::string svg = draw(chart);
  const ReadScale x = read_scale(svg, true);
  const auto dots = elements_of(svg, "circle", "r", "4.5");
  ASSERT_EQ(dots.size(), 2U);
  EXPECT_NEAR(x.value(dots[0].number("cx")), 0.3, 1e-4);
  EXPECT_NEAR(x.value(dots[1].number("cx")), 0.7, 1e-4);
  EXPECT_LT(dots[0].number("cy"), dots[1].number("cy"));
  const SvgElement first = of_colour(svg, "line", fault_stroke(0).colour).at(0);
  EXPECT_NEAR(x.value(first.number("x1")), 0.2, 1e-4);
  EXPECT_NEAR(x.value(first.number("x2")), 0.45, 1e-4);
}

TEST(ReadOff, AStressPathHasRoundCirclesAndTrueAngles) {
  StressPath path;
  path.normal = {30, 28, 22, 20}, path.shear = {4, 6, 9, 11};
  path.marks = {{0, "start"}, {3, "end"}};
  path.cohesion = 2, path.friction = 0.45, path.weakened = 0.3;
  path.circle = StressPath::Circle{36, 22};
  const std::string svg = draw(path);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  EXPECT_NEAR(x.per_px, -y.per_px, 1e-3 * x.per_px) << "one scale for both";
  const std::vector<Point> line = of_colour(svg, "polyline", fault_stroke(0).colour).at(0).points();
  ASSERT_EQ(line.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(x.value(line[k].x), path.normal[k], 0.01) << k;
    EXPECT_NEAR(y.value(line[k].y), path.shear[k], 0.01) << k;
  }
  const auto expect_strength = [&](const SvgElement& drawn, double friction) {
    for (const Point& one : drawn.points())
      EXPECT_NEAR(y.value(one.y), 2 + friction * x.value(one.x), 0.02);
  };
  const auto strengths = of_colour(svg, "polyline", "#b0003a");
  ASSERT_EQ(strengths.size(), 2U);
  expect_strength(strengths[0], 0.45);
  expect_strength(strengths[1], 0.3);
  const std::vector<Point> circle = of_colour(svg, "polyline", kFaint).at(0).points();
  EXPECT_GT(circle.size(), 40U);
  for (const Point& one : circle)
    EXPECT_NEAR(std::hypot(x.value(one.x) - 29, y.value(one.y)), 7, 0.02);
  const auto marks = elements_of(svg, "circle", "r", "4.5");
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_NEAR(x.value(marks[1].number("cx")), 20, 0.01);
  EXPECT_NEAR(y.value(marks[1].number("cy")), 11, 0.01);
}

/// Wide and deep ones alike: nothing is drawn beyond the frame, nor out of scale.
TEST(ReadOff, AStressPathHasTheOneBeforeAChangeAndItsStrengthWhereThatWasAnother) {
  StressPath path;
  path.normal = {20, 18}, path.shear = {5, 8};
  path.cohesion = 1, path.friction = 0.5;
  const std::string without = draw(path);
  path.before = StressPath::Before{{20, 45}, {5, 12}, 1, 0.5};
  std::string svg = draw(path);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  std::vector<Point> points = of_colour(svg, "polyline", before_stroke(0).colour).at(0).points();
  ASSERT_EQ(points.size(), 2U) << "whole: the axes hold it";
  EXPECT_NEAR(x.value(points[1].x), 45, 0.1);
  EXPECT_NEAR(y.value(points[1].y), 12, 0.1);
  EXPECT_TRUE(of_colour(svg, "polyline", paler("#b0003a")).empty()) << "the same strength";
  path.before->friction = 0.25;
  svg = draw(path);
  points = of_colour(svg, "polyline", paler("#b0003a")).at(0).points();
  const double rise = y.value(points[1].y) - y.value(points[0].y);
  EXPECT_NEAR(rise / (x.value(points[1].x) - x.value(points[0].x)), 0.25, 0.01);
}

TEST(ReadOff, ASectionIsToScale) {
  for (const double base : {600.0, 9000.0}) {
    Section section;
    section.from = -500, section.to = 1500, section.top = 0, section.base = base;
    section.rocks = {{"salt", -500, 1500, -500, 1500, 0, 0.5 * base, false},
                     {"west", -200, 300, -250, 350, 0.5 * base, 0.8 * base, true}};
    section.faults = {
        {"F1", {{300, 0.4 * base}, {330, 0.6 * base}, {360, 0.9 * base}}, {0.2, 0.9}}};
    const std::string svg = draw(section);
    const ReadScale x = read_scale(svg, true), depth = read_scale(svg, false);
    EXPECT_NEAR(x.per_px, depth.per_px, 2e-3 * x.per_px) << base;
    const double near = 0.02 * x.per_px;
    const std::vector<Point> west = elements_of(svg, "polygon", "fill", kReservoir).at(0).points();
    const Point expected[] = {
        {-200, 0.5 * base}, {300, 0.5 * base}, {350, 0.8 * base}, {-250, 0.8 * base}};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(x.value(west[k].x), expected[k].x, near) << k;
      EXPECT_NEAR(depth.value(west[k].y), expected[k].y, near) << k;
    }
    const auto pieces = elements_of(svg, "line", "stroke-width", "5.5");
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_TRUE(pieces[0].has("stroke", chi_colour(0.2)));
    EXPECT_TRUE(pieces[1].has("stroke", chi_colour(0.9)));
    EXPECT_NEAR(x.value(pieces[1].number("x2")), 360, near);
    EXPECT_NEAR(depth.value(pieces[1].number("y2")), 0.9 * base, near);
    const double height = elements_of(svg).front().number("height");
    for (const SvgElement& one : elements_of(svg)) {
      if (one.name == "rect") {
        EXPECT_LE(one.number("y") + one.number("height"), height);
      }
    }
    EXPECT_LT(height, 700);
  }
}

TEST(ReadOff, DotsOfAMapStandAtTheirParameters) {
  OutcomeMap map;
  map.x = {0, 5, 10, 2, 8}, map.y = {100, 300, 200, 250, 150};
  map.kind = {CaseClass::holds, CaseClass::slides, CaseClass::holds, CaseClass::event,
              CaseClass::undecided};
  const std::string svg = draw(map);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  const auto dots = elements_of(svg, "circle", "r", "3.4");
  ASSERT_EQ(dots.size(), 2U);
  EXPECT_NEAR(x.value(dots[0].number("cx")), 0, 0.01);
  EXPECT_NEAR(y.value(dots[0].number("cy")), 100, 0.5);
  EXPECT_NEAR(x.value(dots[1].number("cx")), 10, 0.01);
  EXPECT_NEAR(y.value(dots[1].number("cy")), 200, 0.5);
  const auto squares = elements_of(svg, "rect", "width", "6.8");
  ASSERT_EQ(squares.size(), 2U);
  EXPECT_NEAR(x.value(squares[0].number("x") + 3.4), 8, 0.01) << "undecided, below the others";
  EXPECT_NEAR(x.value(squares[1].number("x") + 3.4), 5, 0.01);
  EXPECT_NEAR(y.value(squares[1].number("y") + 3.4), 300, 0.5);
}

/// Cases that ended early are not known to slide, nor to hold.
TEST(ReadOff, SquaresOfAMapHaveTheShareThatSlidesOfThoseThatAreKnown) {
  OutcomeMap map;
  for (int k = 0; k < 4000; ++k) {
    map.x.push_back(k % 2), map.y.push_back(k % 2);
    const CaseClass even = k % 8 == 0 ? CaseClass::event : CaseClass::holds;
    const CaseClass odd = k % 4 == 1 ? CaseClass::ended_early : CaseClass::holds;
    map.kind.push_back(k % 2 == 0 ? even : odd);
  }
  const std::string svg = draw(map);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  const auto expect_square = [&](double at, double share) {
    const auto squares = elements_of(svg, "rect", "fill", share_colour(share));
    bool is_there = false;
    for (const SvgElement& one : squares) {
      const double left = one.number("x"), top = one.number("y");
      is_there |= x.value(left) <= at && at <= x.value(left + one.number("width")) &&
                  y.value(top + one.number("height")) <= at && at <= y.value(top);
    }
    EXPECT_TRUE(is_there) << share << " at " << at;
  };
  expect_square(0, 0.25);
  expect_square(1, 0);
}

TEST(ReadOff, BandsOfAPanelLieBetweenTheirEnds) {
  Svg svg(300, 300, "");
  Panel panel(svg, {50, 20, 200, 100}, axis_between("", 0, 10, 5), axis_between("", -2, 2, 4));
  panel.band_in_x(2, 4, "#111111");
  panel.band_in_x(9, 99, "#333333");
  const std::string text = svg.finish();
  const SvgElement in_x = elements_of(text, "rect", "fill", "#111111").at(0);
  EXPECT_DOUBLE_EQ(in_x.number("x"), 90);
  EXPECT_DOUBLE_EQ(in_x.number("width"), 40);
  EXPECT_DOUBLE_EQ(in_x.number("height"), 100);
  const SvgElement cut = elements_of(text, "rect", "fill", "#333333").at(0);
  EXPECT_DOUBLE_EQ(cut.number("x"), 230);
  EXPECT_DOUBLE_EQ(cut.number("width"), 20);
}

TEST(ReadOff, LinesAreCutWhereTheyCrossAnyEdge) {
  Svg svg(300, 300, "");
  Panel panel(svg, {100, 100, 100, 100}, axis_between("", 0, 10), axis_between("", 0, 10));
  panel.curve({-5, 15}, {2, 6}, {"#111111", 1});   // left and right
  panel.curve({4, 8}, {-10, 30}, {"#222221", 1});  // bottom and top
  panel.curve({5, 15}, {5, 20}, {"#333333", 1});   // begins within
  const std::string text = svg.finish();
  const auto expect_line = [&](const std::string& colour, Point a, Point b) {
    const std::vector<Point> points = of_colour(text, "polyline", colour).at(0).points();
    ASSERT_EQ(points.size(), 2U);
    EXPECT_NEAR(points[0].x, 100 + 10 * a.x, 0.01) << colour;
    EXPECT_NEAR(points[0].y, 200 - 10 * a.y, 0.01) << colour;
    EXPECT_NEAR(points[1].x, 100 + 10 * b.x, 0.01) << colour;
    EXPECT_NEAR(points[1].y, 200 - 10 * b.y, 0.01) << colour;
  };
  expect_line("#111111", {0, 3}, {10, 5});
  expect_line("#222221", {5, 0}, {6, 10});
  expect_line("#333333", {5, 5}, {5 + 10.0 / 3, 10});
}

}  // namespace
}  // namespace faultsim::figure
