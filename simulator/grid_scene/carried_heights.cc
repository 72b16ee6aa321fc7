#include "simulator/grid_scene/carried_heights.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"

namespace faultsim::grid_scene {

using Eigen::Vector2d;

std::vector<double> carried(
    const std::vector<Moved>& sides,
    const std::function<std::optional<Vector2d>(std::size_t side, double z)>& place) {
  constexpr int kRounds = 30;     // a place goes on with the height by less than the height with it
  constexpr double kSame = 1e-4;  // m
  std::vector<double> z = mapped(sides, [](const Moved& one) { return one.level.z; });
  double change = 1;
  for (int round = 0; round < kRounds && change > kSame; ++round) {
    const std::vector<double> before = z;
    double common = 0, n = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const Moved& one = sides[k];
      const Vector2d way = place(k, before[k]).value_or(one.from) - one.from;
      const Vector2d across = one.across * one.across.dot(way);
      z[k] = one.level.z + one.level.slope.dot(way - across);
      common += one.level.slope.dot(across);
      n += one.across.isZero(0) ? 0 : 1;
    }
    change = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (!sides[k].across.isZero(0)) z[k] += common / n;
      change = std::max(change, std::abs(z[k] - before[k]));
    }
  }
  return z;
}

void SideProfile::add(double along, double z) {
  const std::pair point(along, z);
  points_.insert(std::ranges::upper_bound(points_, point), point);
}

std::optional<double> SideProfile::at(double along) const {
  const auto after =
      std::ranges::lower_bound(points_, along, {}, &std::pair<double, double>::first);
  if (after == points_.end() || (after == points_.begin() && after->first > along))
    return std::nullopt;
  if (after->first == along) return after->second;
  const auto before = after - 1;
  const double part = (along - before->first) / (after->first - before->first);
  return before->second + part * (after->second - before->second);
}

}  // namespace faultsim::grid_scene
