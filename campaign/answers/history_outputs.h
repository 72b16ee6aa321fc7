#pragma once

#include <vector>

#include "campaign/answers/sensitivity.h"

/// Inside of the module: metrics at each load step.
namespace faultsweep {

struct HistoryOutputs {
  std::vector<Store::LoadStep> steps;  ///< that all cases have.
  std::vector<ScopedMetric> metrics;   ///< as asked, of a fault each.
  std::vector<ScopedMetric> outputs;   ///< metric by metric, step by step.
};

/// What a request by_step asks for. Throws InputError where a metric is none of a fault that the
/// histories keep, or where the cases do not share their load steps.
HistoryOutputs history_outputs(const Store& store, const CampaignInfo& campaign,
                               const SensitivityRequest& request, const Selection& selection);

}  // namespace faultsweep
