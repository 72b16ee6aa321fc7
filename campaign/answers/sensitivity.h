#pragma once

#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/pick_freeze.h"
#include "campaign/statistics/rank_sensitivity.h"

namespace faultsweep {

struct SensitivityRequest {
  SampledCases cases = {};
  std::string metrics = {};  ///< names with commas; "" = χ̄, slip and sliding of each fault.
  double confidence = 0.95;
  /// At the end of each load step instead of over a stage, and over all steps together. Of metrics
  /// that the histories keep; "" = χ̄ of each fault.
  bool by_step = false;
};

/// What share of a metric's variance each parameter explains alone.
struct MetricSensitivity {
  ScopedMetric metric;
  long n = 0;  ///< rows that have a value.
  double mean = 0, standard_deviation = 0;
  /// Per Sensitivity::parameters; none where its rows are too few. Of a grid without error and
  /// bounds (NaN): it is no sample, and of what was run the shares are exact.
  std::vector<Estimate> first_order;
  /// Of a whole grid, exact: the share in which a parameter takes part, interactions included.
  std::vector<double> total_order = {};
  /// Of a sobol design by pick-freeze: per Sensitivity::frozen, from n_base_samples of them; none
  /// where these are too few.
  std::vector<SobolIndices> sobol = {};
  long n_base_samples = 0;
  /// What is not said of it, as it has fewer rows than intervals take; "" = nothing.
  std::string unsaid = {};
};

struct Sensitivity {
  CampaignInfo campaign;
  SensitivityRequest request;
  Sampling sampling;
  Sample sample;  ///< without its columns: what was taken and left out.
  std::vector<std::string> parameters;
  std::vector<MetricSensitivity> metrics;   ///< by_step: metric by metric, at each of `steps`.
  std::vector<Store::LoadStep> steps = {};  ///< by_step: those of all cases.
  /// by_step, per metric: of all steps together, each counting as much as it varies (Σ V S / Σ V);
  /// its standard deviation is the root of the mean variance, and there is no mean.
  std::vector<MetricSensitivity> over_steps = {};
  std::vector<std::string> frozen = {};  ///< parameters of a sobol design.
  long n_base_samples = 0;               ///< of it, with those that are left out of some metric.
  /// Why parameters may depend on each other, as the beginning of a sentence; "" = they do not.
  std::string dependence = {};
  bool plane_strain = false;  ///< areas, potencies and moments are per metre of strike.
};

/// First-order indices: of a random sample by ranks, of a grid from the means at each value, with
/// total ones where every combination has a value; of a sobol design first and total ones by
/// pick-freeze too. Throws InputError where the campaign's design is not a sample of its
/// parameters, or fewer than kFewestForRankIndex rows of a random one have a history to its end;
/// by_step where these histories do not have the same load steps.
Sensitivity analyse_sensitivity(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request);

/// Indices as bars, largest first; of a sobol design total ones below them.
faultsim::figure::BarChart chart_of(const Sensitivity& sensitivity);
/// Tables `indices`, a row for each metric (and load step), parameter and order, and `metrics`; on
/// the screen a row for each metric, or a table for each with a row for each step; and charts.
Answer to_answer(const Sensitivity& sensitivity);

/// Which parameters matter, by what the campaign's design can say: shares of variance of a sample
/// or grid (analyse_sensitivity), elementary effects of a morris design (screening.h), of
/// one-at-a-time what each parameter changes (one_at_a_time.h). By step: of samples and grids.
/// Throws InputError as these do.
Answer what_matters(const Store& store, const CampaignInfo& campaign,
                    const SensitivityRequest& request);

}  // namespace faultsweep
