#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/query/ranking.h"
#include "campaign/render/answer.h"
#include "campaign/spec/metrics.h"
#include "campaign/store/store.h"

/// `faultsweep compare`: two campaigns, case by case (docs/campaign.md).
namespace faultsweep {

struct CompareRequest {
  double tolerance = 1e-9;  ///< relative; see relative_difference.
  std::string metrics;      ///< names with commas; "" = all.
  std::string stage;        ///< "" = the whole history.
  long top = 10;            ///< rows of the table of the worst cases; 0 = all that differ.
};

/// |a − b|/max(|a|, |b|); 0 where they are equal or both missing (NaN), ∞ where one is missing.
double relative_difference(double a, double b);

/// How far one metric differs over the pairs compared.
struct MetricDifference {
  MetricInfo metric;
  long n_compared = 0;     ///< pairs in which both have it.
  long n_one_missing = 0;  ///< pairs in which one has it.
  long n_beyond = 0;       ///< pairs that differ by more than the tolerance, or one lacks it.
  double max_absolute = 0, max_relative = 0;  ///< over n_compared.
  long worst_a = 0, worst_b = 0;              ///< case numbers of max_relative; 0 = none differs.
};

/// Two cases taken for the same, and how far they differ.
struct ComparedPair {
  long a = 0, b = 0;                 ///< case numbers.
  CaseParameters parameters;         ///< A's.
  std::string outcome_a, outcome_b;  ///< or how the run ended, where there is no result.
  bool outcome_differs = false, flipped = false;  ///< flipped: activated in one only.
  bool identical = false;                         ///< same outcome, and every metric bit for bit.
  double worst = 0;                               ///< largest relative difference of a metric.
  std::size_t worst_metric = 0;                   ///< its index.
  double worst_a = 0, worst_b = 0;                ///< its values; NaN = missing.
};

struct Comparison {
  CampaignInfo a, b;
  CompareRequest request;
  std::vector<std::string> shared_parameters;
  long n_by_identity = 0, n_by_parameters = 0;
  long n_only_a = 0, n_only_b = 0;
  long n_ambiguous = 0;    ///< of these: several cases have the same parameters.
  long n_same_result = 0;  ///< matched, but one stored result of one store: nothing to compare.
  long n_without = 0;      ///< matched, but neither has a result, or one has not been run.
  std::vector<ComparedPair> pairs;  ///< compared, the worst first.
  std::vector<MetricDifference> metrics;
  Store::Kinds kinds;                ///< of the pairs compared.
  std::optional<double> tau_b;       ///< of the places of compared pairs with full histories.
  long n_ranked = 0;                 ///< such pairs.
  long n_top = 0, n_top_shared = 0;  ///< highest of each, at most 10, and how many are in both.

  long count(bool ComparedPair::*flag) const;
  long n_beyond() const;  ///< pairs whose outcome, activation or a metric differs.
  /// Something was compared and all of it agrees.
  bool agrees() const { return !pairs.empty() && n_beyond() == 0; }
};

/// Matches cases by identity, then by the values of the parameters that both campaigns have, and
/// compares their outcome and metrics. Throws InputError (stage, metrics), also where an area,
/// potency or moment per metre of strike would be compared with a total.
Comparison compare_campaigns(const Store& store_a, const CampaignInfo& a, const Store& store_b,
                             const CampaignInfo& b, const CompareRequest& request);

/// Whether they agree, and how many differ in what; then "metrics", how far each is off, and
/// "worst", the pairs that differ most, as tables.
Answer to_answer(const Comparison& comparison);

}  // namespace faultsweep
