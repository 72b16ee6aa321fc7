#include "campaign/tradeoff/stored_trade.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/store/clock.h"
#include "campaign/tradeoff/trade_report.h"

namespace faultsweep {

namespace {

/// The base scenes of a campaign without what may differ between a campaign and its trade.
std::vector<json> base_scenes(const Store& store, const CampaignInfo& campaign) {
  std::vector<json> scenes;
  const json spec = json::parse(store.spec_copies(campaign.id).resolved, nullptr, false);
  if (!spec.is_object() || !spec.contains("groups")) return scenes;
  for (const json& group : spec.at("groups")) {
    json scene = group.value("scene", json());
    if (!scene.is_object()) continue;
    for (const char* key : {"tier", "mesh", "title", "output"}) scene.erase(key);
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

/// Those of the campaign whose cases were its choices.
std::vector<json> base_scenes(const Store& store, const TradeRecord& trade) {
  const std::vector<CampaignInfo> all = store.campaigns();
  const auto found = std::ranges::find(all, trade.campaign, &CampaignInfo::name);
  return found == all.end() ? std::vector<json>() : base_scenes(store, *found);
}

}  // namespace

std::optional<TradeRecord> trade_of(const Store& store, const CampaignInfo& campaign) {
  const std::vector<TradeRecord> trades = store.trades();
  if (trades.empty()) return std::nullopt;
  const std::vector<ErrorBar> bars = store.error_bars(campaign.name);
  const std::vector<json> scenes = base_scenes(store, campaign);
  const auto speaks_of_it = [&](const TradeRecord& trade) {
    if (std::ranges::count(bars, trade.id, &ErrorBar::trade) > 0) return true;
    const std::vector<json> its = base_scenes(store, trade);
    return std::ranges::find_first_of(scenes, its) != scenes.end();
  };
  const auto found = std::ranges::find_if(trades, speaks_of_it);
  return found == trades.end() ? std::nullopt : std::optional(*found);
}

Answer to_answer(const TradeRecord& trade) {
  const json document = json::parse(trade.report);
  Answer answer;
  answer.note(concat("What each modelling choice costs was measured on one scene, ", trade.source,
                     " (", format_time(trade.at), ", faultsweep tradeoff, version ",
                     trade.program_version, "); the choices are the cases of ", trade.campaign,
                     "."));
  for (const json& sentence : document.at("answers")) answer.note(sentence.get<std::string>());
  TradeFigures figures = trade_figures(document);
  if (figures.pareto.series.empty()) {
    answer.note("No mesh has both an error and a cost, so there is no chart of them.");
  } else {
    answer.blocks.emplace_back(AnswerChart(std::move(figures.pareto)));
  }
  return answer;
}

}  // namespace faultsweep
