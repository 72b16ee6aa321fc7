#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "campaign/store/store.h"

/// Inside of the module: how the cases of a stored campaign were designed.
namespace faultsweep {

/// The designs of its resolved spec, those within nested ones too.
std::vector<nlohmann::json> designs_of(const Store& store, const CampaignInfo& campaign);

/// Of a sobol design, a group's only one: from one base sample to the next.
long rows_per_base_sample(const nlohmann::json& design);

}  // namespace faultsweep
