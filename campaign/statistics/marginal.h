#pragma once

/// How likely the values of one parameter are.
namespace faultsweep {

enum class Distribution { uniform, log_uniform, normal, log_normal, triangular };

/// A distribution of numbers in one unit, cut at both ends: what lies beyond is left out, and what
/// is left is as likely as before in proportion.
struct Marginal {
  Distribution distribution = Distribution::uniform;
  /// The ends; ∓infinity (log-normal: 0) where a normal or log-normal is not cut.
  long double from = 0, to = 0;
  long double centre = 0;  ///< mean (normal), median (log-normal) or mode (triangular).
  /// Standard deviation (normal), or the factor that e to the standard deviation of the logarithm
  /// is (log-normal): two thirds of the values lie between centre / spread and centre · spread.
  long double spread = 0;

  /// The value below which a share u of all lies. Of an end that is not cut, that of the smallest
  /// share above 0 that a sample can ask for, 2⁻⁵⁴: 8.2 deviations from the centre.
  /// @pre 0 ≤ u ≤ 1; from < to, but a range may go down.
  long double quantile(long double u) const;
};

}  // namespace faultsweep
