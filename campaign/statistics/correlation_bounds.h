#pragma once

#include <optional>
#include <span>

#include "campaign/statistics/intervals.h"

/// Inside of the module: how sure an index of sensitivity is that is a correlation of pairs of
/// outputs, as those by ranks and by pick-freeze are. The plain value ± z standard errors covers
/// too little where few rows carry the variance, and reaches beyond 1.
namespace faultsweep {

/// How many rows carry the variance: (Σ y²)² / Σ y⁴ of deviations y. A third of them all where
/// these are normal; of a rare flag about as many as have it.
class EffectiveRows {
 public:
  void add(double square) { squares_ += square, fourths_ += square * square; }
  double count() const { return fourths_ > 0 ? squares_ * squares_ / fourths_ : 0; }

 private:
  double squares_ = 0, fourths_ = 0;
};

/// Bounds of a correlation r by Fisher's z = atanh r (1921), whose error √variance / (1 − r²) has
/// little skewness.
/// @param freedom  degrees of freedom of the variance. A point where the variance is 0.
Interval correlation_bounds(double r, double variance, double freedom, double confidence);

/// Of an output that has two values only.
struct RareValue {
  double count = 0;  ///< of the one that is had less often.
  double share = 0;  ///< p: count over all, at most 1/2.
};
/// Nothing where there are more values than two, or one. NaN counts as no value.
std::optional<RareValue> rarer_of_two(std::span<const double> values);

/// Of several flags together, as at several steps: the share of the rarer value is a mean over
/// those that have it, their number that of the flag with fewest.
class RareTogether {
 public:
  void add(const std::optional<RareValue>& one);
  /// Nothing where one of them is no flag.
  std::optional<RareValue> found() const;

 private:
  bool are_flags_ = true;
  double fewest_ = 0, count_ = 0, weighted_ = 0;
};

/// Of a flag r is (q − p) / (1 − p), with the share q of those that have the rare value whose
/// partner has it too. Bounds of q after Wilson (1927), which hold where few pairs, or none, have
/// it: from m = q (1 − q) / (variance (1 − p)²) members, but as many as have the rare value at
/// least.
Interval flag_correlation_bounds(double r, double variance, const RareValue& rare, double freedom,
                                 double confidence);

/// Wilson's score interval of a share from n members, z deviations to either side.
Interval wilson_bounds(double share, double n, double z);

}  // namespace faultsweep
