#pragma once

#include <Eigen/Core>

#include "simulator/linalg/gmres.h"

namespace faultsim {

/// A symmetric preconditioner that also takes away what is slow: on a body that is held at a few
/// points its rigid motions, which multigrid by components does not interpolate.
///
///   z = Q r + (I − Q A) B (I − A Q) r,     Q = R (Rᵀ A R)⁻¹ Rᵀ,     R = (I − B A) motions
///
/// (balancing; Mandel, Commun. Numer. Methods Eng. 9, 1993). One step of B bends the motions to
/// what they are next to the points that are held, without which half of the gain is lost. Costs
/// one B per motion at set-up, two vectors per motion, no product with A per application.
/// @param multiply  A, symmetric positive definite. @param block  B, symmetric.
/// @param sum       where ranks have parts of all vectors; all calls are collective then.
/// @param motions   n x n_motions, independent, none in the null space of A.
LinearMap with_motions_kept(LinearMap block, const LinearMap& multiply,
                            const Eigen::MatrixXd& motions, const SumOverRanks& sum = nullptr);

}  // namespace faultsim
