#pragma once

#include "campaign/expansion/expansion.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// Adds the next round of a campaign whose cases are all decided, in one transaction; false where
/// there is none, and why is then CampaignInfo::conclusion. A round all of whose rows are cases
/// that the campaign has is answered at once. Throws InputError where a proposed scene is wrong.
bool add_next_round(Store& store, const std::string& name);

/// Throws InputError where the spec's rounds ask for what results of its scenes will not have.
void check_rounds(const Expansion& expansion);

}  // namespace faultsweep
