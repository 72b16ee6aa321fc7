// Maps of cases: when they are counted, in which cells, and what these say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "simulator/figure/outcome_cells.h"
#include "simulator/figure/outcome_map.h"
#include "simulator/figure/palette.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim::figure {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

MapCell cell_with(long holds, long undecided, long slides, long events = 0, long early = 0) {
  return {{holds, undecided, slides, events, early}};
}

TEST(ShareText, SaysBothEndsWhereCasesAreUndecidedAndNeverRoundsToNoneOrAll) {
  EXPECT_EQ(share_text(cell_with(3, 0, 1)), "25");
  EXPECT_EQ(share_text(cell_with(3, 0, 0, 1)), "25") << "an event slides";
  EXPECT_EQ(share_text(cell_with(1, 2, 1)), "25–75");
  EXPECT_EQ(share_text(cell_with(0, 4, 0)), "0–100");
  EXPECT_EQ(share_text(cell_with(1000, 0, 1)), "1");
  EXPECT_EQ(share_text(cell_with(1, 0, 1000)), "99");
  EXPECT_EQ(share_text(cell_with(4, 0, 0, 0, 9)), "0")
      << "of those that ended early nothing is known";
  EXPECT_EQ(share_text(cell_with(0, 0, 0, 0, 9)), "");
}

TEST(ShareText, CountsWhereTheCasesAreFew) {
  EXPECT_EQ(share_text(cell_with(2, 0, 1), 5), "1 of 3");
  EXPECT_EQ(share_text(cell_with(3, 0, 0), 5), "0 of 3");
  EXPECT_EQ(share_text(cell_with(1, 2, 1), 5), "1–3 of 4");
  EXPECT_EQ(share_text(cell_with(4, 0, 1), 5), "20");
}

TEST(MapSides, OfFewValuesHaveAColumnForEachWhereverItLies) {
  const MapSide side = side_of("slip, m", {0.1, 0.002, 0.02, 0.1, 0.002}, {});
  EXPECT_EQ(side.n, 3);
  EXPECT_EQ(side.cell_of(0.002), 0);
  EXPECT_EQ(side.cell_of(0.02), 1);
  EXPECT_EQ(side.cell_of(0.1), 2);
  std::vector<std::string> labels;
  for (const Tick& tick : side.axis.ticks) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("0.002", "0.02", "0.1"));
  EXPECT_DOUBLE_EQ(side.place_of(0.06), 1.5) << "between the second and the third";
}

TEST(MapSides, OfNumbersThatAreAlikeHaveTheDigitsThatTellThemApart) {
  const MapSide side = side_of("", {1000.25, 1000.5}, {});
  EXPECT_NE(side.axis.ticks.at(0).label, side.axis.ticks.at(1).label);
}

TEST(MapSides, OfManyValuesHaveEqualParts) {
  std::vector<double> values;
  for (int k = 0; k <= 100; ++k) values.push_back(k);
  MapSide side = side_of("", values, {});
  EXPECT_TRUE(side.has_parts());
  side.n = 10;
  EXPECT_EQ(side.cell_of(0), 0);
  EXPECT_EQ(side.cell_of(9.9), 0);
  EXPECT_EQ(side.cell_of(10), 1);
  EXPECT_EQ(side.cell_of(100), 9) << "the end belongs to the last";
}

TEST(WouldOverlap, SeesTheNearestPair) {
  EXPECT_FALSE(would_overlap({}, 3));
  EXPECT_FALSE(would_overlap({{0, 0}, {6.1, 0}, {0, 6.1}}, 3));
  EXPECT_TRUE(would_overlap({{0, 0}, {50, 0}, {5, 3}}, 3));
  EXPECT_TRUE(would_overlap({{1, 1}, {9, 9}, {1, 1}}, 3));
  EXPECT_FALSE(would_overlap({{0, 0}, {0, 40}, {0, 80}}, 3)) << "above each other, far apart";
}

