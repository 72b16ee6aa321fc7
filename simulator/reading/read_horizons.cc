#include <algorithm>
#include <deque>
#include <iomanip>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/ranges.h"
#include "simulator/horizons/build_body.h"
#include "simulator/mesh/uncut_mesh.h"
#include "simulator/reading/fault_places.h"
#include "simulator/reading/read_body.h"
#include "simulator/reading/read_layered_body.h"
#include "simulator/scene/mesh_body.h"

/// Geometry of the kind `horizons`: a body is built of its keys, and stands in the scene as a mesh.
namespace faultsim {
namespace {

/// Whether all is sound that a body is built of; of faults their names and places alone.
bool is_buildable(const SceneReader& reader) {
  if (!reader.sound("/geometry") || !reader.sound("/mesh") || !reader.has("/mesh/strike"))
    return false;
  for (std::size_t i = 0; i < reader.size("/faults"); ++i) {
    const std::string at = element("/faults", i);
    const bool has_place = reader.has(at + "/trace") || reader.has(at + "/surface");
    if (!reader.sound(at + "/name") || !has_place) return false;
    for (const std::string_view key : place_keys("horizons"))
      if (!reader.sound(at + "/" + std::string(key))) return false;
  }
  return true;
}

/// All that a built body depends on, as a short text.
std::string key_of(const SceneReader& reader, const std::string& tables) {
  std::string text = fingerprint(tables) + "\n";
  for (const char* member : {"/geometry", "/mesh"}) {
    if (const nlohmann::json* value = reader.find(member)) text += value->dump() + "\n";
  }
  for (std::size_t i = 0; i < reader.size("/faults"); ++i) {
    const std::string at = element("/faults", i);
    text += reader.text(at + "/name") + "\n";
    for (const std::string_view key : place_keys("horizons")) {
      const nlohmann::json* value = reader.find(at + "/" + std::string(key));
      text += (value == nullptr ? "-" : value->dump()) + "\n";
    }
  }
  return fingerprint(text);
}

struct Volumes {
  std::vector<MeshVolume> all;
  std::vector<int> of_cell;
};

/// Rock of one layer, in a compartment or in none.
Volumes volumes_of(const BodyOfKeys& keys, const horizons::BuiltBody& built) {
  std::map<std::pair<int, int>, int> numbers;  // by layer and compartment, −1: none
  std::vector<std::pair<int, int>> of_cell;
  for (std::size_t cell = 0; cell < built.layer.size(); ++cell) {
    const int layer = built.layer[cell], compartment = built.compartment[cell];
    const bool is_in = compartment >= 0 && keys.body.compartments[compartment].region[layer] >= 0;
    of_cell.emplace_back(layer, is_in ? compartment : -1);
    numbers.try_emplace(of_cell.back(), 0);
  }
  Volumes volumes;
  for (auto& [place, number] : numbers) {
    const LayerRock& rock = keys.rocks[place.first];
    number = static_cast<int>(volumes.all.size());
    if (place.second < 0) {
      volumes.all.push_back({rock.name, rock.outside, ""});
    } else {
      const std::string& name = keys.body.compartments[place.second].name;
      volumes.all.push_back({rock.name + " in " + name, rock.material, name});
    }
  }
  for (const auto& place : of_cell) volumes.of_cell.push_back(numbers.at(place));
  return volumes;
}

std::shared_ptr<const NamedMesh> named_mesh(const horizons::BuiltBody& built,
                                            const Volumes& volumes) {
  auto mesh = std::make_shared<NamedMesh>();
  mesh->nodes = built.mesh.nodes;
  mesh->corners_per_cell = 4;
  mesh->cells = built.mesh.corners;
  mesh->cell_group = volumes.of_cell;
  mesh->cell_groups = mapped(volumes.all, &MeshVolume::name);
  for (const auto* list : {&built.mesh.boundary, &built.mesh.faults}) {
    for (const FacetGroup& group : *list) {
      mesh->facet_group.insert(mesh->facet_group.end(), group.facets.size(),
                               static_cast<int>(mesh->facet_groups.size()));
      mesh->facets.insert(mesh->facets.end(), group.facets.begin(), group.facets.end());
      mesh->facet_groups.push_back(group.name);
    }
  }
  mesh->fingerprint = fingerprint_of(*mesh);
  return mesh;
}

std::vector<std::string> remarks_of(const horizons::BuiltBody& built) {
  std::vector<std::string> remarks;
  if (built.n_slivers > 0) {
    std::ostringstream quality;
    quality << std::setprecision(2) << built.smallest_sicn;
    const Eigen::Vector3d& at = built.worst_place;
    remarks.push_back(concat(
        "has ", counted(built.n_slivers, "flat cell", "flat cells"), " of ", built.mesh.n_cells(),
        ", of quality below 0.1 (1 is regular), the worst ", quality.str(), " at x ",
        metres(at.x()), ", y ", metres(at.y()), ", z ", metres(at.z())));
  }
  if (built.n_snapped > 0) {
    remarks.push_back(
        concat("has ", counted(built.n_snapped, "place", "places"),
               " where the horizons on both sides of a fault are joined, as they differ "
               "by less than 0.12 of a cell (0.03 where the throw is that of "
               "points)"));
  }
  return remarks;
}

/// A box of the mesh, without conditions on its boundary.
BoxGeometry build(const BodyOfKeys& keys, const std::string& source) {
  const horizons::BuiltBody built = horizons::build_body(keys.body, source);
  Volumes volumes = volumes_of(keys, built);
  BoxGeometry box;
  BodyMesh& mesh = box.mesh.emplace();
  mesh.content = named_mesh(built, volumes);
  mesh.volumes = std::move(volumes.all);
  mesh.remarks = remarks_of(built);
  describe_mesh(box);
  return box;
}

/// The last bodies: cases of a campaign that change strengths or pressures share one.
class LastBodies {
 public:
  std::optional<BoxGeometry> find(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    const auto at = std::ranges::find(kept_, key, &Kept::first);
    return at == kept_.end() ? std::nullopt : std::optional(at->second);
  }
  void keep(const std::string& key, const BoxGeometry& body) {
    constexpr std::size_t kMost = 4;
    const std::scoped_lock lock(mutex_);
    kept_.emplace_front(key, body);
    if (kept_.size() > kMost) kept_.pop_back();
  }

