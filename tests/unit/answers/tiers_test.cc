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
  CampaignInfo run(const std::string& name, std::size_t n, double shift, double seconds,
                   std::size_t failed = 1000, double operator_seconds = 0) {
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
      if (k != failed) one.result = testing::made_up_result(0.9 * samples_[k] + shift);
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
  EXPECT_NEAR(mean.found.estimate.value, truth, 1e-9) << "their difference is the same in all";
  EXPECT_NEAR(mean.low_mean, truth - 0.1, 1e-9);
  EXPECT_NEAR(mean.found.n_equivalent, 200, 60);
  // 200 expensive cases take 200 s; 200 cheap and 40 expensive ones took 2 s and 40 s.
  EXPECT_NEAR(mean.cost_ratio, mean.found.n_equivalent / 42, 1e-9);
  const TierAnswer& slides = found.answers[1];
  EXPECT_TRUE(slides.is_probability);
  double share = 0;
  for (const double one : samples_) share += 0.9 * one + 0.1 > 0.5 ? 1.0 / 200 : 0;
  EXPECT_LE(slides.found.estimate.bounds.low, share);
  EXPECT_GE(slides.found.estimate.bounds.high, share);
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, ::testing::HasSubstr("40 cases at both tiers"));
  EXPECT_THAT(text, ::testing::HasSubstr("Mean of F1.chi_bar at the high tier: 0.5"));
  EXPECT_THAT(text, ::testing::HasSubstr("Costs are seconds of wall clock"));
  const auto document = render_json(answer);
  const auto& row = document.at("answers").at(0);
  EXPECT_TRUE(row.at("pays"));
  EXPECT_EQ(row.at("value").get<double>(), mean.found.estimate.value);
  EXPECT_EQ(row.at("high_alone_low").get<double>(), mean.found.direct.bounds.low);
  EXPECT_NEAR(document.at("taken_s"), 42, 1e-9);
  EXPECT_NEAR(row.at("high_alone_s"), mean.found.n_equivalent, 1e-9) << "1 s each";
}

TEST_F(TiersTest, SaysWhenItDoesNotPay) {
  const CampaignInfo low = run("low", 200, 0, 1), high = run("high", 100, 0.1, 1);
  const Tiers found = compare_tiers(*store_, low, high, {"F1.chi_bar", {"F1.slides"}, 0.95});
  EXPECT_LT(found.answers[0].cost_ratio, 1) << "300 s for what 200 expensive cases tell in 200 s";
  const std::string text = render_text(to_answer(found), 1000);
  EXPECT_THAT(text, ::testing::HasSubstr("Two tiers do not pay: as sure from the high tier alone"));
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
  EXPECT_NEAR(mean.cost_ratio, (dear + mean.found.n_equivalent) / (cheap + 2 + dear + 40), 1e-9);
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
