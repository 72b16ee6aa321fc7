#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace faultsim {

/// y := operator x, on vectors of one size.
using LinearMap = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

/// Adds up, entry by entry, what several processes have of something; each gets the same bits.
using SumOverRanks = std::function<void(Eigen::Ref<Eigen::VectorXd> values)>;

struct GmresReport {
  bool converged = false;
  int iterations = 0;
  double relative_residual = 1;   ///< |b − M x| / |b| by the recurrence.
  std::vector<double> residuals;  ///< the same after 0, 1, 2 … iterations.
};

/// Right-preconditioned GMRES without restart (Saad and Schultz, 1986), for a good preconditioner
/// and few iterations: finds x with |b − M x| ≤ tolerance |b| from x = 0.
/// Keeps a vector of the size of b per iteration that is done. @param precondition  P⁻¹, linear.
/// @param sum  where several processes have parts of the vectors; none: this one has them whole.
/// @param before_each  called before each iteration: may throw to end it.
GmresReport gmres(const LinearMap& multiply, const LinearMap& precondition,
                  const Eigen::VectorXd& b, double tolerance, int max_iterations,
                  Eigen::VectorXd& x, const SumOverRanks& sum = nullptr,
                  const std::function<void()>& before_each = nullptr);

}  // namespace faultsim
