#include "campaign/statistics/cross_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

/// Of deviations of the prior, squared and inverted.
constexpr double kPrior = 1 / (5.0 * 5.0), kPriorOfOne = 1 / (10.0 * 10.0);

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// log(1 + exp(t)), also where exp(t) is not finite.
double log_one_plus_exp(double t) { return std::max(t, 0.0) + std::log1p(std::exp(-std::abs(t))); }

/// What is made least, at some coefficients, to second order.
struct Expansion {
  double value = 0;
  std::vector<double> gradient;
  std::vector<std::vector<double>> hessian;  ///< lower triangle, positive definite.
};

/// Solves hessian · step = gradient by Cholesky's factors, in place of the hessian.
std::vector<double> newton_step(Expansion at) {
  auto& factor = at.hessian;
  std::vector<double>& step = at.gradient;
  const std::size_t n = step.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = factor[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      factor[i][j] = i == j ? std::sqrt(rest) : rest / factor[j][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) step[i] -= factor[i][k] * step[k];
    step[i] /= factor[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) step[i] -= factor[k][i] * step[k];
    step[i] /= factor[i][i];
  }
  return step;
}

/// Members that are fitted to.
class Fitted {
 public:
  Fitted(const StandardFeatures& x, std::span<const double> y, Dependence dependence,
         std::size_t without_fold)
      : x_(x), y_(y), dependence_(dependence), without_fold_(without_fold) {}

  double prior(std::size_t coefficient) const {
    if (coefficient > 0) return kPrior;
    return dependence_ == Dependence::logistic ? kPriorOfOne : 0;  // a mean has no scale
  }
  double value(std::span<const double> b) const {
    double sum = 0;
    for (std::size_t j = 0; j < b.size(); ++j) sum += 0.5 * prior(j) * b[j] * b[j];
    for_each([&](std::span<const double> row, double y) {
      const double t = product(b, row);
      sum +=
          dependence_ == Dependence::line ? 0.5 * (y - t) * (y - t) : log_one_plus_exp(t) - y * t;
    });
    return sum;
  }
  Expansion expansion(std::span<const double> b) const {
    const std::size_t n = b.size();
    Expansion at{value(b), std::vector<double>(n), {n, std::vector<double>(n)}};
    for (std::size_t j = 0; j < n; ++j)
      at.gradient[j] = prior(j) * b[j], at.hessian[j][j] = prior(j);
    for_each([&](std::span<const double> row, double y) {
      const double mean = predicted(b, row, dependence_);
      const double weight = dependence_ == Dependence::line ? 1 : mean * (1 - mean);
      for (std::size_t j = 0; j < n; ++j) {
        at.gradient[j] += (mean - y) * row[j];
        for (std::size_t k = 0; k <= j; ++k) at.hessian[j][k] += weight * row[j] * row[k];
      }
    });
    return at;
  }

 private:
  template <typename Do>
  void for_each(const Do& act) const {
    for (std::size_t i = 0; i < y_.size(); ++i)
      if (fold_of(i) != without_fold_) act(x_.row(i), y_[i]);
  }
  const StandardFeatures& x_;
  std::span<const double> y_;
  Dependence dependence_;
  std::size_t without_fold_;
};

}  // namespace

StandardFeatures::StandardFeatures(std::span<const std::vector<double>> columns,
                                   std::size_t n_members)
    : n_members_(n_members) {
  constexpr double kConstant = 1e-12;  // of a deviation, relative to the largest value
  const auto n = static_cast<double>(n_members);
  std::vector<std::size_t> used;
  std::vector<double> means, deviations;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    FAULTSIM_DEMAND(columns[j].size() == n_members, columns[j].size(), " of ", n_members);
    double mean = 0, squares = 0, largest = 0;
    for (const double x : columns[j]) mean += x / n, largest = std::max(largest, std::abs(x));
    for (const double x : columns[j]) squares += (x - mean) * (x - mean) / n;
    const double deviation = std::sqrt(squares);
    // Not true of what is not finite either.
    const bool varies = std::isfinite(deviation) && deviation > kConstant * largest;
    if (varies) used.push_back(j), means.push_back(mean), deviations.push_back(deviation);
    if (!varies) left_out_.push_back(j);
  }
  width_ = used.size() + 1;
  rows_.reserve(n_members * width_);
  for (std::size_t i = 0; i < n_members; ++i) {
    rows_.push_back(1);
    for (std::size_t k = 0; k < used.size(); ++k)
      rows_.push_back((columns[used[k]][i] - means[k]) / deviations[k]);
  }
}

double predicted(std::span<const double> coefficients, std::span<const double> features,
                 Dependence dependence) {
  const double t = product(coefficients, features);
  return dependence == Dependence::line ? t : 1 / (1 + std::exp(-t));
}

std::vector<double> fit(const StandardFeatures& x, std::span<const double> y, Dependence dependence,
                        std::size_t without_fold) {
  constexpr int kMostSteps = 60,
                kMostHalvings = 40;                 // a dozen steps are usual, of one or no halving
  constexpr double kSmall = 1e-14, kEnough = 1e-4;  // of the descent; Armijo's share of it
  const Fitted fitted(x, y, dependence, without_fold);
  std::vector<double> b(x.n_coefficients());
  for (int k = 0; k < kMostSteps; ++k) {
    const Expansion at = fitted.expansion(b);
    const std::vector<double> step = newton_step(at);
    const double descent = product(step, at.gradient);
    if (descent <= kSmall * (1 + std::abs(at.value))) break;
    double length = 1;
    std::vector<double> next;
    for (int halving = 0; halving < kMostHalvings; ++halving, length /= 2) {
      next = b;
      for (std::size_t j = 0; j < b.size(); ++j) next[j] -= length * step[j];
      if (fitted.value(next) <= at.value - kEnough * length * descent) break;
    }
    b = next;
  }
  return b;
}

std::vector<double> cross_fitted(const StandardFeatures& x, std::span<const double> y,
                                 Dependence dependence) {
  FAULTSIM_DEMAND(y.size() >= kFolds && x.n_members() >= y.size(), y.size(), " of ", x.n_members());
  std::vector<std::vector<double>> fits;
  for (std::size_t fold = 0; fold < kFolds; ++fold) fits.push_back(fit(x, y, dependence, fold));
  std::vector<double> all(x.n_members());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i < y.size()) {
      all[i] = predicted(fits[fold_of(i)], x.row(i), dependence);
      continue;
    }
    for (const std::vector<double>& one : fits)
      all[i] += predicted(one, x.row(i), dependence) / static_cast<double>(kFolds);
  }
  return all;
}

}  // namespace faultsweep
