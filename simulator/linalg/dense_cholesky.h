#pragma once

#include <Eigen/Core>

namespace faultsim {

/// The Cholesky factor of a dense symmetric positive definite matrix, by LAPACK.
class DenseCholesky {
 public:
  /// Factorises in place; only the lower triangle is read. @returns whether the matrix is positive
  /// definite to working precision; if not, there is no factor.
  bool factor(Eigen::MatrixXd matrix);
  /// M⁻¹ x. @pre factor() was true, and x has as many entries as M has rows.
  Eigen::VectorXd solve(Eigen::VectorXd x) const;

 private:
  Eigen::MatrixXd factor_;
};

}  // namespace faultsim
