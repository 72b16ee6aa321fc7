#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/reading/scene_reader.h"

/// What a scene says in vain or leaves out: input that changes nothing is never passed over. Only
/// what was given makes a remark, and not where it says what holds anyway.
namespace faultsim {
namespace {

bool is_zero(const PressureHistory& history) {
  const auto& changes = history.pressure_change;
  return history.scale == 0 ||
         std::ranges::all_of(changes, [](double change) { return change == 0; });
}

bool is_all(const auto& values, double value) {
  return !values.empty() && std::ranges::all_of(values, [&](double each) { return each == value; });
}

bool has_profile(const Fault& fault) { return fault.pressure.rule == FaultPressureRule::table; }

bool prescribes(const Fault& fault) {
  return fault.pressure.rule == FaultPressureRule::prescribed && fault.pressure.prescribed != 0;
}

class IdleInputs {
 public:
  IdleInputs(const SceneReader& reader, Scene& scene)
      : reader_(reader), scene_(scene), is_field_(scene.geometry_kind == GeometryKind::field) {}

  void find() {
    materials();
    temperatures();
    geometry();
    body_mesh();
    boundaries();
    mesh_and_creep();
    initial_state();
    friction();
    fault_pressure();
    windows();
    loading();
    nothing_at_all();
  }

 private:
  void idle(const std::string& pointer, const std::string& why) {
    if (!pointer.empty() && !reader_.has(pointer)) return;
    scene_.remarks.push_back({pointer, "has no effect: " + why});
  }

  /// What is not taken of a mesh as it is.
  void body_mesh() {
    if (!is_meshed(scene_)) return;
    const char* place = reader_.has("/geometry/file") ? "/geometry/file" : "/geometry";
    for (const std::string& remark : scene_.box.mesh->remarks)
      scene_.remarks.push_back({place, remark});
  }

  /// The material whose pressure the blocks change; "" where any may be in a region.
  std::string depleted_material() const {
    return is_field_ ? scene_.field.layers[reservoir_index(scene_.field)].material : "";
  }

  void materials() {
    const std::string depleted = depleted_material();
    const bool no_region = !is_field_ && scene_.box.regions.empty();
    for (const Material& material : scene_.materials) {
      const std::string at = "/materials/" + pointer_token(material.name);
      if (!is_used(scene_, material)) {
        idle(at, "nothing is made of it");
        continue;
      }
      // 1 is what is meant where nothing is said.
      const bool never_changes = no_region || (!depleted.empty() && depleted != material.name);
      if (never_changes && material.biot != 1) idle(at + "/biot", "no pressure changes in it");
      if (material.thermal_expansion != 0 && (never_changes || !has_temperatures()))
        idle(at + "/thermal_expansion", "no temperature changes in it");
      const bool rests = scene_.initial.viscous_layers == ViscousLayers::lithostatic;
      if (scene_.numerics.creep == Switch::off && !rests) {
        idle(at + "/viscosity", "/numerics/creep is off");
      }
    }
  }

  bool has_temperatures() const {
    return scene_.temperature_field.is_given() || !scene_.temperature.empty();
  }

  /// Whether a temperature changes in a material that expands.
  bool heats() const {
    if (!has_temperatures()) return false;
    const std::string only = depleted_material();
    return std::any_of(scene_.materials.begin(), scene_.materials.end(), [&](const Material& m) {
      return m.thermal_expansion > 0 && (only.empty() ? is_used(scene_, m) : m.name == only);
    });
  }

  void temperatures() {
    if (!has_temperatures() || heats()) return;
    const std::string only = depleted_material();
    const std::string why =
        only.empty() ? "no material has a thermal_expansion"
                     : "the regions are made of \"" + only + "\", which has no thermal_expansion";
    idle("/temperature_field", why);
    for (std::size_t i = 0; i < scene_.stages.size(); ++i)
      idle(element("/stages", i) + "/temperature_change", why);
  }

