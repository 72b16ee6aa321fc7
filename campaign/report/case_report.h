#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/store/store.h"
#include "simulator/scene/initial_state.h"

namespace faultsweep {

/// What of a case `faultsweep show` was asked for.
struct ShowRequest {
  std::string stage = {};  ///< "" = all and the whole history.
  std::string fault = {};  ///< "" = all.
};
/// `faultsweep show CASE`: parameters, outcome, stages, what each fault does in each, the χ history
/// per fault. Throws InputError on a stage or fault that its result does not have.
std::string case_to_text(const CampaignInfo& campaign, const StoredCase& one,
                         const ShowRequest& request = {});
nlohmann::json case_to_json(const CampaignInfo& campaign, const StoredCase& one);

/// The initial state per pressure region of a case, from its scene; none where a store from before
/// scenes had their tables names a file that is gone.
std::vector<faultsim::InitialRegion> initial_state_of(const Store& store, const StoredCase& one);

/// `faultsweep explain CASE`: whether `faultsweep run` will compute it, and why.
std::string explain_case(const Store& store, const CampaignInfo& campaign, const StoredCase& one);
/// The same for programs: "will_run", "why", the case, its family and the campaigns that have it.
nlohmann::json explanation_to_json(const Store& store, const CampaignInfo& campaign,
                                   const StoredCase& one);

}  // namespace faultsweep
