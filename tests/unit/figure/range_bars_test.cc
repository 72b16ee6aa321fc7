// Bars of ranges stand where their numbers are, and are told apart without colour.
#include "simulator/figure/range_bars.h"

#include <gtest/gtest.h>

#include <set>

#include "simulator/figure/section.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim::figure {
namespace {

RangeBars three_rows() {
  RangeBars bars;
  bars.title = "bands";
  bars.label = "pressure, bar";
  bars.axis = axis_between(bars.label, 0, 300, 6);
  bars.rows = {{"production", {{130, 230, RangeFill::good}, {80, 130, RangeFill::between}}},
               {"storage", {{150, 200, RangeFill::bad}}, Bounded{170, 160, 190}, "note"},
               {"nothing", {}}};
  bars.marks = {{231, "initial"}};
  bars.key = {"no case slides", "", "slides"};
  return bars;
}

TEST(RangeBars, StandWhereTheirNumbersAre) {
  const std::string svg = draw(three_rows());
  EXPECT_EQ(xml_problem(svg), "");
  const ReadScale x = read_scale(svg, true);
  const auto bar = [&](const char* colour, std::size_t k) {
    const SvgElement one = elements_of(svg, "rect", "fill", colour).at(k);
    const double from = one.number("x");
    return std::pair(x.value(from), x.value(from + one.number("width")));
  };
  EXPECT_NEAR(bar("#b9dcc4", 1).first, 130, 0.2) << "the first is that of the key";
  EXPECT_NEAR(bar("#b9dcc4", 1).second, 230, 0.2);
  EXPECT_NEAR(bar("#f0b04a", 0).first, 80, 0.2);
  EXPECT_NEAR(bar("#c8503c", 1).second, 200, 0.2);
  const SvgElement dot = elements_of(svg, "circle", "stroke", "#ffffff").at(0);
  EXPECT_NEAR(x.value(dot.number("cx")), 170, 0.2);
  const SvgElement mark = elements_of(svg, "line", "stroke-dasharray", "4 3").at(0);
  EXPECT_NEAR(x.value(mark.number("x1")), 231, 0.2);
}

/// The lines of a texture lie within its box, in its direction; the plain one has none.
TEST(RangeBars, EachFillHasATextureOfItsOwn) {
  const Box box{10, 20, 60, 12};
  std::set<std::pair<bool, bool>> textures;
  for (const RangeFill fill :
       {RangeFill::good, RangeFill::between, RangeFill::bad, RangeFill::undecided}) {
    Svg svg(100, 50, "fill");
    draw_fill(svg, box, fill);
    bool rises = false, falls = false;
    for (const SvgElement& one : elements_of(svg.finish())) {
      if (one.name != "line") continue;
      const double dx = one.number("x2") - one.number("x1"),
                   dy = one.number("y2") - one.number("y1");
      EXPECT_NEAR(std::abs(dx), std::abs(dy), 0.02);
      (dx * dy < 0 ? rises : falls) = true;
      for (const char* x : {"x1", "x2"}) {
        EXPECT_GE(one.number(x), box.x - 0.01);
        EXPECT_LE(one.number(x), box.right() + 0.01);
      }
      for (const char* y : {"y1", "y2"}) {
        EXPECT_GE(one.number(y), box.y - 0.01);
        EXPECT_LE(one.number(y), box.bottom() + 0.01);
      }
    }
    EXPECT_TRUE(textures.insert({rises, falls}).second) << static_cast<int>(fill);
  }
}

TEST(RangeBars, ARowWithoutRangesIsEmptyAndNothingIsOutside) {
  RangeBars bars = three_rows();
  bars.rows[0].ranges[0].to = 5000;  // beyond the axis
  const std::string svg = draw(bars);
  EXPECT_EQ(xml_problem(svg), "");
  for (const SvgElement& one : elements_of(svg, "rect", "fill", "#b9dcc4"))
    EXPECT_LE(one.number("x") + one.number("width"), bars.width);
  EXPECT_NE(svg.find("nothing"), std::string::npos);
}

/// The picture of a place has one thick line, the marked fault, where it is.
TEST(SectionOfAPlace, MarksOneFault) {
  Section section;
  section.from = -1000, section.to = 1000, section.top = 1800, section.base = 2400;
  section.rocks = {{.name = "west",
                    .from = -800,
                    .to = 0,
                    .from_base = -800,
                    .to_base = 0,
                    .top = 2000,
                    .base = 2200,
                    .is_reservoir = true}};
  for (const double x : {-800.0, 0.0, 800.0})
    section.faults.push_back(
        {"F" + std::to_string(static_cast<int>(x)), {{x, 1900}, {x, 2300}}, {}});
  section.width = 350;
  section.stretch = 2;
  section.marked = 1;
  const std::string svg = draw(section);
  EXPECT_EQ(xml_problem(svg), "");
  const auto marked = elements_of(svg, "polyline", "stroke-width", "4.5");
  ASSERT_EQ(marked.size(), 1U);
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  EXPECT_NEAR(x.value(marked[0].points()[0].x), 0, 6);
  EXPECT_NEAR(y.value(marked[0].points()[0].y), 1900, 6);
  EXPECT_NEAR(y.value(marked[0].points()[1].y), 2300, 6);
  EXPECT_NEAR(std::abs(x.per_px / y.per_px), 2, 0.05) << "depths are stretched";
  EXPECT_EQ(svg.find("χ"), std::string::npos) << "no χ is known of it";
}

}  // namespace
}  // namespace faultsim::figure