  bool is_heated(std::size_t region) const {
    return heats() &&
           std::ranges::any_of(scene_.temperature, [&](const TemperatureHistory& history) {
             return static_cast<std::size_t>(history.region) == region;
           });
  }

  void geometry() {
    if (is_field_) return;
    // A region without a history may still say where a prescribed fault pressure acts.
    const bool places = std::ranges::any_of(
        scene_.faults, [](const Fault& f) { return prescribes(f) && !f.pressure.depth_window; });
    for (std::size_t i = 0; !places && !scene_.has_field() && i < scene_.box.regions.size(); ++i) {
      const bool is_scaled_off = scene_.pressure[i].scale == 0;  // said on purpose
      if (!is_zero(scene_.pressure[i]) || is_scaled_off || is_heated(i)) continue;
      idle(element("/geometry/regions", i), "its pressure never changes");
    }
  }

  void boundaries() {
    for (std::size_t i = 0; i < scene_.box.boundary.size(); ++i) {
      const BoundaryCondition& condition = scene_.box.boundary[i];
      const std::string at = element("/geometry/boundary", i);
      const bool is_loaded = acts(condition);
      if (condition.kind == BoundaryKind::stress && is_all(condition.stress, 0)) {
        idle(at + "/stress", "it is zero, which leaves the face as free as without it");
      }
      const std::vector<double>& factor = condition.table.factor;
      if (is_all(factor, 0)) {
        idle(at + "/table", "it is 0 at all times, so that the load never acts");
      } else if (is_all(factor, 1)) {
        idle(at + "/table", "it is 1 at all times, as without a table");
      } else if (!is_loaded) {
        idle(at + "/table", "there is nothing for it to multiply");
      }
    }
  }

  /// Whether the face moves or is loaded.
  static bool acts(const BoundaryCondition& condition) {
    if (is_all(condition.table.factor, 0)) return false;
    if (condition.kind == BoundaryKind::stress) return !is_all(condition.stress, 0);
    if (condition.kind != BoundaryKind::displacement) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = condition.gradient.begin() + 3 * static_cast<long>(i);
      const bool moves = condition.translation[i] != 0 ||
                         std::any_of(row, row + 3, [](double value) { return value != 0; });
      if (condition.components[i] && moves) return true;
    }
    return false;
  }

  void mesh_and_creep() {
    const Numerics& numerics = scene_.numerics;
    const bool plane_strain = numerics.plane_strain == Switch::on;
    if (is_field_) idle("/mesh/fine_margin", "it is for boxes");
    if (plane_strain) idle("/mesh/strike", "plane strain has one cell along strike");
    const bool forced = reader_.text("/numerics/half_domain", "automatic") != "automatic";
    if (plane_strain && forced) {
      idle("/numerics/half_domain", "plane strain has no extent along strike");
    }
    const bool viscous = has_viscous_material(scene_);
    if (!viscous || numerics.creep == Switch::off) {
      const std::string why =
          viscous ? "/numerics/creep is off" : "nothing in the model has a viscosity";
      for (const char* key :
           {"creep_time_step", "creep_refinements", "creep_tolerance", "creep_scheme"}) {
        idle(std::string("/numerics/") + key, why);
      }
    }
    if (numerics.turning_points == TurningPoints::report) {
      idle("/numerics/max_added_steps", "turning points are reported, not added");
    }
    if (!numerics.follow_events) idle("/numerics/max_events", "events are not followed");
  }

  void initial_state() {
    const InitialState& state = scene_.initial;
    if (state.tensor || state.ratio_across != 1 || state.ratio_along != 1) return;
    if (state.initial_biot == 1) return;
    idle("/initial_state/initial_biot", "both stress ratios are 1");
  }

