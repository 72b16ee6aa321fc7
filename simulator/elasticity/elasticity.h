#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "simulator/common/unknown_groups.h"
#include "simulator/mesh/mesh.h"

namespace faultsim {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, long>;  // 64-bit: cholmod_l_*

struct ElasticMaterial {
  double youngs_modulus;  ///< Pa.
  double poisson_ratio;
  double shear_factor = 1;  ///< of the shear modulus that acts in a time step (MaxwellStep).
};

/// Displacement prescribed on a group of boundary faces: components, and u(x) = translation +
/// gradient x (per unit factor).
struct DisplacementCondition {
  BoundaryGroup group;
  std::array<bool, 3> components;
  Eigen::Vector3d translation;
  Eigen::Matrix3d gradient;
  int load;  ///< index of the load this value belongs to; -1 = zero for ever (roller, fixed).
};

/// Instantaneous shear modulus G = E/2(1 + ν), Pa.
double shear_modulus(const ElasticMaterial& material);

/// The linear map from unknowns to nodal displacements, u = P x + Σ_k c_k d_k (docs/model.md, 8):
/// x = (r, g): r all independent displacements (ū at places with copies), g the jumps in the local
/// frame, *last*; a copy has u = ū + Σ weight R g (NodeCopy). Ties, plane strain and prescribed
/// displacements are in P and d.
class DofMap {
 public:
  /// Rules (docs/model.md, section 3): a jump component along a direction that is fixed on all
  /// copies is removed; a node where a fixed direction is not one of (n, strike, dip), or is n, is
  /// locked, and so is one that is fixed on some copies only. Where sides share an edge, the
  /// condition listed first gives the value of a component. If no component is prescribed at all,
  /// the rigid motions of the body (6; fewer with ties or in plane strain) are pinned at three
  /// nodes off the faults: reactions there must vanish.
  DofMap(const Mesh& mesh, const std::vector<DisplacementCondition>& conditions, int n_loads);

  struct Term {
    int unknown;
    double coefficient;
  };
  /// Terms of displacement component c of mesh node i.
  std::span<const Term> terms(int node, int component) const;
  /// Prescribed part of that component for load k (0 unless the node is on such a side), m.
  double prescribed(int load, int node, int component) const;
  bool has_prescribed(int load) const { return !prescribed_[load].empty(); }

  int n_unknowns() const { return n_bulk_ + n_jump_; }  ///< n_r + n_g
  int n_bulk() const { return n_bulk_; }                ///< n_r: unknowns 0 … n_r−1
  int n_jump() const { return n_jump_; }                ///< n_g: unknowns n_r … n_r+n_g−1
  /// Jump unknown (0-based within g) of component c (n, strike, dip) of node k of fault f; −1 =
  /// removed. Those of a node follow each other; nodes fault by fault, from the top down.
  int jump_dof(int fault, int node, int component) const {
    return jump_[jump_begin_[fault] + node][component];
  }
  const std::vector<Eigen::Vector3d>& locked_positions() const { return locked_; }
  bool pinned() const { return pinned_; }  ///< the rigid motions of the body were pinned.
  /// Bulk unknowns by places of mesh nodes.
  const UnknownGroups& bulk_groups() const { return groups_; }

 private:
  std::vector<int> begin_;
  std::vector<Term> terms_;
  std::vector<int> jump_begin_;  // per fault, offset into jump_
  std::vector<std::array<int, 3>> jump_;
  std::vector<Eigen::Vector3d> locked_;
  std::vector<std::vector<std::pair<int, double>>>
      prescribed_;  // per load: (3 node + component, m)
  UnknownGroups groups_;
  int n_bulk_ = 0, n_jump_ = 0;
  bool pinned_ = false;

  friend class DofMapBuilder;
};

/// K = Pᵀ K_full P (n x n, lower triangle, sorted columns) of cells as in element.h. Deterministic
/// summation order. In plane strain the matrix and all loads are per metre of thickness.
/// @param wanted  per cell; empty = all. Columns of unknowns without a wanted cell stay empty.
SparseMatrix assemble_stiffness(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                                const DofMap& dofs, bool mean_dilatation,
                                const std::vector<char>& wanted = {});

/// f = Pᵀ ∫ div v: b Δp = 1 Pa in the region, times the cells' volume fractions.
Eigen::VectorXd pressure_load(const Mesh& mesh, const DofMap& dofs, int region);
/// f = Pᵀ ∫_cell div v: what an isotropic eigenstress −1 Pa in one cell adds to the nodal forces, N
/// per Pa, as (unknown, value), each unknown once, ascending.
std::vector<std::pair<int, double>> dilatation_load(const Mesh& mesh, const DofMap& dofs, int cell);
/// ∫ N (Δσ n) over the groups given, N (plane strain: per metre; front and back left out),
/// 3 x n_nodes.
Eigen::Matrix3Xd nodal_stress_forces(const Mesh& mesh, const std::vector<BoundaryGroup>& groups,
                                     const Eigen::Matrix3d& stress);
/// f = Pᵀ ∫ v·(Δσ n), total over the groups given.
Eigen::VectorXd stress_load(const Mesh& mesh, const DofMap& dofs,
                            const std::vector<BoundaryGroup>& groups,
                            const Eigen::Matrix3d& stress);
/// f = −Pᵀ K_full d_k.
Eigen::VectorXd displacement_load(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                                  const DofMap& dofs, int load, bool mean_dilatation);

/// Nodal displacements u = P x + Σ c_k d_k, 3 x n_nodes.
Eigen::Matrix3Xd nodal_displacement(const Mesh& mesh, const DofMap& dofs, const Eigen::VectorXd& x,
                                    const std::vector<double>& load_factors);

}  // namespace faultsim