TEST(ShareColour, DarkensThroughout) {
  const auto lightness = [](const std::string& hex) {
    const auto part = [&](std::size_t at) { return std::stoi(hex.substr(at, 2), nullptr, 16); };
    return 0.3 * part(1) + 0.59 * part(3) + 0.11 * part(5);
  };
  for (int k = 1; k <= 50; ++k)
    EXPECT_LT(lightness(share_colour(k / 50.0)), lightness(share_colour((k - 1) / 50.0))) << k;
}

/// Twelve cases on two by two places: dots would hide eight of them.
OutcomeMap crowded() {
  using enum CaseClass;
  OutcomeMap map{"m", "", "x, m", "y, m", {}, {}, {}};
  const auto add = [&](double x, double y, std::initializer_list<CaseClass> kinds) {
    for (const CaseClass kind : kinds)
      map.x.push_back(x), map.y.push_back(y), map.kind.push_back(kind);
  };
  add(0, 10, {holds, holds, holds});
  add(0, 20, {holds, holds, slides});
  add(7, 10, {holds, undecided, undecided});
  add(7, 20, {slides, event, undecided});
  return map;
}

TEST(OutcomeMapChart, HidesNoCaseBehindAnother) {
  const std::string svg = draw(crowded());
  EXPECT_EQ(xml_problem(svg), "");
  for (const char* share : {">0<", ">33<", ">0–67<", ">67–100<"})
    EXPECT_THAT(svg, HasSubstr(share));
  EXPECT_TRUE(elements_of(svg, "circle", "r", "3.4").empty());
  EXPECT_THAT(svg, HasSubstr("no fault slides: 6; undecided by the cells: 3; slides, no event: 2; "
                             "slip event: 1"));
}

/// At the right of its cell, as wide as the share that is undecided.
TEST(OutcomeMapChart, HatchesTheShareThatIsUndecided) {
  const std::string svg = draw(crowded());
  auto hatched = elements_of(svg, "rect", "fill", "#efeaf5");
  ASSERT_EQ(hatched.size(), 3U) << "two cells, and the key";
  std::erase_if(hatched, [](const SvgElement& one) { return one.number("height") < 12; });
  ASSERT_EQ(hatched.size(), 2U);
  EXPECT_NEAR(hatched[0].number("width") / hatched[1].number("width"), 2, 0.01);
  EXPECT_NEAR(hatched[0].number("x") + hatched[0].number("width"),
              hatched[1].number("x") + hatched[1].number("width"), 0.05);
  // What is decided has the colour of its own share: none of one, and all of two.
  EXPECT_EQ(elements_of(svg, "rect", "fill", share_colour(1)).size(), 1U);
  EXPECT_EQ(elements_of(svg, "rect", "fill", share_colour(0)).size(), 3U) << "and the key";
}

TEST(OutcomeMapChart, SaysWhenThereIsNothingToDraw) {
  EXPECT_THAT(draw(OutcomeMap{"m", "", "x", "y", {}, {}, {}}),
              HasSubstr("No case with both parameters has a result yet."));
  EXPECT_THAT(draw(crowded()), Not(HasSubstr("No case")));
}

TEST(OutcomeMapChart, HasABoundedSizeForAnyNumberOfCases) {
  OutcomeMap map;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 100000; ++k) {
    map.x.push_back(uniform(random));
    map.y.push_back(uniform(random));
    map.kind.push_back(uniform(random) < 0.3 ? CaseClass::undecided
                       : map.x.back() > 0.5  ? CaseClass::slides
                                             : CaseClass::holds);
  }
  const std::string svg = draw(map);
  EXPECT_EQ(xml_problem(svg), "");
  EXPECT_LT(svg.size(), 300'000U);
}

/// A column for each word while there is room, and ticks that do not stand in each other.
TEST(OutcomeMapChart, HasABoundedSizeForAnyNumberOfWords) {
  OutcomeMap map;
  for (int k = 0; k < 20000; ++k) {
    map.x.push_back(k % 1000), map.y.push_back(k % 7), map.kind.push_back(CaseClass::slides);
  }
  for (int k = 0; k < 1000; ++k) map.x_words.push_back("word " + std::to_string(k));
  const std::string svg = draw(map);
  EXPECT_LT(svg.size(), 200'000U);
  EXPECT_THAT(svg, HasSubstr(">word 0<"));
}

}  // namespace
}  // namespace faultsim::figure
