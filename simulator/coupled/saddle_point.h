#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "simulator/coupled/slip_tangent.h"
#include "simulator/coupled/two_sided_bulk.h"
#include "simulator/result/result.h"

namespace faultsim {

/// How a fault node enters the linearisation.
struct NodeLinearisation {
  FaultState state = FaultState::stick;
  SlipTangent tangent = {};  ///< where it slips.
};

/// The Jacobian of the coupled path (model section 11),
///
///   J = [[K + E, C − F], [Cᵀ, 0]],
///
/// over displacements of both sides (n_u, m) and multipliers (n_λ, Pa): tractions of the components
/// that are held closed. A node that sticks has its n, strike and dip, one that slips its n, an
/// open one none. C_k has A_k R_k times the factors of the displacements in the jump (JumpTerm; of
/// two copies plus side 1, minus side −1), so that Cᵀu = A g.
///
/// The shear of a slipping node is t*_T(Δg_T, t'_N) instead of a multiplier. With C_T its two
/// columns of C_k,
///
///   E = Σ C_T ∂t*_T/∂Δg_T A⁻¹ C_Tᵀ,      F = −Σ C_T ∂t*_T/∂t'_N   in the column of its t'_N.
///
/// Of vectors and rows each rank has its own, as TwoSidedBulk; the multipliers of a node are where
/// its rows are, so that all but K is of one rank alone. Numbers of rows and columns here are own
/// ones, from 0 on.
struct SaddlePoint {
  SparseMatrix constraint;      ///< C, n_u x n_λ. CᵀC is diagonal but where faults meet.
  SparseMatrix coupling;        ///< C − F, n_u x n_λ; the same as C where nothing slips.
  SparseMatrix slip;            ///< E, n_u x n_u; 0 x 0 where nothing slips.
  std::vector<int> node_begin;  ///< multipliers of fault node k: node_begin[k] … node_begin[k+1]−1.
  bool symmetric = true;        ///< K + E = (K + E)ᵀ and F = 0.

  int n_displacements() const { return static_cast<int>(constraint.rows()); }
  int n_multipliers() const { return static_cast<int>(constraint.cols()); }
  /// Diagonal of CᵀC, m4.
  Eigen::VectorXd gram() const;
  const Ranks& ranks() const;

  /// K in the solver's format, the bulk's or of set_leading(). Collective.
  EngineMatrix& engine() const;
  /// (K + E) u. Collective.
  Eigen::VectorXd times_leading(const Eigen::VectorXd& u) const;
  /// n_u x 6: the near-null space of K, or what was set in its place. Collective.
  Eigen::MatrixXd motions() const;
  void set_motions(Eigen::MatrixXd motions) { motions_ = std::move(motions); }
  /// An entry of K + E.
  double leading_entry(int row, int column) const;
  Eigen::VectorXd leading_diagonal() const;  ///< Collective.

  /// K + E, both triangles, for what needs the matrix whole: on one rank only.
  const SparseMatrix& leading() const;
  /// (K + E + (K + E)ᵀ)/2, for preconditioners that need symmetry; never null.
  std::shared_ptr<const SparseMatrix> symmetric_leading() const;
  /// A matrix of its own in place of K + E of a bulk, and its near-null space.
  void set_leading(SparseMatrix matrix, Eigen::MatrixXd motions = {});
  /// The same of a matrix that outlives this.
  void lend_leading(const SparseMatrix& matrix, Eigen::MatrixXd motions);
  /// @pre the bulk outlives this.
  void set_bulk(const TwoSidedBulk& bulk) { bulk_ = &bulk; }

 private:
  bool has_engine() const;

  const TwoSidedBulk* bulk_ = nullptr;
  mutable std::shared_ptr<const SparseMatrix> leading_;
  mutable std::shared_ptr<EngineMatrix> engine_;  ///< of a matrix of its own, as
  Eigen::MatrixXd motions_;
};

/// @pre the bulk outlives it. @param nodes  one per node of bulk.fault_nodes(); empty = all stick.
/// Collective.
SaddlePoint make_saddle_point(const TwoSidedBulk& bulk,
                              const std::vector<NodeLinearisation>& nodes = {});

}  // namespace faultsim
