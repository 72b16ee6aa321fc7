// Error bars of rankings: what `faultsweep tradeoff` stored for a campaign at its tier.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/render/render.h"
#include "campaign/reports/ranking_answer.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ErrorBars : public ::testing::Test {
 protected:
  ErrorBars() {
    std::string name = ::testing::TempDir() + "error_bars_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    TradeRecord trade{1e9, "sweep.json", "tradeoff-sweep", "0", "{}", {}};
    trade.error_bars = {{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05},
                        {"sweep", "standard", "chi_bar", "reference", 8, 0.007, 0.01},
                        {"other", "screening", "chi_bar", "standard", 4, 0.5, 0.6}};
    store_->record_trade(trade);
  }
  ~ErrorBars() override { std::filesystem::remove_all(folder_); }

  /// The ranking of a campaign of one case whose groups have these scenes.
  std::string ranked(const std::string& name, const std::vector<std::string>& scenes) {
    Submission s;
    s.name = name;
    s.parameters = {};
    s.rank_by = "activated_area";
    nlohmann::json groups = nlohmann::json::array();
    for (const auto& scene : scenes) groups.push_back({{"scene", nlohmann::json::parse(scene)}});
    s.spec_resolved = nlohmann::json({{"groups", groups}}).dump();
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1000, 100, 1, 1}};
    const auto id = std::to_string(++n_cases_);
    s.cases.push_back({"identity-" + id, 0, 0, "{}", {}});
    const SubmitOutcome outcome = store_->submit(s);
    RunRecord run;
    run.case_id = n_cases_;
    run.status = RunStatus::completed;
    run.result = testing::made_up_result(0.4);
    store_->record_runs(outcome.campaign, {run});
    answer_ = to_answer(make_ranking(*store_, store_->campaign(outcome.name), {}));
    return render_text(answer_);
  }

  std::string folder_;
  std::unique_ptr<Store> store_;
  int n_cases_ = 0;
  Answer answer_;  ///< the last one.
};

TEST_F(ErrorBars, AreThoseOfTheCampaignAtItsTier) {
  const std::string text = ranked("sweep", {R"({"tier": "screening"})"});
  EXPECT_THAT(text, HasSubstr("0.40 ± 0.02"));
  std::string note = text;
  std::replace(note.begin(), note.end(), '\n', ' ');
  EXPECT_THAT(note, HasSubstr("against standard over 32 cases of the campaign, at most 0.05"));
  const auto json = render_json(answer_);
  EXPECT_EQ(json["cases"][0]["chi_bar_error"], 0.02);
  EXPECT_FALSE(json["cases"][0].contains("max_slip_m_error")) << "never measured";
  EXPECT_EQ(json["error_bars"][0]["rms"], 0.02);
}

TEST_F(ErrorBars, OfTheNextTierAreOthers) {
  EXPECT_THAT(ranked("sweep", {R"({"tier": "standard"})"}), HasSubstr("0.400 ± 0.007"));
}

TEST_F(ErrorBars, AreNotShownWhereNothingWasMeasured) {
  EXPECT_THAT(ranked("unknown", {R"({"tier": "screening"})"}), Not(HasSubstr("±")));
}

TEST_F(ErrorBars, AreNotShownWhereTiersOrMeshesDiffer) {
  for (const auto& scenes : std::vector<std::vector<std::string>>{
           {R"({"tier": "screening"})", R"({"tier": "standard"})"},
           {R"({"tier": "screening", "mesh": {"dip": "5 m"}})"},
           {"{}"},
           {R"({"tier": "reference"})"}}) {
    EXPECT_THAT(ranked("sweep", scenes), Not(HasSubstr("±")));
    store_->record_trade({});  // nothing new, and nothing lost
  }
}

TEST_F(ErrorBars, AreReplacedByALaterTrade) {
  TradeRecord later{2e9, "sweep.json", "tradeoff-sweep", "0", "{}", {}};
  later.error_bars = {{"sweep", "screening", "chi_bar", "standard", 64, 0.03, 0.04}};
  store_->record_trade(later);
  EXPECT_THAT(ranked("sweep", {R"({"tier": "screening"})"}), HasSubstr("0.40 ± 0.03"));
}

}  // namespace
}  // namespace faultsweep
