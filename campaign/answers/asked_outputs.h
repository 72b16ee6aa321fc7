#pragma once

#include <limits>
#include <string>
#include <vector>

#include "campaign/answers/sensitivity.h"

/// Inside of the module: what is asked of the parameters of a campaign.
namespace faultsweep {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Names with commas; by default χ̄, slip and sliding of each fault.
std::string asked_metrics(const Store& store, const CampaignInfo& campaign,
                          const SensitivityRequest& request);

/// These metrics. Throws InputError where they are wrong, or would mix what is per metre of strike
/// with what is in total.
std::vector<ScopedMetric> asked_outputs(const Store& store, const CampaignInfo& campaign,
                                        const SensitivityRequest& request,
                                        const Selection& selection);

/// Whether a metric that lies between these two is the same but for rounding: within a billionth of
/// the larger, or of 1 for plain numbers, as χ̄ of a fault that nothing loads is 0 but for rounding.
/// Variances of rounding say nothing of parameters.
bool is_rounding(const ScopedMetric& metric, double least, double most);
/// Gives all values that are there the first one where they differ by rounding only.
void flatten_rounding(const ScopedMetric& metric, std::vector<double>& values);

/// Numbers and unit of a metric on a screen.
ShownUnit unit_of(const ScopedMetric& metric, bool plane_strain);

}  // namespace faultsweep
