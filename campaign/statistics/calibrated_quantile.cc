#include "campaign/statistics/calibrated_quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

/// P(e ≤ t) by m values in order, never 0 or 1.
double smoothed_share(std::span<const double> ascending, double t) {
  const auto count = std::ranges::upper_bound(ascending, t) - ascending.begin();
  return (static_cast<double>(count) + 0.5) / (static_cast<double>(ascending.size()) + 1);
}

/// Where `is_above` turns true between low, where it is not, and high, where it is.
template <typename IsAbove>
double turning_point(double low, double high, const IsAbove& is_above) {
  constexpr int kHalvings = 45;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (is_above(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

CalibratedDistribution::CalibratedDistribution(std::span<const double> values,
                                               const StandardFeatures& features)
    : values_(values.begin(), values.end()),
      predictions_(cross_fitted(features, values, Dependence::line)),
      rests_of_others_(kFolds) {
  FAULTSIM_DEMAND(values.size() >= 2 * kFolds, values.size(), " values");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double rest = values[i] - predictions_[i];
    rests_.push_back(rest);
    for (std::size_t fold = 0; fold < kFolds; ++fold)
      if (fold != fold_of(i)) rests_of_others_[fold].push_back(rest);
  }
  std::ranges::sort(rests_);
  for (std::vector<double>& one : rests_of_others_) std::ranges::sort(one);
  const auto [least, most] = std::ranges::minmax(predictions_);
  const auto [least_value, most_value] = std::ranges::minmax(values_);
  least_ = std::min(least_value, least + rests_.front());
  most_ = std::max(most_value, most + rests_.back());
  const double beyond = std::max(most_ - least_, std::abs(most_) * 1e-9);
  least_ -= beyond, most_ += beyond;
}

PredictedShare CalibratedDistribution::share_up_to(double t) const {
  const std::vector flags = mapped(values_, [t](double y) { return y <= t ? 1.0 : 0.0; });
  std::vector<double> predictions(predictions_.size());
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const auto& rests = i < values_.size() ? rests_of_others_[fold_of(i)] : rests_;
    predictions[i] = smoothed_share(rests, t - predictions_[i]);
  }
  return {flags, predictions};
}

CalibratedQuantile CalibratedDistribution::quantile(double q, double confidence) const {
  FAULTSIM_DEMAND(q > 0 && q < 1, q);
  const auto at = [&](double t) { return share_up_to(t).estimate(confidence); };
  const auto searched = [&](const auto& is_above) {
    return turning_point(least_, most_, is_above);
  };
  QuantileBounds found;
  found.estimate = searched([&](double t) { return at(t).value >= q; });
  if (at(least_).bounds.high < q)
    found.low = searched([&](double t) { return at(t).bounds.high >= q; });
  if (at(most_).bounds.low > q)
    found.high = searched([&](double t) { return at(t).bounds.low > q; });
  return {found, share_up_to(found.estimate)};
}

QuantileBounds CalibratedDistribution::direct(double q, double confidence) const {
  std::vector<double> sorted = values_;
  std::ranges::sort(sorted);
  return quantile_bounds(sorted, 0, q, confidence);
}

double CalibratedQuantile::half_width(double n, double all, double confidence) const {
  if (!bounds.low || !bounds.high) return std::numeric_limits<double>::quiet_NaN();
  return 0.5 * (*bounds.high - *bounds.low) * share_up_to_it.half_width(n, all, confidence) /
         faultsweep::half_width(share_up_to_it.estimate(confidence));
}

}  // namespace faultsweep
