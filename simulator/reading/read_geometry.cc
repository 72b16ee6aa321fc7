#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "simulator/common/ranges.h"
#include "simulator/reading/field_ends.h"
#include "simulator/reading/read_body.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/mesh_body.h"

namespace faultsim {

std::vector<std::string> material_names(const Scene& scene) {
  return mapped(scene.materials, &Material::name);
}

namespace {

std::vector<Layer> read_layers(SceneReader& reader, const Scene& scene) {
  const std::vector<std::string> materials = material_names(scene);
  const auto check = [&](const std::string& at, const Layer& layer,
                         const std::vector<Layer>& above) {
    reader.require_known(at + "material", layer.material, "material", materials);
    if (above.empty() || !(layer.top_depth <= above.back().top_depth)) return;
    reader.problem(at + "top",
                   "the top of layer \"" + layer.name + "\" (" + reader.as_given(at + "top") +
                       ") is not below that of \"" + above.back().name + "\"",
                   "write layers from the surface down");
  };
  return read_list<Layer>(reader, "/geometry/layers", check);
}

void check_neighbours(SceneReader& reader, const std::string& at, const Block& block,
                      const Block& west) {
  const bool overlap = block.from < west.to;
  if (!overlap && !(block.from > west.to)) return;
  reader.problem(at + "from",
                 "block \"" + block.name + "\" begins at " + reader.as_given(at + "from") +
                     (overlap ? ", inside" : ", away from") + " block \"" + west.name +
                     "\", which ends at " + metres(west.to),
                 "write \"" + metres(west.to) + "\": blocks lie side by side from west to east");
}

/// @param length  m, of blocks that do not say where they end along y.
std::vector<Block> read_blocks(SceneReader& reader, double length) {
  const auto check = [&](const std::string& at, Block& block, const std::vector<Block>& west) {
    // Equal, it says nothing, unless a surface goes on to other offsets.
    if (block.mesh_offset == block.offset && !reader.has("/numerics/surface"))
      block.mesh_offset.reset();
    if (block.to <= block.from) {
      reader.problem(at + "to", "block \"" + block.name + "\" ends west of where it begins",
                     "write \"to\" larger than \"from\" (x grows eastwards)");
    }
    if (!west.empty()) check_neighbours(reader, at, block, west.back());
    read_field_ends(reader, at, "block \"" + block.name + "\"", length, block.y_from, block.y_to);
  };
  return read_list<Block>(reader, "/geometry/blocks", check);
}

void read_field(SceneReader& reader, Scene& scene) {
  FieldGeometry& field = scene.field;
  const std::string at = "/geometry/";
  read_keys(reader, at, field);
  field.layers = read_layers(reader, scene);
  std::vector layer_names = mapped(field.layers, &Layer::name);
  if (reader.sound(at + "layers")) {
    reader.require_known(at + "reservoir_layer", field.reservoir_layer, "layer", layer_names);
  }
  reader.require_known(at + "sideburden", field.sideburden, "material", material_names(scene));
  field.blocks = read_blocks(reader, field.block_length);
  const DepthInterval reservoir = reservoir_range(field);
  for (Block& block : field.blocks) {  // that of the layer says nothing
    if (block.thickness == reservoir.bottom - reservoir.top) block.thickness.reset();
  }
  field.pivot_depth = reader.real(at + "pivot_depth", 0.5 * (reservoir.top + reservoir.bottom));
}

void read_components(SceneReader& reader, const std::string& at, BoundaryCondition& condition) {
  if (!reader.has(at + "components")) return;
  condition.components = {false, false, false};
  for (std::size_t i = 0; i < reader.size(at + "components"); ++i) {
    const std::string axis = reader.text(element(at + "components", i));
    for (std::size_t c = 0; c < 3; ++c) {
      if (axis == std::string(1, "xyz"[c])) condition.components[c] = true;
    }
  }
}

void check_tied(SceneReader& reader, const std::string& at, const BoundaryCondition& condition) {
  if (condition.kind != BoundaryKind::tied || !reader.sound(at + "sides")) return;
  for (const Side side : condition.sides) {
    const auto opposite = static_cast<Side>(static_cast<unsigned>(side) ^ 1U);
    if (contains(condition.sides, opposite)) continue;
    reader.problem(at + "sides",
                   concat("side ", to_string(side), " is tied but its opposite is not"),
                   concat("add \"", to_string(opposite), "\" to the same list"));
  }
}

/// The physical surfaces that a condition of a mesh acts on.
void read_surfaces(SceneReader& reader, const std::string& at, const BodyMesh& mesh,
                   std::set<std::string>& taken, BoundaryCondition& condition) {
  for (std::size_t k = 0; k < reader.size(at + "surfaces"); ++k) {
    const std::string place = element(at + "surfaces", k);
    const std::string name = reader.text(place);
    const int surface = surface_number(*mesh.content, name);
    reader.require_known(place, name, "physical surface of the mesh", mesh.content->facet_groups);
    if (surface < 0) continue;
    condition.surfaces.push_back(name);
    if (!taken.insert(name).second) {
      reader.problem(place, "surface \"" + name + "\" has a condition already",
                     "give each surface one condition");
    }
    if (condition.kind == BoundaryKind::roller && !axis_across(*mesh.content, surface)) {
      reader.problem(place, "\"" + name + "\" has a roller, but does not lie across x, y or z",
                     "use \"fixed\", or \"displacement\" with components");
    }
  }
}

void read_sides(SceneReader& reader, const std::string& at, std::set<std::string>& taken,
                BoundaryCondition& condition) {
  for (std::size_t k = 0; k < reader.size(at + "sides"); ++k) {
    const std::string place = element(at + "sides", k);
    const std::string name = reader.text(place);
    const auto side = named<Side>(name);
    if (!side) continue;  // its condition is of no known kind, and refused
    condition.sides.push_back(*side);
    if (!taken.insert(name).second && reader.sound(place)) {
      reader.problem(place, "side " + name + " has a condition already",
                     "give each side one condition");
    }
  }
}

}  // namespace

void read_boundary(SceneReader& reader, BoxGeometry& box) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < reader.size("/geometry/boundary"); ++i) {
    const std::string at = element("/geometry/boundary", i) + "/";
    BoundaryCondition condition;
    read_keys(reader, at, condition);
    if (box.mesh) {
      read_surfaces(reader, at, *box.mesh, taken, condition);
    } else {
      read_sides(reader, at, taken, condition);
      check_tied(reader, at, condition);
    }
    read_components(reader, at, condition);
    if (reader.has(at + "stress")) reader.require_symmetric(at + "stress", condition.stress);
    if (reader.has(at + "table")) condition.table = reader.table(at + "table");
    box.boundary.push_back(condition);
  }
}

namespace {

void read_box(SceneReader& reader, Scene& scene) {
  BoxGeometry& box = scene.box;
  const std::string at = "/geometry/";
  read_keys(reader, at, box);
  box.layers = read_layers(reader, scene);
  const bool has_layers = reader.has(at + "layers");
  if (reader.has(at + "material") == has_layers && reader.sound(at + "material")) {
    reader.problem(has_layers ? at + "material" : "/geometry",
                   has_layers ? "material and layers are both given" : "the box has no material",
                   has_layers ? "remove one of the two" : "add \"material\" or \"layers\"");
  }
  reader.require_known(at + "material", box.material, "material", material_names(scene));
  read_boundary(reader, box);
  box.regions = read_list<PressureRegion>(reader, at + "regions", [](const auto&...) {});
}

}  // namespace

void read_geometry(SceneReader& reader, Scene& scene) {
  const std::string kind = reader.text("/geometry/kind");
  scene.geometry_kind = kind == "field" ? GeometryKind::field : GeometryKind::box;
  if (kind == "field") read_field(reader, scene);
  if (kind == "mesh") read_mesh_body(reader, scene);
  if (kind == "horizons") read_horizons(reader, scene);
  if (kind == "box") read_box(reader, scene);
}

}  // namespace faultsim
