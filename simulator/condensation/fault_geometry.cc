#include "simulator/condensation/fault_geometry.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// The side of a face towards a cell, as PressurePair wants it.
std::pair<int, double> region_of(const Mesh& mesh, int cell) {
  const std::size_t c = static_cast<std::size_t>(cell);
  const double fraction = mesh.region[c] < 0 ? 0 : mesh.region_fraction[c];
  return fraction > 0 ? std::pair(mesh.region[c], fraction) : std::pair(-1, 0.0);
}

void add_pressure_pair(std::vector<PressurePair>& pairs, const PressurePair& pair) {
  const auto same = std::ranges::find_if(pairs, [&](const PressurePair& other) {
    return other.minus_region == pair.minus_region && other.plus_region == pair.plus_region &&
           other.minus_fraction == pair.minus_fraction && other.plus_fraction == pair.plus_fraction;
  });
  if (same == pairs.end()) {
    pairs.push_back(pair);
  } else {
    same->weight += pair.weight;
  }
}

/// Adds a face's corner to the sums of one of its nodes.
void add_corner(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                const FaultFace& face, OperatorNode& node) {
  const double area = corner_area(face);
  const auto material = [&](int cell) { return materials.at(mesh.material[cell]); };
  const ElasticMaterial minus = material(face.minus_cell), plus = material(face.plus_cell);
  const double g_minus = shear_modulus(minus), g_plus = shear_modulus(plus);
  node.effective_shear_modulus += area * 2 * g_plus * g_minus / (g_plus + g_minus);
  node.poisson_ratio += area * (minus.poisson_ratio + plus.poisson_ratio) / 2;
  PressurePair pair;
  std::tie(pair.minus_region, pair.minus_fraction) = region_of(mesh, face.minus_cell);
  std::tie(pair.plus_region, pair.plus_fraction) = region_of(mesh, face.plus_cell);
  pair.weight = area;
  add_pressure_pair(node.pressure, pair);
}

/// Lengthens a node's edges to those of a face, each by the direction that it is nearer to.
void add_edges(const FaultSurface& fault, const FaultFace& face, OperatorNode& node) {
  const std::size_t n = face.n_corners();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along =
        fault.points[face.points[(i + 1) % n]] - fault.points[face.points[i]];
    const bool down = std::abs(along.dot(node.dip)) > std::abs(along.dot(node.strike));
    double& edge = down ? node.edge_dip : node.edge_strike;
    edge = std::max(edge, along.norm());
  }
}

void average_over_faces(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                        const FaultSurface& fault, OperatorNode* nodes) {
  std::vector<double> area(fault.nodes.size(), 0);
  for (const FaultFace& face : fault.faces) {
    for (int corner : face.nodes) {
      if (corner < 0) continue;
      OperatorNode& node = nodes[corner];
      add_corner(mesh, materials, face, node);
      area[corner] += corner_area(face);
      add_edges(fault, face, node);
    }
  }
  for (std::size_t k = 0; k < fault.nodes.size(); ++k) {
    OperatorNode& node = nodes[k];
    FAULTSIM_DEMAND(area[k] > 0, "node ", k, " of fault ", fault.name, " has no face");
    node.effective_shear_modulus /= area[k];
    node.poisson_ratio /= area[k];
    for (PressurePair& pair : node.pressure) pair.weight /= area[k];
  }
}

OperatorFault surface_of(const FaultSurface& fault, int first_node) {
  OperatorFault surface;
  surface.name = fault.name;
  surface.points = fault.points;
  surface.first_node = first_node;
  surface.n_nodes = static_cast<int>(fault.nodes.size());
  for (const int node : fault.node_of_point)
    surface.node_of_point.push_back(node < 0 ? -1 : first_node + node);
  for (const FaultFace& face : fault.faces) {
    surface.faces.push_back(face.points);
    if (face.n_corners() == 3) surface.faces.back()[3] = face.points[2];
  }
  return surface;
}

/// Nodes that a boundary holds closed have no jump: for the contact solve they are like unsplit
/// ones.
void drop_locked_nodes(FaultGeometry& geometry, OperatorFault& fault) {
  std::vector<int> renumbered;
  const auto begin = geometry.nodes.begin() + fault.first_node;
  auto kept = begin;
  for (auto node = begin; node != geometry.nodes.end(); ++node) {
    const bool locked = node->dof == std::array<int, 3>{-1, -1, -1};
    renumbered.push_back(locked ? -1 : static_cast<int>(kept - geometry.nodes.begin()));
    if (locked) continue;
    if (kept != node) *kept = std::move(*node);
    ++kept;
  }
  geometry.nodes.erase(kept, geometry.nodes.end());
  for (int& node : fault.node_of_point) {
    if (node >= 0) node = renumbered[node - fault.first_node];
  }
  fault.n_nodes = static_cast<int>(geometry.nodes.size()) - fault.first_node;
}

}  // namespace

FaultGeometry fault_geometry(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                             const DofMap& dofs, bool half_domain) {
  FaultGeometry geometry;
  geometry.n_dofs = dofs.n_jump();
  geometry.plane_strain = mesh.plane_strain;
  geometry.half_domain = half_domain;
  geometry.locked_positions = dofs.locked_positions();
  for (std::size_t f = 0; f < mesh.faults.size(); ++f) {
    const FaultSurface& fault = mesh.faults[f];
    const int first_node = static_cast<int>(geometry.nodes.size());
    geometry.faults.push_back(surface_of(fault, first_node));
    for (std::size_t k = 0; k < fault.nodes.size(); ++k) {
      const FaultNode& from = fault.nodes[k];
      OperatorNode node;
      node.position = mesh.nodes[from.minus_node];
      node.normal = from.normal;
      node.strike = from.strike;
      node.dip = from.dip;
      node.area = from.area;
      for (int c = 0; c < 3; ++c) {
        node.dof[c] = dofs.jump_dof(static_cast<int>(f), static_cast<int>(k), c);
      }
      geometry.nodes.push_back(std::move(node));
    }
    average_over_faces(mesh, materials, fault, geometry.nodes.data() + first_node);
    OperatorFault& surface = geometry.faults.back();
    drop_locked_nodes(geometry, surface);
    surface.profiles = fault_profiles(surface, geometry.nodes);
  }
  geometry.dof_area.resize(geometry.n_dofs);
  for (const OperatorNode& node : geometry.nodes) {
    for (const int dof : node.dof) {
      if (dof >= 0) geometry.dof_area[dof] = node.area;
    }
  }
  return geometry;
}

}  // namespace faultsim
