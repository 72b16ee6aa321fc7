#include "simulator/reading/read_scene.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene_schema_text.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/tiers.h"
#include "starter_box_text.h"
#include "starter_field_text.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// What a tier says beyond cell sizes; contradicting it is refused rather than renamed.
void apply_tier_switches(SceneReader& reader, Scene& scene) {
  Numerics& numerics = scene.numerics;
  const Tier* tier = find_tier(scene.tier);
  if (tier == nullptr) return;
  if (tier->plane_strain) {
    if (reader.has("/numerics/plane_strain") && numerics.plane_strain == Switch::off) {
      reader.problem("/numerics/plane_strain",
                     concat("the tier \"", tier->name, "\" is plane strain"),
                     "remove this line or choose the tier \"standard\"");
    }
    numerics.plane_strain = Switch::on;
  }
  if (tier->half_domain && numerics.plane_strain != Switch::on) {
    if (numerics.half_domain == Switch::off) {
      reader.problem("/numerics/half_domain",
                     concat("the tier \"", tier->name,
                            "\" is made for half the domain; the whole domain does not fit"),
                     "remove this line or choose the tier \"standard\"");
    }
    numerics.half_domain = Switch::on;
  }
}

/// An operator per step length is cheap in a plane; in 3D it takes gigabytes that must stay.
void default_creep_refinements(SceneReader& reader, Numerics& numerics) {
  if (reader.has("/numerics/creep_refinements")) return;
  numerics.creep_refinements = numerics.plane_strain == Switch::on ? 4 : 1;
}

/// Without a tier the sizes must be there; they are guessed from nothing.
void require_cell_sizes(SceneReader& reader, bool is_box, bool plane_strain) {
  if (!reader.sound("/mesh")) return;
  std::string missing;
  std::string example;
  for (const char* size : {"strike", "dip", "normal"}) {
    const std::string name = std::string("\"") + size + "\"";
    if (reader.has(std::string("/mesh/") + size)) continue;
    if (plane_strain && std::string(size) == "strike") continue;
    missing += (missing.empty() ? "" : ", ") + name;
    example += (example.empty() ? "" : ", ") + name + ": \"20 m\"";
  }
  if (missing.empty()) return;
  const bool has_mesh = reader.has("/mesh");
  reader.problem(
      has_mesh ? "/mesh" : "", "the mesh has no cell size " + missing,
      (has_mesh ? "add for example " + example : "add for example \"mesh\": { " + example + " }") +
          (is_box ? "" : ", or choose a tier: screening, standard or reference"));
}

/// The cells of a mesh are there; those of horizons have a size at the faults, and have been made.
void refuse_cell_sizes(SceneReader& reader, Scene& scene) {
  default_creep_refinements(reader, scene.numerics);
  const bool is_built = is_of_horizons(reader);
  const char* why = is_built ? "has no effect: bodies of horizons have their sizes in \"mesh\""
                             : "has no effect: the cells are those of the mesh";
  if (reader.has("/tier")) reader.problem("/tier", why, "remove it");
  if (!is_built) {
    if (reader.has("/mesh")) reader.problem("/mesh", why, "remove it");
    return;
  }
  for (const std::string& key : reader.keys("/mesh")) {
    if (contains(std::vector<std::string>{"strike", "growth", "largest"}, key)) continue;
    reader.problem("/mesh/" + key, "has no effect in a body of horizons",
                   "remove it; strike is the size of cells at the faults");
  }
  const bool is_readable = !reader.has("/mesh") || reader.find("/mesh")->is_object();
  if (!reader.has("/mesh/strike") && is_readable) {
    reader.problem(reader.has("/mesh") ? "/mesh" : "", "the cells have no size at the faults",
                   "add \"mesh\": { \"strike\": \"50 m\" }");
  }
}

}  // namespace

