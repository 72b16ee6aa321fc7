#pragma once

#include <span>
#include <vector>

#include "campaign/statistics/cross_fit.h"
#include "campaign/statistics/predicted_share.h"

namespace faultsweep {

struct CalibratedQuantile {
  /// An end is missing where the few values leave it open.
  QuantileBounds bounds;
  PredictedShare share_up_to_it;  ///< of members whose value is at most the estimate.
  /// Half the distance of the bounds of another sample like this one, with n values and N
  /// predictions: as many times wider as those of the share. NaN where an end is missing.
  double half_width(double n, double all, double confidence) const;
};

/// Distribution of a value y at an expensive model, known of the first n of N members of a random
/// sample, with features of all N at a cheap one. With ŷ the cross-fitted line on the features and
/// e = y − ŷ of the n members,
///
///   P(Y ≤ t) from PredictedShare of the flags y ≤ t and the predictions
///   q(t) = (#(e ≤ t − ŷ) + ½) / (m + 1)
///
/// over the m values of e whose fold is not that of the member: a model of Chambers & Dunstan
/// (1986) in the difference estimator of Rao, Kovar & Mantel (1990).
class CalibratedDistribution {
 public:
  /// @pre values.size() ≥ 2 kFolds, N ≥ values.size(); values are finite.
  CalibratedDistribution(std::span<const double> values, const StandardFeatures& features);

  /// P(Y ≤ t).
  PredictedShare share_up_to(double t) const;

  /// The t at which the share is q; between the first t at which the upper bound of the share
  /// reaches q and the last at which the lower one is below it (Woodruff 1952), searched for by
  /// halving. @pre 0 < q < 1.
  CalibratedQuantile quantile(double q, double confidence) const;
  /// What the n values say alone: order statistics (quantile_bounds).
  QuantileBounds direct(double q, double confidence) const;

 private:
  std::vector<double> values_, predictions_;          ///< y; ŷ of all.
  std::vector<double> rests_;                         ///< e, ascending.
  std::vector<std::vector<double>> rests_of_others_;  ///< [fold]: ascending.
  double least_ = 0, most_ = 0;                       ///< between which t is searched for.
};

}  // namespace faultsweep
