#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/fault_places.h"
#include "simulator/reading/fault_pressure_csv.h"
#include "simulator/reading/field_ends.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/mesh_body.h"

/// Faults: each takes the top-level friction and fault_pressure and overrides them key by key.
namespace faultsim {
namespace {

constexpr double kRightAngle = 1.5707963267948966;
constexpr double kSteepest = kRightAngle / 2;       // 45 deg from the vertical in a box
constexpr double kFlattestField = kRightAngle / 2;  // 45 deg
constexpr double kAngleSlack = 1e-9;                // rad; "90 deg" may come out one bit off

/// Where the value of a key comes from: the fault's own object, else the default one, else "".
class Overrides {
 public:
  Overrides(const SceneReader& reader, const std::string& name, std::size_t fault)
      : reader_(reader),
        own_(element("/faults", fault) + "/" + name),
        shared_("/" + name),
        own_at_(own_ + "/"),
        shared_at_(shared_ + "/"),
        has_own_(reader.has(own_)) {}

  const std::string& own() const { return own_; }
  /// Whether the fault says anything of its own; else all such faults are alike.
  bool has_own() const { return has_own_; }
  /// Pointer to the key where it is given; where it is given nowhere, a pointer to nothing.
  std::string at(const std::string& key) const {
    if (has_own_ && reader_.has(own_ + "/" + key)) return own_ + "/" + key;
    return shared_ + "/" + key;
  }
  /// The places of keys, for key_reader.
  auto places() const {
    return [own = places_in(reader_, own_at_),
            shared = places_in(reader_, shared_at_)](std::string_view key) {
      const KeyPlace place = own(key);
      return place.value != nullptr ? place : shared(key);
    };
  }
  /// Which of two keys that exclude each other counts: one of the fault's own wins.
  std::string at_either(const std::string& a, const std::string& b) const {
    for (const std::string& object : {own_, shared_}) {
      for (const std::string& key : {a, b}) {
        if (reader_.has(object + "/" + key)) return object + "/" + key;
      }
    }
    return "";
  }

