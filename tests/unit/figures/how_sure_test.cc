// How sure a campaign is, as its page says it: from what the store has of trades and tiers.
#include "campaign/figures/how_sure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaign/answers/tiers.h"
#include "campaign/figures/report_page.h"
#include "campaign/render/render.h"
#include "campaign/tradeoff/trade_report.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class HowSureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "how_sure_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// The first n of samples of the reference field, whose strength at this tier is off by `shift`.
  CampaignInfo run(const std::string& name, const std::string& tier, int n, double shift = 0,
                   double first = 0) {
    const std::string scene =
        std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/scenes/rotliegend.json";
    std::ostringstream text;
    text << std::ifstream(scene).rdbuf();
    Submission s;
    s.name = name;
    s.source = "/somebody/secret/sweep.json";
    s.scenes = {{scene, text.str()}};
    s.families = {{"family-" + name, 1000, 100, 1, 1}};
    s.parameters = {{"strength", faultsim::Dimension::number, false}};
    for (int k = 0; k < n; ++k) {
      const double value = first + strength(k);
      s.cases.push_back(
          {name + std::to_string(k), 0, 0, "{}", {{0, value, std::to_string(value)}}});
    }
    const json parameters = json::array({{{"name", "strength"}}});
    s.spec_resolved =
        json{{"groups",
              {{{"kind", "monte-carlo"}, {"parameters", parameters}, {"scene", {{"tier", tier}}}}}}}
            .dump();
    store_->submit(s);
    const CampaignInfo campaign = store_->campaign(name);
    std::vector<RunRecord> runs;
    for (int k = 0; k < n; ++k) {
      RunRecord one;
      one.case_id = store_->stored_case(campaign.id, std::to_string(k + 1)).id;
      one.status = RunStatus::completed;
      one.result = testing::made_up_result(strength(k) + shift);
      runs.push_back(one);
    }
    store_->record_runs(campaign.id, runs);
    return store_->campaign(name);
  }
  static double strength(int k) { return 0.1 + 0.8 * std::fmod(0.618034 * (k + 1), 1.0); }
  std::string page(const CampaignInfo& campaign) {
    return report_page(*store_, campaign, {.program = "faultsweep test"});
  }
  /// On a screen wide enough for every sentence.
  std::string said(const CampaignInfo& campaign) {
    return render_text(how_sure(*store_, campaign, 0.95), 1000);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
};

constexpr const char* kNotMeasured =
    "What these cells, the tier and the other modelling choices cost in accuracy was not measured "
    "for this campaign: faultsweep tradeoff sweep.json measures and stores it";

TEST_F(HowSureTest, SaysWhereNothingWasMeasuredAndWhichCommandMeasuresIt) {
  const CampaignInfo sweep = run("sweep", "screening", 10);
  EXPECT_THAT(page(sweep), HasSubstr("<h2 id=\"how-sure\">How sure</h2>"));
  EXPECT_THAT(page(sweep), HasSubstr(kNotMeasured));
  EXPECT_THAT(said(sweep), HasSubstr("Mesh: tier screening ("));
  EXPECT_THAT(said(sweep), Not(HasSubstr("Measured at")));
  EXPECT_THAT(said(sweep), HasSubstr("undecided where χ̄ is within 0.011 of the limit in it."));
  EXPECT_THAT(said(sweep), Not(HasSubstr("secret")));
}

TEST_F(HowSureTest, StatesErrorsWithTheirTierQuantityAndUnit) {
  const CampaignInfo sweep = run("sweep", "screening", 10);
  store_->record_trade({1e9,
                        "sweep.json",
                        "tradeoff-sweep",
                        "7",
                        R"({"answers": [], "axes": []})",
                        {{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05},
                         {"sweep", "screening", "max_slip", "standard", 32, 0.0021, 0.004},
                         {"sweep", "demonstration", "chi_bar", "standard", 32, 0.03, 0.06}}});
  const std::string text = said(sweep);
  EXPECT_THAT(text, HasSubstr("Measured at tier screening on cases of this campaign, against tier "
                              "standard: χ̄ off by 0.02 rms, 0.05 at most (32 cases); largest slip "
                              "off by 2.1 mm rms, 4 mm at most (32 cases).\n"));
  EXPECT_THAT(text, HasSubstr("Measured at tier demonstration on cases of this campaign, against "
                              "tier standard: χ̄ off by 0.03 rms, 0.06 at most (32 cases).\n"));
  EXPECT_THAT(text, HasSubstr("The rms errors appear as ± in the ranking."));
  EXPECT_THAT(text, Not(HasSubstr(kNotMeasured)));
  EXPECT_THAT(text, Not(HasSubstr("their own mesh were not measured")));
  EXPECT_THAT(page(sweep), HasSubstr("largest slip off by 2.1 mm rms, 4 mm at most (32 cases)."));
}

TEST_F(HowSureTest, HasTheChartOfTheTradeAndItsSentences) {
  const CampaignInfo sweep = run("sweep", "screening", 10);
  run("tradeoff-rotliegend", "standard", 1);  // of the same base scene
  const json report = {
      {"answers", {"For χ̄ within 0.02: <20 m>, 3D."}},
      {"axes",
       {{{"axis", "cells, 3D"},
         {"choices",
          {{{"choice", "40 m"}, {"operator_s", 2.0}, {"case_s", 1.0}, {"error_chi_in_all", 0.1}},
           {{"choice", "20 m"},
            {"operator_s", 9.0},
            {"case_s", 1.0},
            {"error_chi_in_all", 0.02}}}}}}}};
  store_->record_trade({1e9, "rotliegend.json", "tradeoff-rotliegend", "7", report.dump(), {}});
  const std::string html = page(sweep);
  EXPECT_THAT(html, HasSubstr(draw(trade_figures(report).pareto)));
  EXPECT_THAT(html, HasSubstr("For χ̄ within 0.02: &lt;20 m&gt;, 3D."));
  EXPECT_THAT(html, HasSubstr("was measured on one scene, rotliegend.json ("));
  EXPECT_THAT(html, Not(HasSubstr(kNotMeasured)));
  EXPECT_THAT(html, HasSubstr("Errors of these cases at their own mesh were not measured"));
}

TEST_F(HowSureTest, SaysWhatADearerTierSaysOfTheSameSample) {
  const CampaignInfo low = run("sweep-screening", "screening", 150),
                     high = run("sweep-standard", "standard", 50, 0.01);
  const std::string expected =
      render_text(to_answer(compare_tiers(*store_, low, high, {.confidence = 0.95})), 1000);
  EXPECT_THAT(
      said(low),
      HasSubstr("Answers at the tier of sweep-standard from all samples of sweep-screening"));
  EXPECT_THAT(
      said(high),
      HasSubstr("Answers at the tier of sweep-standard from all samples of sweep-screening"));
  const std::string first = expected.substr(0, expected.find('\n'));
  EXPECT_THAT(said(low), HasSubstr(first));
  EXPECT_THAT(said(low), Not(HasSubstr(kNotMeasured)));
  EXPECT_THAT(page(low), HasSubstr("Answers at the tier of sweep-standard"));
  EXPECT_THAT(said(run("other", "standard", 5)), HasSubstr(kNotMeasured));
}

TEST_F(HowSureTest, SaysWhyTiersAreNotCompared) {
  const CampaignInfo low = run("sweep-screening", "screening", 60);
  run("sweep-standard", "standard", 20, 0, 0.001);
  EXPECT_THAT(said(low), HasSubstr("sweep-screening and sweep-standard are not compared: the "
                                   "samples of sweep-standard are not the first ones"));
}

}  // namespace
}  // namespace faultsweep
