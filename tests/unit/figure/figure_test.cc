#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/bar_chart.h"
#include "simulator/figure/depth_chart.h"
#include "simulator/figure/history_chart.h"
#include "simulator/figure/outcome_map.h"
#include "simulator/figure/palette.h"
#include "simulator/figure/panel.h"
#include "simulator/figure/section.h"
#include "simulator/figure/stress_path.h"
#include "simulator/figure/svg.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim::figure {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> labels(double low, double high, int n) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks_within(low, high, n)) texts.push_back(tick.label);
  return texts;
}

TEST(Ticks, AreMultiplesOfOneTwoOrFiveWithTheDigitsThatTellThemApart) {
  EXPECT_THAT(labels(0, 1, 5), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(labels(-200, 0, 4), ElementsAre("−200", "−150", "−100", "−50", "0"));
  EXPECT_THAT(labels(0, 4000, 4), ElementsAre("0", "1,000", "2,000", "3,000", "4,000"));
  EXPECT_THAT(labels(0, 3e9, 3), ElementsAre("0", "1e9", "2e9", "3e9"));
  EXPECT_THAT(labels(0.13, 0.17, 4), ElementsAre("0.13", "0.14", "0.15", "0.16", "0.17"));
}

TEST(Ticks, AreNoneWhereThereIsNoRange) {
  EXPECT_TRUE(ticks_within(1, 1, 5).empty());
  EXPECT_TRUE(ticks_within(2, 1, 5).empty());
  EXPECT_TRUE(ticks_within(NAN, 1, 5).empty());
  EXPECT_TRUE(ticks_within(0, INFINITY, 5).empty());
  EXPECT_TRUE(ticks_within(1e9, std::nextafter(1e9, 2e9), 5).empty());
}

TEST(Ticks, LieWithinAndAreFewWhateverTheRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-12, 12), mantissa(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const double low = mantissa(random) * std::pow(10, exponent(random));
    const double high = low + std::pow(10, exponent(random));
    if (!(high > low)) continue;
    const std::vector<Tick> ticks = ticks_within(low, high, 6);
    EXPECT_LE(ticks.size(), 13U);
    for (const Tick& tick : ticks) {
      EXPECT_GE(tick.value, low - 1e-6 * (high - low));
      EXPECT_LE(tick.value, high + 1e-6 * (high - low));
    }
  }
}

TEST(AxisOver, HoldsAllFiniteValuesAndWhatItAlwaysHolds) {
  const Axis axis = axis_over("", {3, NAN, 17, INFINITY}, {0});
  EXPECT_EQ(axis.from, 0);
  EXPECT_EQ(axis.to, 20);
  const Axis alike = axis_over("", {5, 5});
  EXPECT_LT(alike.from, 5);
  EXPECT_GT(alike.to, 5);
  const Axis none = axis_over("", {NAN});
  EXPECT_EQ(none.from, 0);
  EXPECT_EQ(none.to, 1);
}

TEST(AxisOver, EndsAtOneWhereASolversToleranceIsAllThatIsBeyond) {
  EXPECT_DOUBLE_EQ(axis_over("", {0, 1 + 1e-9}).to, 1);
  EXPECT_GT(axis_over("", {0, 1.01}).to, 1);
}

TEST(PlainNumber, HasSignificantDigitsForPeople) {
  EXPECT_EQ(plain_number(28.611), "28.6");
  EXPECT_EQ(plain_number(-0.25), "−0.25");
  EXPECT_EQ(plain_number(1440, 9), "1,440");
  EXPECT_EQ(plain_number(0), "0");
  EXPECT_EQ(plain_number(3.1e9), "3.1e9");
  EXPECT_EQ(plain_number(NAN), "–");
}

TEST(PlainNumber, IsWithinHalfOfItsLastDigit) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> power(-3.9, 6.9);
  for (int k = 0; k < 2000; ++k) {
    const double value = std::pow(10, power(random));
    for (const int digits : {2, 3, 5}) {
      double read = 0;
      ASSERT_TRUE(read_number(plain_number(value, digits), read)) << value;
      const double last = std::pow(10, std::floor(std::log10(value)) - digits + 1);
      EXPECT_LE(std::abs(read - value), 0.5 * std::min(last, 1.0) * (1 + 1e-9))
          << value << " with " << digits << " digits";
      if (value > 10 || last < 1e-3) continue;
      EXPECT_LE(plain_number(value, digits).size(), static_cast<std::size_t>(digits) + 4);
    }
  }
}

