#pragma once

#include <string>
#include <vector>

#include "campaign/query/selection.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/control_variate.h"
#include "campaign/store/store.h"

namespace faultsweep {

struct TierRequest {
  std::string metrics = {};                  ///< names with commas; "" = χ̄ of each fault.
  std::vector<std::string> conditions = {};  ///< as of `rank --where`; none = as of `probability`.
  double confidence = 0.95;
};

/// What a tier took.
struct TierCost {
  long n_rows = 0;              ///< with a history to its end.
  long n_left_out = 0;          ///< without.
  double case_seconds = 0;      ///< wall clock, of a case on average.
  double operator_seconds = 0;  ///< wall clock, of building all operators that were not in the
                                ///< cache.
  /// Wall clock, of so many cases and the operators, one after the other.
  double seconds_of(double rows) const;
};

/// The mean of a metric, or the probability of a condition, at the high tier.
struct TierAnswer {
  std::string label;
  bool is_probability = false;
  ShownUnit unit = {};  ///< of the metric; of probabilities percent.
  TieredEstimate found;
  double low_mean = 0;            ///< of the low tier alone, over all its rows.
  double high_alone_seconds = 0;  ///< that the high tier alone would take for the same error.
  double cost_ratio = 0;          ///< of these to Tiers::taken_seconds: above 1 it pays.
  double best_ratio = 1;          ///< rows of the low tier per one of the high that would be best.
};

struct Tiers {
  CampaignInfo low, high;
  TierRequest request;
  long n_pairs = 0;  ///< rows with a history to its end at both.
  TierCost low_cost, high_cost;
  double taken_seconds = 0;  ///< of both tiers.
  std::vector<TierAnswer> answers;
};

/// Control variates: the same random sample at a low tier, all of it, and at a high one, its first
/// rows (statistics/control_variate). Rows without a history to its end at one of the tiers are
/// left out of the pairs, those of the low tier out of all, and counted: answers hold if these are
/// like the others. A metric that some full history lacks is refused, as a mean of what there is
/// would be of other cases.
/// @param low, high  campaigns of the same monte-carlo design; the second has fewer samples, or as
///                   many.
/// Throws InputError where metrics or conditions are wrong, the designs do not fit, or fewer than
/// kFewestPairsForTiers rows are complete at both.
Tiers compare_tiers(const Store& store, const CampaignInfo& low, const CampaignInfo& high,
                    const TierRequest& request);

/// Table `answers`; on the screen a table for each unit, and what the tiers took.
Answer to_answer(const Tiers& tiers);

}  // namespace faultsweep
