#pragma once

#include <string>
#include <vector>

#include "campaign/answers/shares.h"
#include "campaign/answers/tiers.h"
#include "campaign/query/selection.h"

/// The rows of a design at two tiers as columns of numbers.
namespace faultsweep {

/// From what at the cheap tier a condition, or a metric, at the expensive one is predicted: χ̄,
/// largest slip and activated area of each fault and stage that it speaks of, of all faults
/// together where it names none; and the numbers that it names.
/// @param condition  of `rank --where`, or the name of a metric as expressions spell it.
std::vector<ScopedMetric> predictors_of(const std::string& condition, const CampaignInfo& campaign,
                                        const Selection& selection);

/// Columns that are read at both tiers, and those of the cheap one.
struct TierColumns {
  std::vector<std::string> metrics = {};     ///< names as lists of metrics spell them.
  std::vector<std::string> conditions = {};  ///< of `rank --where`.
  std::vector<ScopedMetric> predictors = {};
  /// The place of a metric in `predictors`, where it is added unless it is there.
  std::size_t place_of(const ScopedMetric& predictor);
};

/// A tier's rows in the order of the design.
struct TierRows {
  std::vector<char> complete;  ///< with a history to its end.
  std::vector<CaseParameters> parameters;
  std::vector<std::vector<double>> values;      ///< [metric][row], SI; NaN = none.
  std::vector<std::vector<Held>> held;          ///< [condition][row].
  std::vector<std::vector<double>> predictors;  ///< [predictor][row], SI; NaN = none.
};
/// @param cost  of complete rows and the campaign's operators.
TierRows read_tier(const Store& store, const CampaignInfo& campaign, const TierColumns& columns,
                   TierCost& cost);

/// Rows that are complete at both tiers, then those at the cheap one only.
struct PairedRows {
  std::vector<std::size_t> order;  ///< N rows.
  std::size_t n = 0;               ///< of them at both.
  /// The values of those rows, or of the first n.
  template <typename T>
  std::vector<T> of_all(const std::vector<T>& column) const {
    return taken(column, order.size());
  }
  template <typename T>
  std::vector<T> of_pairs(const std::vector<T>& column) const {
    return taken(column, n);
  }

 private:
  template <typename T>
  std::vector<T> taken(const std::vector<T>& column, std::size_t number) const {
    std::vector<T> some;
    for (std::size_t k = 0; k < number; ++k) some.push_back(column[order[k]]);
    return some;
  }
};
PairedRows paired_rows(const TierRows& low, const TierRows& high);

}  // namespace faultsweep
