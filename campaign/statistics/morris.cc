#include "campaign/statistics/morris.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"

namespace faultsweep {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;
/// Degrees of freedom that an effect gives the variance of σ: a kurtosis from few is uncertain.
constexpr double kFreedomPerEffect = 0.25;

/// Sums of powers of deviations from the mean.
struct FourMoments {
  double n = 0, mean = 0, squares = 0, fourths = 0;
};

FourMoments four_moments_of(std::span<const double> values) {
  FourMoments m;
  m.n = static_cast<double>(values.size());
  double largest = 0;
  for (const double one : values) m.mean += one / m.n, largest = std::max(largest, std::abs(one));
  for (const double one : values) {
    const double square = (one - m.mean) * (one - m.mean);
    m.squares += square, m.fourths += square * square;
  }
  if (m.squares <= m.n * std::pow(kRounding * largest, 2)) m.squares = m.fourths = 0;
  return m;
}

Estimate mean_of(const FourMoments& m, double confidence) {
  if (m.n < 2) return {m.mean, std::nan(""), {-kInfinity, kInfinity}};
  return student_estimate(m.mean, std::sqrt(m.squares / (m.n * (m.n - 1))), m.n - 1, confidence);
}

Estimate deviation_of(const FourMoments& m, double confidence) {
  if (m.n < 2) return {std::nan(""), std::nan(""), {0, kInfinity}};
  const double deviation = std::sqrt(m.squares / (m.n - 1));
  if (deviation == 0) return {0, 0, {0, 0}};
  const double kurtosis = m.n * m.fourths / (m.squares * m.squares);
  const double excess = std::max(0.0, kurtosis - (m.n - 3) / m.n);
  const double of_logarithm = 0.5 * std::sqrt(excess / (m.n - 1));
  const double factor =
      std::exp(student_reach(confidence, std::max(1.0, kFreedomPerEffect * m.n)) * of_logarithm);
  return {deviation, deviation * of_logarithm, {deviation / factor, deviation * factor}};
}

ElementaryEffects summary_of(std::vector<double> effects, double confidence) {
  ElementaryEffects found;
  found.n = static_cast<long>(effects.size());
  if (effects.empty()) {
    const Estimate unknown{std::nan(""), std::nan(""), {-kInfinity, kInfinity}};
    found.mean = found.mean_magnitude = found.deviation = unknown;
    found.mean_magnitude.bounds.low = found.deviation.bounds.low = 0;
    return found;
  }
  const FourMoments moments = four_moments_of(effects);
  found.mean = mean_of(moments, confidence);
  found.deviation = deviation_of(moments, confidence);
  for (double& one : effects) one = std::abs(one);
  found.mean_magnitude = mean_of(four_moments_of(effects), confidence);
  Interval& bounds = found.mean_magnitude.bounds;
  bounds.low = std::max(0.0, bounds.low);
  return found;
}

}  // namespace

MorrisDesign::Made MorrisDesign::make(std::span<const std::vector<double>> x, double step) {
  FAULTSIM_DEMAND(step > 0, step);
  const std::size_t d = x.size(), n = d == 0 ? 0 : x.front().size();
  if (n == 0 || n % (d + 1) != 0)
    return {{}, concat(n, " rows do not divide into trajectories of ", d + 1, " rows")};
  MorrisDesign design;
  design.n_parameters_ = d, design.step_ = step;
  std::vector<char> has_moved(d);
  for (std::size_t row = 1; row < n; ++row) {
    if (row % (d + 1) == 0) continue;  // another trajectory begins
    if (row % (d + 1) == 1) std::ranges::fill(has_moved, 0);
    std::optional<Move> move;
    bool is_one = true;
    for (std::uint32_t p = 0; p < d; ++p) {
      const double before = x[p][row - 1], after = x[p][row];
      if (before == after) continue;
      is_one = is_one && !move && has_moved[p] == 0;
      move = Move{p, after > before ? 1.0 : -1.0};
    }
    if (!move || !is_one) {
      return {
          {},
          concat("row ", row + 1, " does not differ from the one before in exactly one parameter",
                 " that its trajectory has not moved yet")};
    }
    has_moved[move->parameter] = 1;
    design.moves_.push_back(*move);
  }
  return {std::move(design), ""};
}

long MorrisDesign::n_trajectories() const {
  return static_cast<long>(moves_.size() / n_parameters_);
}

std::vector<ElementaryEffects> MorrisDesign::effects(std::span<const double> y,
                                                     double confidence) const {
  const std::size_t n_rows = moves_.size() / n_parameters_ * (n_parameters_ + 1);
  FAULTSIM_DEMAND(y.size() == n_rows, y.size(), " values, ", n_rows, " rows");
  std::vector<std::vector<double>> effects(n_parameters_);
  for (std::size_t k = 0; k < moves_.size(); ++k) {
    const std::size_t row = k + k / n_parameters_;  // before the move
    const double effect = (y[row + 1] - y[row]) * moves_[k].direction / step_;
    if (std::isfinite(effect)) effects[moves_[k].parameter].push_back(effect);
  }
  std::vector<ElementaryEffects> found;
  for (std::vector<double>& one : effects) found.push_back(summary_of(std::move(one), confidence));
  return found;
}

}  // namespace faultsweep
