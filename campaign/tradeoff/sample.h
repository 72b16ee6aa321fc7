#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/expansion/expansion.h"

namespace faultsweep {

/// The group of a ladder's campaign that has the sample at a tier.
std::string sample_group(const std::string& tier);

/// Adds a group per tier to the spec of a ladder, each with the same cases of a campaign: at most
/// n_cases, scattered over its design, with the mesh of the tier instead of their own.
/// @param base  the scene that the spec's cases are changes of.
void add_sample(const Expansion& campaign, const nlohmann::json& base, long n_cases,
                const std::vector<std::string>& tiers, nlohmann::json& spec);

}  // namespace faultsweep
