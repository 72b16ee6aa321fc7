// Why a case of a made-up campaign has its place: neighbours, ties and slopes that are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/answers/why.h"
#include "campaign/render/render.h"
#include "tests/unit/answers/answers_fixture.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using faultsim::InputError;
using ::testing::HasSubstr;

/// The rule is "mean" for the odd positions and "min" for the others.
TEST_F(AnswersTest, WhyListsWhatOneParameterAloneChanges) {
  submit("list", {{0.8, 100},
                  {0.8, 0},  // differs in its rule, too
                  {0.9, 100},
                  {0.2, 1},
                  {0.6, 100},
                  {0.2, 2},
                  {0.55, 100},  // 0.6 is nearer
                  {0.8, 100},   // in its rule alone
                  {0.8, 200}});
  record();
  const Why found = why(1);
  EXPECT_EQ(found.compared, "activated_area");
  ASSERT_EQ(found.neighbours.size(), 4u);
  const std::vector<std::pair<std::string, long>> expected = {
      {"strength", 5}, {"strength", 3}, {"rule", 8}, {"offset", 9}};
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found.neighbours[k].parameter, expected[k].first) << k;
    EXPECT_EQ(found.neighbours[k].row.position, expected[k].second) << k;
  }
  EXPECT_NEAR(found.neighbours[0].change, -3e4, 1e-6) << "m2, neighbour minus case";
  EXPECT_NEAR(found.neighbours[1].change, 1.5e4, 1e-6);
  EXPECT_EQ(found.neighbours[2].change, 0);
  EXPECT_EQ(found.neighbours[3].change, 0);
  EXPECT_EQ(found.place.n_ranked, 9);
  EXPECT_EQ(found.place.ties, (std::vector<long>{2, 8, 9})) << "the very same area";
  EXPECT_THAT(found.no_global, HasSubstr("not a sample"));
  const Answer answer = to_answer(found);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("Case 1 of sweep (strength = 0.8, offset = 100 m, rule = mean) "
                              "ranks 2 of 9 complete histories: activated_area = 45000 m²."));
  EXPECT_THAT(text,
              HasSubstr("F1 slides first in primary_production, load step 1 (year 1), at 2000 "
                        "m depth: west has changed by -10 bar (190 bar absolute)"));
  EXPECT_THAT(text, HasSubstr("The largest change is with strength"));
  const auto document = render_json(answer);
  EXPECT_EQ(document.at("local").size(), 4u);
  EXPECT_TRUE(document.at("nearest").empty());
  EXPECT_EQ(document.at("faults").at(0).at("activation").at("change_minus_pa"), -1e6);
  EXPECT_EQ(document.at("parameters").at("offset"), 100.0);
  testing::expect_the_same_numbers(answer);
  testing::expect_to_fit(answer);
}

/// Names tell cases apart and explain nothing: `rule` is the name of each.
TEST_F(AnswersTest, WhyTakesNamesOfPlacesForNoDifference) {
  design_keys_ = {{"names", "rule"}};
  submit("places", {{0.8, 100}, {0.6, 100}, {0.8, 200}, {0.7, 300}});
  record();
  const Why found = why(1);
  ASSERT_EQ(found.neighbours.size(), 2u);
  EXPECT_EQ(found.neighbours[0].parameter, "strength");
  EXPECT_EQ(found.neighbours[0].row.position, 2) << "which has another name";
  EXPECT_EQ(found.neighbours[1].parameter, "offset");
  EXPECT_EQ(found.neighbours[1].row.position, 3);
}

TEST_F(AnswersTest, WhySaysWhichPlacesTheMeshDoesNotTellApart) {
  submit("list", {{0.30, 1}, {0.31, 1}, {0.32, 1}, {0.2, 1}, {0.1, 1}});
  record();
  const auto text_of = [&](long position) { return render_text(to_answer(why(position)), 1000); };
  EXPECT_THAT(text_of(2), HasSubstr("an error of 0.003 (rms that the tier screening names, against "
                                    "the limit of small cells in plane strain): no other case is"));
  EXPECT_TRUE(why(2).place.ties.empty());
  EXPECT_THAT(render_text(to_answer(why(2, {.by = "moment"})), 1000),
              HasSubstr("was not measured"));
  TradeRecord trade;
  trade.report = "{}";
  trade.error_bars = {{"sweep", "screening", "chi_bar", "standard", 8, 0.01, 0.02}};
  store_->record_trade(trade);
  const Why found = why(2);
  EXPECT_EQ(found.compared, "chi_bar");
  EXPECT_EQ(found.place.place, 2);
  EXPECT_EQ(found.place.ties, (std::vector<long>{3, 1})) << "within 0.014";
  EXPECT_TRUE(why(5).place.ties.empty());
  const std::string text = text_of(4);
  EXPECT_THAT(text, HasSubstr("F1 does not slide: its χ̄ comes to 0.2, in gas_storage"));
  EXPECT_THAT(text, HasSubstr("8 bar more"));
}

TEST_F(AnswersTest, WhyListsTheNearestOfFewAndRefusesWhatIsNotRanked) {
  submit("monte-carlo", even(40));
  runs_[3].result.reset(), runs_[3].status = RunStatus::hung;
  record();
  const Why found = why(30, {.by = "chi_bar"});
  EXPECT_FALSE(found.global);
  EXPECT_THAT(found.no_global, HasSubstr("39 cases with a full history are too few"));
  // 20 of its 38 neighbours have its word; χ̄ is the strength, and the offset does nothing.
  EXPECT_TRUE(found.neighbours.empty());
  ASSERT_EQ(found.nearest.size(), 8u);
  for (std::size_t k = 1; k < 8; ++k)
    EXPECT_LE(found.nearest[k - 1].distance, found.nearest[k].distance);
  const Answer answer = to_answer(found);
  const auto document = render_json(answer);
  EXPECT_THAT(document["no_slopes"].get<std::string>(),
              HasSubstr("need 20 cases with the same words"));
  EXPECT_EQ(document["nearest"].size(), 8u);
  testing::expect_the_same_numbers(answer);
  testing::expect_to_fit(answer);
  EXPECT_FALSE(why(30, {.by = "chi_bar * 2"}).global) << "an expression is not a metric";
  EXPECT_THROW(why(4), InputError) << "no result";
  EXPECT_THROW(why(30, {.where = "strength < 0.1"}), InputError) << "left out";
}

TEST_F(AnswersTest, WhyHasLocalSlopesOfARandomSample) {
  submit("monte-carlo", even(140));
  record();
  const Why found = why(60, {.by = "chi_bar"});
  ASSERT_TRUE(found.global);
  EXPECT_GT(found.global->metrics.at(0).first_order.at(0).value, 0.8);
  ASSERT_EQ(found.plane.slopes.size(), 2u) << found.plane.reason;
  const Answer answer = to_answer(found);
  const auto document = render_json(answer);
  EXPECT_EQ(document["global"][0]["parameter"], "strength");
  EXPECT_EQ(document["slopes"][0]["parameter"], "strength") << "the largest first";
  EXPECT_NEAR(document["slopes"][0]["slope"].get<double>(), 1, 1e-9) << "χ̄ is the strength";
  EXPECT_NEAR(document["slopes"][1]["slope"].get<double>(), 0, 1e-9);
  EXPECT_LT(document["slopes"][0]["per_deviation_error"].get<double>(), 1e-9);
  EXPECT_THAT(answer.headline.at(2),
              HasSubstr("Near this case, chi_bar changes most with strength"));
  testing::expect_the_same_numbers(answer);
  testing::expect_to_fit(answer);
}

}  // namespace
}  // namespace faultsweep
