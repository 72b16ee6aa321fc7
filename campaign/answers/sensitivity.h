#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/answers/sobol_rows.h"
#include "campaign/statistics/rank_sensitivity.h"

namespace faultsweep {

struct SensitivityRequest {
  SampledCases cases = {};
  std::string metrics = {};  ///< names with commas; "" = χ̄, slip and sliding of each fault.
  double confidence = 0.95;
};

/// What share of a metric's variance each parameter explains alone.
struct MetricSensitivity {
  ScopedMetric metric;
  long n = 0;  ///< rows that have a value.
  double mean = 0, standard_deviation = 0;
  std::vector<Estimate> first_order;  ///< per Sensitivity::parameters.
  /// Of a sobol design by pick-freeze: per Sensitivity::frozen, from n_base_samples of them.
  std::vector<SobolIndices> sobol = {};
  long n_base_samples = 0;
};

struct Sensitivity {
  CampaignInfo campaign;
  SensitivityRequest request;
  Sampling sampling;
  Sample sample;  ///< without its columns: what was taken and left out.
  std::vector<std::string> parameters;
  std::vector<MetricSensitivity> metrics;
  std::vector<std::string> frozen = {};  ///< parameters of a sobol design.
};

/// First-order indices by ranks; of a sobol design first and total ones by pick-freeze too. Throws
/// InputError where the campaign's design is not a sample of its parameters, or fewer than
/// kFewestRows full histories were selected.
Sensitivity analyse_sensitivity(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request);
inline constexpr long kFewestRows = 20;

std::string sensitivity_to_text(const Sensitivity& sensitivity);
nlohmann::json sensitivity_to_json(const Sensitivity& sensitivity);

}  // namespace faultsweep
