#pragma once

#include <Eigen/Core>
#include <optional>

namespace faultsim {

/// Condition number of a symmetric positive definite matrix in the 1-norm, ‖M‖ ‖M⁻¹‖, estimated by
/// LAPACK from its Cholesky factor (dpocon: a lower bound, rarely off by more than a factor of 3).
/// Only the lower triangle is read. Nothing when the factorisation fails: not positive definite to
/// working precision, or not finite.
std::optional<double> spd_condition(Eigen::MatrixXd matrix);

}  // namespace faultsim
