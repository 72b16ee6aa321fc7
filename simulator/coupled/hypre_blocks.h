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

/// Entries of a component's row from this share of its largest on are strong for
/// hypre_amg_by_component: above what any shape of cell puts towards a weaker direction. Stiffness
/// along axis d of a cell of sides h is c_d/h_d², c_d = (λ + 2μ)/μ along the component itself and
/// 1 across. Over sides of 1 : 1 to 1 : 100 and ν up to 0.4, an entry that leads (also) along an
/// axis at most a third as stiff as the stiffest is at most 0.83 of the row's largest (cubes:
/// 0.73). Gauss and Seidel do not smooth errors along such axes, so coarsening along them fails:
/// where the threshold lets one shape's entries through, counts double.
inline constexpr double kStrongByComponent = 0.9;

/// The same with components apart: each is coarsened and interpolated by itself along the axes in
/// which cells are stiffest for it, and the rigid motions are taken away besides (kept_motions.h).
/// For stretched cells, where a node's block says little of the axis along which it is stiff; on
/// cubes it takes a few more iterations. @param rigid_motions  own rows x 6.
LinearMap hypre_amg_by_component(std::shared_ptr<HypreMatrix> a,
                                 const Eigen::MatrixXd& rigid_motions);

}  // namespace faultsim
