#pragma once

#include <optional>

#include "campaign/render/answer.h"
#include "campaign/store/store.h"

/// What `faultsweep tradeoff` found earlier and the store keeps, for who asks how sure a campaign
/// is.
namespace faultsweep {

/// The newest trade that speaks of the campaign: measured on its spec (it has error bars of it), or
/// on a scene that is a base scene of it, as given or at another tier, with another mesh, title or
/// outputs. None where there is none.
std::optional<TradeRecord> trade_of(const Store& store, const CampaignInfo& campaign);

/// What `tradeoff` said, its chart of errors against cost where some mesh has both, and where all
/// was measured.
Answer to_answer(const TradeRecord& trade);

}  // namespace faultsweep
