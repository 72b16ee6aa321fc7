#include "simulator/grid_scene/trace_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/corner_point/straight_trace.h"
#include "simulator/horizons/traces.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::cross_product;
using corner_point::line_length;
using corner_point::nearest_on_line;
using corner_point::PlaceOnLine;
using Eigen::Vector2d;

constexpr double kLeastMeeting = 35 * std::numbers::pi / 180;  // 25 are needed
constexpr double kReach = 4, kBack = 2.5;                      // cells

double angle_between(const Vector2d& a, const Vector2d& b) {
  return std::atan2(std::abs(cross_product(a, b)), std::abs(a.dot(b)));
}

/// The least angle of a direction with the pieces of a line within a reach of a place on it.
double least_angle(const Vector2d& direction, const Polyline& other, const Vector2d& at,
                   double reach) {
  double least = std::numbers::pi / 2;
  for (std::size_t k = 0; k + 1 < other.size(); ++k) {
    if (nearest_on_line({other[k], other[k + 1]}, at).distance > reach) continue;
    least = std::min(least, angle_between(direction, other[k + 1] - other[k]));
  }
  return least;
}

/// The trace up to a place some cells before `along`, from where another line is led straight; some
/// of it is always left.
Polyline before(const Polyline& trace, double along, double back) {
  return cut_at(trace, std::max(along - back, 0.3 * along));
}

}  // namespace

std::optional<LineCrossing> crossing_beyond(const Polyline& line, const Polyline& other,
                                            double along) {
  double begin = 0;
  for (std::size_t p = 0; p + 1 < line.size(); ++p) {
    const Vector2d piece = line[p + 1] - line[p];
    std::optional<LineCrossing> first;
    for (std::size_t q = 0; q + 1 < other.size(); ++q) {
      const Vector2d at = horizons::crossing_of(line[p], line[p + 1], other[q], other[q + 1]);
      if (!at.allFinite()) continue;
      const double place = begin + (at - line[p]).norm();
      if (place < along || (first && place >= first->along)) continue;
      first = {at, place, angle_between(piece, other[q + 1] - other[q]), q};
    }
    if (first) return first;
    begin += piece.norm();
  }
  return std::nullopt;
}

Polyline cut_at(const Polyline& line, double along) {
  Polyline cut = {line.front()};
  double left = along;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const double length = (line[k + 1] - line[k]).norm();
    if (left <= length) {
      if (left > 0) cut.emplace_back(line[k] + left / length * (line[k + 1] - line[k]));
      return cut;
    }
    cut.push_back(line[k + 1]);
    left -= length;
  }
  return cut;
}

Polyline prolonged(Polyline trace, double by) {
  const Vector2d along = (trace.back() - trace[trace.size() - 2]).normalized();
  trace.back() += by * along;
  return trace;
}

std::optional<Polyline> led_across(const Polyline& trace, const Polyline& other, double cell,
                                   double beyond) {
  const double length = line_length(trace);
  const auto crossing =
      crossing_beyond(prolonged(trace, kReach * cell), other, length - kReach * cell);
  Polyline led;
  if (crossing && crossing->angle >= kLeastMeeting) {
    led = cut_at(prolonged(trace, kReach * cell), crossing->along);
  } else {
    const double end = crossing ? std::min(crossing->along, length) : length;
    led = before(trace, end, kBack * cell);
    const PlaceOnLine nearest = nearest_on_line(other, led.back());
    if (nearest.distance > (kReach + kBack) * cell || nearest.distance == 0) return std::nullopt;
    led.push_back(nearest.point);
  }
  return prolonged(led, beyond);
}

Polyline led_to(const Polyline& trace, const Polyline& other, double cell) {
  const Vector2d last = trace.back() - trace[trace.size() - 2];
  constexpr double kNear = 0.1;  // cells
  const PlaceOnLine end = nearest_on_line(other, trace.back());
  const bool is_on_it = end.distance <= kNear * cell;
  if (is_on_it && least_angle(last, other, trace.back(), kNear * cell) >= kLeastMeeting)
    return trace;
  if (!is_on_it && end.distance <= cell) {
    const Vector2d moved = end.point - trace[trace.size() - 2];
    if (least_angle(moved, other, end.point, kNear * cell) >= kLeastMeeting) {
      Polyline joined = trace;
      joined.back() = end.point;
      return joined;
    }
  }
  Polyline led = before(trace, line_length(trace), kBack * cell);
  const PlaceOnLine nearest = nearest_on_line(other, led.back());
  if (nearest.distance == 0) return trace;
  led.push_back(nearest.point);
  const Vector2d straight = led.back() - led[led.size() - 2];
  return least_angle(straight, other, led.back(), kNear * cell) >= kLeastMeeting ? led : trace;
}

}  // namespace faultsim::grid_scene
