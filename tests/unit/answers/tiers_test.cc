// Two tiers of a made-up campaign: the same samples, of which the expensive one has the first few.
#include "campaign/answers/tiers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "campaign/query/parameters.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

class TiersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "tiers_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (int k = 0; k < 200; ++k) samples_.push_back(uniform(random));
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// The first n samples, whose strength at this tier is 0.9 · sample + shift; each took `seconds`.
  /// @param open  as near as this to 0.5 the cells leave open whether F1 slides.
  CampaignInfo run(const std::string& name, std::size_t n, double shift, double seconds,
                   std::size_t failed = 1000, double operator_seconds = 0, double open = 0) {
    Submission s;
    s.name = name;
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-" + name, 1000, 100, 1, 1}};
    s.parameters = {{"strength", faultsim::Dimension::number, false}};
    s.spec_resolved =
        R"({"groups": [{"kind": "monte-carlo", "parameters": [{"name": "strength"}]}]})";
    for (std::size_t k = 0; k < n; ++k) {
      s.cases.push_back(
          {name + std::to_string(k), 0, 0, "{}", {{0, samples_[k], std::to_string(samples_[k])}}});
    }
    store_->submit(s);
    const CampaignInfo campaign = store_->campaign(name);
    for (const WaitingFamily& family : store_->waiting_families(campaign.id))
      store_->record_operator(family.family,
                              {"op-" + name, false, operator_seconds, 1000, 100, 1000, 1000});
    std::vector<RunRecord> runs;
    for (std::size_t k = 0; k < n; ++k) {
      RunRecord one;
      one.case_id = store_->stored_case(campaign.id, std::to_string(k + 1)).id;
      one.status = k == failed ? RunStatus::hung : RunStatus::completed;
      one.wall_seconds = seconds;
      const double strength = 0.9 * samples_[k] + shift;
      if (k != failed) one.result = testing::made_up_result(strength);
      if (one.result && std::abs(strength - 0.5) < open) {
        one.result->whole.faults[0].activation_resolved = false;
        one.result->whole.activation_resolved = false;
      }
      runs.push_back(one);
    }
    store_->record_runs(campaign.id, runs);
    return store_->campaign(name);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  std::vector<double> samples_;
};

TEST_F(TiersTest, ACheapTierThatGoesWithTheDearOneIsWorthAllItsCases) {
  const CampaignInfo low = run("low", 200, 0, 0.01), high = run("high", 41, 0.1, 1, 7);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  EXPECT_EQ(found.n_pairs, 40);
  EXPECT_EQ(found.high_cost.n_left_out, 1);
  EXPECT_NEAR(found.low_cost.case_seconds, 0.01, 1e-12);
  ASSERT_EQ(found.answers.size(), 2u);
  double truth = 0;
  for (const double one : samples_) truth += (0.9 * one + 0.1) / 200;
  const TierAnswer& mean = found.answers[0];
  EXPECT_NEAR(mean.found.value, truth, 1e-9) << "their difference is the same in all";
  EXPECT_NEAR(mean.low_value, truth - 0.1, 1e-9);
  EXPECT_NEAR(mean.n_equivalent, 200, 60);
  // 200 expensive cases take 200 s; 200 cheap and 40 expensive ones took 2 s and 40 s.
  EXPECT_NEAR(mean.cost_ratio, mean.n_equivalent / 42, 1e-9);
  const TierAnswer& slides = found.answers[1];
  EXPECT_EQ(slides.question, TierQuestion::probability);
  double share = 0;
  for (const double one : samples_) share += 0.9 * one + 0.1 > 0.5 ? 1.0 / 200 : 0;
  EXPECT_LE(slides.found.bounds.low, share);
  EXPECT_GE(slides.found.bounds.high, share);
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, ::testing::HasSubstr("40 cases at both tiers"));
  EXPECT_THAT(text, ::testing::HasSubstr("Mean of F1.chi_bar at the high tier: 0.5"));
  EXPECT_THAT(text, ::testing::HasSubstr("Costs are seconds of wall clock"));
  const auto document = render_json(answer);
  const auto& row = document.at("answers").at(0);
  EXPECT_TRUE(row.at("pays"));
  EXPECT_EQ(row.at("value").get<double>(), mean.found.value);
  EXPECT_EQ(row.at("high_alone_low").get<double>(), mean.alone.bounds.low);
  EXPECT_NEAR(document.at("taken_s"), 42, 1e-9);
  EXPECT_NEAR(row.at("high_alone_s"), mean.n_equivalent, 1e-9) << "1 s each";
}

TEST_F(TiersTest, SaysWhenItDoesNotPay) {
  const CampaignInfo low = run("low", 200, 0, 1), high = run("high", 100, 0.1, 1);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  EXPECT_LT(found.answers[0].cost_ratio, 1) << "300 s for what 200 expensive cases tell in 200 s";
  const std::string text = render_text(to_answer(found), 1000);
  EXPECT_THAT(
      text, ::testing::HasSubstr("Two tiers do not pay: equal certainty from the high tier alone"));
  EXPECT_THAT(text, ::testing::HasSubstr("no: alone 0."));
}

