#include "simulator/plan/body_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/mesh/structured_grid.h"
#include "simulator/scene/mesh_body.h"

namespace faultsim {
namespace {

/// About how many nodes a fault splits: as many as half of its facets, if they are triangles.
int about_split(const NamedMesh& mesh, int surface) {
  const auto n = std::ranges::count(mesh.facet_group, surface);
  return static_cast<int>(mesh.corners_per_cell == 4 ? n / 2 : n);
}

/// Turns tetrahedra that other programs number the other way round.
void turn_inverted(UncutMesh& body) {
  for (std::size_t first = 0; first < body.corners.size(); first += 4) {
    const auto edge = [&](std::size_t v) -> Eigen::Vector3d {
      return body.nodes[body.corners[first + v]] - body.nodes[body.corners[first]];
    };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0)
      std::swap(body.corners[first + 2], body.corners[first + 3]);
  }
}

}  // namespace

int material_index(const Scene& scene, const std::string& name) {
  return static_cast<int>(&material_named(scene, name) - scene.materials.data());
}

UncutMesh uncut_mesh(const Scene& scene) {
  const BodyMesh& file = *scene.box.mesh;
  const NamedMesh& from = *file.content;
  UncutMesh body;
  body.nodes = from.nodes;
  body.shape = from.corners_per_cell == 4 ? CellShape::tetrahedron : CellShape::hexahedron;
  body.corners = from.cells;
  if (body.shape == CellShape::tetrahedron) turn_inverted(body);
  const std::vector<std::string> compartments = region_names(scene);
  for (const int group : from.cell_group) {
    const MeshVolume& volume = file.volumes[group];
    const auto region = std::ranges::find(compartments, volume.compartment);
    const bool has_region = region != compartments.end();
    body.material.push_back(material_index(scene, volume.material));
    body.region.push_back(has_region ? static_cast<int>(region - compartments.begin()) : -1);
    body.region_fraction.push_back(has_region ? 1 : 0);
  }
  for (const std::string& name : from.facet_groups) body.boundary.push_back({name, {}});
  std::vector<int> fault_of(from.facet_groups.size(), -1);
  std::vector<bool> is_named(from.facet_groups.size(), false);
  for (const BoundaryCondition& condition : scene.box.boundary)
    for (const std::string& name : condition.surfaces)
      is_named[static_cast<std::size_t>(surface_number(from, name))] = true;
  for (const Fault& fault : scene.faults) {
    const int surface = surface_number(from, fault.name);
    if (surface >= 0) fault_of[surface] = static_cast<int>(body.faults.size());
    body.faults.push_back({fault.name, {}});
  }
  for (std::size_t k = 0; k < from.facets.size(); ++k) {
    const auto surface = static_cast<std::size_t>(from.facet_group[k]);
    if (fault_of[surface] >= 0) body.faults[fault_of[surface]].facets.push_back(from.facets[k]);
    if (is_named[surface]) body.boundary[surface].facets.push_back(from.facets[k]);
  }
  return body;
}

Mesh body_mesh(const Scene& scene) {
  Mesh mesh = cut(uncut_mesh(scene), scene.box.mesh->name);
  refuse_bad_cells(mesh);
  return mesh;
}

GridShape shape_of_mesh(const Scene& scene) {
  const BodyMesh& file = *scene.box.mesh;
  const auto n_nodes =
      static_cast<double>(file.content->nodes.size()) + static_cast<double>(file.n_sides);
  const int side = std::max(2, static_cast<int>(std::lround(std::cbrt(n_nodes))));
  GridShape shape;
  shape.n_lines = {side, side, side};
  for (const Fault& fault : scene.faults) {
    const double n_split = about_split(*file.content, surface_number(*file.content, fault.name));
    const int edge = std::clamp(static_cast<int>(std::lround(std::sqrt(n_split))), 1, side);
    const int middle = side / 2, from = (side - edge) / 2;
    shape.faults.push_back({{{{middle, middle + 1}, {from, from + edge}, {from, from + edge}}},
                            n_split / (edge * edge)});
  }
  return shape;
}

}  // namespace faultsim
