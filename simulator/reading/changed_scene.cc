#include "simulator/reading/changed_scene.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/reading/scene_reader.h"

/// What is read again when members of a document change.
namespace faultsim {
namespace {

using nlohmann::json;

/// Members of a document that can be read without the others, and the section that they say.
constexpr std::array<std::pair<std::string_view, SceneSection>, 8> kSections = {
    {{"materials", kMaterials},
     {"geometry", kGeometry},
     {"initial_state", kInitialState},
     {"faults", kFaults},
     {"friction", kFaults},
     {"fault_pressure", kFaults},
     {"stages", kLoading},
     {"compartments", kLoading}}};

using Members = std::set<std::string, std::less<>>;

/// "" where it is not a pointer to a member.
std::string_view member_of(std::string_view pointer) {
  return pointer.size() < 2 ? "" : pointer.substr(1, pointer.find('/', 1) - 1);
}

/// Pressures that are not given as changes are held against the initial ones.
bool has_absolute_pressures(const json& document) {
  const auto any_has = [&](const char* list, const char* key) {
    const auto found = document.find(list);
    return found != document.end() && std::ranges::any_of(*found, [&](const json& one) {
             return one.is_object() && one.contains(key);
           });
  };
  return document.contains("pressure_csv") || any_has("stages", "pressure") ||
         any_has("compartments", "csv");
}

/// A surface takes what it is over in intervals, so that a scene without one may be beside them.
bool asks_for_surface(const json& document) {
  const auto numerics = document.find("numerics");
  return numerics != document.end() && numerics->is_object() && numerics->contains("surface");
}

/// What a change of the document at hand touches.
struct Touched {
  Members members;                     ///< that differ now.
  std::vector<std::string> values;     ///< pointers to those put in the place of others, or
  bool is_in_place = false;            ///< false: more has changed than these.
  std::vector<std::string> placeless;  ///< pointers that have no place.
};

/// Whether places of faults change, and not their strengths and pressures alone.
bool moves_faults(const Touched& touched) {
  const auto is_strength = [](const std::string& at) {
    return at.find("/friction/") != std::string::npos ||
           at.find("/fault_pressure/") != std::string::npos;
  };
  return touched.members.contains("faults") &&
         !(touched.is_in_place && std::ranges::all_of(touched.values, [&](const std::string& at) {
             return !at.starts_with("/faults/") || is_strength(at);
           }));
}

/// The sections that follow from these members; kAll where the scene must be read whole.
unsigned sections_of(const Touched& touched, const ChangedScene& changed) {
  unsigned sections = 0;
  for (const std::string& name : touched.members) {
    const auto found =
        std::ranges::find(kSections, name, &std::pair<std::string_view, SceneSection>::first);
    if (found == kSections.end()) return kAll;
    sections |= found->second;
  }
  if ((sections & kGeometry) != 0) sections |= kFaults;  // patches of a box are faults
  const bool moves_datum = (sections & (kGeometry | kInitialState)) != 0;
  if (moves_datum && has_absolute_pressures(changed.document.value)) sections |= kLoading;
  const Scene& scene = changed.scene;
  const bool is_mixed =  // what fields, tables and surfaces make of the rest
      scene.has_field() || asks_for_surface(changed.document.value) || scene.n_table_remarks > 0;
  // Where faults are is a part of such a body.
  const json* const kind = value_at(changed.document.value, "/geometry/kind");
  const bool is_of_traces = kind != nullptr && *kind == "horizons" &&
                            ((sections & kGeometry) != 0 || moves_faults(touched));
  // Intervals of a surface over an offset depend on how far faults reach.
  const bool moves_intervals = asks_for_surface(changed.document.value) && moves_faults(touched);
  if (is_of_traces || moves_intervals) return kAll;
  const bool is_small = (sections & ~unsigned{kInitialState | kFaults}) == 0;
  return is_mixed && !is_small ? unsigned{kAll} : sections;
}

/// A reader of the document at hand, with the quantities that are known. Large designs keep them,
/// as most of their values never change.
SceneReader reader_of(const Touched& touched, unsigned sections, Relations relations,
                      ChangedScene& changed, std::vector<Problem>& problems) {
  if (relations == Relations::checked) {
    std::vector<std::string> members;
    for (const auto& [name, section] : kSections) {
      if ((sections & section) != 0) members.emplace_back(name);
    }
    return {changed.document, problems, members};
  }
  if (!touched.is_in_place || changed.known.by_value.empty()) return {changed.document, problems};
  SceneReader reader(changed.document, problems, std::move(changed.known.by_value));
  const bool is_read = std::ranges::all_of(
      touched.values, [&](const std::string& pointer) { return reader.read_again(pointer); });
  if (is_read) return reader;
  const std::vector<std::string> members(touched.members.begin(), touched.members.end());
  return {changed.document, problems, members, std::move(reader.quantities())};
}

/// What initial pressures from a flow result's report were made of, beside the result and blocks.
struct OfReport {
  InitialState initial;
  std::vector<double> dips;
  explicit OfReport(const Scene& scene)
      : initial(scene.initial), dips(mapped(scene.faults, &Fault::dip_from_vertical)) {}
};

/// Whether initial pressures of a scene are what they were, where they are those of a report: means
/// over blocks between faults, above hydrostatic. What is read again says none, and gets them back.
bool keeps_report(const OfReport& before, Scene& scene) {
  const InitialState& old = before.initial;
  InitialState& now = scene.initial;
  if (old.pressure_from != now.pressure_from) return false;
  if (now.pressure_from == InitialPressure::given) return true;
  const auto hydrostatic = [](const InitialState& of) {
    return std::tuple(of.kind, of.gravity, of.water_density, of.water_depth, of.pressure,
                      of.pressure_gradient);
  };
  const bool is_given = now.overpressure != 0 && now.overpressure != old.overpressure;
  if (is_given || hydrostatic(old) != hydrostatic(now) || OfReport(scene).dips != before.dips)
    return false;
  now.overpressure = old.overpressure;
  return true;
}

/// False where there is a problem, or more must be read.
bool read_sections(const Touched& touched, unsigned sections, Relations relations,
                   ChangedScene& changed) {
  std::vector<Problem> problems;
  SceneReader reader = reader_of(touched, sections, relations, changed, problems);
  if (!problems.empty()) return false;
  Scene& scene = changed.scene;
  const OfReport report(scene);
  if ((sections & kMaterials) != 0) {
    scene.materials.clear();
    read_materials(reader, scene);
  }
  if ((sections & kGeometry) != 0) {
    const GeometryKind kind = scene.geometry_kind;
    const std::vector<std::string> regions = region_names(scene);
    scene.field = {};
    scene.box = {};
    read_geometry(reader, scene);
    // Loads are held by the numbers of regions.
    if (scene.geometry_kind != kind || region_names(scene) != regions) return false;
  }
  if ((sections & kInitialState) != 0) {
    scene.initial = {};
    read_initial_state(reader, scene);
  }
  if ((sections & kFaults) != 0) {
    scene.faults.clear();
    scene.box.patches.clear();
    scene.field.fault_extents.clear();
    read_faults(reader, scene);
  }
  if (!keeps_report(report, scene)) return false;
  if ((sections & kLoading) != 0) {
    scene.stages.clear();
    scene.pressure.clear();
    scene.temperature.clear();
    read_loading(reader, scene);
    if (scene.remarks.size() > scene.n_table_remarks) return false;
  }
  scene.remarks.resize(scene.n_table_remarks);
  if (relations == Relations::checked) relate_parts(reader, problems, scene);
  if (problems.empty() && (sections & ~unsigned{kLoading}) != 0) find_openings(scene);
  changed.known.by_value.clear();
  if (relations == Relations::trusted) changed.known.by_value.swap(reader.quantities());
  return problems.empty();
}

/// Whether no value lies at, above or below the place of another.
bool are_apart(const std::vector<PlacedValue>& values) {
  const auto is_in = [](const std::string& inner, const std::string& outer) {
    return inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '/');
  };
  for (auto a = values.begin(); a != values.end(); ++a) {
    const bool meets = std::any_of(values.begin(), a, [&](const PlacedValue& b) {
      return is_in(a->pointer, b.pointer) || is_in(b.pointer, a->pointer);
    });
    if (meets) return false;
  }
  return true;
}

/// Takes the document at hand to the new values.
Touched move_document(const JsonDocument& base, const std::vector<PlacedValue>& values,
                      ChangedScene& changed) {
  json& document = changed.document.value;
  Touched touched;
  const auto put = [&](const PlacedValue& one) {
    if (!put_value(document, one.pointer, one.value)) touched.placeless.push_back(one.pointer);
  };
  const std::vector<PlacedValue>& before = changed.values;
  touched.is_in_place =
      changed.values_are_apart &&
      std::ranges::equal(values, before, [](const PlacedValue& a, const PlacedValue& b) {
        const bool is_word = !a.value.is_structured() && !b.value.is_structured();
        return a.pointer == b.pointer && (is_word || a.value == b.value);
      });
  for (std::size_t i = 0; touched.is_in_place && i < values.size(); ++i) {
    if (values[i].value == before[i].value) continue;
    touched.members.emplace(member_of(values[i].pointer));
    touched.values.push_back(values[i].pointer);
    put(values[i]);
  }
  if (touched.is_in_place) return touched;
  changed.values_are_apart = are_apart(values);
  for (const auto* list : {&before, &values}) {
    for (const PlacedValue& one : *list) touched.members.emplace(member_of(one.pointer));
  }
  json old = json::object();
  for (const std::string& name : touched.members) {
    if (const auto found = document.find(name); found != document.end())
      old[name] = std::move(*found);
    if (const json* member = child_at(base.value, name)) {
      document[name] = *member;
    } else {
      document.erase(name);
    }
  }
  for (const PlacedValue& one : values) put(one);
  // Cases of a family say again what makes it one: such a member may stay as it is.
  std::erase_if(touched.members, [&](const std::string& name) {
    const json *is = child_at(document, name), *was = child_at(old, name);
    return is == nullptr || was == nullptr ? is == was : *is == *was;
  });
  return touched;
}

}  // namespace

