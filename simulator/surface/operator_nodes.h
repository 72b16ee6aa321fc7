#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/model/operator_basis.h"

namespace faultsim {

/// Exact operators at the nodes of a surface, seen as vectors: the lower triangle of H by columns,
/// then L, U and V (FaultOperator). Each block, a block per load in L, counts relative to its norm
/// at the centre; one that is zero there as it is. All is computed by a pass over the columns of H
/// of all nodes side by side, which lie in mapped files: none is copied.
class OperatorNodes {
 public:
  explicit OperatorNodes(std::shared_ptr<const FaultOperator> centre);

  /// The next node. @pre shape and load keys are the centre's (InternalError).
  void add(std::shared_ptr<const FaultOperator> op);
  const std::shared_ptr<const FaultOperator>& centre() const { return nodes_.front(); }

  /// The largest norm of a block of op − Σ_k w_k node_k, w having an entry per node.
  double surplus(const FaultOperator& op, const Eigen::VectorXd& weights, StopToken stop) const;
  /// Dᵀ D, D = [H_i − H_0] / |H_0| over the nodes but the centre, triangles by columns.
  Eigen::MatrixXd stiffness_gram(StopToken stop) const;
  /// B = D V |H_0|, weights Vᵀ and the differences of L, U and V; nodes and fingerprint stay empty.
  /// @param directions  V: a row for each node but the centre, a column for each direction.
  /// @param left_out    how much of |H_0| the blocks of all directions together may leave out.
  OperatorBasis basis(const Eigen::MatrixXd& directions, double left_out, StopToken stop) const;

 private:
  DirectionBlocks blocks(const Eigen::MatrixXd& directions, double left_out, StopToken stop) const;
  Eigen::MatrixXd block(const Eigen::MatrixXd& directions, const RowRange& rows,
                        const RowRange& columns) const;

  std::vector<std::shared_ptr<const FaultOperator>> nodes_;
  std::vector<double> scale_;  ///< per block, what is divided by.
};

}  // namespace faultsim
