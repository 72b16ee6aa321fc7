#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "simulator/measures/fault_neighbours.h"
#include "simulator/measures/metrics.h"

namespace faultsim {

/// Two plane-strain faults of nodes every 10 m, 100 m of dip, from 2000 m depth: F1 has the region
/// west on its plus side, F2 west on its minus and east on its plus side; each region beside the
/// nodes at 2030 to 2070 m. p0 = 1e4 Pa/m.
struct FaultsBetweenRegions {
  static constexpr int kNodes = 9;
  static constexpr double kSpacing = 10;

  FaultsBetweenRegions() {
    scene.geometry_kind = GeometryKind::box;
    scene.box.from = {-2000, -2000, -3000};
    scene.box.to = {2000, 2000, 0};
    scene.materials.resize(1);
    scene.initial.kind = InitialStressKind::profile;
    scene.initial.pressure_gradient = 1e4;
    for (const char* region : {"west", "east"}) {
      scene.pressure.emplace_back();
      scene.pressure.back().region = region;
      scene.box.regions.emplace_back();
      scene.box.regions.back().from = {-1000, -1000, -2070};
      scene.box.regions.back().to = {1000, 1000, -2030};
    }
    op.loads.keys = {{LoadKey::Kind::pressure, 0, 0}, {LoadKey::Kind::pressure, 1, 0}};
    add_fault("F1", -1, 0);
    add_fault("F2", 0, 1);
    CoulombLaw law;
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(0.5);
    const std::size_t n = op.geometry.nodes.size();
    laws.assign(n, law);
    op.geometry.n_dofs = static_cast<int>(2 * n);
    state.jump = state.traction = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    state.slip_path = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
    state.state.assign(n, FaultState::stick);
    state.cohesion_lost.assign(n, 0);
  }
  void add_fault(const std::string& name, int minus, int plus) {
    OperatorFault fault;
    fault.name = name;
    fault.first_node = static_cast<int>(op.geometry.nodes.size());
    fault.n_nodes = kNodes;
    for (int row = 0; row < kNodes + 2; ++row) {
      const bool tip = row == 0 || row == kNodes + 1;
      const double depth = 2000 + kSpacing * row;
      fault.points.emplace_back(0, 0, -depth);
      fault.node_of_point.push_back(tip ? -1 : fault.first_node + row - 1);
      if (row > 0) fault.faces.push_back({row - 1, row, row, row - 1});
      if (tip) continue;
      OperatorNode node;
      node.position = {0, 0, -depth};
      node.strike = Eigen::Vector3d::UnitY();
      node.dip = -Eigen::Vector3d::UnitZ();
      node.area = kSpacing;
      const int dof = 2 * static_cast<int>(op.geometry.nodes.size());
      node.dof = {dof, -1, dof + 1};
      node.effective_shear_modulus = 5e9;
      const bool inside = depth >= 2030 && depth <= 2070;
      node.pressure = {{inside ? minus : -1, 1.0, inside ? plus : -1, 1.0, 1.0}};
      op.geometry.nodes.push_back(node);
    }
    fault.profiles = fault_profiles(fault, op.geometry.nodes);
    op.geometry.faults.push_back(fault);
  }
  /// More slip on a stretch of nodes of a fault, tent-shaped: largest at the middle node.
  void slip(int fault, double largest, int first = 1, int last = 7) {
    for (int k = first; k <= last; ++k) {
      const double share = 1 - std::abs(2.0 * k - first - last) / (2.0 * (last - first + 1));
      state.jump[2 * (fault * kNodes + k) + 1] += largest * share;
    }
  }
  FaultMeter meter() const { return {op, laws, 1e-4, 40}; }
  FaultNeighbours neighbours() const { return {scene, op}; }

  Scene scene;
  FaultOperator op;
  ContactLaws laws;
  ContactState state;
};

}  // namespace faultsim