/// Wherever they want to be, they are within, in order and apart.
TEST(Spread, StaysWithin) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-50, 150);
  for (int repeat = 0; repeat < 300; ++repeat) {
    std::vector<double> wanted;
    for (int k = 0; k < 1 + repeat % 7; ++k) wanted.push_back(place(random));
    const std::vector<double> placed = spread(wanted, 12, 0, 100);
    for (std::size_t a = 0; a < wanted.size(); ++a) {
      EXPECT_GE(placed[a], -1e-9);
      EXPECT_LE(placed[a], 100 + 1e-9);
      for (std::size_t b = 0; b < wanted.size(); ++b) {
        if (wanted[a] < wanted[b]) {
          EXPECT_GE(placed[b] - placed[a], 12 - 1e-9);
        }
      }
    }
  }
}

TEST(Spread, KeepsOrderAndDistanceAndMovesLittle) {
  EXPECT_THAT(spread({10, 50}, 15, 0, 100), ElementsAre(10, 50));
  EXPECT_THAT(spread({50, 50}, 10, 0, 100), ElementsAre(45, 55));
  EXPECT_THAT(spread({99, 98}, 10, 0, 100), ElementsAre(100, 90));
  const std::vector<double> crowded = spread({5, 5, 5, 5, 5}, 50, 0, 100);
  EXPECT_DOUBLE_EQ(crowded.front(), 0);
  EXPECT_DOUBLE_EQ(crowded.back(), 100);
}

