#pragma once

#include <span>

#include "campaign/statistics/intervals.h"

/// What a sample says when its members count with weights w_i ≥ 0, as draws from one distribution
/// that stand for another: w_i = likelihood of what was seen, given the i-th (importance sampling
/// from the prior). Weights are taken relative to their sum; members are independent.
namespace faultsweep {

/// (Σ w)² / Σ w² (Kish 1965): how many equal members would say as much. 0 where all weights are 0.
double effective_sample_size(std::span<const double> weights);

/// From that many effective members on, 95 % intervals hold 93 to 97 %; medians and shares of a
/// half do from 50, but not what a twentieth of all weight has (results/coverage).
inline constexpr double kFewestEffectiveMembers = 150;

/// Between which two numbers the weight of a member lies that is not known to its end; known:
/// equal.
struct WeightRange {
  double least = 0, most = 0;
  bool is_known() const { return least == most; }
  /// The range of a product of two that are not known of each other.
  WeightRange& operator*=(const WeightRange& other) {
    least *= other.least;
    most *= other.most;
    return *this;
  }
};
/// Whether a member has a property.
enum class Holds : char { no, yes, unknown };

/// P of a property, after Korn & Graubard (1998): Clopper & Pearson's bounds for n* = P (1 − P) /
/// variance members, at most as many as there are of weight, of which n* P have the property; at
/// P = 0 and 1, where the variance says nothing, n* is the effective sample size. Where weights and
/// property are not known of all, the estimate is of the members of which both are, and the bounds
/// reach over every way in which the others may turn out: of equal weights, proportion_bounds.
/// @pre of some member both are known, with a weight that is not 0.
Estimate weighted_probability(std::span<const Holds> holds, std::span<const WeightRange> weights,
                              double confidence);
/// The smallest value up to which members carry a share q of all weight, between the values of the
/// two shares that are the bounds of q as a weighted probability (Woodruff 1952). An end is missing
/// where fewer than one member lies beyond it. What is not known counts as above.
/// @param order  of values, ascending. @pre 0 < q < 1, some weight that is not 0 is known.
QuantileBounds weighted_quantile(std::span<const double> values,
                                 std::span<const WeightRange> weights,
                                 std::span<const std::size_t> order, double q, double confidence);

}  // namespace faultsweep
