// Charts against time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "simulator/common/dates.h"
#include "simulator/figure/palette.h"
#include "simulator/flow/flow_field.h"
#include "tests/unit/case_figures/read_curves.h"
#include "tests/unit/case_figures/small_case.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Years of the calendar, at their first of January.
TEST(DrawCase, HasDatesWhereTheSceneHas) {
  Scene scene = field_scene();
  const CaseResult result = small_result();
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string without = draw_case(picture, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(without, HasSubstr(">time, years<"));
  scene.start_date = parse_date("1990-07-02");  // 182 days into the year
  const std::string svg = draw_case(picture, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr(">date<"));
  EXPECT_THAT(svg, Not(HasSubstr("years")));
  const auto x_of = [&](const std::string& year) {
    for (const auto& one : figure::elements_of(svg, "text", "text-anchor", "middle"))
      if (one.text == year) return one.number("x");
    return std::nan("");
  };
  const double per_year = (x_of("2000") - x_of("1992")) / 8;
  const auto frames = figure::elements_of(svg, "rect", "fill", "none");
  ASSERT_FALSE(frames.empty());
  EXPECT_NEAR(x_of("1992") - frames[0].number("x"), 1.5 * per_year, 0.01 * per_year);
  EXPECT_THAT(draw_case(picture, {CaseChart::section, {}, 1, false}),
              HasSubstr("primary production, 1995-07-02 (5 years)"));
}

/// Dates have four digits: there are none before the year 1 or after 9999, where salt still creeps.
TEST(DrawCase, HasYearsWhereDatesEnd) {
  Scene scene = field_scene();
  CaseResult result = small_result();
  constexpr double kYear = 365.25 * 86400;
  const auto drawn = [&](const char* start, double years) {
    scene.start_date = parse_date(start);
    for (StepResult& step : result.steps) step.time = step.step * years * kYear / 2;
    return draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  };
  const std::string last = drawn("1990-01-31", 8009);
  EXPECT_THAT(last, HasSubstr(">date<"));
  EXPECT_THAT(last, HasSubstr(">9000<"));
  EXPECT_THAT(last, Not(HasSubstr(">2500<"))) << "a thousand years apart";
  const std::string beyond = drawn("1990-01-31", 9000);
  EXPECT_THAT(beyond, HasSubstr(">time, years since 1990-01-31<"));
  EXPECT_THAT(beyond, Not(HasSubstr(">date<")));
  EXPECT_THAT(drawn("0001-01-01", 1000), HasSubstr(">date<"));
}

/// A field that only cools has a line that says so.
TEST(DrawCase, HasTheTemperatureOfRegionsThatCool) {
  Scene scene = field_scene();
  constexpr double kYear = 365.25 * 86400;
  scene.temperature = {{1, {0, 10 * kYear}, {0, -40}}};
  const CaseResult result = small_result();
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr("ΔT, K"));
  const auto lines =
      figure::elements_of(svg, "polyline", "stroke", figure::fault_stroke(13).colour);
  const auto has_half = [](const figure::SvgElement& one) {  // −20 K after five of ten years
    const auto p = one.points();
    return p.size() == 3 && std::abs(p[1].y - (p[0].y + p[2].y) / 2) < 0.02 && p[2].y > p[0].y + 50;
  };
  EXPECT_TRUE(std::ranges::any_of(lines, has_half));
}

/// Of a flow result the means that the result has.
TEST(DrawCase, HasTheMeanTemperaturesOfAFlowResult) {
  Scene scene = field_scene();
  scene.temperature_field.field = std::make_shared<FlowField>();
  CaseResult result = small_result();
  const std::array<double, 3> changes = {0, -30, -15};  // as no pressure does
  for (StepResult& step : result.steps)
    step.temperature_change = {0, changes.at(static_cast<std::size_t>(step.step))};
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr("mean ΔT, K"));
  const auto lines =
      figure::elements_of(svg, "polyline", "stroke", figure::fault_stroke(13).colour);
  const auto returns_half = [](const figure::SvgElement& one) {
    const auto p = one.points();
    return p.size() == 3 && std::abs(p[2].y - (p[0].y + p[1].y) / 2) < 0.02 && p[1].y > p[0].y + 50;
  };
  EXPECT_TRUE(std::ranges::any_of(lines, returns_half));
}

