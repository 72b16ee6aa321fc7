#include "campaign/statistics/weighted.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

double sum_of(std::span<const double> weights) {
  double sum = 0;
  for (const double w : weights) sum += w;
  FAULTSIM_DEMAND(sum > 0, sum);
  return sum;
}

/// Clopper & Pearson's bounds for numbers that need not be whole.
Interval share_bounds(double share, double n, double confidence) {
  const double tail = 0.5 * (1 - confidence);
  const double k = share * n;
  return {k <= 0 ? 0 : boost::math::ibeta_inv(k, n - k + 1, tail),
          k >= n ? 1 : boost::math::ibetac_inv(k + 1, n - k, tail)};
}

/// How many equal members would have this variance.
double members_for(double share, double variance, double n_effective, double n) {
  if (share <= 0 || share >= 1 || variance <= 0) return n_effective;
  return std::min(share * (1 - share) / variance, n);
}

}  // namespace

double effective_sample_size(std::span<const double> weights) {
  double sum = 0, squares = 0;
  for (const double w : weights) sum += w, squares += w * w;
  return squares > 0 ? sum * sum / squares : 0;
}

Estimate weighted_mean(std::span<const double> values, std::span<const double> weights,
                       double confidence) {
  const double sum = sum_of(weights);
  double mean = 0, variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += weights[i] / sum * values[i];
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double one = weights[i] / sum * (values[i] - mean);
    variance += one * one;
  }
  return normal_estimate(mean, std::sqrt(variance), confidence);
}

Estimate weighted_probability(std::span<const char> holds, std::span<const double> weights,
                              double confidence) {
  const double sum = sum_of(weights);
  double share = 0, variance = 0;
  bool any = false, all = true;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (weights[i] > 0) any |= holds[i] != 0, all &= holds[i] != 0;
    if (holds[i] != 0) share += weights[i] / sum;
  }
  share = !any ? 0 : all ? 1 : share;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const double one = weights[i] / sum * ((holds[i] != 0 ? 1 : 0) - share);
    variance += one * one;
  }
  const double n_members = members_for(share, variance, effective_sample_size(weights),
                                       static_cast<double>(holds.size()));
  return {share, std::sqrt(variance), share_bounds(share, n_members, confidence)};
}

QuantileBounds weighted_quantile(std::span<const double> values, std::span<const double> weights,
                                 std::span<const std::size_t> order, double q, double confidence) {
  FAULTSIM_DEMAND(q > 0 && q < 1, q);
  const double sum = sum_of(weights);
  const auto value_at = [&](double share) {
    double so_far = 0;
    double last = values[order.front()];
    for (const std::size_t i : order) {
      if (weights[i] <= 0) continue;
      so_far += weights[i] / sum;
      last = values[i];
      if (so_far >= share - 1e-12) break;  // rounding of the sum
    }
    return last;
  };
  QuantileBounds found;
  found.estimate = value_at(q);
  // The share of weight up to the estimate varies as that of any property with probability q.
  double variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double one = weights[i] / sum * ((values[i] <= found.estimate ? 1 : 0) - q);
    variance += one * one;
  }
  const double n_members =
      members_for(q, variance, effective_sample_size(weights), static_cast<double>(values.size()));
  const Interval shares = share_bounds(q, n_members, confidence);
  // Beyond the outermost member nothing is known.
  if (shares.low * n_members >= 1) found.low = value_at(shares.low);
  if ((1 - shares.high) * n_members >= 1) found.high = value_at(shares.high);
  return found;
}

}  // namespace faultsweep
