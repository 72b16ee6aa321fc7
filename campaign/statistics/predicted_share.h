#pragma once

#include <array>
#include <span>

#include "campaign/statistics/intervals.h"

namespace faultsweep {

/// P(y = 1) of a flag that is known of the first n of N members of a random sample, from
/// predictions q of all N, in [0, 1], none of which has seen the flag of its own member
/// (cross_fit.h). Members count in two classes c, predicted no (q < ½) and predicted yes:
///
///   P = Σ_c π_c a_c,   a_c = mean_n,c(y) + λ (mean_N,c(q) − mean_n,c(q)),   π_c = N_c / N,
///
/// the difference estimator with cross-fitted predictions (Zrnic & Candès 2024), within classes:
/// whatever q are, it is not biased. λ is the slope of y on q within classes, 0 ≤ λ ≤ 1
/// (Angelopoulos, Duchi & Zrnic 2023): predictions that say nothing are left aside.
///
/// Bounds: those of a_c are Jeffreys' for n_c / R_c members, where R_c is what q leaves of the
/// variance of y,
///
///   R_c = (Σ (y − mean y − λ (q − mean q))² + 1) / (Σ (y − mean y)² + 1)   over the n_c,
///
/// so that few differences between flag and prediction do not pass for a small variance: where none
/// was seen R_c = 1, and the bound is that of "none of n_c". Those of the two classes, and of
/// the mean of what is predicted for all N, are put together by their squared distances (Zou &
/// Donner 2008), times t / z of Student's distribution with n − 2 degrees of freedom. A class
/// without a flag may hold anything. From kFewestPairsForTiers pairs on, 95 % intervals hold 93 to
/// 97 % where five or more flags differ from what is predicted, and up to 100 % where hardly any
/// does: too few have then been seen to say less (results/coverage).
class PredictedShare {
 public:
  /// @param flags        n: 0 or 1. @param predictions  N ≥ n.
  /// @pre n ≥ 4.
  PredictedShare(std::span<const double> flags, std::span<const double> predictions);

  /// The standard error is half the width of the bounds over z.
  Estimate estimate(double confidence) const;
  /// What the n flags say alone: Jeffreys' interval.
  Estimate direct(double confidence) const;
  /// Half the width of the bounds of another sample like this one, with n flags and N predictions;
  /// fewer for more of either.
  double half_width(double n, double all, double confidence) const;
  /// Members with a flag alone whose interval is as narrow; at least n.
  double n_equivalent(double confidence) const;
  /// Of flag and prediction, over the n.
  double correlation() const { return correlation_; }

 private:
  struct Class {
    double share = 0;         ///< π.
    double n = 0;             ///< members with a flag.
    double probability = 0;   ///< a.
    double flag_squares = 0;  ///< Σ (y − mean y)².
    double rest_squares = 0;  ///< Σ (y − mean y − λ (q − mean q))².
    /// Of what another sample, with n flags where this one has n_here, is likely to have.
    Interval bounds(double n, double n_here, double confidence) const;
  };
  Estimate estimate(double n, double all, double confidence) const;

  std::array<Class, 2> classes_;
  double n_ = 0, all_ = 0;
  double n_holds_ = 0;  ///< flags that are 1.
  double value_ = 0;    ///< P.
  double between_ = 0;  ///< variance of what is predicted, over the N.
  double correlation_ = 0;
};
/// Pairs of a flag, or value, of the expensive model with what the cheap one says.
inline constexpr long kFewestPairsForTiers = 40;

}  // namespace faultsweep