  /// A key of /friction or /fault_pressure, wherever it is given: at the top level it is idle when
  /// no fault takes it from there and makes use of it.
  /// @param keys  that exclude each other: one of the fault's own replaces any at the top level.
  template <typename Uses>
  void shared_key(const std::string& object, const std::vector<std::string>& keys,
                  const std::string& why, const Uses& uses) {
    const auto any_key = [&](const std::string& at) {
      return std::ranges::any_of(keys,
                                 [&](const std::string& key) { return reader_.has(at + key); });
    };
    bool shared_used = false, all_own = true;
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) {
      const std::string own = element("/faults", f) + object + "/";
      const bool used = uses(scene_.faults[f]);
      if (!any_key(own)) {
        all_own = false;
        shared_used = shared_used || used;
        continue;
      }
      for (const std::string& key : keys) {
        if (!used) idle(own + key, why);
      }
    }
    for (const std::string& key : keys) {
      if (shared_used) continue;
      const bool no_fault = scene_.faults.empty();
      idle(object + "/" + key, no_fault  ? "there is no fault"
                               : all_own ? "every fault has its own"
                                         : why);
    }
  }

  void friction() {
    const auto always = [](const Fault&) { return true; };
    const auto weakens = [](const Fault& f) {
      return f.friction.dynamic_friction_angle < f.friction.static_friction_angle;
    };
    const auto coheres = [](const Fault& f) { return f.friction.cohesion > 0; };
    shared_key("/friction", {"friction_angle", "friction_coefficient"}, "", always);
    shared_key("/friction", {"dynamic_friction_angle", "dynamic_friction_coefficient"}, "", always);
    shared_key("/friction", {"cohesion"}, "", always);
    const std::string no_weakening =
        "friction does not weaken: the dynamic value is the static one";
    shared_key("/friction", {"slip_weakening_distance"}, no_weakening, weakens);
    shared_key("/friction", {"law"}, no_weakening, [&](const Fault& f) {
      return weakens(f) || f.friction.weakening == WeakeningLaw::angle;
    });
    shared_key("/friction", {"slip_measure"}, no_weakening, [&](const Fault& f) {
      return weakens(f) || f.friction.slip_measure == SlipMeasure::current;
    });
    shared_key("/friction", {"cohesion_after_opening"}, "there is no cohesion",
               [&](const Fault& f) { return coheres(f) || !f.friction.cohesion_after_opening; });
    shared_key("/friction", {"cohesion_after_slip"}, "there is no cohesion",
               [&](const Fault& f) { return coheres(f) || f.friction.cohesion_after_slip; });
  }

  void fault_pressure() {
    const auto is_fraction = [](const Fault& f) {
      return f.pressure.rule == FaultPressureRule::fraction;
    };
    const auto is_prescribed = [](const Fault& f) {
      return f.pressure.rule == FaultPressureRule::prescribed;
    };
    shared_key("/fault_pressure", {"rule"}, "", [](const Fault&) { return true; });
    shared_key("/fault_pressure", {"fraction"}, "it is for the rule \"fraction\"", is_fraction);
    for (const char* key : {"prescribed", "table", "depth_window"}) {
      shared_key("/fault_pressure", {key}, "it is for the rule \"prescribed\"", is_prescribed);
    }
    shared_key("/fault_pressure", {"csv"}, "it is for the rule \"table\"",
               [](const Fault& f) { return f.pressure.rule == FaultPressureRule::table; });
    shared_key("/fault_pressure", {"table"}, "it is 0 at all times", [](const Fault& f) {
      return !prescribes(f) || !is_all(f.pressure.table.factor, 0);
    });
  }

