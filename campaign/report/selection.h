#pragma once

#include <string>
#include <vector>

#include "campaign/spec/metrics.h"
#include "campaign/store/store.h"

/// Which cases, stages and metrics a command is about.
namespace faultsweep {

/// Throws InputError naming the stages there are. "" is the whole history.
void check_stage(const Store& store, const CampaignInfo& campaign, const std::string& stage);
/// --where as SQL; "" gives the empty fragment. Throws InputError.
SqlFragment parse_condition(const std::string& where, const Symbols& symbols);
/// Whether the salt of any of its cases creeps.
bool creeps(const Store& store, const CampaignInfo& campaign);
/// "moment,max_slip" as metrics, in this order; "" gives all (those of creep only with_creep: they
/// are slow to read), or, unless with_missing, those that every full history has. Throws InputError
/// with the nearest name.
std::vector<MetricInfo> choose_metrics(const std::string& list, bool with_missing, bool with_creep);

}  // namespace faultsweep
