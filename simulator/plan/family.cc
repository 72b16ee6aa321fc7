#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/documents/canonical_text.h"
#include "simulator/plan/body_mesh.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

/// The text that a family is the fingerprint of: what the linear bulk depends on. Structs of the
/// scene stand in it as lists of the members that the list of keys says are part of it.
namespace faultsim {
namespace {

template <typename Value>
void append_member(std::string& text, const Value& value) {
  if constexpr (std::is_same_v<Value, PatchShape> || std::is_same_v<Value, RegionShape>) {
    append(text, value != Value());  // an ellipse, a disc
  } else {
    append(text, value);
  }
}

/// A list without the bracket at its end.
template <typename Struct>
void append_members(std::string& text, const Struct& one) {
  char before = '[';
  const auto add = [&](const auto& value) {
    text += std::exchange(before, ',');
    append_member(text, value);
  };
  for_each_key(one, [&](const SceneKey& key, const auto& member) {
    if (!key.is(kFamily)) return;
    if constexpr (requires { member.has_value(); }) {
      if (member) add(*member);
    } else if constexpr (requires(std::string & to) { append(to, member); }) {
      add(member);
    }
  });
}

constexpr auto members = [](std::string& text, const auto& one) {
  append_members(text, one);
  text += ']';
};

/// A function for ObjectText.
template <typename List>
auto lists(const List& all) {
  return [&all](std::string& to) { append_list(to, all, members); };
}

void append_block(std::string& text, const Block& block) {
  append_members(text, block);
  if (block.thickness || block.y_from || block.y_to) {
    text += ',';
    ObjectText own(text);
    if (block.thickness) own.add("thickness", *block.thickness);
    if (block.y_from) own.add("y_from", *block.y_from);
    if (block.y_to) own.add("y_to", *block.y_to);
    own.close();
  }
  text += ']';
}

void append_extent(std::string& text, const FaultExtent& fault) {
  ObjectText own(text);
  if (fault.y_from) own.add("y_from", *fault.y_from);
  if (fault.y_to) own.add("y_to", *fault.y_to);
  if (fault.overshoot) own.add("overshoot", *fault.overshoot);
  own.close();
}

std::vector<double> tops(const std::vector<Layer>& layers, double sign) {
  std::vector<double> depths;
  for (const Layer& layer : layers) depths.push_back(sign * layer.top_depth);
  return depths;
}

void add_field(const FieldMeshSpec& spec, ObjectText& family) {
  family.add("kind", "field");
  family.add("extent", std::array{spec.width, spec.length, spec.depth});
  family.add("layer_tops", tops(spec.layers, 1));
  family.add("layer_materials", spec.layer_materials);
  family.add("reservoir_layer", static_cast<int>(reservoir_index(spec)));
  family.add("sideburden", spec.sideburden_material);
  if (spec.uses_block_length()) family.add("block_length", spec.block_length);
  const double fault_length = spec.uses_fault_length() ? spec.fault_length : 0;
  family.add("fault", std::array{fault_length, spec.fault_overshoot, spec.pivot_depth});
  if (!spec.fault_extents.empty()) {
    family.add("fault_extents",
               [&](std::string& to) { append_list(to, spec.fault_extents, append_extent); });
  }
  family.add("fault_dips", spec.fault_dips);
  family.add("half", spec.half_domain);
  family.add("blocks", [&](std::string& to) { append_list(to, spec.blocks, append_block); });
  if (!spec.plane_strain && fault_length >= spec.length) family.add("fault_ends", "none");
}

void add_box(const BoxMeshSpec& box, ObjectText& family) {
  family.add("kind", "box");
  family.add("from", box.from);
  family.add("to", box.to);
  family.add("layer_tops", tops(box.layers, -1));
  family.add("layer_materials", box.layer_materials);
  family.add("patches", lists(box.patches));
  family.add("regions", lists(box.regions));
  family.add("boundary", lists(box.boundary));
}

void add_mesh(const Scene& scene, ObjectText& family) {
  // Materials by number: their list has no names, which alone would say nothing.
  const auto append_volume = [&](std::string& to, const MeshVolume& volume) {
    to += '[';
    append(to, material_index(scene, volume.material));
    to += ',';
    append(to, volume.compartment);
    to += ']';
  };
  family.add("kind", "mesh");
  family.add(kMeshInText, scene.box.mesh->content->fingerprint);
  family.add("volumes",
             [&](std::string& to) { append_list(to, scene.box.mesh->volumes, append_volume); });
  family.add("faults", mapped(scene.faults, &Fault::name));
  family.add("boundary", lists(scene.box.boundary));
  family.add("surfaces", mapped(scene.box.boundary, &BoundaryCondition::surfaces));
}

/// Absent where nothing creeps: elastic families are those from before there was creep.
void add_creep(const Scene& scene, const CreepPlan& creep, ObjectText& family) {
  const auto viscosity = [&](std::string& to, const Material& m) {
    const bool creeps = m.viscosity && is_used(scene, m);
    append(to, creeps ? *m.viscosity : std::numeric_limits<double>::infinity());
  };
  family.add("creep", [&](std::string& text) {
    ObjectText object(text);
    object.add("viscosities",
               [&](std::string& to) { append_list(to, scene.materials, viscosity); });
    object.add("scheme", scene.numerics.creep_scheme);
    object.add("rungs", creep.rungs);
    object.close();
  });
}

/// Scenes that differ in the values of a surface's parameters alone share it.
std::string family_of_surface(Scene scene, const Plan& plan) {
  const SurfaceRequest surface = std::exchange(scene.numerics.surface, {});
  for (const SurfaceParameter& one : surface.over) set_value(one, one.from, scene);
  std::string text;
  ObjectText family(text);
  const std::string inner = canonical_family(scene, plan);
  family.add("surface", std::string_view(inner));
  family.add("method", kSurfaceMethod);
  family.add("over", [&](std::string& all) {
    append_list(all, surface.over, [](std::string& to, const SurfaceParameter& one) {
      to += concat('[', static_cast<int>(one.kind), ',', one.index, ',');
      append(to, one.from);
      to += ',';
      append(to, one.to);
      to += ']';
    });
  });
  family.add("tolerance", surface.tolerance);
  family.add("most_operators", surface.most_operators);
  if (surface.probes) {
    family.add("chi_tolerance", surface.probes->tolerance);
    family.add("probes", surface.probes->cases);
  }
  family.close();
  return text;
}

}  // namespace

std::string canonical_family(const Scene& scene, const Plan& plan) {
  if (scene.numerics.surface.wanted()) return family_of_surface(scene, plan);
  std::string text;
  ObjectText family(text);
  if (is_meshed(scene)) {
    add_mesh(scene, family);
  } else if (scene.geometry_kind == GeometryKind::field) {
    add_field(field_mesh_spec(scene, plan), family);
  } else {
    add_box(box_mesh_spec(scene, plan), family);
  }
  if (!is_meshed(scene)) family.add("sizes", [&](std::string& to) { members(to, scene.mesh); });
  if (scene.mesh.grades_corners()) {
    family.add("corners", std::array{scene.mesh.corner, scene.mesh.corner_growth});
  }
  family.add("plane_strain", plan.plane_strain);
  family.add("b_bar", scene.numerics.b_bar);
  family.add("materials", lists(scene.materials));
  if (plan.creep.active) add_creep(scene, plan.creep, family);
  family.close();
  return text;
}

}  // namespace faultsim
