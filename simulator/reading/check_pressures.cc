#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

/// No pressure falls below zero: of regions, and of faults by any rule. NaN marks what was reported
/// before and fails no check.
namespace faultsim {
namespace {

constexpr double kRounding = 1;  // Pa: "fall to zero" is written in decimal units

/// Where pressure can be lowest in a region: its top and, if within, below an overpressured layer.
struct Place {
  double depth;
  DepthSide side;
};
std::vector<Place> lowest_places(const Scene& scene, std::size_t region) {
  const DepthInterval depths = depths_of_region(scene, region);
  std::vector<Place> places = {{depths.top, DepthSide::below}};
  if (scene.geometry_kind == GeometryKind::box) {
    places.push_back({depths.bottom, DepthSide::above});
  } else if (!scene.field.blocks[region].overpressure) {
    const DepthInterval layer = reservoir_range(scene.field);
    for (const double jump : {layer.top, layer.bottom}) {
      if (jump > depths.top && jump < depths.bottom) places.push_back({jump, DepthSide::below});
    }
  }
  return places;
}

double pressure_at(const Scene& scene, std::size_t region, const Place& place) {
  if (scene.geometry_kind == GeometryKind::field && scene.field.blocks[region].overpressure) {
    return initial_region_pressure(scene, region, place.depth);
  }
  return initial_state(scene, -place.depth, place.side).pressure;
}

/// What in the document made the pressure of a region at a step.
std::string cause(const SceneReader& reader, const PressureHistory& history, std::size_t stage) {
  const std::string& region = history.region;
  const std::string csv = "/compartments/" + pointer_token(region) + "/csv";
  if (reader.has(csv)) return csv;
  if (history.from_csv) return "/pressure_csv";
  for (std::size_t i = stage + 1; i-- > 0;) {
    for (const char* key : {"pressure_change", "pressure", "pressure_between"}) {
      const std::string pointer = element("/stages", i) + "/" + key;
      if (reader.has(pointer + "/" + pointer_token(region))) {
        return pointer + "/" + pointer_token(region);
      }
      if (reader.has(pointer) && !reader.find(pointer)->is_object()) return pointer;
    }
  }
  return "/stages";
}

std::string below_zero(const std::string& where, double depth, double pressure, std::size_t step,
                       const Stage& stage) {
  return "the pressure " + where + " falls to " + in_unit(pressure, Dimension::pressure, "bar") +
         " at " + metres(depth) + " depth in step " + std::to_string(step + 1) + " (stage \"" +
         stage.name + "\")";
}

/// The cure rounds towards zero, so that following it to the letter works.
std::string below_zero_cure(double initial) {
  return std::string("let it fall by at most ") +
         formatted("%.1f bar", std::floor(10 * from_si(initial, Dimension::pressure, "bar")) / 10);
}

/// The least of factor times the values, and of 0: what a change never falls below.
double least_of(const std::vector<double>& values, double factor) {
  double least = 0;
  for (const double value : values) least = std::fmin(least, factor * value);
  return least;
}

void check_region(SceneReader& reader, const Scene& scene, std::size_t region) {
  const PressureHistory& history = scene.pressure[region];
  // Most histories never get there; only the others are followed step by step.
  const double least = least_of(history.pressure_change, history.scale);
  const std::vector<Place> places = lowest_places(scene, region);
  const bool safe = std::ranges::all_of(
      places, [&](const Place& place) { return pressure_at(scene, region, place) + least >= 0; });
  if (safe) return;
  const std::vector<StepEnd> steps = step_ends(scene);
  for (std::size_t step = 0; step < steps.size(); ++step) {
    for (const Place& place : places) {
      const double initial = pressure_at(scene, region, place);
      const double pressure = initial + pressure_change_at(history, steps[step].time);
      if (!(pressure < -kRounding)) continue;
      const std::size_t stage = steps[step].stage;
      reader.problem(cause(reader, history, stage),
                     below_zero("in \"" + history.region + "\"", place.depth, pressure, step,
                                scene.stages[stage]),
                     initial > 0 ? below_zero_cure(initial)
                                 : "give the region an initial pressure in initial_state");
      return;
    }
  }
}

/// Pa; a change that could make the pressure of a fault lowest.
double least_given(const FaultPressure& law) {
  const std::vector<double> once = {1};
  if (law.rule == FaultPressureRule::prescribed)
    return least_of(law.table.factor.empty() ? once : law.table.factor, law.prescribed);
  return least_of(law.profile.change, 1);
}

struct FaultPressureAt {
  double depth = 0, pressure = 0, initial = 0;
};

/// Reports the place where the pressure of a fault is lowest in the first step in which it falls
/// below zero. @param at  FaultPressureAt of a place and a time.
template <typename Places, typename At, typename Cure>
void check_lowest(SceneReader& reader, const Scene& scene, std::size_t fault, const char* key,
                  const Places& places, const At& at, const Cure& cure) {
  const std::vector<StepEnd> steps = step_ends(scene);
  for (std::size_t step = 0; step < steps.size(); ++step) {
    FaultPressureAt lowest;
    for (const auto& place : places) {
      const FaultPressureAt here = at(place, steps[step].time);
      if (here.pressure < lowest.pressure) lowest = here;
    }
    if (!(lowest.pressure < -kRounding)) continue;
    return reader.problem(reader.fault_pressure_key(fault, key),
                          below_zero("in fault \"" + scene.faults[fault].name + "\"", lowest.depth,
                                     lowest.pressure, step, scene.stages[steps[step].stage]),
                          cure(lowest.initial));
  }
}

/// By rule `prescribed` or `table`.
void check_given(SceneReader& reader, const Scene& scene, std::size_t fault) {
  const FaultPressure& law = scene.faults[fault].pressure;
  const std::vector<FaultPlace> places = given_pressure_places(scene, fault);
  const auto initial = [&](const FaultPlace& place) {
    return initial_state(scene, -place.depth, place.side).pressure;
  };
  // Most never get there; only the others are followed step by step.
  const double least = least_given(law);
  const auto safe = [&](double p0) { return !(p0 + least < -kRounding); };
  if (std::ranges::all_of(places, safe, initial)) return;
  check_lowest(
      reader, scene, fault, law.rule == FaultPressureRule::table ? "csv" : "prescribed", places,
      [&](const FaultPlace& place, double time) -> FaultPressureAt {
        const double p0 = initial(place);
        return {place.depth, p0 + given_pressure_change(scene, fault, place, time), p0};
      },
      [](double p0) {
        return p0 <= 0
                   ? "let it act only where there is an initial pressure (depth_window), or change "
                     "initial_state"
                   : below_zero_cure(p0) + " there";
      });
}

/// Where a field's fault lies beside blocks or parts of them.
struct MixedPlace {
  double y, depth;  ///< m.
  DepthSide side;
};

/// Amid the pieces into which the ends of blocks cut the strike, m.
std::vector<double> middles_along(const FieldGeometry& field, std::span<const Block> blocks) {
  std::vector<double> ends, middles;
  for (const Block& block : blocks) {
    const StrikeInterval along = block_ends(field, block);
    ends.insert(ends.end(), {along.from, along.to});
  }
  std::ranges::sort(ends);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (ends[i] < ends[i + 1]) middles.push_back(0.5 * (ends[i] + ends[i + 1]));
  return middles;
}

/// What the rule of a field's fault makes of blocks with an overpressure of their own: one that
/// takes the overpressure from one side and the fall from the other may go below zero where neither
/// block does.
void check_mixed(SceneReader& reader, const Scene& scene, std::size_t fault) {
  const FaultPressure& law = scene.faults[fault].pressure;
  const auto blocks = blocks_beside(scene.field, fault);
  if (std::ranges::none_of(blocks,
                           [](const Block& block) { return block.overpressure.has_value(); }))
    return;
  std::vector<double> depths = {reservoir_range(scene.field).top,
                                reservoir_range(scene.field).bottom};
  for (const Block& block : blocks) {
    depths.push_back(reservoir_range(scene.field, block).top);
    depths.push_back(reservoir_range(scene.field, block).bottom);
  }
  const std::vector<Block>& all = scene.field.blocks;
  const auto by_rule = [&](const MixedPlace& at, const auto& of_block) {
    const auto beside = [&](std::size_t block) {  // west of fault f lies block f − 1
      const bool is_there = block < all.size() && reaches(scene, block, at.y) &&
                            reservoir_range(scene.field, all[block]).holds(at.depth, at.side);
      return is_there ? of_block(block) : 0.0;
    };
    return pressure_by_rule(law, beside(fault - 1), beside(fault));
  };
  std::vector<MixedPlace> places;
  for (const double y : middles_along(scene.field, blocks)) {
    for (const double depth : depths) {
      for (const DepthSide side : {DepthSide::above, DepthSide::below})
        places.push_back({y, depth, side});
    }
  }
  check_lowest(
      reader, scene, fault, "rule", places,
      [&](const MixedPlace& at, double time) -> FaultPressureAt {
        const double initial =
            initial_state(scene, -at.depth, at.side).pressure + by_rule(at, [&](std::size_t b) {
              return own_pressure_excess(scene, b, -at.depth, at.side);
            });
        const double change =
            by_rule(at, [&](std::size_t b) { return pressure_change_at(scene.pressure[b], time); });
        return {at.depth, initial + change, initial};
      },
      [](double) {
        return "choose a rule that takes both from the same side, such as \"mean\", or let the "
               "pressures of the blocks fall less";
      });
}

}  // namespace

void check_pressures(SceneReader& reader, const Scene& scene) {
  for (const char* part : {"/geometry", "/materials", "/initial_state"}) {
    if (!reader.has(part) || !reader.sound(part)) return;
  }
  for (std::size_t i = 0; i < scene.pressure.size(); ++i) check_region(reader, scene, i);
  if (!is_body_known(reader, scene)) return;  // faults of a mesh have their places in it
  if (!reader.sound("/faults") || !reader.sound("/fault_pressure")) return;
  const bool mixes = scene.geometry_kind == GeometryKind::field && !scene.pressure_field.is_given();
  for (std::size_t i = 0; i < scene.faults.size(); ++i) {
    check_given(reader, scene, i);
    if (mixes && reader.sound("/stages")) check_mixed(reader, scene, i);
  }
}

}  // namespace faultsim
