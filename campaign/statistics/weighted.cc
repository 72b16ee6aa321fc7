#include "campaign/statistics/weighted.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "campaign/common/names.h"
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

/// Members with their weights, all of them known.
struct Members {
  std::vector<char> holds;
  std::vector<double> weights;
  void add(bool one, double weight) {
    holds.push_back(one ? 1 : 0);
    weights.push_back(weight);
  }
  Estimate probability(double confidence) const;
};

Estimate Members::probability(double confidence) const {
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

/// The first value up to which members carry a share of all weight, if those up to it count
/// `below` and those beyond it `above`.
double value_at(double share, std::span<const double> values, std::span<const WeightRange> weights,
                std::span<const std::size_t> order, double WeightRange::*below,
                double WeightRange::*above) {
  double beyond = 0, so_far = 0;
  for (const WeightRange& one : weights) beyond += one.*above;
  double last = values[order.front()];
  for (const std::size_t i : order) {
    if (weights[i].most <= 0) continue;
    beyond = std::max(0.0, beyond - weights[i].*above);
    so_far += weights[i].*below;
    last = values[i];
    if (so_far >= (share - 1e-12) * (so_far + beyond)) break;  // rounding of the sums
  }
  return last;
}

}  // namespace

double effective_sample_size(std::span<const double> weights) {
  double sum = 0, squares = 0;
  for (const double w : weights) sum += w, squares += w * w;
  return squares > 0 ? sum * sum / squares : 0;
}

Estimate weighted_probability(std::span<const Holds> holds, std::span<const WeightRange> weights,
                              double confidence) {
  Members known;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (holds[i] != Holds::unknown && weights[i].is_known())
      known.add(holds[i] == Holds::yes, weights[i].most);
  }
  Estimate found = known.probability(confidence);
  if (known.holds.size() == holds.size()) return found;
  for (const Holds side : {Holds::no, Holds::yes}) {
    // What is on this side, or may be, counts as much as it can, the rest as little.
    Members all;
    for (std::size_t i = 0; i < holds.size(); ++i) {
      const bool on_side = holds[i] == side || holds[i] == Holds::unknown;
      all.add((side == Holds::yes) == on_side, on_side ? weights[i].most : weights[i].least);
    }
    const Interval bounds = all.probability(confidence).bounds;
    found.bounds.low = std::min(found.bounds.low, bounds.low);
    found.bounds.high = std::max(found.bounds.high, bounds.high);
  }
  return found;
}

QuantileBounds weighted_quantile(std::span<const double> values,
                                 std::span<const WeightRange> weights,
                                 std::span<const std::size_t> order, double q, double confidence) {
  FAULTSIM_DEMAND(q > 0 && q < 1, q);
  std::vector<WeightRange> known(weights.begin(), weights.end());
  for (WeightRange& one : known)
    if (!one.is_known()) one = {};
  QuantileBounds found;
  found.estimate = value_at(q, values, known, order, &WeightRange::most, &WeightRange::most);
  // The share of weight up to the estimate varies as that of any property with probability q.
  std::vector counted = mapped(known, &WeightRange::most);
  const double sum = sum_of(counted);
  double variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double one = counted[i] / sum * ((values[i] <= found.estimate ? 1 : 0) - q);
    variance += one * one;
  }
  const double n_members =
      members_for(q, variance, effective_sample_size(counted), static_cast<double>(values.size()));
  const Interval shares = share_bounds(q, n_members, confidence);
  // Beyond the outermost member nothing is known. What is not known counts where it moves an end
  // outwards: much below the lower and little above it, the other way round for the upper.
  if (shares.low * n_members >= 1)
    found.low =
        value_at(shares.low, values, weights, order, &WeightRange::most, &WeightRange::least);
  if ((1 - shares.high) * n_members >= 1)
    found.high =
        value_at(shares.high, values, weights, order, &WeightRange::least, &WeightRange::most);
  return found;
}

}  // namespace faultsweep
