#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/model/direction_blocks.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// Operators as a function of parameters θ (docs/model.md, 12), from those at nodes with weights
/// w_i(θ), i = 1 … m without the centre. L, U and V, which are small, as they are; H compressed:
///
///   L(θ) = L_0 + Σ_i w_i (L_i − L_0),      H(θ) = H_0 + Σ_k c_k B_k,  c = C w,  k = 1 … K,
///
/// H_0 at the centre in double, B_k by blocks and in single precision: what is lost is far below
/// the errors of interpolation and part of the errors measured.
struct OperatorBasis {
  std::string fingerprint;                       ///< of the surface; also its file's name.
  std::shared_ptr<const FaultOperator> centre;   ///< H_0 …, with the faults as they are there.
  std::vector<std::vector<int>> nodes;           ///< multi-indices of the grid, the centre first.
  Eigen::MatrixXd weights;                       ///< C, K x m.
  DirectionBlocks stiffness;                     ///< B_1 … B_K, N/m.
  Eigen::MatrixXd traction, per_load, per_jump;  ///< L_i − L_0 … as columns, each x m.

  Eigen::Index size() const { return weights.rows(); }  ///< K.

  /// L, U and V at w (m entries) put into `op`, and an InterpolatedCompliance as its H.
  static void put(const std::shared_ptr<const OperatorBasis>& basis, const Eigen::VectorXd& w,
                  FaultOperator& op);
};

/// H at c, whose columns are summed up run by run (DirectionBlocks) when one of them is asked for:
/// a case reads the columns of nodes that move and no others. What was made stays; for one thread
/// at a time.
class InterpolatedCompliance final : public Compliance {
 public:
  /// @param factors  c, K entries.
  InterpolatedCompliance(std::shared_ptr<const OperatorBasis> basis, Eigen::VectorXd factors);

  int size() const override { return static_cast<int>(diagonal_.size()); }
  Column column(int j) const override;
  double diagonal(int j) const override { return diagonal_[j]; }
  const double* matrix_entries() const override;
  int n_made() const { return n_made_; }  ///< columns that were summed up.

 private:
  std::shared_ptr<const OperatorBasis> basis_;
  DirectionSum directions_;
  Eigen::VectorXd diagonal_;
  // n x n, of which the system gives memory to what is written only.
  std::unique_ptr<double[]> entries_;
  mutable std::vector<bool> made_;  ///< by run.
  mutable int n_made_ = 0;
};

}  // namespace faultsim
