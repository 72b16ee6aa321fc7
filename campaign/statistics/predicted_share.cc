#include "campaign/statistics/predicted_share.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

constexpr double kNoVariance = 1e-6;  // of predictions, relative to that of flags

std::size_t class_of(double prediction) { return prediction < 0.5 ? 0 : 1; }

/// Sums over the members of a class, those with a flag and all.
struct Sums {
  double n = 0, flags = 0, predictions = 0;
  double all = 0, all_predictions = 0;
  double flag_mean() const { return n > 0 ? flags / n : 0; }
  double prediction_mean() const { return n > 0 ? predictions / n : 0; }
  double all_mean() const { return all > 0 ? all_predictions / all : 0; }
};

/// Squares and products of deviations from the means of their class.
struct Products {
  double flags = 0, predictions = 0, both = 0;
  void add(double flag, double prediction) {
    flags += flag * flag, predictions += prediction * prediction, both += flag * prediction;
  }
};

/// Of flags and predictions over the whole, whose products within classes and sums are given.
double correlation_of(const std::array<Sums, 2>& sums, const Products& within) {
  Products total = within;
  const double n = sums[0].n + sums[1].n;
  const double y = (sums[0].flags + sums[1].flags) / n,
               q = (sums[0].predictions + sums[1].predictions) / n;
  for (const Sums& one : sums) {
    const double dy = one.flag_mean() - y, dq = one.prediction_mean() - q;
    total.flags += one.n * dy * dy, total.predictions += one.n * dq * dq,
        total.both += one.n * dy * dq;
  }
  const double scale = std::sqrt(total.flags * total.predictions);
  return scale > 0 ? total.both / scale : 0;
}

}  // namespace

PredictedShare::PredictedShare(std::span<const double> flags, std::span<const double> predictions)
    : n_(static_cast<double>(flags.size())), all_(static_cast<double>(predictions.size())) {
  FAULTSIM_DEMAND(flags.size() >= 4 && predictions.size() >= flags.size(), flags.size(), " of ",
                  predictions.size());
  std::array<Sums, 2> sums;
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    Sums& one = sums[class_of(predictions[i])];
    one.all += 1, one.all_predictions += predictions[i];
    if (i < flags.size()) one.n += 1, one.flags += flags[i], one.predictions += predictions[i];
  }
  Products within;
  std::array<Products, 2> products;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const Sums& one = sums[class_of(predictions[i])];
    const double y = flags[i] - one.flag_mean(), q = predictions[i] - one.prediction_mean();
    within.add(y, q), products[class_of(predictions[i])].add(y, q);
    n_holds_ += flags[i];
  }
  correlation_ = correlation_of(sums, within);
  const double weight =
      within.predictions > 0 ? std::clamp(within.both / within.predictions, 0.0, 1.0) : 0;
  for (std::size_t c = 0; c < classes_.size(); ++c) {
    const Sums& s = sums[c];
    const Products& p = products[c];
    const double corrected = s.flag_mean() + weight * (s.all_mean() - s.prediction_mean());
    classes_[c] = {s.all / all_, s.n, std::clamp(s.n > 0 ? corrected : s.all_mean(), 0.0, 1.0),
                   p.flags, p.flags - 2 * weight * p.both + weight * weight * p.predictions};
    value_ += classes_[c].share * classes_[c].probability;
  }
  for (const double q : predictions) {
    const std::size_t c = class_of(q);
    const double one = classes_[c].probability + weight * (q - sums[c].all_mean()) - value_;
    between_ += one * one / std::max(1.0, all_ - 1);
  }
}

Interval PredictedShare::Class::bounds(double n_wanted, double n_here, double confidence) const {
  // Members that are added spread over the classes as all do.
  const double members =
      n_wanted <= n_here ? n * n_wanted / n_here : n + share * (n_wanted - n_here);
  const double times = n > 0 ? members / n : 0;
  const double left = (rest_squares * times + 1) / (flag_squares * times + 1);
  return jeffreys_bounds(probability * members / left, members / left, confidence);
}

Estimate PredictedShare::estimate(double n, double all, double confidence) const {
  double down = 0, up = 0;
  const double flag_variance = value_ * (1 - value_);
  if (between_ > kNoVariance * flag_variance) {
    // So many flags that are known would have a mean that varies as much.
    const double members = all * std::max(1.0, flag_variance / between_);
    const Interval of_all = jeffreys_bounds(value_ * members, members, confidence);
    down = value_ - of_all.low, up = of_all.high - value_;
  }
  for (const Class& one : classes_) {
    const Interval of_class = one.bounds(n, n_, confidence);
    down = std::hypot(down, one.share * (one.probability - of_class.low));
    up = std::hypot(up, one.share * (of_class.high - one.probability));
  }
  const double z = student_reach(confidence, std::numeric_limits<double>::infinity());
  const double stretch = student_reach(confidence, n - 2) / z;
  const Interval bounds{std::max(0.0, value_ - stretch * down),
                        std::min(1.0, value_ + stretch * up)};
  return {value_, 0.5 * (bounds.high - bounds.low) / z, bounds};
}

Estimate PredictedShare::estimate(double confidence) const {
  return estimate(n_, all_, confidence);
}

Estimate PredictedShare::direct(double confidence) const {
  const double share = n_holds_ / n_;
  return {share, std::sqrt(share * (1 - share) / n_), jeffreys_bounds(n_holds_, n_, confidence)};
}

double PredictedShare::half_width(double n, double all, double confidence) const {
  return faultsweep::half_width(estimate(n, all, confidence));
}

double PredictedShare::n_equivalent(double confidence) const {
  return members_for_half_width(value_, half_width(n_, all_, confidence), n_, confidence);
}

}  // namespace faultsweep
