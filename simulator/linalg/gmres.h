#pragma once

#include <Eigen/Core>
#include <functional>

namespace faultsim {

/// y := operator x, on vectors of one size.
using LinearMap = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

struct GmresReport {
  bool converged = false;
  int iterations = 0;
  double relative_residual = 1;  ///< |b − M x| / |b| by the recurrence.
};

/// Right-preconditioned GMRES without restart (Saad and Schultz, 1986), for a good preconditioner
/// and few iterations: finds x with |b − M x| ≤ tolerance |b| from x = 0.
/// @param precondition  P⁻¹.
GmresReport gmres(const LinearMap& multiply, const LinearMap& precondition,
                  const Eigen::VectorXd& b, double tolerance, int max_iterations,
                  Eigen::VectorXd& x);

}  // namespace faultsim
