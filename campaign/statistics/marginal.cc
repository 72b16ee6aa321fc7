#include "campaign/statistics/marginal.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

const boost::math::normal_distribution<double> kStandard;

/// The standard normal distribution between two ends, each possibly infinite. How far they are
/// apart is given as well: of two ends close together the difference is rounding.
struct CutNormal {
  long double from = 0, to = 0, width = 0;  ///< deviations.
};

/// A place in it, deviations above the centre or an end.
struct PlaceInNormal {
  enum class Origin { centre, from, to } origin = Origin::centre;
  long double distance = 0;
};

/// ∫ exp(−slope t − t²/2) dt from 0 to s.
long double decay_integral(long double slope, long double s) {
  using Gauss = boost::math::quadrature::gauss<long double, 30>;
  return Gauss::integrate([&](long double t) { return std::exp(-t * (slope + t / 2)); }, 0.0L, s);
}

/// How far below its upper end all but a share u of it lies: the density there is
/// exp(−slope t − t²/2) of that at the end. For shares that differences of distribution functions
/// lose: the cut is narrow, or far from the centre.
/// @pre slope = −to ≥ 0, or the cut is narrow.
long double distance_from_top(const CutNormal& cut, long double u) {
  constexpr long double kEnough = 45;  // beyond, exp(−45) of the density is left
  const long double slope = -cut.to;
  const long double reach =
      std::min(cut.width, 2 * kEnough / (slope + std::sqrt(slope * slope + 2 * kEnough)));
  const long double wanted = (1 - u) * decay_integral(slope, reach);
  // As of the exponential distribution (slope → 0: the uniform one), then Newton.
  const long double fall = slope * reach;
  long double s =
      std::abs(fall) < 1e-6L ? (1 - u) * reach : -std::log1p((1 - u) * std::expm1(-fall)) / slope;
  for (int k = 0; k < 200; ++k) {
    const long double density = std::exp(-s * (slope + s / 2));
    const long double next =
        std::clamp(s - (decay_integral(slope, s) - wanted) / density, 0.0L, reach);
    const bool stands = std::abs(next - s) <= 1e-17L * reach;
    s = next;
    if (stands) break;
  }
  return s;
}

/// The value below which a share u of it lies.
PlaceInNormal normal_quantile(const CutNormal& cut, long double u) {
  using Origin = PlaceInNormal::Origin;
  // Shares close to 1 cannot be told apart: the upper tail is the lower one from the other side.
  if (cut.from > -cut.to || (cut.from == -cut.to && u > 0.5L)) {
    const auto [origin, distance] = normal_quantile({-cut.to, -cut.from, cut.width}, 1 - u);
    return {origin == Origin::to ? Origin::from : origin, -distance};
  }
  constexpr double kLeast = 0x1p-54;
  constexpr long double kNarrow = 1e-3L, kFar = -30;
  if (std::isinf(cut.from)) u = std::max<long double>(u, kLeast);
  if (cut.width < kNarrow || cut.to < kFar) return {Origin::to, -distance_from_top(cut, u)};
  const auto a = static_cast<double>(cut.from), b = static_cast<double>(cut.to);
  const double below_a = std::isinf(a) ? 0 : boost::math::cdf(kStandard, a);
  const double below_b = std::isinf(b) ? 1 : boost::math::cdf(kStandard, b);
  const double share = below_a + static_cast<double>(u) * (below_b - below_a);
  return {Origin::centre,
          std::clamp(share <= 0 ? a : boost::math::quantile(kStandard, share), a, b)};
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
  const auto origin_of = [&](const PlaceInNormal& place) {
    return place.origin == PlaceInNormal::Origin::centre ? centre
           : place.origin == PlaceInNormal::Origin::from ? from
                                                         : to;
  };
  switch (distribution) {
    case Distribution::uniform:
      return from + (to - from) * u;
    case Distribution::log_uniform:
      return from * std::pow(to / from, u);
    case Distribution::normal: {
      const PlaceInNormal place = normal_quantile(
          {(from - centre) / spread, (to - centre) / spread, (to - from) / spread}, u);
      return std::clamp(origin_of(place) + spread * place.distance, from, to);
    }
    case Distribution::log_normal: {
      const long double scale = std::log(spread);
      const PlaceInNormal place =
          normal_quantile({std::log(from / centre) / scale,  // of 0: −infinity
                           std::log(to / centre) / scale, std::log(to / from) / scale},
                          u);
      return std::clamp(origin_of(place) * std::exp(scale * place.distance), from, to);
    }
    case Distribution::triangular:
      return std::clamp(triangular_quantile(*this, u), from, to);
  }
  FAULTSIM_DEMAND(false, static_cast<int>(distribution));
  return 0;
}

}  // namespace faultsweep
