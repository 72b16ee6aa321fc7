#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/output/write_result.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kResultFormat = 2;

// One list of fields per struct, shared by writing and reading. Names carry the unit.

template <typename Metrics, typename Visit>
void for_each_field_of_metrics(Metrics& m, Visit&& visit) {
  visit("chi_bar", m.chi_bar);
  visit("chi_max", m.chi_max);
  visit("chi_static_max", m.chi_static_max);
  visit("area_chi_080_m2", m.area_chi_080);
  visit("thickness_chi_080_max_m", m.thickness_chi_080_max);
  visit("thickness_chi_080_mean_m", m.thickness_chi_080_mean);
  visit("slipping_area_m2", m.slipping_area);
  visit("open_area_m2", m.open_area);
  visit("activated_area_m2", m.activated_area);
  visit("activated_length_m", m.activated_length);
  visit("activated", m.activated);
  visit("activation_resolved", m.activation_resolved);
  visit("activated_at_edge", m.activated_at_edge);
  visit("max_slip_m", m.max_slip);
  visit("mean_slip_m", m.mean_slip);
  visit("potency_m3", m.potency);
  visit("moment_nm", m.moment);
  visit("moment_step_nm", m.moment_step);
}

template <typename Counts, typename Visit>
void for_each_field_of_counts(Counts& c, Visit&& visit) {
  visit("newton_iterations", c.newton_iterations);
  visit("active_set_passes", c.active_set_passes);
  visit("sub_steps", c.sub_steps);
  visit("wasted_newton_iterations", c.wasted_newton_iterations);
}

template <typename Creep, typename Visit>
void for_each_field_of_fault_creep(Creep& c, Visit&& visit) {
  visit("normal_min_pa", c.normal_min);
  visit("normal_max_pa", c.normal_max);
  visit("shear_max_pa", c.shear_max);
}

template <typename Creep, typename Visit>
void for_each_field_of_creep(Creep& c, Visit&& visit) {
  visit("time_steps", c.time_steps);
  visit("time_error_pa", c.time_error);
  visit("time_resolved", c.time_resolved);
  visit("faults", c.faults);
}

template <typename Step, typename Visit>
void for_each_field_of_step(Step& s, Visit&& visit) {
  visit("step", s.step);
  visit("stage", s.stage);
  visit("time_s", s.time);
  visit("pressure_change_pa", s.pressure_change);
  visit("outcome", s.outcome);
  visit("reason", s.reason);
  visit("n_stick", s.n_stick);
  visit("n_slip", s.n_slip);
  visit("n_open", s.n_open);
  visit("faults", s.faults);
  visit("observed_m", s.observed);
  visit("creep", s.creep);
  visit("counts", s.counts);
  visit("wall_s", s.seconds);
}

template <typename Sides, typename Visit>
void for_each_field_of_sides(Sides& s, Visit&& visit) {
  visit("region_minus", s.region_minus);
  visit("region_plus", s.region_plus);
  visit("change_minus_pa", s.change_minus);
  visit("change_plus_pa", s.change_plus);
  visit("absolute_minus_pa", s.absolute_minus);
  visit("absolute_plus_pa", s.absolute_plus);
  visit("change_in_fault_pa", s.change_in_fault);
}

template <typename Onset, typename Visit>
void for_each_field_of_onset(Onset& o, Visit&& visit) {
  visit("step", o.step);
  visit("depth_m", o.depth);
  visit("pressures", o.pressures);
}

template <typename Stage, typename Visit>
void for_each_field_of_fault_stage(Stage& s, Visit&& visit) {
  visit("fault", s.fault);
  visit("slips", s.slips);
  visit("activated", s.activated);
  visit("activation_resolved", s.activation_resolved);
  visit("opens", s.opens);
  visit("activation", s.activation);
  visit("opening", s.opening);
  visit("chi_bar", s.chi_bar);
  visit("chi_max", s.chi_max);
  visit("area_chi_080_m2", s.area_chi_080);
  visit("thickness_chi_080_m", s.thickness_chi_080);
  visit("activated_area_m2", s.activated_area);
  visit("slipping_area_m2", s.slipping_area);
  visit("open_area_m2", s.open_area);
  visit("max_slip_m", s.max_slip);
  visit("potency_m3", s.potency);
  visit("moment_nm", s.moment);
  visit("n_events", s.n_events);
  visit("event_moment_nm", s.event_moment);
  visit("event_magnitude_mw", s.event_magnitude);
}

