#pragma once

#include <Eigen/Core>

#include "simulator/linalg/gmres.h"

namespace faultsim {

struct CgReport {
  bool converged = false;
  int iterations = 0;
  double energy_error = 0;  ///< bound of |x − A⁻¹b|_A, in the unit of √(bᵀx).
  double least_ritz = 1;    ///< θ, the smallest Ritz value of M⁻¹A met, at most 1.
};

/// Preconditioned conjugate gradients (Hestenes and Stiefel, 1952) for A x = b with A symmetric
/// positive definite, from x = 0, until the error is known to be small in the energy norm,
///
///   |x − A⁻¹b|_A = √(ρᵀA⁻¹ρ) ≤ √(ρᵀM⁻¹ρ / λ) ≤ tolerance √(bᵀM⁻¹b),      ρ = b − A x,
///
/// with λ ≤ the smallest eigenvalue of M⁻¹A. λ is θ/2: Ritz values, the eigenvalues of the Lanczos
/// matrix that the iteration is, fall towards those of M⁻¹A from above (Meurant and Strakoš, Acta
/// Numerica 15, 2006), so the bound is as sure as it is that the least one has come within a factor
/// of two. ρ is that of the recurrence until the bound holds, then computed afresh; where rounding
/// has parted the two the iteration goes on from x, so that the bound holds of the x returned. Bits
/// depend on nothing but the arguments.
///
/// @param precondition  M⁻¹ ≈ A⁻¹, symmetric positive definite, linear.
/// @param tolerance     relative, > 0: √(bᵀM⁻¹b) is |A⁻¹b|_A but for a factor between the square
/// roots of the extreme eigenvalues of M⁻¹A.
CgReport conjugate_gradients(const LinearMap& multiply, const LinearMap& precondition,
                             const Eigen::VectorXd& b, double tolerance, int max_iterations,
                             Eigen::VectorXd& x);

}  // namespace faultsim
