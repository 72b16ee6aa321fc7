#include "campaign/statistics/correlation_bounds.h"

#include <algorithm>
#include <cmath>

namespace faultsweep {
namespace {

/// With fewer, Student's t has no variance and bounds say nothing.
constexpr double kLeastFreedom = 2;

}  // namespace

Interval correlation_bounds(double r, double variance, double freedom, double confidence) {
  if (!(variance > 0)) return {r, r};
  const double error = std::sqrt(variance);
  // Within an error of the ends z and its error would run away.
  const double end = std::max(0.0, 1 - error);
  const double inner = std::clamp(r, -end, end);
  const double z = std::atanh(inner);
  const double reach =
      student_reach(confidence, std::max(freedom, kLeastFreedom)) * error / (1 - inner * inner);
  return {std::tanh(z - reach), std::tanh(z + reach)};
}

std::optional<RareValue> rarer_of_two(std::span<const double> values) {
  double one = std::nan(""), other = std::nan("");
  double n_one = 0, n_other = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (std::isnan(one)) one = value;
    if (value == one) {
      ++n_one;
      continue;
    }
    if (std::isnan(other)) other = value;
    if (value != other) return std::nullopt;
    ++n_other;
  }
  if (n_other == 0) return std::nullopt;
  const double count = std::min(n_one, n_other);
  return RareValue{count, count / (n_one + n_other)};
}

void RareTogether::add(const std::optional<RareValue>& one) {
  are_flags_ = are_flags_ && one;
  if (!one) return;
  fewest_ = count_ > 0 ? std::min(fewest_, one->count) : one->count;
  count_ += one->count, weighted_ += one->count * one->share;
}

std::optional<RareValue> RareTogether::found() const {
  if (!are_flags_ || count_ == 0) return std::nullopt;
  return RareValue{fewest_, weighted_ / count_};
}

Interval wilson_bounds(double share, double n, double z) {
  const double zz = z * z / n;
  const double centre = (share + zz / 2) / (1 + zz);
  const double half = std::sqrt(share * (1 - share) * zz + zz * zz / 4) / (1 + zz);
  return {share > 0 ? centre - half : 0, share < 1 ? centre + half : 1};
}

Interval flag_correlation_bounds(double r, double variance, const RareValue& rare, double freedom,
                                 double confidence) {
  const double p = rare.share;
  const double q = std::clamp(p + r * (1 - p), 0.0, 1.0);
  const double variance_q = variance * (1 - p) * (1 - p);
  const double members =
      variance_q > 0 ? std::max(rare.count, q * (1 - q) / variance_q) : rare.count;
  const double z = student_reach(confidence, std::max(freedom, kLeastFreedom));
  const Interval of_q = wilson_bounds(q, members, z);
  return {(of_q.low - p) / (1 - p), (of_q.high - p) / (1 - p)};
}

}  // namespace faultsweep
