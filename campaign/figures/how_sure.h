#pragma once

#include "campaign/render/answer.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// How sure the results of a campaign are, as far as the store has it measured: what its cells are
/// off by (`tradeoff`, on its cases), what a dearer tier says of the same sample (`tiers`), what
/// each choice of model costs on its base scene (`tradeoff`, with its chart), and with which errors
/// operators and fields were approximated. Where nothing was measured it says so, and by which
/// command it is.
/// @param confidence  of intervals.
Answer how_sure(const Store& store, const CampaignInfo& campaign, double confidence);

}  // namespace faultsweep
