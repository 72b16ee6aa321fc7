#pragma once

#include <Eigen/Core>

#include "simulator/coupled/saddle_point.h"

namespace faultsim {

/// What the reverse augmented constraint preconditioner inverts instead of J (model section 11): a
/// fault that is held not rigidly but by springs D, so that multipliers can be eliminated, and
/// whose slip does not feel how its normal traction changes, so that what is left is symmetric,
///
///   [[K + E, C], [Cᵀ, −D⁻¹]]:   S_u u = r_u + C D r_λ,   λ = D (Cᵀ u − r_λ),
///
/// with S_u = K + E + C D Cᵀ, which stays regular where a fault cuts a piece loose and K is
/// singular. d_k = |K_k| / (c_k·c_k), |K_k| the Frobenius norm of K + E on the dofs of column c_k.
///
/// F, the friction of a changing normal traction, is left to GMRES. With it the symmetric part of
/// S_u, which multigrid is made for, is indefinite: a smooth slip g_T gains −d (tan φ)²/4 |g_T|² by
/// a normal jump of −tan φ/2 of it, while the rock's stiffness to it falls with its length. Left
/// out, an exact block takes no iteration more and multigrid a third of them.
Eigen::VectorXd augmenting_springs(const SaddlePoint& j);  ///< D, n_λ, Pa/m3.

/// What K lacks to the symmetric part of S_u: that of E + C D Cᵀ, n_u x n_u.
/// @param springs  empty: none, and K + E is meant.
SparseMatrix added_to_bulk(const SaddlePoint& j, const Eigen::VectorXd& springs);

/// S_u as a matrix of its own, without multipliers.
SaddlePoint augmented(const SaddlePoint& j, const Eigen::VectorXd& springs);

}  // namespace faultsim
