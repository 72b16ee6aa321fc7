#pragma once

#include "campaign/render/answer.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// `faultsweep explain CASE`: whether `faultsweep run` will compute it, and why.
Answer explanation(const Store& store, const CampaignInfo& campaign, const StoredCase& one);

}  // namespace faultsweep
