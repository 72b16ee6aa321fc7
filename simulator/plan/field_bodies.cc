#include "simulator/plan/field_bodies.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

namespace faultsim {
namespace {

std::vector<MappedCell> bodies_of_blocks(const Scene& scene) {
  std::vector<MappedCell> bodies;
  const int n_blocks = static_cast<int>(scene.field.blocks.size());
  for (int b = 0; b < n_blocks; ++b) {
    const Block& block = scene.field.blocks[b];
    const DepthInterval depths = reservoir_range(scene.field, block);
    const auto x_of = [&](int fault) {
      return std::array{fault_x(scene, fault, depths.top), fault_x(scene, fault, depths.bottom)};
    };
    const std::array<double, 2> west = x_of(b), east = x_of(b + 1);
    const double beside = std::min({kBesideFault, east[0] - west[0], east[1] - west[1]});
    const std::array<double, 2> east_of_west = {west[0] + beside, west[1] + beside},
                                west_of_east = {east[0] - beside, east[1] - beside};
    const StrikeInterval ends = block_ends(scene.field, block);
    const auto slice = [&](const std::array<double, 2>& from, const std::array<double, 2>& to) {
      return within_ends(between_sides(from, to, depths.top, depths.bottom, 1), ends);
    };
    bodies.push_back({.corners = block_corners(scene, static_cast<std::size_t>(b)), .region = b});
    bodies.push_back({.corners = slice(west, east_of_west), .region = n_blocks + b});
    bodies.push_back({.corners = slice(west_of_east, east), .region = n_blocks + b + 1});
  }
  return bodies;
}

MappedCell mapped_cell(const Mesh& mesh, int cell, int region) {
  return {.corners = corners_of_cell(mesh, cell),
          .region = region,
          .fraction = mesh.region_fraction[cell]};
}

std::vector<MappedCell> of_compartments(const Mesh& mesh) {
  std::vector<MappedCell> cells;
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) {
    if (mesh.region[c] >= 0) cells.push_back(mapped_cell(mesh, c, mesh.region[c]));
  }
  return cells;
}

/// Cells of compartments first.
std::vector<MappedCell> bodies_of_box(const Scene& scene, const Plan& plan) {
  const Mesh mesh = scene_mesh(scene, plan);
  std::vector<MappedCell> bodies = of_compartments(mesh);
  for (std::size_t f = 0; f < mesh.faults.size(); ++f) {
    std::set<int> beside;
    for (const FaultFace& face : mesh.faults[f].faces)
      beside.insert({face.minus_cell, face.plus_cell});
    for (const int c : beside) {
      if (mesh.region[c] >= 0)
        bodies.push_back(mapped_cell(mesh, c, static_cast<int>(scene.pressure.size() + f)));
    }
  }
  return bodies;
}

}  // namespace

CellCorners corners_of_cell(const Mesh& mesh, int cell) {
  const std::span<const int> nodes = mesh.cells[cell];
  const auto at = [&](std::size_t v) { return mesh.nodes[nodes[v]]; };
  if (mesh.cells.shape() == CellShape::hexahedron)
    return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
  // Five of the six tetrahedra around the diagonal from the first to the seventh are flat.
  return {at(0), at(1), at(2), at(2), at(0), at(1), at(3), at(3)};
}

std::vector<MappedCell> cells_of_compartments(const Mesh& mesh, double y) {
  std::vector<MappedCell> cells = of_compartments(mesh);
  for (MappedCell& cell : cells) {
    if (mesh.plane_strain) cell.corners = at_section(cell.corners, y);
  }
  return cells;
}

std::vector<MappedCell> field_bodies(const Scene& scene, const Plan& plan, double y) {
  std::vector<MappedCell> bodies = scene.geometry_kind == GeometryKind::field
                                       ? bodies_of_blocks(scene)
                                       : bodies_of_box(scene, plan);
  for (MappedCell& body : bodies) {
    if (plan.plane_strain) body.corners = at_section(body.corners, y);
  }
  return bodies;
}

}  // namespace faultsim
