#include "simulator/initial_state/fault_pressure.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/scene/field_extents.h"

namespace faultsim {
namespace {

double mix(double share, double first, double second) { return first + share * (second - first); }

/// The depths at which the initial pressure of a scene jumps.
std::vector<double> jumps(const Scene& scene) {
  if (scene.geometry_kind != GeometryKind::field) return {};
  const DepthInterval layer = reservoir_range(scene.field);
  return {layer.top, layer.bottom};
}

/// Whether a region of a box may touch a patch: their bounding boxes do. Of a leaning patch that is
/// rather too often.
bool may_touch(const PressureRegion& region, const PatchGeometry& patch) {
  const Bounds a = bounds_of(region), b = bounds_of(patch);
  const auto overlap = [&](std::size_t k) {
    return a.low[k] <= b.high[k] && a.high[k] >= b.low[k];
  };
  return overlap(0) && overlap(1);
}

DepthInterval depths_of(const Bounds& bounds) { return {-bounds.high[2], -bounds.low[2]}; }

/// Where a prescribed pressure acts if it has no window: beside regions.
std::vector<DepthInterval> depths_beside(const Scene& scene, std::size_t fault) {
  std::vector<DepthInterval> all;
  if (scene.geometry_kind == GeometryKind::field) {
    for (const Block& block : blocks_beside(scene.field, fault))
      all.push_back(reservoir_range(scene.field, block));
    return all;
  }
  for (const PressureRegion& region : scene.box.regions) {
    if (may_touch(region, scene.box.patches[fault])) all.push_back(depths_of(bounds_of(region)));
  }
  return all;
}

/// How far the corners of a box are from the centre of a patch along its strike, m: a patch that
/// cuts the whole box may be longer.
std::array<double, 2> body_along_strike(const BoxGeometry& box, const PatchGeometry& patch) {
  std::array<double, 2> range = {HUGE_VAL, -HUGE_VAL};
  for (const double x : {box.from[0], box.to[0]}) {
    for (const double y : {box.from[1], box.to[1]}) {
      const double at = (x - patch.center[0]) * std::sin(patch.strike) +
                        (y - patch.center[1]) * std::cos(patch.strike);
      range = {std::min(range[0], at), std::max(range[1], at)};
    }
  }
  return range;
}

class Places {
 public:
  Places(const Scene& scene, std::size_t fault)
      : scene_(scene),
        law_(scene.faults[fault].pressure),
        fault_(fault),
        reach_(depths_of_fault(scene, fault)) {}

  std::vector<FaultPlace> all() {
    if (law_.rule == FaultPressureRule::prescribed && law_.depth_window) {
      add((*law_.depth_window)[0], (*law_.depth_window)[1], DepthSide::mean, DepthSide::mean);
    } else if (law_.rule == FaultPressureRule::prescribed) {
      // A node at the edge of a region takes half of the change: the other half is not of it.
      for (const DepthInterval& each : depths_beside(scene_, fault_))
        add(each.top, each.bottom, DepthSide::below, DepthSide::above);
    } else if (law_.rule == FaultPressureRule::table && !law_.profile.change.empty()) {
      add_table();
    }
    return std::move(places_);
  }

 private:
  /// The ends of an interval of depths on the fault, and the jumps in it.
  void add(double top, double bottom, DepthSide at_top, DepthSide at_bottom) {
    if (!(bottom >= reach_.top) || !(top <= reach_.bottom)) return;
    const double from = std::max(top, reach_.top), to = std::min(bottom, reach_.bottom);
    places_.push_back({from, at_top});
    places_.push_back({to, at_bottom});
    for (const double jump : jumps(scene_)) {
      if (!(jump > from) || !(jump < to)) continue;
      places_.push_back({jump, DepthSide::above});
      places_.push_back({jump, DepthSide::below});
    }
  }

  void add_table() {
    const FaultPressureTable& table = law_.profile;
    const TableExtent extent = table_extent(scene_, fault_);
    for (const double dip : within(table.dip, extent.dip))
      places_.push_back({depth_at(dip), DepthSide::mean, dip});
    for (const double jump : jumps(scene_)) {
      if (!(jump > reach_.top) || !(jump < reach_.bottom)) continue;
      places_.push_back({jump, DepthSide::above, jump});
      places_.push_back({jump, DepthSide::below, jump});
    }
    if (table.strike.empty()) return;
    std::vector<FaultPlace> along;
    for (FaultPlace place : places_) {
      for (const double strike : within(table.strike, extent.strike)) {
        place.strike = strike;
        along.push_back(place);
      }
    }
    places_ = std::move(along);
  }

