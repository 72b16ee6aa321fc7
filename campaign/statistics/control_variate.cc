#include "campaign/statistics/control_variate.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

struct Moments {
  double n = 0, mean = 0, squares = 0;  ///< squares of the deviations, summed.
  double largest = 0;                   ///< of the values, without their signs.
  double variance() const { return squares / std::max(1.0, n - 1); }
  /// Whether they differ by more than rounding, of which the mean of equal values has some too.
  bool varies() const {
    constexpr double kRounding = 1e-12;
    const double rounding = kRounding * largest;
    return squares > n * rounding * rounding;
  }
};

Moments moments_of(std::span<const double> values) {
  Moments m{static_cast<double>(values.size())};
  for (const double v : values) m.mean += v / m.n;
  for (const double v : values) m.largest = std::max(m.largest, std::abs(v));
  for (const double v : values) m.squares += (v - m.mean) * (v - m.mean);
  return m;
}

void check(const TieredSample& sample) {
  FAULTSIM_DEMAND(sample.high.size() >= 4 && sample.low.size() >= sample.high.size(),
                  sample.high.size(), " of ", sample.low.size());
}

double product_sum(std::span<const double> x, double mean_x, std::span<const double> y,
                   double mean_y) {
  double sum = 0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += (x[i] - mean_x) * (y[i] - mean_y);
  return sum;
}

/// How many members alone have this standard error; never fewer than were run.
double equivalent(double variance_of_one, double error, double n) {
  return error > 0 ? std::max(n, variance_of_one / (error * error)) : n;
}

}  // namespace

TieredEstimate tiered_mean(const TieredSample& sample, double confidence) {
  check(sample);
  const auto n = static_cast<double>(sample.high.size());
  const auto paired = sample.low.first(sample.high.size());
  const Moments y = moments_of(sample.high), x = moments_of(paired), all = moments_of(sample.low);
  TieredEstimate found;
  found.direct = student_estimate(y.mean, std::sqrt(y.variance() / n), n - 1, confidence);
  found.n_equivalent = n;
  if (!x.varies() || !y.varies()) {
    found.estimate = found.direct;
    found.residual_variance = y.variance();
    return found;
  }
  const double xy = product_sum(paired, x.mean, sample.high, y.mean);
  found.weight = xy / x.squares;
  found.correlation = xy / std::sqrt(x.squares * y.squares);
  const double residual = std::max(0.0, y.squares - xy * found.weight) / (n - 2);
  const double shift = all.mean - x.mean;
  const double variance = residual * (1 / n + shift * shift / x.squares) +
                          found.weight * found.weight * all.variance() / all.n;
  found.residual_variance = residual;
  found.explained_variance = found.weight * found.weight * all.variance();
  found.estimate =
      student_estimate(y.mean + found.weight * shift, std::sqrt(variance), n - 2, confidence);
  found.n_equivalent = equivalent(y.variance(), found.estimate.standard_error, n);
  return found;
}

double mean_half_width(const TieredEstimate& mean, double n, double all, double confidence) {
  return student_reach(confidence, n - 2) *
         std::sqrt(mean.residual_variance / n + mean.explained_variance / all);
}

double best_ratio(double correlation, double cost_ratio) {
  FAULTSIM_DEMAND(cost_ratio > 0, cost_ratio);
  const double rest = std::max(1 - correlation * correlation, 1e-12);
  return std::max(1.0, std::sqrt(correlation * correlation / rest / cost_ratio));
}

}  // namespace faultsweep
