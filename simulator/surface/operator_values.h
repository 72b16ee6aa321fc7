#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// What of an operator is a smooth function of scene parameters, as one vector: the lower triangle
/// of H by columns, then L, U and V (FaultOperator); and the operator of such a vector. Each block,
/// a block per load in L, is divided by its norm in a reference operator, so that errors are
/// relative ones; one that is zero there stays as it is.
class OperatorValues {
 public:
  explicit OperatorValues(const FaultOperator& reference);

  /// @pre shape and load keys are those of the reference (InternalError).
  Eigen::VectorXd pack(const FaultOperator& op) const;
  /// H, L, U and V of a vector, put into `op`.
  void unpack(const Eigen::VectorXd& values, FaultOperator& op) const;
  /// The largest norm of a block.
  double largest_block(const Eigen::VectorXd& difference) const;
  /// Relative errors of `op` against an exact operator, slip included; the rest is left 0.
  static CaseSurface errors(const FaultOperator& op, const FaultOperator& exact);

  Eigen::Index size() const { return size_; }

 private:
  struct Block {
    Eigen::Index first = 0, size = 0;
    double scale = 1;  ///< what is divided by.
  };
  Eigen::VectorXd unscaled(const FaultOperator& op) const;

  Eigen::Index n_dofs_ = 0, n_loads_ = 0, n_rows_ = 0, size_ = 0;
  std::vector<LoadKey> keys_;
  std::vector<Block> blocks_;
};

}  // namespace faultsim
