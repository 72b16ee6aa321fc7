#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "campaign/query/selection.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/intervals.h"
#include "campaign/statistics/tier_numbers.h"
#include "campaign/store/store.h"

namespace faultsweep {

struct TierRequest {
  std::string metrics = {};                  ///< names with commas; "" = χ̄ of each fault.
  std::vector<std::string> conditions = {};  ///< as of `rank --where`; none = as of `probability`.
  double confidence = 0.95;
  /// Of which metrics quantiles are wanted, names with commas. Where some are, metrics and
  /// conditions that are not given are none.
  std::string quantiles = {};
  std::vector<double> at = {0.05, 0.5, 0.95};  ///< shares of quantiles, in (0, 1).
  /// Wanted distance of the bounds of probabilities, in (0, 1], and then half and a quarter of it;
  /// of means and quantiles half and a quarter of the present one. 0 = not asked.
  double width = 0;
};

/// What a tier took.
struct TierCost {
  long n_rows = 0;              ///< with a history to its end.
  long n_left_out = 0;          ///< without.
  double case_seconds = 0;      ///< wall clock, of a case on average.
  double operator_seconds = 0;  ///< wall clock, of building all operators that were not in the
                                ///< cache.
  long n_operators = 0;         ///< families.
  /// Whether more cases take more operators: where more than half of the cases have one of their
  /// own.
  bool has_operator_per_case() const { return 2 * n_operators > n_rows; }
  /// Of so many cases and the operators, one after the other: once + rows · per_case.
  double seconds_of(double rows) const;
  double once_seconds() const;
  double seconds_per_case() const;
};

enum class TierQuestion { mean, probability, quantile };

/// Numbers of cases that bounds as close as wanted take, for the least time.
struct NumbersForWidth {
  double half_width = 0;               ///< wanted, SI; of a probability the part by number.
  std::optional<TierNumbers> numbers;  ///< cost in s; none = no number does.
};

/// The mean or a quantile of a metric, or the probability of a condition, at the high tier.
struct TierAnswer {
  std::string label;  ///< metric or condition.
  TierQuestion question = TierQuestion::mean;
  double share = std::numeric_limits<double>::quiet_NaN();  ///< below a quantile.
  ShownUnit unit = {};  ///< of the metric; of probabilities percent.
  /// Bounds that are NaN are open, as the few cases leave them; quantiles have no standard error.
  Estimate found;
  Estimate alone;           ///< from the cases of the high tier alone.
  double by_number = 0;     ///< half the width that the number of cases makes; NaN where open.
  double by_undecided = 0;  ///< half the width that undecided flags make.
  long n_undecided = 0;     ///< of the pairs, at the high tier.
  std::vector<std::string> predictors;  ///< at the low tier; of a mean the metric itself.
  std::vector<std::string> left_out;    ///< of these: they do not vary, or some case has none.
  std::optional<double> weight;         ///< with which the low values count in a mean.
  double correlation = 0;               ///< of the value, or flag, and what is predicted.
  double n_equivalent = 0;              ///< cases of the high tier alone that would be as sure.
  double low_value = 0;                 ///< of the low tier alone, over all its rows.
  double high_alone_seconds = 0;        ///< that the high tier alone would take for the same error.
  double cost_ratio = 0;                ///< of these to Tiers::taken_seconds: above 1 it pays.
  double best_ratio = 1;  ///< rows of the low tier per one of the high that would be best.
  std::vector<NumbersForWidth> numbers;  ///< where a width was asked for.
};

struct Tiers {
  CampaignInfo low, high;
  TierRequest request;
  long n_pairs = 0;  ///< rows with a history to its end at both.
  TierCost low_cost, high_cost;
  double taken_seconds = 0;  ///< of both tiers.
  std::vector<TierAnswer> answers;
};

/// The same random sample at a low tier, all of it, and at a high one, its first rows: means by
/// regression (statistics/control_variate), probabilities from predictions by what the low tier
/// says of the case (statistics/calibrated_share), with flags of the high tier that cells or its
/// stated errors leave undecided at both their values, quantiles by the probability to be below
/// them (statistics/calibrated_quantile). Rows without a history to its end at one of the tiers are
/// left out of the pairs, those of the low tier out of all, and counted: answers hold if these are
/// like the others. A metric that some full history lacks is refused, as a mean of what there is
/// would be of other cases.
/// @param low, high  campaigns of the same monte-carlo design; the second has fewer samples, or as
///                   many.
/// Throws InputError where metrics, shares or conditions are wrong, the designs do not fit, or
/// fewer than kFewestPairsForTiers rows are complete at both.
Tiers compare_tiers(const Store& store, const CampaignInfo& low, const CampaignInfo& high,
                    const TierRequest& request);

struct TierPair {
  CampaignInfo low, high;
};
/// The campaigns NAME-TIER that `faultsweep tiers` made of a spec, where the store has two or more:
/// those of the cheapest tier and of the dearest, in the order of faultsim::tiers.
/// @param campaign  NAME itself or one of them.
std::optional<TierPair> tiers_beside(const Store& store, const CampaignInfo& campaign);

/// Tables `answers` and, where a width was asked for, `numbers`; on the screen a table for each
/// unit, and what the tiers took.
Answer to_answer(const Tiers& tiers);

}  // namespace faultsweep
