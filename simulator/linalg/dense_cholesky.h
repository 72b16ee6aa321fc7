#pragma once

#include <Eigen/Core>
#include <optional>

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

/// Condition number of a symmetric positive definite matrix in the 1-norm, ‖M‖ ‖M⁻¹‖, estimated by
/// LAPACK from its Cholesky factor (dpocon: a lower bound, rarely off by more than a factor of 3).
/// Only the lower triangle is read. Nothing when the factorisation fails: not positive definite to
/// working precision, or not finite.
std::optional<double> spd_condition(Eigen::MatrixXd matrix);

}  // namespace faultsim
