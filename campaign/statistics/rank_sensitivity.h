#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "campaign/statistics/intervals.h"

namespace faultsweep {

/// The order that sorts x; equal values in an order that is random, but the same for the same
/// numbers: neighbours must not share what else varies, as they would in the order of a grid.
/// @pre no x is NaN.
std::vector<std::uint32_t> random_tied_order(std::span<const double> x);

/// First-order Sobol' indices S = Var E[y | x] / Var y from any independent sample of (x, y), by
/// ranks (Gamboa, Gremaud, Klein & Lagnoux 2022): with y_(i) the deviations from the mean in the
/// random_tied_order of x,
///
///   S ≈ [Σ_{i<n} y_(i) y_(i+1) + ½ (y_(1) y_(2) + y_(n−1) y_(n))] / Σ y_i²,
///
/// as neighbours share what x explains. The half products stand for the two ends, where their paper
/// pairs the last with the first: that would leave an error of order 1/n.
///
/// Variance: between that of the terms with the covariance of neighbours, which share a y, and that
/// of leaving out each row in turn, less what this counts twice; the first is too small where few
/// rows carry the variance. Bounds: of a correlation (Fisher's z), Student's t with 0.7 degrees of
/// freedom per row that carries the variance, around S + (1 − S) / n, as the mean is of the same
/// rows. Of an output with two values those of a share (Wilson), which hold where few neighbours
/// share the rarer one.
///
/// From kFewestForRankIndex rows, and kFewestOfEitherValue with each value of an output that has
/// two, 95 % intervals hold 93 to 97 % (results/coverage). An index above 0.95 takes
/// kFewestForRankIndexNearOne: with fewer rows the estimate is too low by some thousandths. Zeros
/// where y does not vary or n < 4.
class RankSensitivity {
 public:
  /// What concerns the parameters alone is done here, once.
  /// @param parameters  [parameter][row].
  explicit RankSensitivity(std::span<const std::vector<double>> parameters, int n_threads = 1);

  /// Per parameter. A row without a finite value is left out.
  /// @param output  one value per row.
  std::vector<Estimate> first_order(std::span<const double> output, double confidence) const;

  /// Of each output, [output][parameter]; the same bits with any number of threads.
  std::vector<std::vector<Estimate>> first_order(std::span<const std::vector<double>> outputs,
                                                 double confidence, int n_threads) const;

  /// Of outputs of the same unit together, as a metric at all steps, each counting as much as it
  /// varies: Σ V S / Σ V (Gamboa, Janon, Klein & Lagnoux 2014). That is the index above with sums
  /// over the outputs in its numerator and denominator, so its interval is found in the same way,
  /// and how the outputs depend on each other is in it. A row without a finite value of some output
  /// is left out of all.
  std::vector<Estimate> aggregated(std::span<const std::vector<double>> outputs,
                                   double confidence) const;

 private:
  std::size_t n_rows_ = 0;
  std::vector<std::vector<std::uint32_t>> orders_;  ///< [parameter].
};
inline constexpr long kFewestForRankIndex = 128;
inline constexpr long kFewestForRankIndexNearOne = 400;
inline constexpr long kFewestOfEitherValue = 20;

}  // namespace faultsweep
