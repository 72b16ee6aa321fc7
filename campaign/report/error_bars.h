#pragma once

#include <vector>

#include "campaign/store/store.h"

namespace faultsweep {

/// What `faultsweep tradeoff` measured of the campaign's spec at the tier of its cases; nothing
/// where its scenes have several tiers or a mesh of their own.
std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign);

}  // namespace faultsweep
