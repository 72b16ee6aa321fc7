#include "campaign/report/error_bars.h"

#include <nlohmann/json.hpp>

namespace faultsweep {

using nlohmann::json;

namespace {

/// The tier that all groups of a resolved spec have, without sizes of their own; "" = no such.
std::string common_tier(const std::string& resolved_spec) {
  std::string tier;
  const json spec = json::parse(resolved_spec);
  for (const json& group : spec.at("groups")) {
    const json& scene = group.at("scene");
    const std::string own = scene.value("tier", std::string());
    const bool has_sizes = scene.contains("mesh") && !scene["mesh"].empty();
    if (own.empty() || has_sizes || (!tier.empty() && own != tier)) return "";
    tier = own;
  }
  return tier;
}

}  // namespace

std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign) {
  std::vector<ErrorBar> bars = store.error_bars(campaign.name);
  if (bars.empty()) return bars;
  const std::string tier = common_tier(store.spec_copies(campaign.id).resolved);
  std::erase_if(bars, [&](const ErrorBar& bar) { return bar.tier != tier; });
  return bars;
}

}  // namespace faultsweep
