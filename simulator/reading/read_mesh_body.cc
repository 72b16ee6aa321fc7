#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "simulator/gmsh/gmsh_mesh.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_body.h"
#include "simulator/reading/read_keys.h"
#include "simulator/scene/mesh_body.h"

/// Geometry of the kind `mesh`: a file of Gmsh and what its volumes are.
namespace faultsim {
namespace {

/// The file of a mesh, and what its volumes are.
std::optional<BodyMesh> read_mesh_file(SceneReader& reader, const Scene& scene) {
  const std::string at = "/geometry/file", name = reader.text(at);
  if (name.empty()) return std::nullopt;
  const JsonDocument& document = reader.document();
  BodyMesh file;
  file.name = name;
  const FieldPlace place = field_place(document.value, document.source, name);
  try {
    auto content = std::make_shared<const GmshMesh>(read_gmsh(place.path));
    if (content->largest_bend > 0) {
      file.remarks.push_back(concat("has curved cells: their sides are straightened, by up to ",
                                    metres(content->largest_bend)));
    }
    file.content = std::move(content);
  } catch (const InputError& error) {
    reader.table_problems(at, name, error);
    return std::nullopt;
  }
  if (!place.fingerprint.empty() && place.fingerprint != file.content->fingerprint) {
    reader.problem(
        at, "\"" + name + "\" is no longer what it was: the file has changed",
        "put the old file back, or remove its entry under \"fields\" to take the new one");
    return std::nullopt;
  }
  for (const std::string& volume : file.content->cell_groups) {
    const std::string own = "/geometry/volumes/" + pointer_token(volume);
    if (!reader.has(own)) {
      reader.problem("/geometry/volumes",
                     "the volume \"" + volume + "\" of the mesh has no material",
                     "add \"" + volume + "\": { \"material\": ... }");
      continue;
    }
    MeshVolume& one = file.volumes.emplace_back(MeshVolume{volume, "", ""});
    read_keys(reader, own + "/", one);
    reader.require_known(own + "/material", one.material, "material", material_names(scene));
  }
  for (const std::string& named : reader.keys("/geometry/volumes")) {
    reader.require_known("/geometry/volumes/" + pointer_token(named), named,
                         "physical volume of the mesh", file.content->cell_groups);
  }
  return file;
}

}  // namespace

void read_mesh_body(SceneReader& reader, Scene& scene) {
  std::optional<BodyMesh> file = read_mesh_file(reader, scene);
  if (!file) return;
  const bool is_whole = file->volumes.size() == file->content->cell_groups.size();
  scene.box.mesh = std::move(file);
  if (is_whole) describe_mesh(scene.box);
  read_boundary(reader, scene.box);
}

}  // namespace faultsim
