// The limit in maps of counted cases: where it must be of cases whose limit is known, and what it
// says of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "simulator/figure/limit_line.h"
#include "simulator/figure/outcome_map.h"
#include "tests/unit/figure/svg_reader.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsim::figure {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum CaseClass;

/// Counts of a cell: of what holds, is undecided, slides, has an event, ended early.
using Counts = std::array<long, kCaseClasses>;

/// A grid of ranges of values, of the rows from below.
CellGrid grid_of(const std::vector<std::vector<Counts>>& rows) {
  CellGrid grid;
  grid.x.n = static_cast<int>(rows.front().size()), grid.y.n = static_cast<int>(rows.size());
  for (const std::vector<Counts>& row : rows) {
    for (const Counts& counts : row) grid.cells.push_back({counts});
  }
  return grid;
}

/// Edges as text, "x y-x y".
std::set<std::string> edges_of(const LimitLine& limit) {
  std::set<std::string> all;
  for (const auto& [a, b] : limit.edges)
    all.insert(coordinate(a.x) + " " + coordinate(a.y) + "-" + coordinate(b.x) + " " +
               coordinate(b.y));
  return all;
}
std::set<std::string> edges_of(const std::vector<std::vector<Counts>>& rows) {
  return edges_of(limit_line(grid_of(rows)));
}

const Counts kSafe = {9, 0, 0, 0, 0}, kSlides = {4, 0, 3, 0, 0}, kEmpty = {0, 0, 0, 0, 0};

TEST(LimitLine, SeparatesCellsInWhichNothingSlidesFromOthers) {
  EXPECT_EQ(edges_of({{kSafe, kSlides}}), (std::set<std::string>{"1 0-1 1"}));
  EXPECT_EQ(edges_of({{kSafe}, {kSlides}}), (std::set<std::string>{"0 1-1 1"}));
  EXPECT_EQ(edges_of({{kSlides, kSlides}, {kSafe, kSlides}}),
            (std::set<std::string>{"0 1-1 1", "1 1-1 2"}));
  EXPECT_THAT(edges_of({{kSafe, kSafe}, {kSafe, kSafe}}), IsEmpty());
  EXPECT_THAT(edges_of({{kSlides, kSlides}}), IsEmpty());
}

/// Whatever may slide makes a cell one that is not safe: one case is enough.
TEST(LimitLine, TakesWhatIsUndecidedOrEndedEarlyAsWhatMaySlide) {
  for (std::size_t kind = 1; kind < kCaseClasses; ++kind) {
    Counts one = {100, 0, 0, 0, 0};
    one[kind] = 1;
    EXPECT_EQ(edges_of({{kSafe, one}}).size(), 1U) << to_string(static_cast<CaseClass>(kind));
  }
}

TEST(LimitLine, SaysNothingOfCellsWithoutCasesOrWithTooFew) {
  EXPECT_THAT(edges_of({{kSafe, kEmpty, kSlides}}), IsEmpty());
  const Counts enough = {5, 0, 0, 0, 0}, few = {4, 0, 0, 0, 0}, one_slides = {0, 0, 1, 0, 0};
  EXPECT_EQ(edges_of({{enough, kSlides}}).size(), 1U);
  EXPECT_THAT(edges_of({{few, kSlides}}), IsEmpty()) << "four cases that hold prove little";
  EXPECT_THAT(edges_of({{enough, few}}), IsEmpty());
  EXPECT_EQ(edges_of({{enough, one_slides}}).size(), 1U) << "one that slides is enough";
  EXPECT_EQ(limit_line(grid_of({{enough, kSlides, kSafe}})).fewest, 5);
}

/// A cell that is one value of each parameter has no values between those of its cases.
TEST(LimitLine, NeedsOneCaseOfSingleValues) {
  CellGrid grid = grid_of({{{1, 0, 0, 0, 0}, kSlides}});
  EXPECT_THAT(edges_of(limit_line(grid)), IsEmpty());
  grid.x.levels = {0, 1}, grid.y.levels = {0};
  EXPECT_EQ(edges_of(limit_line(grid)).size(), 1U);
  grid.y.levels.clear();
  EXPECT_THAT(edges_of(limit_line(grid)), IsEmpty()) << "a range along one side";
}

TEST(LimitLine, IsMirroredWithItsParameters) {
  const std::vector<std::vector<Counts>> rows = {{kSafe, kSafe, kSlides, kEmpty},
                                                 {kSafe, kSlides, kSafe, kSafe},
                                                 {kSlides, kEmpty, kSafe, kSlides}};
  std::vector<std::vector<Counts>> mirrored(rows.front().size());
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    for (const auto& row : rows) mirrored[i].push_back(row[i]);
  }
  LimitLine limit = limit_line(grid_of(rows));
  EXPECT_EQ(limit.edges.size(), 8U);
  for (auto& [a, b] : limit.edges) std::swap(a.x, a.y), std::swap(b.x, b.y);
  EXPECT_EQ(edges_of(limit), edges_of(mirrored));
}

TEST(LimitLine, SaysWhatItIsOrWhyThereIsNone) {
  const auto said = [](const std::vector<std::vector<Counts>>& rows) {
    const LimitWords words = words_of(limit_line(grid_of(rows)));
    return words.sentence + "|" + words.remark;
  };
  EXPECT_EQ(said({{kSafe, kSlides}}),
            "limit: in no cell beyond it does a case slide, nor may one (undecided, ended early)|"
            "It runs along cells of 5 decided cases or more (the fewest has 9); where there are "
            "fewer, as in “0 of 3”, or none there is no line.");
  EXPECT_EQ(said({{kSafe, kSafe}}),
            "No limit is drawn: in no cell does a case slide, nor may one.|");
  EXPECT_EQ(said({{kSlides, {4, 0, 0, 0, 0}}}),
            "No limit is drawn: each cell of 5 decided cases or more has one that slides, or may "
            "(undecided, ended early).|");
  EXPECT_EQ(said({{kSafe, kEmpty, kSlides}}),
            "No limit is drawn: no cell of 5 decided cases or more in which nothing slides, nor "
            "may, is beside one in which something does.|");
}

