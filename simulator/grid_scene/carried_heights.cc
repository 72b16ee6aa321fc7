#include "simulator/grid_scene/carried_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulator/common/ranges.h"

namespace faultsim::grid_scene {

using Eigen::Vector2d;

namespace {

/// What a surface goes on by where a side is moved to, m.
struct Change {
  double along, across;  ///< the fault that it is on.
};

Change change_of(const Moved& side, const Vector2d& to) {
  const Vector2d way = to - side.from;
  const Vector2d across = side.across * side.across.dot(way);
  return {side.level.slope.dot(way - across), side.level.slope.dot(across)};
}

/// Where rest(z) is zero, which is less than 0 below and greater above; none if it jumps there or
/// is not finite. By secants, which are exact on lines, from z on, the second place z − rest(z);
/// once the zero lies between two places, by halves too. The last call is with what is returned.
std::optional<double> zero_of(double z, const std::function<double(double)>& rest) {
  constexpr int kRounds = 200;
  constexpr double kSame = 1e-6;  // m
  constexpr double kJump = 0.01;  // m: pillars beside a fault may jump by millimetres
  double low = -HUGE_VAL, high = HUGE_VAL, before = z, there = rest(z), slope = 1;
  for (int round = 0; round < kRounds && std::isfinite(there) && high - low > kSame; ++round) {
    if (std::abs(there) <= kSame) return z;
    (there < 0 ? low : high) = z;
    const bool is_between = std::isfinite(low) && std::isfinite(high);
    double next = z - there / slope;
    if (is_between && round % 3 == 2) next = (low + high) / 2;
    if (!(next > low && next < high)) next = is_between ? (low + high) / 2 : z + 2 * (z - before);
    before = std::exchange(z, next);
    const double rest_before = std::exchange(there, rest(z));
    slope = (there - rest_before) / (z - before);
  }
  return std::abs(there) <= kJump ? std::optional(z) : std::nullopt;
}

}  // namespace

CarriedHeights carried(
    const std::vector<Moved>& sides,
    const std::function<std::optional<Vector2d>(std::size_t side, double z)>& place) {
  std::vector<double> z = mapped(sides, [](const Moved& one) { return one.level.z; });
  // Given what all sides of faults go on by across them, each has its height by itself.
  const auto rest = [&](double common) {
    double across = 0, n = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const Moved& one = sides[k];
      const bool is_on_fault = !one.across.isZero(0);
      const double own = one.level.z + (is_on_fault ? common : 0);
      Change change{0, 0};
      const std::optional<double> found = zero_of(own, [&](double height) {
        change = change_of(one, place(k, height).value_or(one.from));
        return height - own - change.along;
      });
      if (!found) return std::numeric_limits<double>::quiet_NaN();
      z[k] = *found;
      across += change.across;
      n += is_on_fault ? 1 : 0;
    }
    return n > 0 ? common - across / n : 0;
  };
  if (zero_of(0, rest)) return {z, true};
  return {mapped(sides, [](const Moved& one) { return one.level.z; }), false};
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

std::optional<double> SideProfiles::at(int fault, int side, double along) const {
  const auto found = of_side_.find({fault, side});
  return found == of_side_.end() ? std::nullopt : found->second.at(along);
}

}  // namespace faultsim::grid_scene