  /// A prescribed pressure must meet a fault of those that take it from one place. What only the
  /// cells know is found when it runs.
  void windows() {
    std::map<std::string, std::string> missed;  // place -> why, of each fault
    std::set<std::string> met;
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) {
      if (!prescribes(scene_.faults[f])) continue;
      const bool has_window = scene_.faults[f].pressure.depth_window.has_value();
      const std::string at =
          reader_.fault_pressure_key(f, has_window ? "depth_window" : "prescribed");
      const std::string why = why_missed(f);
      if (why.empty()) met.insert(at);
      if (!why.empty()) missed[at] += (missed[at].empty() ? "" : "; ") + why;
    }
    for (const auto& [at, why] : missed) {
      if (met.count(at) == 0) idle(at, why);
    }
  }

  /// Why the prescribed pressure of a fault acts nowhere; "" where it may act.
  std::string why_missed(std::size_t f) const {
    const Fault& fault = scene_.faults[f];
    if (!fault.pressure.depth_window) {
      if (is_field_ || !scene_.box.regions.empty()) return "";
      return "on fault " + fault.name +
             " it acts where a pressure region lies on either side, but there is none: give a "
             "\"depth_window\"";
    }
    const auto [top, base] = depths_of_fault(scene_, f);
    const std::array<double, 2>& window = *fault.pressure.depth_window;
    if (window[0] <= base && window[1] >= top) return "";
    return "fault " + fault.name + " lies between " + in_unit(top, Dimension::length, "m") +
           " and " + in_unit(base, Dimension::length, "m") + " depth";
  }

  void loading() {
    for (const PressureHistory& history : scene_.pressure) {
      const std::string at = "/compartments/" + pointer_token(history.region) + "/";
      const bool empty = is_all(history.pressure_change, 0);
      const std::string why = "the pressure of the region never changes";
      if (empty && history.scale != 1) idle(at + "scale", why);
      if ((empty || history.scale == 0) && history.lag != 0) idle(at + "lag", why);
    }
    for (std::size_t i = 0; i < scene_.stages.size(); ++i) {
      for (const char* key : {"pressure_change", "pressure", "pressure_between"}) {
        replaced_by_csv(element("/stages", i) + "/" + key);
      }
    }
  }

  void replaced_by_csv(const std::string& pointer) {
    if (!reader_.has(pointer)) return;
    const bool by_region = reader_.find(pointer)->is_object();
    bool all = true;
    for (const PressureHistory& history : scene_.pressure) {
      all = all && history.from_csv;
      const std::string inner = pointer + "/" + pointer_token(history.region);
      if (by_region && history.from_csv) idle(inner, "a CSV table replaces it");
    }
    if (!by_region && all) idle(pointer, "CSV tables replace it in all regions");
  }

  void nothing_at_all() {
    const auto& regions = scene_.pressure;
    const auto& faults = scene_.faults;
    const auto& faces = scene_.box.boundary;
    const bool loaded =
        scene_.pressure_field.is_given() || heats() || !std::ranges::all_of(regions, is_zero) ||
        std::ranges::any_of(faults, prescribes) || std::ranges::any_of(faults, has_profile) ||
        std::ranges::any_of(faces, acts);
    // A box without regions may be there for its start; salt moves by itself; what is scaled off is
    // meant so.
    const bool meant = contains(regions, 0, &PressureHistory::scale);
    if (loaded || meant || regions.empty() || has_viscous_material(scene_)) return;
    idle("/stages", "no pressure or temperature changes and no face is moved or loaded");
  }

  const SceneReader& reader_;
  Scene& scene_;
  bool is_field_;
};

/// The load step (from 1) that a time lies in.
std::size_t step_at(const std::vector<StepEnd>& steps, double time) {
  std::size_t step = 0;
  while (step + 1 < steps.size() && steps[step].time < time) ++step;
  return step + 1;
}

void remark_skipped_turns(Scene& scene) {
  constexpr std::size_t kShown = 5;
  const std::vector<TurningPoint> skipped = skipped_turning_points(scene);
  if (skipped.empty()) return;
  const std::vector<StepEnd> steps = step_ends(scene);
  for (std::size_t i = 0; i < std::min(kShown, skipped.size()); ++i) {
    scene.remarks.push_back(
        {"", concat("load step ", step_at(steps, skipped[i].from),
                    " skips a turning point: ", turning_point_text(skipped[i]))});
  }
  if (skipped.size() <= kShown) return;
  scene.remarks.push_back(
      {"", concat("load steps skip ", skipped.size() - kShown, " more turning points")});
}

}  // namespace

void add_remarks(const SceneReader& reader, Scene& scene) {
  IdleInputs(reader, scene).find();
  remark_skipped_turns(scene);
}

}  // namespace faultsim