/// What operators took is paid once per tier, whatever the number of cases.
TEST_F(TiersTest, OperatorsCostToo) {
  const double cheap = 5, dear = 300;  // s
  const CampaignInfo low = run("low", 200, 0, 0.01, 1000, cheap),
                     high = run("high", 40, 0.1, 1, 1000, dear);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  EXPECT_EQ(found.low_cost.operator_seconds, cheap);
  EXPECT_EQ(found.high_cost.operator_seconds, dear);
  const TierAnswer& mean = found.answers.at(0);
  EXPECT_NEAR(mean.cost_ratio, (dear + mean.n_equivalent) / (cheap + 2 + dear + 40), 1e-9);
}

/// The low tier's χ̄, slip and area say of a flag more than the flag alone: its threshold lies 0.1
/// off, which shifts the flags of many cases, but not what χ̄ makes of them.
TEST_F(TiersTest, AProbabilityIsPredictedFromMarginsToo) {
  const CampaignInfo low = run("low", 200, 0, 0.01), high = run("high", 60, 0.1, 1);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  const TierAnswer& slides = found.answers.at(1);
  double low_share = 0, truth = 0;
  for (const double one : samples_) {
    low_share += 0.9 * one > 0.5 ? 1.0 / 200 : 0;
    truth += 0.9 * one + 0.1 > 0.5 ? 1.0 / 200 : 0;
  }
  EXPECT_NEAR(slides.low_value, low_share, 1e-12);
  EXPECT_NEAR(slides.found.value, truth, 0.03);
  EXPECT_GT(truth - low_share, 0.1);
  EXPECT_LT(slides.found.bounds.high - slides.found.bounds.low,
            0.8 * (slides.alone.bounds.high - slides.alone.bounds.low));
  EXPECT_EQ(slides.n_undecided, 0);
  EXPECT_THAT(slides.predictors, ::testing::ElementsAre("F1.chi_bar", "F1.max_slip",
                                                        "F1.activated_area", "F1.slides"));
  EXPECT_THAT(slides.left_out, ::testing::IsEmpty());
  const std::string text = render_text(to_answer(found), 1000);
  EXPECT_THAT(text, ::testing::HasSubstr("logistic regressions fitted without the case"));
}

TEST_F(TiersTest, UndecidedFlagsWidenTheBoundsAndAreCounted) {
  const CampaignInfo low = run("low", 200, 0, 0.01, 1000, 0, 0.05),
                     high = run("high", 80, 0.1, 1, 1000, 0, 0.1);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  const TierAnswer& slides = found.answers.at(1);
  long n_open = 0;
  double computed = 0, least = 0, most = 0;
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const double strength = 0.9 * samples_[k] + 0.1;
    const bool is_open = std::abs(strength - 0.5) < 0.1;
    if (k < 80) n_open += is_open ? 1 : 0;
    computed += strength > 0.5 ? 1.0 / 200 : 0;
    least += strength > 0.5 && !is_open ? 1.0 / 200 : 0;
    most += strength > 0.5 || is_open ? 1.0 / 200 : 0;
  }
  EXPECT_EQ(slides.n_undecided, n_open);
  EXPECT_NEAR(slides.found.value, computed, 0.05);
  EXPECT_NEAR(slides.by_undecided, 0.5 * (most - least), 0.03);
  EXPECT_LT(slides.found.bounds.low, least);
  EXPECT_GT(slides.found.bounds.high, most);
  EXPECT_LT(slides.by_number, 0.12);
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, ::testing::HasSubstr(concat("by ", n_open, " undecided).")));
  EXPECT_THAT(text, ::testing::HasSubstr(concat("up to ", n_open, " of 80 are undecided")));
  const auto document = render_json(answer);
  EXPECT_EQ(document.at("answers").at(1).at("undecided"), n_open);
  EXPECT_EQ(document.at("answers").at(1).at("by_undecided").get<double>(), slides.by_undecided);
}

/// F2 slides when F1 does, but its χ̄ never reaches 0.9: the flag is the same in all cases.
TEST_F(TiersTest, SaysWhatCouldNotBeUsed) {
  const CampaignInfo low = run("low", 200, 0, 0.01), high = run("high", 60, 0.1, 1);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F2.chi_bar > 0.9"}, 0.95});
  const TierAnswer& never = found.answers.at(1);
  EXPECT_THAT(never.left_out, ::testing::ElementsAre("F2.chi_bar > 0.9"));
  EXPECT_NEAR(never.found.value, 0, 0.01);
  EXPECT_GT(never.found.bounds.high, 0.02);
  const Answer answer = to_answer(found);
  EXPECT_THAT(render_text(answer, 1000),
              ::testing::HasSubstr("or missing in some: F2.chi_bar > 0.9."));
  EXPECT_EQ(render_json(answer).at("answers").at(1).at("left_out"), "F2.chi_bar > 0.9");
}