TEST(DrawCase, AHistoryIsInYearsBarAndMillimetres) {
  const Scene scene = field_scene();
  CaseResult result = small_result();
  for (StepResult& step : result.steps) {
    step.faults[0].max_slip = 0.012 * step.step;
    step.faults[0].thickness_chi_080_max = 40.0 * step.step;
  }
  SlipEvent event;
  event.fault = "F2", event.time = result.steps[1].time, event.magnitude = 2.345;
  event.resolved = false;
  result.events = {event};
  const CasePicture picture{result, scene, nullptr, {}};
  const std::string slip = draw_case(picture, {CaseChart::slip, {}, {}, false});
  expect_values(read_off(slip, 0, true), {0, 5, 10}, 0.02);
  expect_values(read_off(slip, 0, false), {0, 12, 24}, 0.1);
  expect_values(read_off(slip, 6, false, 0, 1), {0, -100, -200}, 1.5);  // of the west
  EXPECT_THAT(slip, HasSubstr(">Mw 2.3 (unresolved) on F2<"));
  const std::string thickness = draw_case(picture, {CaseChart::thickness, {}, {}, false});
  expect_values(read_off(thickness, 0, false), {0, 40, 80}, 0.3);
  const std::string chi = draw_case(picture, {CaseChart::history, {}, {}, false});
  expect_values(read_off(chi, 0, false), {0, 0.3, 0.6}, 0.005);
  // The first stage goes from the start to step 1, and is shaded; the second is not.
  const figure::ReadScale time = figure::read_scale(chi, true);
  const auto shades = figure::elements_of(chi, "rect", "fill", figure::kShade);
  ASSERT_EQ(shades.size(), 2U) << "in each of two panels";
  EXPECT_NEAR(time.value(shades[0].number("x")), 0, 0.02);
  EXPECT_NEAR(time.value(shades[0].number("x") + shades[0].number("width")), 5, 0.02);
  double middle = 0;
  for (const figure::SvgElement& one : figure::elements_of(chi))
    if (one.text == "gas storage") middle = time.value(one.number("x"));
  EXPECT_NEAR(middle, 7.5, 0.05);
}

TEST(DrawCase, IsInDaysWhereAllIsOverInLessThanTwoYears) {
  const Scene scene = field_scene();
  CaseResult result = small_result();
  for (StepResult& step : result.steps) step.time = step.step * 10 * 86400.0;
  const std::string svg =
      draw_case({result, scene, nullptr, {}}, {CaseChart::history, {}, {}, false});
  EXPECT_THAT(svg, HasSubstr("time, days"));
  expect_values(read_off(svg, 0, true), {0, 10, 20}, 0.03);
}

/// The case before a change: F1 comes to half of what it is now, F3 was called F0, F2 is the same;
/// it took twice as long, and the west lost 150 bar at the end.
CaseResult original_result() {
  CaseResult original = small_result();
  original.fault_names[2] = "F0";
  for (StepResult& step : original.steps) {
    step.time *= 2;
    step.faults[0].chi_bar = 0.15 * step.step;
    step.faults[0].max_slip = 0.1 * step.step;
    step.pressure_change[0] *= 0.75;
  }
  return original;
}

TEST(DrawCase, HasTheHistoryBeforeAChangeByTheNamesOfFaultsAndRegions) {
  const Scene scene = field_scene();
  const CaseResult result = small_result(), before = original_result();
  const CasePicture original{before, scene, nullptr, {}};
  CasePicture picture{result, scene, nullptr, {}};
  for (const CaseChart chart : {CaseChart::history, CaseChart::thickness, CaseChart::slip}) {
    EXPECT_THAT(draw_case(picture, {chart, {}, {}, true}), Not(HasSubstr("before the change")));
  }
  const std::string section = draw_case(picture, {CaseChart::section, {}, 1, true});
  picture.original = &original;
  EXPECT_EQ(draw_case(picture, {CaseChart::section, {}, 1, true}), section);
  const std::string svg = draw_case(picture, {CaseChart::history, {}, {}, true});
  EXPECT_EQ(figure::xml_problem(svg), "");
  EXPECT_THAT(svg, HasSubstr(">thin: before the change; a"));
  expect_values(read_off(svg, 0, false), {0, 0.3, 0.6}, 0.005);
  expect_values(read_off(svg, 0, true), {0, 5, 10}, 0.05);
  expect_values(read_thin(svg, 0, false), {0, 0.15, 0.3}, 0.005);
  expect_values(read_thin(svg, 0, true), {0, 10, 20}, 0.05);
  expect_values(read_thin(svg, 1, false), {0.2, 1, 1}, 0.005);
  EXPECT_THROW(read_thin(svg, 2, false), std::out_of_range) << "F3 was not there";
  EXPECT_THAT(svg, HasSubstr(">F0, before<"));
  expect_values(read_thin(svg, 3, false), {0, 0, 0}, 0.005);
  expect_values(read_off(svg, 6, false, 0, 1), {0, -100, -200}, 1.5);
  expect_values(read_thin(svg, 6, false, 0, 1), {0, -75, -150}, 1.5);
  CasePicture named = original;
  named.name = "sweep/3";
  picture.original = &named;
  EXPECT_THAT(draw_case(picture, {CaseChart::history, {}, {}, true}),
              HasSubstr(">thin: sweep/3; a"));
  const std::string slip = draw_case(picture, {CaseChart::slip, {}, {}, false});
  expect_values(read_thin(slip, 0, false), {0, 100, 200}, 1);
}

}  // namespace
}  // namespace faultsim
