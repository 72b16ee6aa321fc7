#include "campaign/statistics/marginal.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

const boost::math::normal_distribution<double> kStandard;

/// Of the standard normal distribution between a and b, each possibly infinite.
double normal_quantile(double a, double b, double u) {
  // Shares close to 1 cannot be told apart: the upper tail is the lower one from the other side.
  if (a > -b || (a == -b && u > 0.5)) return -normal_quantile(-b, -a, 1 - u);
  constexpr double kLeast = 0x1p-54;
  if (std::isinf(a)) u = std::max(u, kLeast);
  const double below_a = std::isinf(a) ? 0 : boost::math::cdf(kStandard, a);
  const double below_b = std::isinf(b) ? 1 : boost::math::cdf(kStandard, b);
  const double share = below_a + u * (below_b - below_a);
  return std::clamp(share <= 0 ? a : boost::math::quantile(kStandard, share), a, b);
}

long double triangular_quantile(const Marginal& m, long double u) {
  const long double left = m.centre - m.from, right = m.to - m.centre, all = m.to - m.from;
  return u * all <= left ? m.from + std::sqrt(u * all * left)
                         : m.to - std::sqrt((1 - u) * all * right);
}

}  // namespace

long double Marginal::quantile(long double u) const {
  FAULTSIM_DEMAND(u >= 0 && u <= 1, static_cast<double>(u));
  const bool is_cut_below =
      std::isfinite(from) && (distribution != Distribution::log_normal || from > 0);
  if (u == 0 && is_cut_below) return from;
  if (u == 1 && std::isfinite(to)) return to;
  const auto cut_normal = [&](long double low, long double high) {
    return normal_quantile(static_cast<double>(low), static_cast<double>(high),
                           static_cast<double>(u));
  };
  switch (distribution) {
    case Distribution::uniform:
      return from + (to - from) * u;
    case Distribution::log_uniform:
      return from * std::pow(to / from, u);
    case Distribution::normal:
      return std::clamp(
          centre + spread * cut_normal((from - centre) / spread, (to - centre) / spread), from, to);
    case Distribution::log_normal: {
      const long double scale = std::log(spread);
      const long double z = cut_normal(std::log(from / centre) / scale,  // of 0: −infinity
                                       std::log(to / centre) / scale);
      return std::clamp(centre * std::exp(scale * z), from, to);
    }
    case Distribution::triangular:
      return std::clamp(triangular_quantile(*this, u), from, to);
  }
  FAULTSIM_DEMAND(false, static_cast<int>(distribution));
  return 0;
}

}  // namespace faultsweep