template <typename Stage, typename Visit>
void for_each_field_of_stage(Stage& s, Visit&& visit) {
  visit("stage", s.stage);
  visit("first_step", s.first_step);
  visit("last_step", s.last_step);
  visit("slips", s.slips);
  visit("activated", s.activated);
  visit("activation_resolved", s.activation_resolved);
  visit("opens", s.opens);
  visit("activation_step", s.activation_step);
  visit("activated_fault", s.activated_fault);
  visit("opening_step", s.opening_step);
  visit("opened_fault", s.opened_fault);
  visit("chi_bar", s.chi_bar);
  visit("chi_max", s.chi_max);
  visit("area_chi_080_m2", s.area_chi_080);
  visit("thickness_chi_080_m", s.thickness_chi_080);
  visit("activated_area_m2", s.activated_area);
  visit("slipping_area_m2", s.slipping_area);
  visit("open_area_m2", s.open_area);
  visit("max_slip_m", s.max_slip);
  visit("potency_m3", s.potency);
  visit("moment_nm", s.moment);
  visit("magnitude_if_released_at_once_mw", s.magnitude_if_at_once);
  visit("n_events", s.n_events);
  visit("event_moment_nm", s.event_moment);
  visit("event_magnitude_mw", s.event_magnitude);
  visit("faults", s.faults);
}

template <typename Event, typename Visit>
void for_each_field_of_event(Event& e, Visit&& visit) {
  visit("step", e.step);
  visit("stage", e.stage);
  visit("load_factor_before", e.load_factor_before);
  visit("load_factor_after", e.load_factor_after);
  visit("time_s", e.time);
  visit("fault", e.fault);
  visit("depth_m", e.depth);
  visit("pressures", e.pressures);
  visit("nucleation_length_m", e.nucleation_length);
  visit("slipped_area_m2", e.slipped_area);
  visit("max_slip_m", e.max_slip);
  visit("mean_slip_m", e.mean_slip);
  visit("stress_drop_pa", e.stress_drop);
  visit("potency_m3", e.potency);
  visit("moment_nm", e.moment);
  visit("magnitude_mw", e.magnitude);
  visit("duration_s", e.duration);
  visit("resolved", e.resolved);
  visit("negative_pivots", e.negative_pivots);
  visit("n_lost_cohesion", e.n_lost_cohesion);
  visit("residual_before", e.residual_before);
  visit("residual_after", e.residual_after);
  visit("energy_released_j", e.energy_released);
  visit("energy_dissipated_j", e.energy_dissipated);
  visit("evidence_holds", e.evidence_holds);
}

template <typename Part, typename Visit>
void for_each_field_of_episode(Part& e, Visit&& visit) {
  visit("stage", e.stage);
  visit("fault", e.fault);
  visit("first_step", e.first_step);
  visit("last_step", e.last_step);
  visit("depth_m", e.depth);
  visit("pressures", e.pressures);
  visit("after_recovery", e.after_recovery);
  visit("activated_area_m2", e.activated_area);
  visit("max_slip_m", e.max_slip);
  visit("moment_nm", e.moment);
  visit("magnitude_if_released_at_once_mw", e.magnitude_if_at_once);
}

template <typename Evidence, typename Visit>
void for_each_field_of_reactivation(Evidence& r, Visit&& visit) {
  visit("episode", r.episode);
  visit("after_episode", r.after);
}

template <typename Case, typename Visit>
void for_each_field_of_case(Case& c, Visit&& visit) {
  visit("title", c.title);
  visit("identity", c.identity);
  visit("operator_fingerprint", c.operator_fingerprint);
  visit("numerics_version", c.numerics_version);
  visit("outcome", c.outcome);
  visit("reason", c.reason);
  visit("failed_step", c.failed_step);
  visit("plane_strain", c.plane_strain);
  visit("weakening_resolved", c.weakening_resolved);
  visit("max_nucleation_ratio", c.max_nucleation_ratio);
  visit("max_penetration_m", c.max_penetration);
  visit("pressure_margin_pa", c.pressure_margin);
  visit("regions", c.region_names);
  visit("faults", c.fault_names);
  visit("observations", c.observation_names);
  visit("steps", c.steps);
  visit("stages", c.stages);
  visit("whole", c.whole);
  visit("events", c.events);
  visit("episodes", c.episodes);
  visit("unexpected", c.unexpected);
  visit("counts", c.counts);
  visit("warnings", c.warnings);
  visit("wall_s", c.seconds);
}

/// Sends a struct to its list of fields.
template <typename Struct, typename Visit>
void for_each_field(Struct& value, Visit&& visit) {
  using Plain = std::remove_const_t<Struct>;
  if constexpr (std::is_same_v<Plain, FaultMetrics>) for_each_field_of_metrics(value, visit);
  if constexpr (std::is_same_v<Plain, SolveCounts>) for_each_field_of_counts(value, visit);
  if constexpr (std::is_same_v<Plain, StepResult>) for_each_field_of_step(value, visit);
  if constexpr (std::is_same_v<Plain, FaultCreep>) for_each_field_of_fault_creep(value, visit);
  if constexpr (std::is_same_v<Plain, StepCreep>) for_each_field_of_creep(value, visit);
  if constexpr (std::is_same_v<Plain, SidePressures>) for_each_field_of_sides(value, visit);
  if constexpr (std::is_same_v<Plain, FaultOnset>) for_each_field_of_onset(value, visit);
  if constexpr (std::is_same_v<Plain, FaultStageMetrics>)
    for_each_field_of_fault_stage(value, visit);
  if constexpr (std::is_same_v<Plain, Reactivation>) for_each_field_of_reactivation(value, visit);
  if constexpr (std::is_same_v<Plain, StageMetrics>) for_each_field_of_stage(value, visit);
  if constexpr (std::is_same_v<Plain, SlipEvent>) for_each_field_of_event(value, visit);
  if constexpr (std::is_same_v<Plain, Episode>) for_each_field_of_episode(value, visit);
  if constexpr (std::is_same_v<Plain, CaseResult>) for_each_field_of_case(value, visit);
}

