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
struct SaddlePoint {
  SparseMatrix constraint;      ///< C, n_u x n_λ. CᵀC is diagonal but where faults meet.
  SparseMatrix coupling;        ///< C − F, n_u x n_λ; the same as C where nothing slips.
  std::vector<int> node_begin;  ///< multipliers of fault node k: node_begin[k] … node_begin[k+1]−1.
  bool symmetric = true;        ///< K + E = (K + E)ᵀ and F = 0.
  Eigen::MatrixXd rigid_motions;  ///< n_u x 6: the near-null space of K.

  /// K + E, both triangles; where nothing slips it is the bulk's K, which then must outlive this.
  const SparseMatrix& leading() const { return *leading_; }
  void set_leading(SparseMatrix matrix) {
    leading_ = std::make_shared<const SparseMatrix>(std::move(matrix));
  }
  void lend_leading(const SparseMatrix& matrix) {
    leading_ = std::shared_ptr<const SparseMatrix>(std::shared_ptr<void>(), &matrix);
  }
  int n_displacements() const { return static_cast<int>(leading_->rows()); }
  int n_multipliers() const { return static_cast<int>(constraint.cols()); }
  /// Diagonal of CᵀC, m4.
  Eigen::VectorXd gram() const;
  /// (K + E + (K + E)ᵀ)/2, for preconditioners that need symmetry; never null.
  std::shared_ptr<const SparseMatrix> symmetric_leading() const;

 private:
  std::shared_ptr<const SparseMatrix> leading_;
};

/// @param nodes  one per node of bulk.fault_nodes(); empty = all stick.
SaddlePoint make_saddle_point(const TwoSidedBulk& bulk,
                              const std::vector<NodeLinearisation>& nodes = {});

}  // namespace faultsim
