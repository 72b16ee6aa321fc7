#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/store/store.h"

/// Inside of the module: how the cases of a stored campaign were designed.
namespace faultsweep {

/// The designs of its resolved spec, those within nested ones too.
std::vector<nlohmann::json> designs_of(const Store& store, const CampaignInfo& campaign);

/// What designs of a campaign choose: by index in its parameters, whether one follows from others
/// (`derived` of the spec), so that it explains nothing of its own.
std::vector<char> derived_parameters(const std::vector<nlohmann::json>& designs,
                                     const CampaignInfo& campaign);
/// "Computed from others, so not told apart from them: throw."; "" where there are none.
std::string derived_note(const std::vector<std::string>& names);

/// Of a sobol design, a group's only one: from one base sample to the next.
long rows_per_base_sample(const nlohmann::json& design);

}  // namespace faultsweep