void read_mesh(SceneReader& reader, Scene& scene) {
  read_keys(reader, "/numerics/", scene.numerics);
  for_each_creep_key(scene.numerics, key_reader(reader, places_in(reader, "/numerics/")));
  scene.tier = reader.text("/tier", "custom");
  if (is_of_mesh(reader)) return refuse_cell_sizes(reader, scene);
  const bool is_box = scene.geometry_kind == GeometryKind::box;
  if (is_box && scene.tier != "custom" && reader.sound("/geometry/kind")) {
    reader.problem("/tier", "tiers are for a field, this is a box",
                   "remove it and give \"mesh\" with strike, dip and normal");
    return;
  }
  if (is_box && scene.numerics.half_domain == Switch::on) {
    reader.problem("/numerics/half_domain",
                   "half domains are for a field, a box is modelled as given",
                   "remove this line; for half a box put a roller on its plane of symmetry");
  }
  MeshSizes& mesh = scene.mesh;
  mesh = {.strike = kNaN, .dip = kNaN, .normal = kNaN};
  const Tier* tier = find_tier(scene.tier);
  if (tier != nullptr) mesh = tier->sizes;
  read_keys(reader, "/mesh/", mesh);
  for (const char* key : {"corner", "corner_growth"}) {
    const std::string at = std::string("/mesh/") + key;
    if (is_box && reader.has(at)) {
      reader.problem(at, "has no effect in a box, which has no compartment corners",
                     "remove it and give fine_margin, or a smaller dip");
    }
  }
  constexpr double kSmallest = 1e-3;  // m, as of the other sizes; 0 is none
  if (mesh.largest > 0 && mesh.largest < kSmallest) {
    reader.problem("/mesh/largest", reader.as_given("/mesh/largest") + " is below 1 mm",
                   "write the largest cell size, at least 1 mm, or 0 m for no limit");
  }
  if (mesh.corner > 0 && mesh.corner < kSmallest) {
    reader.problem("/mesh/corner", reader.as_given("/mesh/corner") + " is below 1 mm",
                   "write a size of at least 1 mm, or 0 m for cells of `dip` everywhere");
  }
  apply_tier_switches(reader, scene);
  default_creep_refinements(reader, scene.numerics);
  if (scene.tier != "custom") return;
  const bool plane_strain = scene.numerics.plane_strain == Switch::on;
  require_cell_sizes(reader, is_box, plane_strain);
  // One cell along y: its size says nothing and must not tell equal cases apart.
  if (plane_strain && !reader.has("/mesh/strike")) mesh.strike = tiers().front().sizes.strike;
}

void read_materials(SceneReader& reader, Scene& scene) {
  for (const std::string& name : reader.keys("/materials")) {
    const std::string at = "/materials/" + pointer_token(name) + "/";
    if (name.empty()) {
      reader.problem("/materials/", "a material has an empty name", "give it a name");
      continue;
    }
    Material material;
    material.name = name;
    read_keys(reader, at, material);
    scene.materials.push_back(material);
  }
}

void read_initial_state(SceneReader& reader, Scene& scene) {
  const std::string at = "/initial_state/";
  InitialState& state = scene.initial;
  read_keys(reader, at, state);
  if (state.pressure_from == InitialPressure::first_report && !reader.has("/pressure_field")) {
    reader.problem(at + "pressure_from",
                   "there is no \"pressure_field\" whose report it could take",
                   "add one, or remove this line");
  }
  if (!state.tensor) return;
  reader.require_symmetric(at + "tensor", *state.tensor);
  for (const char* key : {"vertical_stress", "vertical_stress_gradient", "ratio_across",
                          "ratio_along", "initial_biot"}) {
    if (reader.has(at + key)) {
      reader.problem(at + key, "has no effect alongside \"tensor\"", "remove one of the two");
    }
  }
}

void read_output(SceneReader& reader, Scene& scene) {
  OutputRequest& output = scene.output;
  read_keys(reader, "/output/", output);
  output.observation_points =
      read_list<ObservationPoint>(reader, "/output/observation_points", [](const auto&...) {});
}

const Schema& scene_schema() {
  static const Schema schema(json::parse(embedded::scene_schema_text));
  return schema;
}

void relate_parts(SceneReader& reader, const std::vector<Problem>& problems, Scene& scene) {
  check_geometry(reader, scene);
  check_fault_tables(reader, scene);
  check_pressures(reader, scene);
  check_creep(reader, scene);
  check_flow_loads(scene);
  check_turning_points(reader, scene);
  if (!problems.empty()) return;
  add_remarks(reader, scene);
  remark_fault_tables(reader, scene);
}

Scene read_scene(const JsonDocument& document, std::vector<Problem>& problems) {
  SceneReader reader(document, problems);
  Scene scene;
  scene.title = reader.text("/title");
  if (!document.value.is_object()) return scene;
  read_materials(reader, scene);
  read_geometry(reader, scene);
  read_mesh(reader, scene);
  read_initial_state(reader, scene);
  read_flow_loads(reader, scene);
  read_faults(reader, scene);
  take_first_report(reader, scene);
  read_loading(reader, scene);
  scene.n_table_remarks = scene.remarks.size();
  read_output(reader, scene);
  read_surface(reader, scene);
  relate_parts(reader, problems, scene);
  if (problems.empty()) find_openings(scene);
  std::ranges::stable_sort(problems, {}, &Problem::line);
  return scene;
}

Scene read_scene(const JsonDocument& document) {
  std::vector<Problem> problems;
  Scene scene = read_scene(document, problems);
  if (!problems.empty()) throw InputError(document.source, problems);
  return scene;
}

std::string starter_scene(const std::string& kind) {
  if (kind == "field") return std::string(embedded::starter_field_text);
  if (kind == "box") return std::string(embedded::starter_box_text);
  throw InputError("init", "there is no starter scene \"" + kind + "\"",
                   "choose \"field\" or \"box\"");
}

}  // namespace faultsim
