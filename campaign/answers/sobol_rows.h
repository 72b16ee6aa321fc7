#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/statistics/pick_freeze.h"

namespace faultsweep {

/// The outputs of a sample on all rows of a campaign that is one sobol design.
struct SobolRows {
  std::vector<std::string> parameters;    ///< in the order of PickFreezeValues::ab.
  std::vector<PickFreezeValues> outputs;  ///< of the base samples whose every row has a value.
  long n_base_samples = 0;                ///< with those that are left out.
};

/// Nothing where the campaign is another design, or a condition selects some of its cases.
std::optional<SobolRows> read_sobol_rows(const Store& store, const CampaignInfo& campaign,
                                         const SampledCases& request,
                                         const std::vector<ScopedMetric>& outputs);

}  // namespace faultsweep