struct Writer {
  json& object;

  void operator()(const char* name, double value) const {
    FAULTSIM_DEMAND(!std::isinf(value), name, " is infinite");
    object[name] = std::isnan(value) ? json(nullptr) : json(value);
  }
  void operator()(const char* name, bool value) const { object[name] = value; }
  void operator()(const char* name, int value) const { object[name] = value; }
  void operator()(const char* name, const std::string& value) const { object[name] = value; }
  void operator()(const char* name, Outcome value) const { object[name] = to_string(value); }
  template <typename Value>
  void operator()(const char* name, const std::optional<Value>& value) const {
    if (value) {
      (*this)(name, *value);
    } else {
      object[name] = nullptr;
    }
  }
  template <typename Value>
  void operator()(const char* name, const std::vector<Value>& values) const {
    json list = json::array();
    for (const Value& value : values) {
      json slot;
      Writer{slot}(name, value);
      list.push_back(std::move(slot[name]));
    }
    object[name] = std::move(list);
  }
  template <typename Struct>
  requires std::is_class_v<Struct>
  void operator()(const char* name, const Struct& value) const {
    json fields = json::object();
    for_each_field(value, Writer{fields});
    object[name] = std::move(fields);
  }
};

struct Reader {
  const json& object;

  const json& at(const char* name) const {
    const auto found = object.find(name);
    if (found == object.end()) throw StorageError(concat("the key \"", name, "\" is missing"));
    return *found;
  }
  [[noreturn]] static void refuse(const char* name, const json& value, const char* wanted) {
    throw StorageError(concat("\"", name, "\" is ", value.type_name(), " instead of ", wanted));
  }
  static void read(const char* name, const json& value, double& target) {
    if (!value.is_null() && !value.is_number()) refuse(name, value, "a number");
    target = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  static void read(const char* name, const json& value, bool& target) {
    if (!value.is_boolean()) refuse(name, value, "true or false");
    target = value.get<bool>();
  }
  static void read(const char* name, const json& value, int& target) {
    if (!value.is_number_integer()) refuse(name, value, "an integer");
    const auto number = value.get<std::int64_t>();
    if (!std::in_range<int>(number)) throw StorageError(concat("\"", name, "\" is too large"));
    target = static_cast<int>(number);
  }
  static void read(const char* name, const json& value, std::string& target) {
    if (!value.is_string()) refuse(name, value, "a text");
    target = value.get<std::string>();
  }
  static void read(const char* name, const json& value, Outcome& target) {
    std::string text;
    read(name, value, text);
    target = outcome_from_string(text);
  }
  template <typename Value>
  static void read(const char* name, const json& value, std::optional<Value>& target) {
    target.reset();
    if (value.is_null()) return;
    Value inner{};
    read(name, value, inner);
    target = inner;
  }
  template <typename Value>
  static void read(const char* name, const json& value, std::vector<Value>& target) {
    if (!value.is_array()) refuse(name, value, "an array");
    target.clear();
    for (std::size_t i = 0; i < value.size(); ++i) {
      with_context([&] { return concat("reading ", name, "/", i); },
                   [&] {
                     Value element{};
                     read(name, value[i], element);
                     target.push_back(std::move(element));
                   });
    }
  }
  template <typename Struct>
  requires std::is_class_v<Struct>
  static void read(const char* name, const json& value, Struct& target) {
    if (!value.is_object()) refuse(name, value, "an object");
    for_each_field(target, Reader{value});
  }
  template <typename Value>
  void operator()(const char* name, Value& target) const {
    read(name, at(name), target);
  }
};

}  // namespace

nlohmann::json result_to_json(const CaseResult& result) {
  json document = json::object();
  document["format"] = kResultFormat;
  for_each_field(result, Writer{document});
  return document;
}

CaseResult result_from_json(const nlohmann::json& document) {
  return with_context([] { return "reading a result"; },
                      [&] {
                        if (!document.is_object()) throw StorageError("it is not a JSON object");
                        int format = 0;
                        Reader{document}("format", format);
                        if (format != kResultFormat) {
                          throw StorageError(concat("it has format version ", format,
                                                    "; this program reads ", kResultFormat));
                        }
                        CaseResult result;
                        for_each_field(result, Reader{document});
                        return result;
                      });
}

}  // namespace faultsim
