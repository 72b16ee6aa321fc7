#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace faultsim {

/// Share of one pair of neighbouring cells in the pressure seen by a fault node.
struct PressurePair {
  int minus_region = -1;      ///< -1 = no pressure change on that side.
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

/// A fault's grid (see mesh.h); grid_node and first_node index FaultGeometry::nodes.
struct OperatorFault {
  std::string name;
  int n_columns = 0;
  int n_rows = 0;
  std::vector<Eigen::Vector3d> grid_position;
  std::vector<int> grid_node;  ///< into FaultGeometry::nodes; -1 = not split.
  std::vector<char> grid_used;
  std::vector<double> column_width;       ///< m; plane strain: 1.
  std::vector<std::array<int, 4>> faces;  ///< grid indices of the corners.
  int first_node = 0;
  int n_nodes = 0;
};

/// Everything about the faults that does not depend on the loads.
struct FaultGeometry {
  std::vector<OperatorNode>
      nodes;  ///< all faults, fault by fault, column-major (down dip fastest).
  std::vector<OperatorFault> faults;
  int n_dofs = 0;
  bool plane_strain = false;
  bool half_domain = false;  ///< areas, potency and M0 are to be doubled.
  std::vector<Eigen::Vector3d>
      locked_positions;  ///< nodes that a boundary holds closed; not in nodes.
};

/// A displacement component observed at a node of the mesh.
struct ObservationRow {
  std::string name;          ///< "above_centre.z"
  Eigen::Vector3d position;  ///< of the node used.
};

/// The linear bulk condensed onto the faults (docs/model.md, 8), all in the local fault frame:
///
///   t'(step) = t'_0 + Σ_k c_k(step) L_k + α_f Δp_f n − A⁻¹ H g,      u_obs = Σ_k c_k U_k + V g.
struct FaultOperator {
  std::string fingerprint;  ///< of what it depends on; also the file's name.
  FaultGeometry geometry;
  Eigen::VectorXd dof_area;  ///< A per dof, m2 (n_dofs).
  std::vector<std::string>
      load_names;          ///< "pressure:0" (b Δp = 1 Pa in region 0), "boundary:2" (factor 1).
  Eigen::MatrixXd locked;  ///< L: n_dofs x n_loads, Pa per unit of load.
  std::vector<ObservationRow> observations;
  Eigen::MatrixXd observed_load;  ///< U: n_obs x n_loads, m per unit of load.
  Eigen::MatrixXd observed_jump;  ///< V: n_obs x n_dofs, m per m.

  /// H (n_dofs x n_dofs, symmetric, both triangles stored, column-major), N/m per m.
  Eigen::Map<const Eigen::MatrixXd> h{nullptr, 0, 0};
  std::shared_ptr<const void> h_owner;  ///< keeps the memory (or the file mapping) behind h alive.

  // How it was made: reported, never part of the identity.
  int n_unknowns = 0;  ///< bulk and jump unknowns of the factorised matrix.
  double build_seconds = 0;
  double factor_bytes = 0;
  std::string blas;  ///< library, kernel and threads.
};

/// Gives the operator a matrix of its own.
void own_h(FaultOperator& op, Eigen::MatrixXd h);

}  // namespace faultsim
