#include "campaign/statistics/intervals.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {

double student_reach(double confidence, double freedom) {
  if (std::isinf(freedom)) return std::sqrt(2.0) * boost::math::erf_inv(confidence);
  return boost::math::quantile(boost::math::students_t(freedom), 0.5 + 0.5 * confidence);
}

Estimate student_estimate(double value, double standard_error, double freedom, double confidence) {
  const double reach = student_reach(confidence, freedom) * standard_error;
  return {value, standard_error, {value - reach, value + reach}};
}

Interval proportion_bounds(long k, long n, double confidence) {
  FAULTSIM_DEMAND(0 <= k && k <= n && confidence > 0 && confidence < 1, k, " of ", n);
  const double tail = 0.5 * (1 - confidence);
  const auto successes = static_cast<double>(k), failures = static_cast<double>(n - k);
  return {k == 0 ? 0 : boost::math::ibeta_inv(successes, failures + 1, tail),
          k == n ? 1 : boost::math::ibetac_inv(successes + 1, failures, tail)};
}

Interval proportion_bounds(long k, long n_unknown, long n, double confidence) {
  return {proportion_bounds(k, n, confidence).low,
          proportion_bounds(k + n_unknown, n, confidence).high};
}

Interval jeffreys_bounds(double k, double n, double confidence) {
  if (n == 0) return {0, 1};
  const double tail = 0.5 * (1 - confidence), a = k + 0.5, b = n - k + 0.5;
  return {k <= 0 ? 0 : boost::math::ibeta_inv(a, b, tail),
          k >= n ? 1 : boost::math::ibetac_inv(a, b, tail)};
}

double members_for_half_width(double share, double half_width, double fewest, double confidence) {
  constexpr double kMost = 1e12, kAccuracy = 1e-5;
  const auto is_wider = [&](double n) {
    const Interval one = jeffreys_bounds(share * n, n, confidence);
    return one.high - one.low > 2 * half_width;
  };
  double low = fewest, high = fewest;
  while (is_wider(high) && high < kMost) low = high, high *= 2;
  while (high - low > kAccuracy * high) {
    const double middle = 0.5 * (low + high);
    (is_wider(middle) ? low : high) = middle;
  }
  return high;
}

long samples_for_half_width(double expected, double half_width, double confidence) {
  FAULTSIM_DEMAND(half_width > 0, half_width);
  const auto is_enough = [&](long n) {
    const long k = std::lround(expected * static_cast<double>(n));
    const Interval bounds = proportion_bounds(k, n, confidence);
    return bounds.high - bounds.low <= 2 * half_width;
  };
  long enough = 1;
  while (!is_enough(enough)) enough *= 2;
  long short_of = enough / 2;
  while (enough - short_of > 1) {
    const long middle = short_of + (enough - short_of) / 2;
    (is_enough(middle) ? enough : short_of) = middle;
  }
  return enough;
}

namespace {

/// Of n values in order, between which two the q-quantile lies: r and s, from 1; 0 and n + 1 where
/// there are too few.
struct OrderBounds {
  long r = 0, s = 0;
};

OrderBounds order_bounds(long n, double q, double confidence) {
  // B of n samples lie below the quantile: y_(r) is above it iff B < r.
  const boost::math::binomial_distribution<> below_it(static_cast<double>(n), q);
  const double tail = 0.5 * (1 - confidence);
  const auto share_up_to = [&](long b) {  // P(B ≤ b)
    return b < 0 ? 0 : b >= n ? 1 : boost::math::cdf(below_it, static_cast<double>(b));
  };
  long r = 0;  // largest with P(B < r) ≤ tail
  for (long step = n; step > 0; step /= 2) {
    while (r + step <= n && share_up_to(r + step - 1) <= tail) r += step;
  }
  long s = n + 1;  // least with P(B ≥ s) ≤ tail
  for (long step = n; step > 0; step /= 2) {
    while (s - step >= 1 && 1 - share_up_to(s - step - 1) <= tail) s -= step;
  }
  return {r, s};
}

}  // namespace

QuantileBounds quantile_bounds(std::span<const double> sorted, long n_unknown, double q,
                               double confidence) {
  FAULTSIM_DEMAND(!sorted.empty() && q > 0 && q < 1, sorted.size(), " values, q = ", q);
  const auto n = static_cast<long>(sorted.size());
  const double place = q * static_cast<double>(n - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  QuantileBounds bounds;
  bounds.estimate = std::lerp(sorted[below], sorted[above], place - std::floor(place));
  // All that is unknown may lie below every known value, which moves these up by as many places, or
  // above.
  const auto [r, s] = order_bounds(n + n_unknown, q, confidence);
  if (r > n_unknown) bounds.low = sorted[static_cast<std::size_t>(r - n_unknown - 1)];
  if (s <= n) bounds.high = sorted[static_cast<std::size_t>(s - 1)];
  return bounds;
}

}  // namespace faultsweep
