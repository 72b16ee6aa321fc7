#include "campaign/statistics/copula.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

#include "campaign/common/names.h"
#include "simulator/common/errors.h"

namespace faultsweep {

std::optional<GaussianCopula> GaussianCopula::make(
    const std::vector<std::vector<double>>& rank_correlations) {
  constexpr double kSingular = 1e-10;  // of a pivot: numbers that follow from the others
  GaussianCopula copula;
  for (std::size_t i = 0; i < rank_correlations.size(); ++i) {
    std::vector<double> row;
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = 2 * std::sin(std::numbers::pi * rank_correlations[i][j] / 6);
      for (std::size_t k = 0; k < j; ++k) {
        rest -= row[k] * (j == i ? row[k] : copula.factor_[j][k]);
      }
      if (j == i && rest <= kSingular) return std::nullopt;
      row.push_back(j == i ? std::sqrt(rest) : rest / copula.factor_[j][j]);
    }
    copula.factor_.push_back(std::move(row));
  }
  return copula;
}

void GaussianCopula::correlate(std::span<double> u) const {
  FAULTSIM_DEMAND(u.size() == factor_.size(), u.size(), " numbers");
  static const boost::math::normal_distribution<double> kStandard;
  constexpr double kLeast = 0x1p-54, kMost = 1 - 0x1p-53;
  std::vector z = mapped(u, [&](const double& one) {
    return boost::math::quantile(kStandard, std::clamp(one, kLeast, kMost));
  });
  for (std::size_t i = 1; i < u.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k <= i; ++k) sum += factor_[i][k] * z[k];
    u[i] = std::min(boost::math::cdf(kStandard, sum), kMost);
  }
}

}  // namespace faultsweep
