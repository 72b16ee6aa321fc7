#pragma once

#include <optional>
#include <span>

/// Intervals that hold whatever the distribution of what is sampled. Samples are independent.
namespace faultsweep {

struct Interval {
  double low = 0, high = 0;
};

/// An estimate with its interval.
struct Estimate {
  double value = 0;
  double standard_error = 0;
  Interval bounds;  ///< not always as far to either side: see who makes it.
};
/// Half the distance between its bounds, which need not lie evenly about it.
inline double half_width(const Estimate& estimate) {
  return 0.5 * (estimate.bounds.high - estimate.bounds.low);
}

/// The t between −t and t of which a number of Student's distribution lies with `confidence`.
/// @param freedom  degrees of freedom > 0; of infinity it is the normal one.
double student_reach(double confidence, double freedom);

/// value ± t standard errors.
Estimate student_estimate(double value, double standard_error, double freedom, double confidence);

/// Two-sided bounds of a probability of which k of n samples had the property, after Clopper &
/// Pearson (1934): exact, so they cover it with at least `confidence`. [0, 1] for n = 0.
/// @pre 0 ≤ k ≤ n, 0 < confidence < 1.
Interval proportion_bounds(long k, long n, double confidence);
/// The same where n_unknown of the n may or may not have it: from none of these to all.
/// @pre k + n_unknown ≤ n.
Interval proportion_bounds(long k, long n_unknown, long n, double confidence);

/// Quantiles of Beta(k + ½, n − k + ½) (Jeffreys' interval; Brown, Cai & DasGupta 2001), an end
/// open where none or all have the property: they cover about as often as they say on average over
/// probabilities, not at each. k and n need not be whole. [0, 1] for n = 0.
Interval jeffreys_bounds(double k, double n, double confidence);
/// How many samples, a share of them with a property, have Jeffreys' interval of that half width;
/// at least `fewest`.
double members_for_half_width(double share, double half_width, double fewest, double confidence);

/// The fewest samples with which proportion_bounds are at most 2 half_width apart, if a share
/// `expected` of them has the property.
long samples_for_half_width(double expected, double half_width, double confidence);

/// Bounds of the q-quantile: order statistics y_(r) and y_(s) between which it lies with at least
/// `confidence` whatever the distribution (Conover 1999, section 3.2). An end is missing where
/// there are too few samples for it.
struct QuantileBounds {
  double estimate = 0;  ///< the sample's own quantile, linear between its values.
  std::optional<double> low, high;
};
/// Where n_unknown more samples may have any value each, the estimate is of the others, and the
/// bounds hold however these turn out; an end is missing where they may reach beyond it.
/// @param sorted  ascending, not empty. @pre 0 < q < 1.
QuantileBounds quantile_bounds(std::span<const double> sorted, long n_unknown, double q,
                               double confidence);

}  // namespace faultsweep
