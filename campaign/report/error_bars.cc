#include "campaign/report/error_bars.h"

#include "campaign/report/ranking_report.h"

namespace faultsweep {

std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign) {
  std::vector<ErrorBar> bars = store.error_bars(campaign.name);
  if (bars.empty()) return bars;
  const std::string tier = common_tier(store, campaign);
  std::erase_if(bars, [&](const ErrorBar& bar) { return bar.tier != tier; });
  return bars;
}

}  // namespace faultsweep
