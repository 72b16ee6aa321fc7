// Trades of a store: which of them speaks of a campaign, and that they say again what was said.
#include "campaign/tradeoff/stored_trade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/render/render.h"
#include "campaign/tradeoff/trade_report.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class StoredTradeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "stored_trade_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// A campaign whose groups have these base scenes.
  CampaignInfo submit(const std::string& name, const std::vector<json>& scenes) {
    Submission s;
    s.name = name;
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-" + name, 1000, 100, 1, 1}};
    s.cases = {{"identity-" + name, 0, 0, "{}", {}}};
    json groups = json::array();
    for (const json& scene : scenes) groups.push_back({{"scene", scene}});
    s.spec_resolved = json{{"groups", groups}}.dump();
    store_->submit(s);
    return store_->campaign(name);
  }
  /// @param campaign  whose cases were its choices.
  void record(const std::string& campaign, const std::vector<ErrorBar>& bars = {},
              const std::string& source = "scene.json") {
    store_->record_trade({1e9, source, campaign, "7", "{}", bars});
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(StoredTradeTest, SpeaksOfACampaignWithItsBaseSceneAtWhateverTier) {
  const json scene = {{"friction", {{"cohesion", "0 MPa"}}}, {"faults", {"F1"}}};
  json at_tier = scene, other = scene;
  at_tier["tier"] = "screening", at_tier["mesh"] = {{"dip", "5 m"}}, at_tier["title"] = "sweep";
  at_tier["output"] = {{"fields", "all"}};
  other["friction"]["cohesion"] = "1 MPa";
  const CampaignInfo sweep = submit("sweep", {other, at_tier}), last = submit("last", {other});
  EXPECT_FALSE(trade_of(*store_, sweep)) << "nobody measured anything";
  submit("tradeoff-scene", {scene, scene});
  record("tradeoff-scene");
  ASSERT_TRUE(trade_of(*store_, sweep));
  EXPECT_EQ(trade_of(*store_, sweep)->campaign, "tradeoff-scene");
  EXPECT_FALSE(trade_of(*store_, last)) << "another cohesion";
  record("a campaign of another store");
  EXPECT_EQ(trade_of(*store_, sweep)->campaign, "tradeoff-scene");
}

TEST_F(StoredTradeTest, SpeaksOfTheCampaignThatItWasMeasuredOn) {
  const CampaignInfo sweep = submit("sweep", {{{"a", 1}}}), other = submit("other", {{{"a", 1}}});
  submit("tradeoff-sweep", {{{"a", 2}}});
  record("tradeoff-sweep", {{"sweep", "screening", "chi_bar", "standard", 8, 0.01, 0.02}},
         "first.json");
  EXPECT_TRUE(trade_of(*store_, sweep));
  EXPECT_FALSE(trade_of(*store_, other));
  record("tradeoff-sweep", {{"sweep", "screening", "chi_bar", "standard", 9, 0.01, 0.02}},
         "second.json");
  EXPECT_EQ(trade_of(*store_, sweep)->source, "second.json") << "the newest";
  submit("tradeoff-third", {{{"a", 3}}});
  record("tradeoff-third", {}, "third.json");
  EXPECT_EQ(trade_of(*store_, sweep)->source, "second.json") << "the third is of something else";
}

/// Two meshes of a trade with costs and errors, and one without.
json made_up_report() {
  const auto choice = [](const char* name, double size, double seconds, json error) {
    return json{{"choice", name},
                {"size", size},
                {"operator_s", seconds},
                {"case_s", 0.5},
                {"error_chi", error},
                {"error_chi_in_all", error},
                {"outcome", error.is_null() ? json() : json("converged")}};
  };
  return {{"answers", {"First <it> says.", "Then it recommends."}},
          {"axes",
           {{{"axis", "cells, 3D"},
             {"converges", true},
             {"choices",
              {choice("40 m", 40, 1.5, 0.04), choice("20 m", 20, 9.5, 0.01),
               choice("10 m", 10, 99, nullptr)}}}}}};
}

TEST_F(StoredTradeTest, SaysAndDrawsWhatWasMeasured) {
  const json report = made_up_report();
  const TradeRecord trade{1e9, "scene.json", "tradeoff-scene", "7", report.dump(), {}};
  const Answer answer = to_answer(trade);
  const std::string text = render_text(answer);
  EXPECT_THAT(text, HasSubstr("First <it> says."));
  EXPECT_LT(text.find("First"), text.find("Then it recommends."));
  EXPECT_THAT(text, HasSubstr("the choices are the cases of tradeoff-scene"));
  const TradeFigures figures = trade_figures(report);
  ASSERT_EQ(figures.pareto.series.size(), 1U);
  const auto& points = figures.pareto.series[0].points;
  ASSERT_EQ(points.size(), 2U) << "what was not run has no error";
  EXPECT_EQ(points[1].name, "20 m");
  EXPECT_DOUBLE_EQ(points[1].x, 10);
  EXPECT_DOUBLE_EQ(points[1].y, 0.01);
  EXPECT_DOUBLE_EQ(figures.convergence.series.at(0).points.at(0).x, 2) << "of the finest that ran";
  EXPECT_EQ(first_chart(answer), draw(figures.pareto));
}

TEST_F(StoredTradeTest, HasNoChartOfNothing) {
  json report = made_up_report();
  for (json& choice : report["axes"][0]["choices"]) choice["error_chi_in_all"] = nullptr;
  const Answer answer = to_answer({1e9, "scene.json", "tradeoff-scene", "7", report.dump(), {}});
  EXPECT_EQ(first_chart(answer), "");
  EXPECT_THAT(render_text(answer), HasSubstr("No mesh has both an error and a cost"));
}

}  // namespace
}  // namespace faultsweep