std::vector<std::string> change_scene(const JsonDocument& base, std::vector<PlacedValue> values,
                                      Relations relations, ChangedScene& changed,
                                      std::vector<Problem>& problems) {
  const bool was_of_base = std::exchange(changed.is_of_base, false);
  const bool has_members =
      base.value.is_object() &&
      std::ranges::none_of(values, [](const auto& one) { return member_of(one.pointer).empty(); });
  Touched touched;
  unsigned sections = kAll;
  if (was_of_base && has_members) {
    touched = move_document(base, values, changed);
    if (touched.placeless.empty()) sections = sections_of(touched, changed);
  } else {
    changed.document.value = base.value;
    for (const auto& [pointer, value] : values) {
      if (!put_value(changed.document.value, pointer, value)) touched.placeless.push_back(pointer);
    }
  }
  if (!touched.placeless.empty()) return touched.placeless;
  const std::vector<FaultExtent> extents = changed.scene.field.fault_extents;
  if (sections == kAll || !read_sections(touched, sections, relations, changed)) {
    changed.known.by_value.clear();
    std::vector<Problem> found;
    changed.scene = read_scene(changed.document, found);
    problems.insert(problems.end(), found.begin(), found.end());
    if (!found.empty()) return {};
    sections = kAll;
  }
  if (changed.scene.field.fault_extents != extents) sections |= kGeometry;  // it says them
  write_parts(changed.scene, sections, changed.canonical);
  changed.values = std::move(values);
  changed.is_of_base = true;
  return {};
}

}  // namespace faultsim
