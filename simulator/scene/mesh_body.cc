#include "simulator/scene/mesh_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

std::array<double, 3> array_of(const Vector3d& x) { return {x.x(), x.y(), x.z()}; }

Eigen::AlignedBox3d bounds_of_volumes(const NamedMesh& mesh, const std::vector<bool>& counts) {
  const auto n = static_cast<std::size_t>(mesh.corners_per_cell);
  Eigen::AlignedBox3d bounds;
  for (std::size_t cell = 0; cell < mesh.cell_group.size(); ++cell) {
    if (!counts[mesh.cell_group[cell]]) continue;
    for (std::size_t v = 0; v < n; ++v) bounds.extend(mesh.nodes[mesh.cells[n * cell + v]]);
  }
  return bounds;
}

/// Sides of all cells, each once.
long count_sides(const NamedMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kOfTetrahedron = {
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  if (mesh.corners_per_cell != 4) return 0;
  std::vector<std::pair<int, int>> sides;
  sides.reserve(6 * mesh.cell_group.size());
  for (std::size_t cell = 0; cell < mesh.cell_group.size(); ++cell) {
    for (const auto& [a, b] : kOfTetrahedron)
      sides.push_back(std::minmax(mesh.cells[4 * cell + a], mesh.cells[4 * cell + b]));
  }
  std::ranges::sort(sides);
  drop_repeated(sides);
  return std::ssize(sides);
}

/// n dA of a facet, turned so that it points to larger x; of one across x to larger y, or up.
Vector3d turned_area(const NamedMesh& mesh, const std::array<int, 4>& facet) {
  constexpr double kAcross = 1e-3;
  const Vector3d &a = mesh.nodes[facet[0]], &b = mesh.nodes[facet[1]], &c = mesh.nodes[facet[2]];
  Vector3d area = (b - a).cross(c - a) / 2;
  if (facet[3] >= 0) area = (c - a).cross(mesh.nodes[facet[3]] - b) / 2;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(area[k]) > kAcross * area.norm()) return area[k] < 0 ? Vector3d(-area) : area;
  }
  return area;
}

template <typename Function>
void for_each_facet(const NamedMesh& mesh, int surface, const Function& visit) {
  for (std::size_t k = 0; k < mesh.facets.size(); ++k)
    if (mesh.facet_group[k] == surface) visit(mesh.facets[k]);
}

/// Extent of a surface along a direction.
double extent_along(const NamedMesh& mesh, int surface, const Vector3d& direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for_each_facet(mesh, surface, [&](const std::array<int, 4>& facet) {
    for (const int node : facet) {
      if (node < 0) continue;
      low = std::min(low, mesh.nodes[node].dot(direction));
      high = std::max(high, mesh.nodes[node].dot(direction));
    }
  });
  return high - low;
}

}  // namespace

void describe_mesh(BoxGeometry& box) {
  BodyMesh& file = *box.mesh;
  const NamedMesh& mesh = *file.content;
  const Eigen::AlignedBox3d all =
      bounds_of_volumes(mesh, std::vector<bool>(mesh.cell_groups.size(), true));
  box.from = array_of(all.min());
  box.to = array_of(all.max());
  for (const MeshVolume& volume : file.volumes) {
    if (volume.compartment.empty() ||
        contains(box.regions, volume.compartment, &PressureRegion::name))
      continue;
    std::vector<bool> counts;
    for (const MeshVolume& other : file.volumes)
      counts.push_back(other.compartment == volume.compartment);
    const Eigen::AlignedBox3d bounds = bounds_of_volumes(mesh, counts);
    box.regions.push_back(
        {.name = volume.compartment, .from = array_of(bounds.min()), .to = array_of(bounds.max())});
  }
  file.n_sides = count_sides(mesh);
}

int surface_number(const NamedMesh& mesh, const std::string& name) {
  const auto at = std::ranges::find(mesh.facet_groups, name);
  return at == mesh.facet_groups.end() ? -1 : static_cast<int>(at - mesh.facet_groups.begin());
}

PatchGeometry mean_patch(const NamedMesh& mesh, int surface) {
  Vector3d area = Vector3d::Zero(), centre = Vector3d::Zero();
  double total = 0;
  for_each_facet(mesh, surface, [&](const std::array<int, 4>& facet) {
    const Vector3d own = turned_area(mesh, facet);
    const Vector3d middle =
        (mesh.nodes[facet[0]] + mesh.nodes[facet[1]] + mesh.nodes[facet[2]]) / 3;
    area += own;
    centre += own.norm() * middle;
    total += own.norm();
  });
  const Vector3d n = area.normalized();
  PatchGeometry patch;
  patch.center = array_of(centre / total);
  patch.dip_from_vertical = std::asin(std::clamp(n.z(), -1.0, 1.0));
  patch.strike = std::atan2(-n.y(), n.x());
  const Vector3d along(std::sin(patch.strike), std::cos(patch.strike), 0);
  patch.length = extent_along(mesh, surface, along);
  patch.width = extent_along(mesh, surface, n.cross(along));
  return patch;
}

std::optional<std::size_t> axis_across(const NamedMesh& mesh, int surface) {
  constexpr double kFlat = 1e-9;
  std::optional<std::size_t> axis;
  bool is_flat = true;
  for_each_facet(mesh, surface, [&](const std::array<int, 4>& facet) {
    const Vector3d area = turned_area(mesh, facet);
    Eigen::Index largest = 0;
    area.cwiseAbs().maxCoeff(&largest);
    const double off = (area - area[largest] * Vector3d::Unit(largest)).norm();
    is_flat = is_flat && off <= kFlat * area.norm() &&
              (!axis || *axis == static_cast<std::size_t>(largest));
    axis = static_cast<std::size_t>(largest);
  });
  return is_flat ? axis : std::nullopt;
}

}  // namespace faultsim
