#include "campaign/rounds/limit_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "campaign/rounds/limit_searcher.h"

namespace faultsweep {
namespace {

using json = nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using State = std::function<PointState(double)>;

/// What the search finds when it may try what it wants, from -110 to 0 in steps of 10.
struct Found {
  LimitFinding finding;
  int n_rounds = 0;
};
Found search(const State& state, double tolerance = 1, double from = -110, double step = 10) {
  std::vector<SearchPoint> points;
  const auto add = [&](double value) {
    const bool is_new = std::none_of(points.begin(), points.end(),
                                     [&](const auto& one) { return one.value == value; });
    EXPECT_TRUE(is_new) << value << " was tried before";
    points.push_back({value, state(value), true, static_cast<long>(points.size()) + 1});
  };
  for (int k = 0; k < 12; ++k) add(from + k * step);
  Found found;
  for (found.finding = judge(points, step > 0, tolerance);; ++found.n_rounds) {
    const auto values = next_values(found.finding, from, tolerance);
    if (values.empty() || found.n_rounds > 100) return found;
    for (const double value : values) add(value);
    found.finding = judge(points, step > 0, tolerance);
  }
}
State unsafe_if(const std::function<bool(double)>& unsafe) {
  return [=](double value) { return unsafe(value) ? PointState::unsafe : PointState::safe; };
}

TEST(LimitSearch, ABracketIsAsNarrowAsTheToleranceAndHasTheLimitInside) {
  for (double limit = -109.9; limit < 0; limit += 0.37) {
    const Found found = search(unsafe_if([&](double value) { return value > limit; }));
    ASSERT_EQ(found.finding.verdict, LimitVerdict::limit);
    const Crossing& crossing = *found.finding.limit();
    EXPECT_TRUE(crossing.narrow);
    EXPECT_LE(crossing.before.value, limit);
    EXPECT_GT(crossing.after.value, limit);
    EXPECT_DOUBLE_EQ(crossing.width(), 1);
    EXPECT_EQ(crossing.before.value, std::round(crossing.before.value)) << "on the grid";
    EXPECT_LE(found.n_rounds, 4) << "10 bar take four halvings";
    EXPECT_GT(crossing.before.position * crossing.after.position, 0) << "both were computed";
  }
}

TEST(LimitSearch, GoesDownAsWellAsUpAndToFractionsOfAUnit) {
  const Found found = search(unsafe_if([](double value) { return value < -33.21; }), 0.1, 0, -10);
  ASSERT_EQ(found.finding.verdict, LimitVerdict::limit);
  EXPECT_DOUBLE_EQ(found.finding.limit()->before.value, -33.2);
  EXPECT_DOUBLE_EQ(found.finding.limit()->after.value, -33.3);
}

TEST(LimitSearch, AScanThatIsNoMultipleOfTheToleranceIsHalvedAllTheSame) {
  const Found found =
      search(unsafe_if([](double value) { return value > -30.0001; }), 0.7, -110, 10.0 / 3);
  ASSERT_EQ(found.finding.verdict, LimitVerdict::safe_throughout) << "the range ends at -73";
  const Found inside =
      search(unsafe_if([](double value) { return value > -80.0001; }), 0.7, -110, 10.0 / 3);
  ASSERT_EQ(inside.finding.verdict, LimitVerdict::limit);
  EXPECT_LE(inside.finding.limit()->width(), 0.7 + 1e-9);
  EXPECT_LE(inside.n_rounds, 4);
}

TEST(LimitSearch, NeverAndAlwaysTakeNoFurtherCase) {
  const Found never = search(unsafe_if([](double) { return false; }));
  EXPECT_EQ(never.finding.verdict, LimitVerdict::safe_throughout);
  EXPECT_EQ(never.finding.limit(), nullptr);
  EXPECT_EQ(never.n_rounds, 0);
  const Found always = search(unsafe_if([](double) { return true; }));
  EXPECT_EQ(always.finding.verdict, LimitVerdict::unsafe_throughout);
  EXPECT_EQ(always.n_rounds, 0);
}

TEST(LimitSearch, EveryCrossingOfANonMonotoneAnswerIsNarrowed) {
  const Found found =
      search(unsafe_if([](double value) { return (value > -77 && value < -52) || value > -8; }));
  EXPECT_EQ(found.finding.verdict, LimitVerdict::non_monotone);
  ASSERT_EQ(found.finding.crossings.size(), 3u);
  for (const Crossing& one : found.finding.crossings) EXPECT_TRUE(one.narrow);
  EXPECT_EQ(found.finding.limit()->before.value, -77);
  EXPECT_EQ(found.finding.crossings[1].after.value, -52);
  EXPECT_EQ(found.finding.crossings[2].before.value, -8);
}

TEST(LimitSearch, WhatIsUnsafeAtTheSafeEndHasNoLimit) {
  const Found found = search(unsafe_if([](double value) { return value < -55; }));
  EXPECT_EQ(found.finding.verdict, LimitVerdict::non_monotone);
  EXPECT_EQ(found.finding.limit(), nullptr);
  EXPECT_TRUE(found.finding.crossings.at(0).narrow) << "where it becomes safe is found as well";
}

TEST(LimitSearch, GoesRoundACaseThatFailed) {
  const Found found = search([](double value) {
    if (value == -45) return PointState::unknown;
    return value > -43.5 ? PointState::unsafe : PointState::safe;
  });
  ASSERT_EQ(found.finding.verdict, LimitVerdict::limit);
  EXPECT_EQ(found.finding.limit()->before.value, -44);
  EXPECT_EQ(found.finding.limit()->after.value, -43);
  EXPECT_EQ(found.finding.n_unknown, 1);
}

TEST(LimitSearch, GivesUpWhereCasesFailAroundTheLimit) {
  const Found found = search([](double value) {
    if (value > -49 && value < -41) return PointState::unknown;
    return value > -45 ? PointState::unsafe : PointState::safe;
  });
  ASSERT_EQ(found.finding.verdict, LimitVerdict::limit);
  EXPECT_FALSE(found.finding.limit()->narrow);
  EXPECT_LE(found.finding.limit()->before.value, -49);
  EXPECT_GE(found.finding.limit()->after.value, -41);
  EXPECT_LE(found.finding.n_unknown, kMostUnknown);
}

TEST(LimitSearch, NothingIsSaidWhereTheSafeEndIsNotKnown) {
  const Found found = search([](double value) {
    if (value == -110) return PointState::unknown;
    return value > -45 ? PointState::unsafe : PointState::safe;
  });
  EXPECT_EQ(found.finding.verdict, LimitVerdict::unknown);
  EXPECT_EQ(found.finding.limit(), nullptr);
}

TEST(LimitSearch, PointsThatHangOnTheCellsAreNotSure) {
  std::vector<SearchPoint> points;
  for (int k = 0; k < 6; ++k) {
    points.push_back({1.0 * k, k < 3 ? PointState::safe : PointState::unsafe, k < 2 || k > 3, 1});
  }
  const LimitFinding finding = judge(points, true, 1);
  EXPECT_EQ(finding.limit()->before.value, 2);
  EXPECT_EQ(finding.surely_safe->value, 1);
  EXPECT_EQ(finding.surely_unsafe->value, 4);
}

/// What lies behind a point whose answer hangs on the cells is not surely safe, however sure
/// itself.
TEST(LimitSearch, NothingIsSurelySafeBehindAnAnswerThatIsNotSure) {
  std::vector<SearchPoint> points;
  for (int k = 0; k < 8; ++k)
    points.push_back({1.0 * k, k < 5 ? PointState::safe : PointState::unsafe, k != 2 && k != 5, 1});
  points[1].state = PointState::unknown;
  const LimitFinding finding = judge(points, true, 1);
  EXPECT_EQ(finding.surely_safe->value, 0);
  EXPECT_EQ(finding.surely_unsafe->value, 6);
  for (SearchPoint& one : points) one.value *= -1;
  EXPECT_EQ(judge(points, false, 1).surely_safe->value, 0) << "downwards alike";
  points[0].resolved = false;
  EXPECT_FALSE(judge(points, false, 1).surely_safe);
}

/// One configuration per row of the design; two limits, the first of two faults.
class LimitSearcherTest : public ::testing::Test {
 protected:
  LimitSearcherTest() {
    LimitSearch up, down;
    up.name = "storage";
    up.faults = {"F1", "F2"};
    up.unit = "bar";
    up.tolerance = 1;
    up.scan = {-100, -50, 0};
    down.name = "depth";
    down.faults = {"F1"};
    down.tolerance = 2;
    down.scan = {10, 0};
    searcher_.emplace(std::vector<LimitSearch>{up, down});
  }
  /// The answers of a round: of fault f in configuration c storage is unsafe above -40 - 10 c - f,
  /// depth below 4.
  void answer(const json& design, int round) {
    const std::vector<double> scan = {-100, -50, 0};
    std::vector<std::pair<int, double>> values;
    if (round == 0) {
      values = {{0, -100}, {0, -50}, {0, 0}, {1, 10}, {1, 0}};
    } else {
      for (const auto& one : design["values"]["storage"])
        values.emplace_back(0, std::stod(one.get<std::string>()));
      for (const auto& one : design["values"]["depth"]) values.emplace_back(1, one.get<double>());
    }
    const auto n = static_cast<long>(values.size());
    std::vector<long> rows;
    if (round == 0) {
      for (long row = 0; row < 2 * n; ++row) rows.push_back(row);
    } else {
      rows = design["rows"].get<std::vector<long>>();
    }
    for (const long row : rows) {
      const auto [limit, value] = values.at(static_cast<std::size_t>(row % n));
      const double edge = -40.5 - 10.0 * static_cast<double>(row / n);
      RowAnswers one;
      one.round = round;
      one.row = row;
      one.position = static_cast<long>(answers_.size()) + 1;
      one.complete = true;
      const bool up = limit == 0;
      for (const bool is_unsafe : {up && value > edge, up && value > edge - 1, !up && value < 4})
        one.held.push_back(is_unsafe ? Held::yes : Held::no);
      answers_.push_back(one);
    }
    designs_.push_back(design);
  }
  std::optional<LimitSearcher> searcher_;
  std::vector<RowAnswers> answers_;
  std::vector<json> designs_;
};

TEST_F(LimitSearcherTest, AllConfigurationsFaultsAndLimitsAreSearchedTogether) {
  answer(json{{"kind", "grid"}}, 0);
  const Proposal first = searcher_->propose(answers_, designs_);
  EXPECT_THAT(first.reason, HasSubstr("6 searches: 6 limit; 6 wider"));
  EXPECT_EQ(first.design["values"]["storage"], (json{"-75 bar", "-25 bar"}));
  EXPECT_EQ(first.design["values"]["depth"], json{4.0}) << "a middle on the grid of 2";
  // F1 and F2 share a case; configuration 1 looks above -50 bar for neither of them.
  EXPECT_EQ(first.design["rows"], (json{1, 2, 3, 5}));
  for (int round = 1; round < 20; ++round) {
    const Proposal next = searcher_->propose(answers_, designs_);
    if (next.design.is_null()) break;
    answer(next.design, round);
  }
  EXPECT_EQ(searcher_->propose(answers_, designs_).reason, "6 searches: 6 limit");
  const auto searches = searcher_->search(answers_, designs_);
  ASSERT_EQ(searches.size(), 6u);
  const double expected[] = {-41, -42, 4, -51, -52, 4};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(searches[k].finding.limit()->before.value, expected[k]) << k;
    EXPECT_EQ(searches[k].configuration, k / 3);
  }
}

/// What came out of an undecided case counts, but is not sure, on its own fault only.
TEST_F(LimitSearcherTest, AnUndecidedAnswerIsNotSure) {
  answer(json{{"kind", "grid"}}, 0);
  answers_[1].held[1] = Held::undecided_no;   // of F2, at -50 bar
  answers_[2].held[1] = Held::undecided_yes;  // at 0 bar
  const auto searches = searcher_->search(answers_, designs_);
  EXPECT_EQ(searches[0].finding.surely_safe->value, -50);
  EXPECT_EQ(searches[0].finding.surely_unsafe->value, 0);
  EXPECT_EQ(searches[1].finding.limit()->before.value, -50);
  EXPECT_EQ(searches[1].finding.surely_safe->value, -100);
  EXPECT_FALSE(searches[1].finding.surely_unsafe);
}

TEST_F(LimitSearcherTest, AFailedCaseAndOneThatWasExcludedAreNotKnown) {
  answer(json{{"kind", "grid"}}, 0);
  answers_[1].held.assign(3, Held::unknown);  // failed, at -50 bar
  answers_.erase(answers_.begin() + 4);       // excluded, the far end of depth
  const auto searches = searcher_->search(answers_, designs_);
  EXPECT_EQ(searches[0].finding.points[1].state, PointState::unknown);
  EXPECT_EQ(searches[0].finding.limit()->n_unknown, 1);
  EXPECT_EQ(searches[2].finding.verdict, LimitVerdict::safe_throughout);
  EXPECT_EQ(searches[2].finding.n_unknown, 1);
}

}  // namespace
}  // namespace faultsweep