TEST_F(TiersTest, QuantilesAreThoseOfAllCases) {
  const CampaignInfo low = run("low", 200, 0, 0.01), high = run("high", 60, 0.1, 1);
  TierRequest request;
  request.quantiles = "F1.chi_bar, F1.max_slip in gas_storage";
  request.at = {0.02, 0.5};
  const Tiers found = compare_tiers(*store_, low, high, request);
  ASSERT_EQ(found.answers.size(), 4u) << "nothing else is asked for";
  std::vector<double> truth = samples_;
  std::ranges::sort(truth);
  const TierAnswer& median = found.answers[1];
  EXPECT_EQ(median.question, TierQuestion::quantile);
  EXPECT_EQ(median.share, 0.5);
  EXPECT_NEAR(median.found.value, 0.9 * truth[100] + 0.1, 0.02);
  EXPECT_NEAR(median.low_value, 0.9 * truth[100], 0.01);
  EXPECT_LT(median.found.bounds.low, 0.9 * truth[100] + 0.1);
  EXPECT_GT(median.found.bounds.high, 0.9 * truth[100] + 0.1);
  EXPECT_TRUE(std::isnan(found.answers[0].found.bounds.low)) << "60 do not close the 2 % quantile";
  EXPECT_THAT(found.answers[3].predictors,
              ::testing::ElementsAre("F1.chi_bar in gas_storage", "F1.max_slip in gas_storage",
                                     "F1.activated_area in gas_storage"));
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, ::testing::HasSubstr("2 % quantile of F1.chi_bar at the high tier: "));
  EXPECT_THAT(text, ::testing::HasSubstr("(open to "));
  EXPECT_THAT(text, ::testing::HasSubstr("50 % of F1.chi_bar"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("Not used to predict")));
  const auto document = render_json(answer);
  EXPECT_TRUE(document.at("answers").at(0).at("low").is_null());
  EXPECT_EQ(document.at("answers").at(0).at("question"), "quantile");
  request.at = {1.5};
  EXPECT_THROW(compare_tiers(*store_, low, high, request), faultsim::InputError);
}

/// What is wanted takes what it says, and half of it more.
TEST_F(TiersTest, AWidthIsWorthItsCases) {
  const double cheap = 5, dear = 300;  // s, of the one operator
  const CampaignInfo low = run("low", 200, 0, 0.01, 1000, cheap),
                     high = run("high", 60, 0.1, 1, 1000, dear);
  TierRequest request{"F1.chi_bar", {"F1.slides"}, 0.95};
  request.width = 0.1;
  const Tiers found = compare_tiers(*store_, low, high, request);
  const auto& slides = found.answers.at(1).numbers;
  ASSERT_EQ(slides.size(), 3u);
  EXPECT_EQ(slides[0].half_width, 0.05);
  EXPECT_EQ(slides[2].half_width, 0.0125);
  for (const NumbersForWidth& one : slides) {
    ASSERT_TRUE(one.numbers.has_value());
    EXPECT_LE(one.numbers->half_width, one.half_width);
    EXPECT_NEAR(one.numbers->cost,
                cheap + dear + static_cast<double>(one.numbers->n) +
                    0.01 * static_cast<double>(one.numbers->all),
                1e-6);
  }
  EXPECT_GT(slides[1].numbers->n, slides[0].numbers->n);
  EXPECT_GT(slides[0].numbers->all, slides[0].numbers->n);
  const auto& mean = found.answers.at(0).numbers;
  ASSERT_EQ(mean.size(), 2u);
  EXPECT_EQ(mean[0].half_width, 0.5 * found.answers[0].by_number);
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 1000),
              ::testing::HasSubstr("Bounds of F1.slides that are 10 % apart need "));
  EXPECT_EQ(render_json(answer).at("numbers").at(2).at("high_cases"), slides[0].numbers->n);
}

/// Where each case has an operator of its own, more cases take more of them.
TEST_F(TiersTest, OperatorsOfTheirOwnCostByTheCase) {
  TierCost cost;
  cost.n_rows = 100, cost.case_seconds = 2, cost.operator_seconds = 500, cost.n_operators = 1;
  EXPECT_EQ(cost.seconds_of(200), 900);
  cost.n_operators = 90;
  EXPECT_EQ(cost.seconds_of(200), 1400);
  EXPECT_EQ(cost.seconds_of(100), 700) << "what was taken is the same";
}

TEST_F(TiersTest, OtherSamplesAndTooFewAreRefused) {
  const CampaignInfo low = run("low", 100, 0, 1), few = run("few", 10, 0, 1);
  EXPECT_THROW(compare_tiers(*store_, low, few, {}), faultsim::InputError);
  std::swap(samples_[3], samples_[4]);
  const CampaignInfo other = run("other", 50, 0, 1);
  EXPECT_THROW(compare_tiers(*store_, low, other, {}), faultsim::InputError);
  EXPECT_THROW(compare_tiers(*store_, few, low, {}), faultsim::InputError);
  EXPECT_THROW(compare_tiers(*store_, low, low, {.metrics = "event_magnitude"}),
               faultsim::InputError);
}

}  // namespace
}  // namespace faultsweep