TEST(EscapeXml, LeavesNothingThatEndsATextOrBreaksADocument) {
  EXPECT_EQ(escape_xml("a<b & \"c\" > 'd'"), "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(escape_xml("χ̄ Δp"), "χ̄ Δp");
  EXPECT_EQ(escape_xml("\x01"), "\xEF\xBF\xBD");
  EXPECT_EQ(escape_xml("\xC0\xAF"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // overlong
  EXPECT_EQ(escape_xml("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // cut off
  EXPECT_EQ(escape_xml("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
}

TEST(Coordinate, HasTwoDecimalsAtMostAndIsFinite) {
  EXPECT_EQ(coordinate(12), "12");
  EXPECT_EQ(coordinate(1.239), "1.24");
  EXPECT_EQ(coordinate(-0.001), "0");
  EXPECT_THROW(coordinate(NAN), InternalError);
}

TEST(Fitted, CutsBetweenCharacters) {
  EXPECT_EQ(fitted("short", 100, 12), "short");
  const std::string cut = fitted("χχχχχχχχχχχχ", 40, 12);
  EXPECT_EQ(escape_xml(cut), cut);
  EXPECT_LE(text_width(cut, 12), 40);
  EXPECT_EQ(fitted("long", 1, 12), "");
}

/// sRGB lightness, near enough to say which of two colours is darker.
double lightness(const std::string& hex) {
  const auto part = [&](std::size_t at) { return std::stoi(hex.substr(at, 2), nullptr, 16); };
  return 0.3 * part(1) + 0.59 * part(3) + 0.11 * part(5);
}

TEST(ChiColour, DarkensThroughoutAndChangesItsHueAtTheTwoLimits) {
  double before = 256;
  for (int k = 0; k <= 100; ++k) {
    const double now = lightness(chi_colour(k / 100.0));
    EXPECT_LE(now, before + 1) << k;
    before = now;
  }
  const auto red_over_blue = [](const std::string& hex) {
    return std::stoi(hex.substr(1, 2), nullptr, 16) > std::stoi(hex.substr(5, 2), nullptr, 16);
  };
  EXPECT_FALSE(red_over_blue(chi_colour(0.799)));
  EXPECT_TRUE(red_over_blue(chi_colour(0.8)));
  EXPECT_NE(chi_colour(0.9999), chi_colour(1));
  EXPECT_EQ(chi_colour(1 - 1e-9), chi_colour(1));
}

/// Contrast of WCAG 2.
double contrast(const std::string& a, const std::string& b) {
  const auto luminance = [](const std::string& hex) {
    const auto linear = [&](std::size_t at) {
      const double part = std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0;
      return part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(1) + 0.7152 * linear(3) + 0.0722 * linear(5);
  };
  const auto [low, high] = std::minmax({luminance(a), luminance(b)});
  return (high + 0.05) / (low + 0.05);
}

TEST(FaultInk, CanBeReadOnWhiteAndOnAShadedStage) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_GE(contrast(fault_ink(k), "#ffffff"), 4.5) << k;
    EXPECT_GE(contrast(fault_ink(k), kShade), 4.5) << k;
    seen.insert(fault_ink(k));
  }
  EXPECT_EQ(seen.size(), 7U);
  EXPECT_NEAR(contrast("#767676", "#ffffff"), 4.54, 0.01) << "what this calls contrast";
}

TEST(FaultStroke, IsAnotherOneForEachOfManyFaults) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < 28; ++k) {
    seen.insert(fault_stroke(k).colour + fault_stroke(k).dash);
  }
  EXPECT_EQ(seen.size(), 28U);
}

TEST(BeforeStroke, IsThinnerAndPalerThanWhatIsWrittenAndSeenOnWhite) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < 28; ++k) {
    const Stroke stroke = before_stroke(k);
    EXPECT_LE(stroke.width, fault_stroke(k).width / 2) << k;
    EXPECT_EQ(stroke.dash, fault_stroke(k).dash) << k;
    EXPECT_LT(contrast(stroke.colour, "#ffffff"), contrast(fault_ink(k), "#ffffff") / 1.5) << k;
    EXPECT_GE(contrast(stroke.colour, kShade), 2) << k;
    seen.insert(stroke.colour + stroke.dash);
  }
  EXPECT_EQ(seen.size(), 28U);
  EXPECT_EQ(paler("#0064ff"), "#66a2ff") << "two fifths of the way to white";
}

TEST(Panel, DrawsOnlyThePartOfALineThatLiesWithin) {
  Svg svg(200, 200, "");
  Panel panel(svg, {50, 50, 100, 100}, axis_between("", 0, 1), axis_between("", 0, 1));
  panel.curve({-1, 2}, {0.5, 0.5}, {"#123456", 1});
  panel.curve({0, NAN, 1}, {0, 0, 0}, {"#654321", 1});  // nothing beside a gap
  panel.curve({0, 0.5, 1}, {2, 3, 2}, {"#abcdef", 1});  // outside
  const std::string text = svg.finish();
  EXPECT_THAT(text, HasSubstr("points=\"50,100 150,100\" stroke=\"#123456\""));
  EXPECT_THAT(text, Not(HasSubstr("#654321")));
  EXPECT_THAT(text, Not(HasSubstr("#abcdef")));
}

TEST(Panel, KeepsWhatIsARoundingBeyondItsEnd) {
  Svg svg(200, 200, "");
  Panel panel(svg, {50, 50, 100, 100}, axis_between("", 0, 1), axis_between("", 0, 1));
  panel.curve({0, 0.5, 1}, {1, 1 + 1e-9, 1}, {"#123456", 1});
  EXPECT_THAT(svg.finish(), HasSubstr("points=\"50,50 100,50 150,50\" stroke=\"#123456\""));
}

TEST(Panel, KeepsALineWithinInOnePiece) {
  Svg svg(200, 200, "");
  Panel panel(svg, {50, 50, 100, 100}, axis_between("", 0, 1), axis_between("", 0, 1));
  panel.curve({0.1, 0.37, 0.61, 0.9}, {0.2, 0.9, 0.13, 0.4}, {"#123456", 1});
  const std::string text = svg.finish();
  EXPECT_EQ(text.find("#123456"), text.rfind("#123456"));
}

// Every chart, with names that are nasty and values that are missing ----------------------------

constexpr const char* kNasty = "<F&\"1'> \x01 \xFF";

HistoryChart nasty_history() {
  HistoryChart chart;
  chart.title = chart.remark = chart.time_label = kNasty;
  chart.time = {0, 1, 2, 3};
  chart.stages = {{kNasty, 0, 1.5}, {"a much too long name of a stage", 1.5, 1.6}, {"", 1.6, 3}};
  chart.marks = {{1, kNasty}, {1.01, "close by"}, {99, "outside"}};
  chart.panels = {{kNasty, {{kNasty, 0, {0, NAN, 1, 2}}, {"none", 1, {}}}, {{1, kNasty}}, {0, 1}}};
  chart.cursor = 2;
  return chart;
}

std::vector<std::string> every_chart() {
  DepthChart depth{kNasty,
                   kNasty,
                   {2000, 2100},
                   {{kNasty, 2050, 2080, true}},
                   {{kNasty, {{kNasty, 0, {1, NAN}}, {"b", 1, {2, 3}}}, {{1, ""}}, {0}}}};
  FaultMap map{kNasty,
               kNasty,
               kNasty,
               kNasty,
               {{{{0, 2000}, {1, 2000}, {1, 2010}, {0, 2010}}, 0.9, true}},
               {{kNasty, 1990, 2005}}};
  StressPath path{kNasty,
                  kNasty,
                  {10, 12},
                  {0, 5},
                  {{0, kNasty}, {1, "end"}},
                  0,
                  0.6,
                  0.3,
                  StressPath::Circle{20, 10}};
  BarChart bars{
      kNasty,
      kNasty,
      kNasty,
      "a",
      "b",
      {{kNasty, {{kNasty, {0.5, 0.4, 0.6}, {{0.7, NAN, NAN}}}, {"nothing", {NAN, NAN, NAN}}}}}};
  IntervalChart intervals{
      kNasty, kNasty, kNasty, {{kNasty, {0.5, 0.4, 0.6}, kNasty}, {"", {NAN, 0, 1}, ""}}};
  OutcomeMap outcomes{
      kNasty,
      kNasty,
      kNasty,
      kNasty,
      {0, 1, 2, 3},
      {0, 1, 0, 1},
      {CaseClass::holds, CaseClass::slides, CaseClass::event, CaseClass::ended_early},
      {},
      {kNasty, "b"}};
  Section section;
  section.title = section.remark = kNasty;
  section.rocks = {{kNasty, -10, 10, -10, 10, 0, 20, true, kNasty}};
  section.faults = {{kNasty, {{0, 5}, {1, 10}, {2, 15}}, {0.5, 1}}, {"empty", {}, {}}};
  section.from = -10, section.to = 10, section.top = 0, section.base = 20;
  return {draw(nasty_history()),
          draw(depth),
          draw(map),
          draw(path),
          draw(bars),
          draw(intervals),
          draw(outcomes),
          draw(section),
          draw(HistoryChart()),
          draw(DepthChart()),
          draw(FaultMap()),
          draw(StressPath()),
          draw(BarChart()),
          draw(IntervalChart()),
          draw(OutcomeMap())};
}

TEST(Charts, AreWellFormedWhateverNamesAndValuesTheyGet) {
  for (const std::string& svg : every_chart()) {
    EXPECT_EQ(xml_problem(svg), "") << svg.substr(0, 400);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(Charts, AreTheSameBytesAgainAndHaveNoIds) {
  EXPECT_EQ(every_chart(), every_chart());
  for (const std::string& svg : every_chart()) EXPECT_THAT(svg, Not(HasSubstr(" id=")));
}

TEST(XmlCheck, SeesWhatIsNotWellFormed) {
  EXPECT_EQ(xml_problem("<a b=\"1\"><c/>x &amp; y</a>"), "");
  EXPECT_NE(xml_problem("<a><b></a></b>"), "");
  EXPECT_NE(xml_problem("<a>x & y</a>"), "");
  EXPECT_NE(xml_problem("<a b=\"<\"/>"), "");
  EXPECT_NE(xml_problem("<a>\x01</a>"), "");
}

}  // namespace
}  // namespace faultsim::figure
