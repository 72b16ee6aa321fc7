#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "campaign/store/store.h"

namespace faultsweep {

/// `faultsweep show CASE`: parameters, outcome, stages, the χ history per fault.
std::string case_to_text(const CampaignInfo& campaign, const StoredCase& one);
nlohmann::json case_to_json(const CampaignInfo& campaign, const StoredCase& one);

/// `faultsweep explain CASE`: whether `faultsweep run` will compute it, and why.
std::string explain_case(const Store& store, const CampaignInfo& campaign, const StoredCase& one);

}  // namespace faultsweep