 private:
  const SceneReader& reader_;
  std::string own_;
  std::string shared_;
  std::string own_at_, shared_at_;  ///< with a slash.
  bool has_own_;
};

void require_one_of(SceneReader& reader, const std::string& object, const std::string& angle,
                    const std::string& coefficient) {
  if (reader.has(object + "/" + angle) && reader.has(object + "/" + coefficient)) {
    reader.problem(object + "/" + coefficient, angle + " is given too", "remove one of the two");
  }
}

/// The friction angle at pointer, rad, also when it is given as a coefficient.
double angle_at(const SceneReader& reader, const std::string& pointer) {
  if (pointer.empty()) return kNaN;
  return pointer.ends_with("coefficient") ? std::atan(reader.real(pointer)) : reader.real(pointer);
}

void read_weakening(SceneReader& reader, const Overrides& from, CoulombLaw& friction) {
  const std::string dynamic =
      from.at_either("dynamic_friction_angle", "dynamic_friction_coefficient");
  const double static_angle = friction.static_friction_angle;
  friction.dynamic_friction_angle = dynamic.empty() ? static_angle : angle_at(reader, dynamic);
  const std::string fixed = from.at_either("friction_angle", "friction_coefficient");
  if (friction.dynamic_friction_angle > static_angle) {
    reader.problem(dynamic,
                   "the dynamic friction " + reader.as_given(dynamic) +
                       " is larger than the static one, " + reader.as_given(fixed),
                   "write at most the static value: friction weakens with slip");
  }
  const std::string distance = from.at("slip_weakening_distance");
  const bool weakens = friction.dynamic_friction_angle < static_angle;
  friction.slip_weakening_distance = weakens ? reader.real(distance) : 0;
  if (weakens && !reader.has(distance) && reader.sound(dynamic.substr(0, dynamic.rfind('/')))) {
    reader.problem(dynamic,
                   "friction weakens from " + reader.as_given(fixed) + " to " +
                       reader.as_given(dynamic) + " but slip_weakening_distance is missing",
                   "add for example \"slip_weakening_distance\": \"0.02 m\" beside it");
  }
}

CoulombLaw read_friction(SceneReader& reader, const Overrides& from) {
  CoulombLaw friction;
  for (const std::string& object : {std::string("/friction"), from.own()}) {
    if (!from.has_own() && object == from.own()) continue;
    require_one_of(reader, object, "friction_angle", "friction_coefficient");
    require_one_of(reader, object, "dynamic_friction_angle", "dynamic_friction_coefficient");
  }
  for_each_key(friction, key_reader(reader, from.places()));
  const std::string fixed = from.at_either("friction_angle", "friction_coefficient");
  if (fixed.empty() && reader.sound("/friction") && reader.sound(from.own())) {
    reader.problem(reader.has("/friction") ? "/friction" : "/faults", "no friction angle is given",
                   "add \"friction\": { \"friction_angle\": \"30 deg\" } at the top level");
  }
  friction.static_friction_angle = angle_at(reader, fixed);
  read_weakening(reader, from, friction);
  const bool weakens = friction.dynamic_friction_angle < friction.static_friction_angle;
  if (weakens) return friction;
  // Neither law nor measure says anything; equal cases stay equal.
  friction.weakening = WeakeningLaw::angle;
  friction.slip_measure = SlipMeasure::current;
  return friction;
}

/// The table of a fault's pressure, from the scene's own tables or its file.
FaultPressureTable read_profile(SceneReader& reader, const std::string& rule, const std::string& at,
                                const Scene& scene) {
  const std::string name = reader.text(at);
  if (name.empty()) {
    reader.problem(rule, "the rule \"table\" needs a table of pressures over place and time",
                   "add \"csv\": \"fault_pressure.csv\" beside it");
    return {};
  }
  const JsonDocument& document = reader.document();
  FaultPressureCsv csv;
  try {
    csv = parse_fault_pressure_csv(table_text(document.value, document.source, name), name,
                                   start_date(reader, scene));
  } catch (const InputError& error) {
    reader.table_problems(at, name, error);
    return {};
  }
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  if (is_field && csv.table.place == FaultPressureTable::Place::along_dip) {
    reader.problem(at, name + ": along_dip is for patches of a box, which have a centre",
                   "give the depth of the places");
  }
  if (!csv.table.strike.empty() && scene.numerics.half_domain == Switch::on) {
    reader.problem(at, name + " varies along strike, but only half of the domain is modelled",
                   "set /numerics/half_domain to \"off\", or leave along_strike out");
  }
  return csv.table;
}

FaultPressure read_fault_pressure(SceneReader& reader, const Overrides& from, const Scene& scene) {
  FaultPressure pressure;
  for_each_key(pressure, key_reader(reader, from.places()));
  const std::string rule = from.at("rule");
  if (pressure.rule == FaultPressureRule::table)
    pressure.profile = read_profile(reader, rule, from.at("csv"), scene);
  if (pressure.rule != FaultPressureRule::prescribed) return pressure;
  if (!reader.has(from.at("prescribed"))) {
    reader.problem(rule, "the rule \"prescribed\" needs a pressure change",
                   "add for example \"prescribed\": \"-100 bar\" beside it");
  }
  if (reader.has(from.at("table"))) pressure.table = reader.table(from.at("table"));
  if (pressure.depth_window && (*pressure.depth_window)[1] <= (*pressure.depth_window)[0]) {
    reader.problem(from.at("depth_window"), "the window ends above where it begins",
                   "write the top depth, then the bottom depth");
  }
  return pressure;
}

void check_dip(SceneReader& reader, const std::string& at, bool is_box, double dip) {
  const std::string pointer = at + "dip_from_vertical";
  if (!is_box && std::abs(dip) > kFlattestField + kAngleSlack) {
    reader.problem(pointer, reader.as_given(pointer) + " is too far from the vertical for a field",
                   "write a dip from -45 deg to 45 deg");
  }
  const bool is_horizontal = std::abs(std::abs(dip) - kRightAngle) < kAngleSlack;
  if (is_box && std::abs(dip) > kSteepest + kAngleSlack && !is_horizontal) {
    reader.problem(pointer,
                   reader.as_given(pointer) + " is too far from the vertical for the sheared grid",
                   "write a dip from -45 deg to 45 deg or 90 deg, and turn the stress instead");
  }
}

PatchGeometry read_patch(SceneReader& reader, const std::string& at) {
  PatchGeometry patch;
  read_keys(reader, at, patch);
  const bool sound = reader.sound(at.substr(0, at.size() - 1));
  for (const char* key : {"center", "length", "width"}) {
    if (sound && !reader.has(at + key)) {
      reader.problem(at + key, std::string("the fault of a box has no \"") + key + "\"",
                     std::string("add for example \"") + key +
                         (key[0] == 'c' ? "\": [\"0 m\", \"0 m\", \"0 m\"]" : "\": \"1000 m\""));
    }
  }
  return patch;
}

/// The place of a fault of a mesh is that of a surface: its mean plane.
void read_surface_place(SceneReader& reader, const std::string& at, const Fault& fault,
                        Scene& scene) {
  if (!is_meshed(scene)) return;  // what is wrong with the mesh has been said
  const NamedMesh& mesh = *scene.box.mesh->content;
  reader.require_known(at + "name", fault.name, "physical surface of the mesh", mesh.facet_groups);
  const int surface = surface_number(mesh, fault.name);
  scene.box.patches.push_back(surface < 0 ? PatchGeometry{} : mean_patch(mesh, surface));
}

/// Keys that say where a fault is, in bodies of another kind.
void refuse_other_places(SceneReader& reader, const std::string& at) {
  struct Kind {
    std::string_view name, what, cure;
  };
  constexpr std::array<Kind, 4> kKinds = {
      {{"field", "faults of a field lie at the ends of the blocks",
        "remove it; y_from and y_to say how far along strike, overshoot how far beyond reservoirs"},
       {"box", "a fault of a box is a patch",
        "remove it; center, length and width say where it is"},
       {"mesh", "a fault of a mesh lies where its physical surface does", "remove it"},
       {"horizons", "a fault of horizons has a trace",
        "remove it; trace, top and bottom say where it is"}}};
  const auto* const kind = std::ranges::find(kKinds, reader.text("/geometry/kind"), &Kind::name);
  if (kind == kKinds.end()) return;  // said
  const auto place_of = places_in(reader, at);
  for (const std::string_view key : all_place_keys()) {
    if (contains(place_keys(kind->name), key) || place_of(key).value == nullptr) continue;
    reader.problem(at + std::string(key), std::string(kind->what), std::string(kind->cure));
  }
}

/// A list of dips says where a fault of horizons is; the scene's number is of other bodies.
void read_dip_list(SceneReader& reader, const std::string& pointer, Fault& fault) {
  const nlohmann::json* given = reader.find(pointer);
  if (given == nullptr || !given->is_array()) return;
  fault.dip_from_vertical = 0;
  if (is_of_horizons(reader) || is_of_mesh(reader) || !reader.sound(pointer)) return;
  reader.problem(pointer, "a fault of this body has one dip", "write one value");
}

/// How far a fault of a field reaches, where it says so.
FaultExtent read_extent(SceneReader& reader, const std::string& at, const Fault& fault,
                        const FieldGeometry& field) {
  FaultExtent extent;
  read_keys(reader, at, extent);
  read_field_ends(reader, at, "fault \"" + fault.name + "\"", field.fault_length, extent.y_from,
                  extent.y_to);
  if (extent.overshoot == field.fault_overshoot) extent.overshoot.reset();
  return extent;
}

/// The patch of a fault of a box, the mean plane of that of a mesh, the extent of that of a field,
/// whose dip is known.
void read_place(SceneReader& reader, const std::string& at, const Fault& fault, Scene& scene) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  if (is_of_mesh(reader)) {
    read_surface_place(reader, at, fault, scene);
  } else {
    check_dip(reader, at, !is_field, fault.dip_from_vertical);
    if (is_field)
      scene.field.fault_extents.push_back(read_extent(reader, at, fault, scene.field));
    else
      scene.box.patches.push_back(read_patch(reader, at));
  }
  refuse_other_places(reader, at);
}

/// What fault i says, or what is read once for all faults that say nothing.
template <typename Struct, typename Read>
Struct own_or_shared(const SceneReader& reader, const char* name, std::size_t fault,
                     std::optional<Struct>& shared, const Read& read) {
  if (shared && !reader.has(element("/faults", fault) + "/" + name)) return *shared;
  const Overrides from(reader, name, fault);
  const Struct result = read(from);
  if (!from.has_own()) shared = result;
  return result;
}

void check_count(SceneReader& reader, const Scene& scene) {
  const std::size_t wanted = scene.field.blocks.size() + 1;
  if (scene.field.blocks.empty() || scene.faults.size() == wanted) return;
  const bool listed = reader.has("/faults");
  reader.problem(
      listed ? "/faults" : "",
      concat("there are ", scene.faults.size(), " faults for ", scene.field.blocks.size(),
             " blocks"),
      concat("list ", wanted, " faults: one at each end of the row and one between blocks"));
}

}  // namespace

