#include <algorithm>
#include <array>
#include <optional>
#include <ranges>
#include <set>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/words.h"
#include "simulator/documents/canonical_text.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/identity.h"
#include "simulator/scene/scene.h"

/// The resolved scene as text, from the list of its keys (scene.h).
namespace faultsim {
namespace {

template <typename Struct>
concept HasKeys = requires(const Struct& one) {
  for_each_key(one, [](const SceneKey&, const auto&) {});
};

/// Appends values to a text. −0 is 0, and quantities are doubles, so that 1 and 1.0 are the same.
struct Canonical {
  std::string& text;

  template <typename Value>
  void write(const Value& value) {
    append(text, value);
  }
  void write(double value) { append(text, value + 0.0); }
  template <std::ranges::range List>
  requires(!std::is_convertible_v<List, std::string_view>) void write(const List& list) {
    append_list(text, list, [](std::string& to, const auto& one) { Canonical{to}.write(one); });
  }
  void write(const std::vector<Side>& sides) {
    append_list(text, std::set<Side>(sides.begin(), sides.end()),
                [](std::string& to, Side side) { append(to, side); });
  }
  template <typename Value>
  void write(const std::optional<Value>& value) {
    write(*value);
  }
  /// Thousands of numbers: told by the fingerprint of their bits.
  void write(const FaultPressureTable& table) {
    std::vector<double> all = {static_cast<double>(table.place)};
    for (const auto* values : {&table.dip, &table.strike, &table.time, &table.change}) {
      all.push_back(static_cast<double>(values->size()));
      for (const double value : *values) all.push_back(value + 0.0);
    }
    append(text, fingerprint(all.data(), all.size() * sizeof(double)));
  }
  void write(const SurfaceParameter& one) {
    text += '[' + std::to_string(static_cast<int>(one.kind)) + ',' + std::to_string(one.index);
    for (const double end : {one.from, one.to}) {
      text += ',';
      write(end);
    }
    text += ']';
  }
  /// Adds the members that it is called with to an object.
  static auto adder(ObjectText& object) {
    return [&object](const SceneKey& key, const auto& member) {
      if (key.is(kIdle) || key.is(kSilent)) return;
      if constexpr (requires { member.has_value(); }) {
        if (!member) return;
      }
      object.add(key.in_text.empty() ? key.name : key.in_text, [&](std::string& to) {
        if constexpr (requires { words(member); }) {
          if (key.is(kWord)) return append(to, to_string(member));
        }
        Canonical{to}.write(member);
      });
    };
  }