// As it is drawn ----------------------------------------------------------------------------------

constexpr int kAlong = 280;  // cases along a side: as many in each of 20 columns and 14 rows

/// Cases in the middles of 280 x 280 squares of [0, 1]²; those slide that lie above x + y = 1.
OutcomeMap half_plane() {
  OutcomeMap map{"m", "", "x", "y", {}, {}, {}};
  for (int b = 0; b < kAlong; ++b) {
    for (int a = 0; a < kAlong; ++a) {
      map.x.push_back((a + 0.5) / kAlong), map.y.push_back((b + 0.5) / kAlong);
      map.kind.push_back(a + b >= kAlong ? slides : holds);
    }
  }
  return map;
}

/// The pieces of the line in the units of the axes, without that of the key.
std::vector<std::pair<Point, Point>> drawn_limit(const std::string& svg) {
  const ReadScale x = read_scale(svg, true), y = read_scale(svg, false);
  std::vector<std::pair<Point, Point>> pieces;
  for (const SvgElement& one : elements_of(svg, "polyline", "stroke-width", "2.5")) {
    const std::vector<Point> ends = one.points();
    const auto place = [&](Point p) { return Point{x.value(p.x), y.value(p.y)}; };
    pieces.emplace_back(place(ends.at(0)), place(ends.at(1)));
  }
  std::erase_if(pieces, [](const auto& piece) { return piece.first.y > 1.01; });
  return pieces;
}

/// Cells within the half plane are safe, those that its limit crosses are not: the line is within a
/// cell of the limit, on its safe side, from one end of the map to the other.
TEST(LimitLine, OfAHalfPlaneIsWithinACellOfIt) {
  const std::string svg = draw(half_plane());
  EXPECT_EQ(xml_problem(svg), "");
  const auto pieces = drawn_limit(svg);
  constexpr double kWidth = 1.0 / 20, kHeight = 1.0 / 14, kNear = 0.003;
  double along_x = 0, along_y = 0;
  for (const auto& [a, b] : pieces) {
    for (const Point end : {a, b}) {
      EXPECT_LE(end.x + end.y, 1 + kNear);
      EXPECT_GE(end.x + end.y, 1 - kWidth - kHeight - kNear);
    }
    along_x += std::abs(b.x - a.x), along_y += std::abs(b.y - a.y);
  }
  EXPECT_NEAR(along_x, 1 - 2 * kWidth, kNear) << "the limit crosses all cells of two columns";
  EXPECT_NEAR(along_y, 1 - kHeight, kNear);
  EXPECT_THAT(svg, HasSubstr("limit: in no cell beyond it does a case slide"));
  EXPECT_THAT(svg, HasSubstr("(the fewest has 280)"));
}

TEST(LimitLine, IsMovedByASingleCaseThatSlides) {
  OutcomeMap map = half_plane();
  const auto before = drawn_limit(draw(map)).size();
  map.kind[0] = slides;  // in the corner, far from the limit
  const auto after = drawn_limit(draw(map));
  EXPECT_EQ(after.size(), before + 2) << "right of its cell and above";
  const auto is_near_corner = [](const auto& piece) {
    return piece.second.x + piece.second.y < 0.2;
  };
  EXPECT_EQ(std::ranges::count_if(after, is_near_corner), 2);
}

/// Three hundred cases: few have company enough, and the drawing says so.
TEST(LimitLine, OfFewCasesSaysHowFew) {
  OutcomeMap map = half_plane();
  OutcomeMap some{"m", "", "x", "y", {}, {}, {}};
  std::mt19937 random(3);
  for (int k = 0; k < 300; ++k) {
    const std::size_t at = random() % map.x.size();
    some.x.push_back(map.x[at]), some.y.push_back(map.y[at]), some.kind.push_back(map.kind[at]);
  }
  const std::string svg = draw(some);
  const auto pieces = drawn_limit(svg);
  ASSERT_FALSE(pieces.empty());
  for (const auto& [a, b] : pieces) EXPECT_LE(std::max(a.x + a.y, b.x + b.y), 1.05);
  EXPECT_THAT(svg, HasSubstr("It runs along cells of 5 decided cases or more"));
}

/// Only where nothing slides, nor may.
TEST(OutcomeMapChart, HasALimitOfSingleValuesToo) {
  OutcomeMap map{"m", "", "x", "y", {0, 0, 7, 7, 7}, {10, 10, 10, 10, 20}, {}};
  map.kind = {holds, holds, holds, undecided, slides};
  const auto pieces = elements_of(draw(map), "polyline", "stroke-width", "2.5");
  EXPECT_EQ(pieces.size(), 2U) << "between the lower cells, and in the key";
  map.kind = {holds, holds, holds, holds, holds};
  const std::string all_safe = draw(map);
  EXPECT_TRUE(elements_of(all_safe, "polyline", "stroke-width", "2.5").empty());
  EXPECT_THAT(all_safe, HasSubstr("No limit is drawn: in no cell does a case slide, nor may one."));
  EXPECT_THAT(all_safe, Not(HasSubstr("limit: in no cell beyond it")));
}

}  // namespace
}  // namespace faultsim::figure
