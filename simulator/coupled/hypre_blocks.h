#pragma once

#include <memory>

#include "simulator/coupled/leading_block.h"

/// The leading blocks whose engine is hypre, on all ranks of a symmetric matrix `a`. All are
/// collective, what they return too.
namespace faultsim {

class HypreMatrix;

std::shared_ptr<HypreMatrix> hypre_matrix(const SparseMatrix& symmetric);

/// ILUT: L U with dropping, of each rank's own block. Symmetric only as far as dropping leaves it
/// so.
LinearMap hypre_ilu(std::shared_ptr<HypreMatrix> a, const IluOptions& options);
/// One V-cycle of BoomerAMG for systems of three unknowns per node, whose interpolation keeps the
/// rigid motions: translations as constants per component, rotations by hypre's "GM2" variant.
/// @param rigid_motions  own rows x 6, orthonormal.
LinearMap hypre_amg(std::shared_ptr<HypreMatrix> a, const Eigen::MatrixXd& rigid_motions);

/// The same with components apart: each is coarsened and interpolated by itself, along strong
/// entries only (0.9 of a row's largest). On stretched cells, where the rows of a node's block say
/// little of the way in which it is stiff, and not as good on cubes.
LinearMap hypre_amg_by_component(std::shared_ptr<HypreMatrix> a);

}  // namespace faultsim