  template <HasKeys Struct>
  void write(const Struct& one) {
    ObjectText object(text);
    for_each_key(one, adder(object));
    object.close();
  }
};

template <typename Value>
std::string text_of(const Value& value) {
  std::string text;
  Canonical{text}.write(value);
  return text;
}

/// Only materials that something is made of: an unused one is a remark.
std::string materials(const Scene& scene) {
  std::string text;
  ObjectText object(text);
  for (const Material& material : scene.materials) {
    if (!is_used(scene, material)) continue;
    object.add(material.name, [&](std::string& to) { Canonical{to}.write(material); });
  }
  object.close();
  return text;
}

std::string geometry(const Scene& scene) {
  return scene.geometry_kind == GeometryKind::field ? text_of(scene.field) : text_of(scene.box);
}

std::string numerics(const Numerics& numerics) {
  std::string text;
  ObjectText object(text);
  const auto add = Canonical::adder(object);
  for_each_key(numerics, add);
  if (numerics.surface.wanted()) add(SceneKey{"surface"}, numerics.surface);
  object.close();
  return text;
}

/// What counts when creep is left out did not include temperatures once, nor tables of fault
/// pressure and faults that are open at the start: scenes without them keep their identity.
int estimate_version(const Scene& scene) {
  const bool has_table = std::ranges::any_of(scene.faults, [](const Fault& fault) {
    return fault.pressure.rule == FaultPressureRule::table;
  });
  if (has_table || scene.opens_at_start) return 3;
  return scene.temperature.empty() ? 1 : 2;
}

/// An elastic scene has no creep to speak of: it keeps the identity from before there was any.
std::string creep(const Scene& scene) {
  std::string text;
  if (!has_viscous_material(scene)) return text;
  ObjectText object(text);
  const auto add = Canonical::adder(object);
  for_each_creep_key(scene.numerics, add);
  const bool is_estimated = scene.numerics.creep == Switch::automatic;
  const int version = is_estimated ? estimate_version(scene) : 1;
  if (version > 1) add(SceneKey{"estimate"}, version);
  object.close();
  return text;
}

/// Where a block's own overpressure and the column's have an edge in common, faults had too much of
/// the column's there once.
std::string block_edge(const Scene& scene) {
  const bool is_column = scene.initial.kind == InitialStressKind::column;
  if (scene.geometry_kind != GeometryKind::field || !is_column || scene.initial.overpressure == 0)
    return "";
  const DepthInterval column = reservoir_range(scene.field);
  const auto shares_edge = [&](const Block& block) {
    const DepthInterval reservoir = reservoir_range(scene.field, block);
    return block.overpressure && (reservoir.inner_side(column.top) != DepthSide::mean ||
                                  reservoir.inner_side(column.bottom) != DepthSide::mean);
  };
  return std::ranges::any_of(scene.field.blocks, shares_edge) ? "2" : "";
}

/// The same of flow results and temperatures: members of the scene, each with a comma before it.
std::string fields(const Scene& scene) {
  std::string text;
  const auto add = [&](const std::string& name, const std::string& value) {
    text += ",\"" + name + "\":" + value;
  };
  if (scene.pressure_field.is_given()) add("pressure_field", text_of(scene.pressure_field));
  if (scene.temperature_field.is_given())
    add("temperature_field", text_of(scene.temperature_field));
  for (const TemperatureHistory& history : scene.temperature)
    add(concat("temperature_", history.region), text_of(std::array{history.time, history.change}));
  return text;
}

std::string identity_under(int numerics_version, const std::string& canonical) {
  return fingerprint(concat("numerics ", numerics_version, "\n", canonical));
}

}  // namespace

std::string CanonicalParts::text() const {
  std::string optional = block_edge.empty() ? "" : "\"block_edge\":" + block_edge + ",";
  if (!creep.empty()) optional += "\"creep\":" + creep + ",";
  return concat("{", optional, "\"faults\":", faults, ",\"format\":1,\"geometry\":", geometry,
                ",\"initial_state\":", initial_state, ",\"materials\":", materials,
                ",\"mesh\":", mesh, ",\"numerics\":", numerics, ",\"pressure\":", pressure, fields,
                ",\"stages\":", stages, "}");
}

void write_parts(const Scene& scene, unsigned sections, CanonicalParts& parts) {
  if ((sections & kFaults) != 0) parts.faults = text_of(scene.faults);
  // The patches of a box are faults, and what a material is used for makes it count.
  const bool has_patches = scene.geometry_kind == GeometryKind::box;
  if ((sections & (kGeometry | (has_patches ? kFaults : 0U))) != 0)
    parts.geometry = geometry(scene);
  if ((sections & (kGeometry | kMaterials)) != 0) parts.materials = materials(scene);
  parts.creep = creep(scene);  // whether something creeps may depend on each of them
  if ((sections & (kGeometry | kInitialState)) != 0) parts.block_edge = block_edge(scene);
  if ((sections & kInitialState) != 0) parts.initial_state = text_of(scene.initial);
  if ((sections & kLoading) != 0) {
    parts.pressure = text_of(scene.pressure);
    parts.stages = text_of(scene.stages);
    parts.fields = fields(scene);
  }
  if (sections != kAll) return;
  parts.mesh = text_of(scene.mesh);
  parts.numerics = numerics(scene.numerics);
}

CanonicalParts canonical_parts(const Scene& scene) {
  CanonicalParts parts;
  write_parts(scene, kAll, parts);
  return parts;
}

std::string canonical_scene(const Scene& scene) { return canonical_parts(scene).text(); }

std::string case_identity(const CanonicalParts& parts) {
  return identity_under(kNumericsVersion, parts.text());
}

std::string case_identity(const Scene& scene) { return case_identity(canonical_parts(scene)); }

bool has_identity(const Scene& scene, const std::string& identity) {
  const std::string canonical = canonical_scene(scene);
  for (int version = kNumericsVersion; version >= 1; --version) {
    if (identity_under(version, canonical) == identity) return true;
  }
  return false;
}

}  // namespace faultsim
