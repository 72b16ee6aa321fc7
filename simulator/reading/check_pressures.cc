#include <algorithm>
#include <cmath>
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
  if (scene.geometry_kind == GeometryKind::field) {
    const DepthInterval layer = reservoir_range(scene.field);
    const DepthInterval reservoir = reservoir_range(scene.field, scene.field.blocks[region]);
    const bool is_uniform = scene.field.blocks[region].overpressure.has_value();
    std::vector<Place> places = {{reservoir.top, DepthSide::below}};
    for (const double jump : {layer.top, layer.bottom}) {
      if (is_uniform) continue;
      if (jump > reservoir.top && jump < reservoir.bottom) {
        places.push_back({jump, DepthSide::below});
      }
    }
    return places;
  }
  const PressureRegion& box = scene.box.regions[region];
  const bool disc = box.shape == RegionShape::disc;
  const double top = disc ? box.center[2] + 0.5 * box.thickness : box.to[2];
  const double bottom = disc ? box.center[2] - 0.5 * box.thickness : box.from[2];
  return {{-std::min(top, scene.box.to[2]), DepthSide::below},
          {-std::max(bottom, scene.box.from[2]), DepthSide::above}};
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

/// Where a key of a fault's pressure is given.
std::string place_of(const SceneReader& reader, std::size_t fault, const std::string& key) {
  const std::string own = element("/faults", fault) + "/fault_pressure/" + key;
  return reader.has(own) ? own : "/fault_pressure/" + key;
}

/// Where the pressure of a fault is lowest in the first step in which it falls below zero.
struct LowestPressure {
  double depth = 0, pressure = 0, initial = 0;
  std::size_t step = 0;
};

void report(SceneReader& reader, const Scene& scene, std::size_t fault, const std::string& pointer,
            const LowestPressure& found, const std::string& cure) {
  const std::vector<StepEnd> steps = step_ends(scene);
  reader.problem(pointer,
                 below_zero("in fault \"" + scene.faults[fault].name + "\"", found.depth,
                            found.pressure, found.step, scene.stages[steps[found.step].stage]),
                 cure);
}

/// By rule `prescribed` or `table`.
void check_given(SceneReader& reader, const Scene& scene, std::size_t fault) {
  const FaultPressure& law = scene.faults[fault].pressure;
  const std::vector<FaultPlace> places = given_pressure_places(scene, fault);
  std::vector initial = mapped(places, [&](const FaultPlace& place) {
    return initial_state(scene, -place.depth, place.side).pressure;
  });
  // Most never get there; only the others are followed step by step.
  const double least = least_given(law);
  const auto safe = [&](double p0) { return !(p0 + least < -kRounding); };
  if (std::ranges::all_of(initial, safe)) return;
  LowestPressure found;
  const std::vector<StepEnd> steps = step_ends(scene);
  for (std::size_t step = 0; step < steps.size() && !(found.pressure < -kRounding); ++step) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double change = given_pressure_change(scene, fault, places[i], steps[step].time);
      if (initial[i] + change < found.pressure)
        found = {places[i].depth, initial[i] + change, initial[i], step};
    }
  }
  if (!(found.pressure < -kRounding)) return;
  const bool is_table = law.rule == FaultPressureRule::table;
  const std::string cure =
      found.initial <= 0 ? "let it act where there is an initial pressure: its depth_window, or "
                           "initial_state"
                         : below_zero_cure(found.initial) + " there";
  report(reader, scene, fault, place_of(reader, fault, is_table ? "csv" : "prescribed"), found,
         cure);
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
  const auto by_rule = [&](double depth, DepthSide side, const auto& of_block) {
    const auto beside = [&](std::size_t block) {  // west of fault f lies block f − 1
      const bool is_there =
          block < all.size() && reservoir_range(scene.field, all[block]).holds(depth, side);
      return is_there ? of_block(block) : 0.0;
    };
    return pressure_by_rule(law, beside(fault - 1), beside(fault));
  };
  LowestPressure found;
  const std::vector<StepEnd> steps = step_ends(scene);
  for (std::size_t step = 0; step < steps.size() && !(found.pressure < -kRounding); ++step) {
    for (const double depth : depths) {
      for (const DepthSide side : {DepthSide::above, DepthSide::below}) {
        const double initial =
            initial_state(scene, -depth, side).pressure + by_rule(depth, side, [&](std::size_t b) {
              return own_pressure_excess(scene, b, -depth, side);
            });
        const double pressure = initial + by_rule(depth, side, [&](std::size_t b) {
                                  return pressure_change_at(scene.pressure[b], steps[step].time);
                                });
        if (pressure < found.pressure) found = {depth, pressure, initial, step};
      }
    }
  }
  if (!(found.pressure < -kRounding)) return;
  report(reader, scene, fault, place_of(reader, fault, "rule"), found,
         "take a rule that takes both from one side, as \"mean\", or let the blocks fall less");
}

}  // namespace

void check_pressures(SceneReader& reader, const Scene& scene) {
  for (const char* part : {"/geometry", "/materials", "/initial_state"}) {
    if (!reader.has(part) || !reader.sound(part)) return;
  }
  for (std::size_t i = 0; i < scene.pressure.size(); ++i) check_region(reader, scene, i);
  if (!reader.sound("/faults") || !reader.sound("/fault_pressure")) return;
  const bool mixes = scene.geometry_kind == GeometryKind::field && !scene.pressure_field.is_given();
  for (std::size_t i = 0; i < scene.faults.size(); ++i) {
    check_given(reader, scene, i);
    if (mixes && reader.sound("/stages")) check_mixed(reader, scene, i);
  }
}

}  // namespace faultsim
