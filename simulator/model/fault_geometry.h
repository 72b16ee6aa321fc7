#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "simulator/model/fault_profile.h"

/// Where the faults of a model are: their points, the faces between them, the frames and areas of
/// their nodes, and lines down their dip. Public (simulator/simulation/simulation.h).
namespace faultsim {

/// Share of one pair of neighbouring cells in the pressure seen by a fault node.
struct PressurePair {
  int minus_region = -1;      ///< pressure load (LockedLoads::keys); -1 = no change on that side.
  double minus_fraction = 0;  ///< share of the cell's volume in the region.
  int plus_region = -1;
  double plus_fraction = 0;
  double weight = 0;  ///< area share; the weights of a node sum to 1.
};

/// A node pair of a fault as the contact solve sees it.
struct OperatorNode {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< local frame (see mesh.h).
  Eigen::Vector3d strike = Eigen::Vector3d::Zero();
  Eigen::Vector3d dip = Eigen::Vector3d::Zero();
  double area = 0;                        ///< A_k, m2 (per metre in plane strain).
  std::array<int, 3> dof = {-1, -1, -1};  ///< index of the jump in n, strike, dip; -1 = removed.
  double effective_shear_modulus = 0;     ///< G_eff = 2 G⁺G⁻/(G⁺+G⁻), Pa, area-weighted.
  double poisson_ratio = 0;  ///< area-weighted mean of both sides, for nucleation length.
  double edge_strike = 0, edge_dip = 0;  ///< m, longest cell edge around the node.
  std::vector<PressurePair> pressure;
};

/// A fault as a surface: its points, the faces between them, and what lies on it.
struct OperatorFault {
  std::string name;
  std::vector<Eigen::Vector3d> points;  ///< m, each the corner of a face.
  std::vector<int> node_of_point;       ///< into FaultGeometry::nodes; -1 = not split.
  /// Points at the corners, cyclic. A triangle has its last corner twice; in plane strain a face is
  /// an edge down dip and has both of its ends twice: (a, b, b, a).
  std::vector<std::array<int, 4>> faces;
  int first_node = 0;  ///< its nodes are consecutive in FaultGeometry::nodes.
  int n_nodes = 0;
  std::vector<Profile> profiles;  ///< fault_profiles() of all this.
};

/// Everything about the faults that does not depend on the loads. Of a model that is half of a
/// field (half_domain) only the nodes at y ≥ 0 are there.
struct FaultGeometry {
  std::vector<OperatorNode> nodes;  ///< all faults, fault by fault.
  std::vector<OperatorFault> faults;
  int n_dofs = 0;
  Eigen::VectorXd dof_area;  ///< A per dof, m2 (n_dofs).
  bool plane_strain = false;
  bool half_domain = false;  ///< areas, potency and M0 are to be doubled.
  std::vector<Eigen::Vector3d>
      locked_positions;  ///< nodes that a boundary holds closed; not in nodes.
};

}  // namespace faultsim
