#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/sensitivity.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/morris.h"

namespace faultsweep {

/// What the trajectories of a morris design say of a metric.
struct MetricEffects {
  ScopedMetric metric;
  /// Per Screening::parameters, SI of the metric per whole range of the parameter. Bounds are NaN
  /// where fewer effects are known than they take (kFewestTrajectories, kFewestForDeviation).
  std::vector<ElementaryEffects> effects;
};

struct Screening {
  CampaignInfo campaign;
  SensitivityRequest request;
  std::vector<std::string> parameters;
  std::vector<MetricEffects> metrics;
  std::vector<std::string> derived = {};  ///< parameters that follow from these.
  long n_trajectories = 0;
  long n_rows = 0, n_without = 0;  ///< of the design; without a history to its end.
  long n_unresolved = 0;           ///< which count as computed.
  bool plane_strain = false;       ///< areas, potencies and moments are per metre of strike.
};

/// Elementary effects (statistics/morris.h); nothing where the campaign is not one morris design.
/// A row without a history to its end, or without the metric, takes the effects before and behind
/// it with it. Throws InputError where cases are selected or excluded, as trajectories are broken
/// then.
std::optional<Screening> screen(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request);

/// Table `effects`, a row for each metric and parameter, largest μ* first, and a chart of each.
Answer to_answer(const Screening& screening);

}  // namespace faultsweep