  /// The ends of a range, and the values in between.
  static std::vector<double> within(const std::vector<double>& values,
                                    const std::array<double, 2>& range) {
    std::vector<double> all = {range[0], range[1]};
    for (const double value : values) {
      if (value > range[0] && value < range[1]) all.push_back(value);
    }
    return all;
  }

  double depth_at(double dip) const {
    if (law_.profile.place == FaultPressureTable::Place::depth) return dip;
    const PatchGeometry& patch = scene_.box.patches[fault_];
    return -patch.center[2] + dip * std::cos(patch.dip_from_vertical);
  }

  const Scene& scene_;
  const FaultPressure& law_;
  std::size_t fault_;
  DepthInterval reach_;
  std::vector<FaultPlace> places_;
};

}  // namespace

double pressure_by_rule(const FaultPressure& law, double minus, double plus) {
  switch (law.rule) {
    case FaultPressureRule::mean:
      return 0.5 * (minus + plus);
    case FaultPressureRule::min:
      return std::min(minus, plus);
    case FaultPressureRule::max:
      return std::max(minus, plus);
    case FaultPressureRule::minus:
      return minus;
    case FaultPressureRule::plus:
      return plus;
    case FaultPressureRule::fraction: {
      const double low = std::min(minus, plus);
      return low + law.fraction * (std::max(minus, plus) - low);
    }
    case FaultPressureRule::prescribed:
    case FaultPressureRule::table:
    case FaultPressureRule::none:
      return 0;
  }
  throw_internal("known fault pressure rule", "", __FILE__, __LINE__);
}

double prescribed_pressure_change(const Scene& scene, const FaultPressure& law, double time) {
  if (!law.table.time.empty()) return law.prescribed * factor_at(law.table, time);
  const double ramp = scene.stages.empty() ? 0 : scene.stages.front().duration;
  return law.prescribed * (ramp > 0 ? std::clamp(time / ramp, 0.0, 1.0) : 1.0);
}

double table_pressure(const FaultPressureTable& table, double dip, double strike, double time) {
  const Between i = between(table.dip, dip), j = between(table.strike, strike),
                t = between(table.time, time);
  const std::size_t n_strike = std::max<std::size_t>(table.strike.size(), 1);
  const auto at_time = [&](std::size_t row, std::size_t column) {
    const double* values = table.change.data() + (row * n_strike + column) * table.time.size();
    return mix(t.share, values[t.first], values[t.second]);
  };
  const auto at_dip = [&](std::size_t row) {
    return mix(j.share, at_time(row, j.first), at_time(row, j.second));
  };
  return mix(i.share, at_dip(i.first), at_dip(i.second));
}

DepthInterval depths_of_fault(const Scene& scene, std::size_t fault) {
  if (scene.geometry_kind == GeometryKind::field) return fault_range(scene.field, fault);
  const PatchGeometry& patch = scene.box.patches[fault];
  const double half = 0.5 * patch.width * std::abs(std::cos(patch.dip_from_vertical));
  return {std::max(-patch.center[2] - half, -scene.box.to[2]),
          std::min(-patch.center[2] + half, -scene.box.from[2])};
}

TableExtent table_extent(const Scene& scene, std::size_t fault) {
  const DepthInterval depths = depths_of_fault(scene, fault);
  if (scene.geometry_kind == GeometryKind::field) {
    const StrikeInterval ends = fault_ends(scene.field, fault);
    return {{depths.top, depths.bottom}, {ends.from, ends.to}};
  }
  const PatchGeometry& patch = scene.box.patches[fault];
  TableExtent extent{{depths.top, depths.bottom}, {-0.5 * patch.length, 0.5 * patch.length}};
  if (scene.faults[fault].pressure.profile.place == FaultPressureTable::Place::along_dip) {
    const double lean = std::cos(patch.dip_from_vertical);
    extent.dip = {-0.5 * patch.width, 0.5 * patch.width};
    constexpr double kLevel = 1e-6;  // a level patch has one depth
    if (lean > kLevel)
      extent.dip = {(depths.top + patch.center[2]) / lean,
                    (depths.bottom + patch.center[2]) / lean};
  }
  const std::array<double, 2> body = body_along_strike(scene.box, patch);
  extent.strike = {std::max(extent.strike[0], body[0]), std::min(extent.strike[1], body[1])};
  return extent;
}

std::vector<FaultPlace> given_pressure_places(const Scene& scene, std::size_t fault) {
  return Places(scene, fault).all();
}

double given_pressure_change(const Scene& scene, std::size_t fault, const FaultPlace& place,
                             double time) {
  const FaultPressure& law = scene.faults[fault].pressure;
  if (law.rule == FaultPressureRule::prescribed)
    return prescribed_pressure_change(scene, law, time);
  if (law.rule != FaultPressureRule::table) return 0;
  return table_pressure(law.profile, place.dip, place.strike, time);
}

}  // namespace faultsim