void read_faults(SceneReader& reader, Scene& scene) {
  const bool known_kind = reader.sound("/geometry/kind");
  std::vector<std::string> names;
  std::optional<CoulombLaw> friction;  // of those that say nothing
  std::optional<FaultPressure> pressure;
  for (std::size_t i = 0; i < reader.size("/faults"); ++i) {
    const std::string at = element("/faults", i) + "/";
    Fault fault;
    read_keys(reader, at, fault);
    read_dip_list(reader, at + "dip_from_vertical", fault);
    const std::string own_biot = at + "fault_biot";
    fault.fault_biot = reader.real(reader.has(own_biot) ? own_biot : "/fault_pressure/fault_biot",
                                   fault.fault_biot);
    if (known_kind) read_place(reader, at, fault, scene);
    fault.friction = own_or_shared(reader, "friction", i, friction, [&](const Overrides& from) {
      return read_friction(reader, from);
    });
    fault.pressure = own_or_shared(
        reader, "fault_pressure", i, pressure,
        [&](const Overrides& from) { return read_fault_pressure(reader, from, scene); });
    scene.faults.push_back(fault);
    names.push_back(fault.name);
  }
  reader.require_unique("/faults", "/name", names);
  std::vector<FaultExtent>& extents = scene.field.fault_extents;
  const auto is_common = [](const FaultExtent& one) { return one == FaultExtent(); };
  if (std::ranges::all_of(extents, is_common)) extents.clear();
  if (scene.geometry_kind == GeometryKind::field) check_count(reader, scene);
}

}  // namespace faultsim