 private:
  using Kept = std::pair<std::string, BoxGeometry>;
  std::mutex mutex_;
  std::deque<Kept> kept_;
};

std::optional<BoxGeometry> body_of(SceneReader& reader, const BodyOfKeys& keys) {
  static LastBodies last;
  const std::string key = key_of(reader, keys.tables);
  std::optional<BoxGeometry> body = last.find(key);
  if (body) return body;
  try {
    body = build(keys, reader.document().source);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems())
      reader.problem(scene_pointer(reader, problem.pointer), problem.what, problem.cure);
    return std::nullopt;
  }
  last.keep(key, *body);
  return body;
}

/// Sides and base slide along themselves; the top is free.
void hold_sides(BoxGeometry& box) {
  BoundaryCondition& held = box.boundary.emplace_back();
  held.surfaces = {"x-", "x+", "y-", "y+", "z-"};
  held.kind = BoundaryKind::roller;
}

/// Names of faults stand beside those of the sides.
void refuse_names_of_sides(SceneReader& reader) {
  for (std::size_t i = 0; i < reader.size("/faults"); ++i) {
    const std::string at = element("/faults", i) + "/name", name = reader.text(at);
    if (!named<Side>(name)) continue;
    reader.problem(at, "\"" + name + "\" is the name of a side of the body",
                   "give the fault another name");
  }
}

}  // namespace

void read_horizons(SceneReader& reader, Scene& scene) {
  const BodyOfKeys keys = read_layered_body(reader, scene);
  refuse_names_of_sides(reader);
  if (!is_buildable(reader)) return;
  std::optional<BoxGeometry> body = body_of(reader, keys);
  if (!body) return;
  scene.box = *std::move(body);
  scene.box.mesh->name = reader.document().source;
  if (reader.has("/geometry/boundary")) return read_boundary(reader, scene.box);
  hold_sides(scene.box);
}

}  // namespace faultsim
