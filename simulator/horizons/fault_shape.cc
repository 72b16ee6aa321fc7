#include "simulator/horizons/fault_shape.h"

#include <algorithm>

#include "simulator/common/ranges.h"
#include "simulator/horizons/traces.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

std::vector<double> places_along(const std::vector<Vector2d>& line) {
  std::vector<double> along = {0};
  for (std::size_t k = 1; k < line.size(); ++k)
    along.push_back(along.back() + (line[k] - line[k - 1]).norm());
  return along;
}

std::vector<Vector2d> directions_across(const std::vector<Vector2d>& line) {
  std::vector<Vector2d> pieces, directions;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vector2d t = (line[k + 1] - line[k]).normalized();
    pieces.emplace_back(t.y(), -t.x());
  }
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vector2d& before = pieces[k > 0 ? k - 1 : 0];
    const Vector2d& after = pieces[std::min(k, pieces.size() - 1)];
    const Vector2d mean = (before + after) / 2;
    directions.emplace_back(mean / mean.squaredNorm());
  }
  return directions;
}

/// The interval of ascending numbers that holds one, or is nearest to it, and the part of it
/// before.
struct InInterval {
  std::size_t k;
  double part;
};

/// @param to_ends  whether numbers outside count as the nearest end.
InInterval interval_of(const std::vector<double>& numbers, double at, bool to_ends) {
  const auto next = std::ranges::upper_bound(numbers, at);
  const std::ptrdiff_t last = std::ssize(numbers) - 2;
  const std::ptrdiff_t k = std::clamp<std::ptrdiff_t>(next - numbers.begin() - 1, 0, last);
  const double width = numbers[k + 1] - numbers[k];
  const double part = width > 0 ? (at - numbers[k]) / width : 0;
  return {static_cast<std::size_t>(k), to_ends ? std::clamp(part, 0.0, 1.0) : part};
}

double linear(double a, double b, double part) { return a + part * (b - a); }

/// Shifts of a profile at depths, from the depth of traces on.
std::vector<double> shifts_at(DipProfile profile, const std::vector<double>& depths,
                              double trace_depth) {
  std::ranges::sort(profile, {}, &DipPoint::z);
  const std::vector<double> known = mapped(profile, &DipPoint::z);
  const auto at = [&](double z) {
    const InInterval here = interval_of(known, z, false);
    return linear(profile[here.k].shift, profile[here.k + 1].shift, here.part);
  };
  const double there = at(std::clamp(trace_depth, depths.front(), depths.back()));
  std::vector<double> shifts;
  for (const double z : depths) shifts.push_back(at(z) - there);
  return shifts;
}

}  // namespace

FaultShape::FaultShape(const LayeredBody& body, const LayeredFault& fault,
                       const std::vector<Vector2d>& line)
    : across_(directions_across(line)),
      along_(places_along(line)),
      profile_at_(places_along(fault.trace)) {
  for (const Vector2d& at : line) {
    const NearestOnLine nearest = nearest_on_line(fault.trace, at);
    on_trace_.push_back(profile_at_[nearest.segment] +
                        (nearest.point - fault.trace[nearest.segment]).norm());
  }
  depths_ = {fault.bottom.value_or(body.base), fault.top.value_or(body.top)};
  const double low = depths_.front(), high = depths_.back();
  for (const DipProfile& profile : fault.profiles)
    for (const DipPoint& point : profile)
      if (point.z > low && point.z < high) depths_.push_back(point.z);
  std::ranges::sort(depths_);
  drop_repeated(depths_);
  for (const DipProfile& profile : fault.profiles)
    shifts_.push_back(shifts_at(profile, depths_, body.trace_depth));
  if (shifts_.empty()) shifts_.emplace_back(depths_.size(), 0);
  is_alike_ = std::ranges::all_of(shifts_, [&](const auto& one) { return one == shifts_[0]; });
}

double FaultShape::shift(double along, double z) const {
  if (is_alike_) return between(0, z);
  const InInterval here = interval_of(along_, along, true);
  return between(linear(on_trace_[here.k], on_trace_[here.k + 1], here.part), z);
}

double FaultShape::between(double on_trace, double z) const {
  const InInterval depth = interval_of(depths_, z, true);
  const auto at = [&](std::size_t profile) {
    return linear(shifts_[profile][depth.k], shifts_[profile][depth.k + 1], depth.part);
  };
  if (is_alike_) return at(0);
  const InInterval here = interval_of(profile_at_, on_trace, true);
  return linear(at(here.k), at(here.k + 1), here.part);
}

std::vector<FaultShape> fault_shapes(const LayeredBody& body, const MapMesh& map) {
  std::vector<FaultShape> shapes;
  for (int f = 0; f < map.n_faults; ++f) {
    std::vector<Vector2d> line;
    for (const int v : map.lines[f]) line.push_back(map.vertices[v]);
    shapes.emplace_back(body, body.faults[f], line);
  }
  return shapes;
}

}  // namespace faultsim::horizons
