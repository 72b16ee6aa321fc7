#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/model/fault_operator.h"
#include "simulator/model/stored_matrix.h"

namespace faultsim {

/// Operators as a function of parameters θ (docs/model.md, 12), from those at nodes with weights
/// w_i(θ), i = 1 … m without the centre. L, U and V, which are small, as they are; H compressed:
///
///   L(θ) = L_0 + Σ_i w_i (L_i − L_0),      H(θ) = H_0 + Σ_k c_k B_k,  c = C w,  k = 1 … K,
///
/// H_0 at the centre in double, B_k in single precision: what is lost, 6e-8 of a difference to the
/// centre, is far below the errors of interpolation and part of the errors measured.
struct OperatorBasis {
  std::string fingerprint;                      ///< of the surface; also its file's name.
  std::shared_ptr<const FaultOperator> centre;  ///< H_0 …, with the faults as they are there.
  std::vector<std::vector<int>> nodes;          ///< multi-indices of the grid, the centre first.
  Eigen::MatrixXd weights;                      ///< C, K x m.
  StoredFloats stiffness;                       ///< B, n x (n K): column j K + k is B_k e_j, N/m.
  Eigen::MatrixXd diagonal;  ///< entries of `stiffness` on the diagonal of H, n x K.
  Eigen::MatrixXd traction, per_load, per_jump;  ///< L_i − L_0 … as columns, each x m.

  Eigen::Index size() const { return weights.rows(); }  ///< K.

  /// L, U and V at w (m entries) put into `op`, and an InterpolatedCompliance as its H.
  static void put(const std::shared_ptr<const OperatorBasis>& basis, const Eigen::VectorXd& w,
                  FaultOperator& op);
};

/// H at c, whose columns are summed up when they are asked for: a case reads the columns of nodes
/// that move and no others. Columns that were made stay; for one thread at a time.
class InterpolatedCompliance final : public Compliance {
 public:
  /// @param factors  c, K entries.
  InterpolatedCompliance(std::shared_ptr<const OperatorBasis> basis, Eigen::VectorXd factors);

  int size() const override { return static_cast<int>(diagonal_.size()); }
  Column column(int j) const override;
  double diagonal(int j) const override { return diagonal_[j]; }
  const double* matrix_entries() const override;
  int n_made() const { return n_made_; }  ///< columns that were asked for.

 private:
  std::shared_ptr<const OperatorBasis> basis_;
  Eigen::VectorXd factors_, diagonal_;
  // n x n, of which the system gives memory to what is written only.
  std::unique_ptr<double[]> entries_;
  mutable std::vector<bool> made_;
  mutable int n_made_ = 0;
};

}  // namespace faultsim
