#pragma once

#include <span>

#include "campaign/statistics/intervals.h"
#include "campaign/statistics/predicted_share.h"

/// What an exact but expensive model says of a sample, from a few runs of it and many of a cheap
/// model that goes with it. The sample is random; the expensive model was run on its first n
/// members, the cheap one on all N ≥ n.
namespace faultsweep {

/// Dear values y of the first members and cheap values x of all.
struct TieredSample {
  std::span<const double> high;  ///< n.
  std::span<const double> low;   ///< N ≥ n.
};

/// What it took, and what the expensive model alone would have taken.
struct TieredEstimate {
  Estimate estimate;       ///< of the expensive model.
  Estimate direct;         ///< from its n values alone.
  double weight = 0;       ///< with which the cheap values count.
  double correlation = 0;  ///< of x and y, over the n.
  /// Members of the expensive model alone that would be as sure: with the same standard error; n
  /// where the cheap one does not help.
  double n_equivalent = 0;
  /// s_e² and β² s_x²: what one member more of either model makes less.
  double residual_variance = 0, explained_variance = 0;
};

/// Mean of y by the regression estimator of double sampling (Cochran 1977, section 12.6):
///
///   mean(y_n) + β (mean(x_N) − mean(x_n)),   β = S_xy / S_xx over the n, which is the best weight;
///   variance  s_e² (1 / n + (mean(x_N) − mean(x_n))² / S_xx) + β² s_x² / N,
///
/// with s_e² the residual variance (n − 2 in its denominator) and s_x² that of all N; bounds by
/// Student's t with n − 2 degrees of freedom. Where x or y does not vary over the n but for
/// rounding, x is left out. From kFewestPairsForTiers pairs, 95 % intervals hold 93 to 97 %
/// (results/coverage).
/// @pre n ≥ 4, N ≥ n.
TieredEstimate tiered_mean(const TieredSample& sample, double confidence);
/// Half the width of the bounds of such a mean from n and N members: t √(s_e² / n + β² s_x² / N).
double mean_half_width(const TieredEstimate& mean, double n, double all, double confidence);

/// The N / n at which cases of the two models, whose costs stand as c = cost_low / cost_high, give
/// the smallest variance for their price: √(ρ² / (1 − ρ²) / c), at least 1.
double best_ratio(double correlation, double cost_ratio);

}  // namespace faultsweep
