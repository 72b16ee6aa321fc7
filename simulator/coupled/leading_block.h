#pragma once

#include "simulator/common/words.h"
#include "simulator/coupled/saddle_point.h"
#include "simulator/linalg/gmres.h"

namespace faultsim {

/// How (K + E)⁻¹ is approximated.
enum class LeadingKind { exact, fsai, incomplete_cholesky, ilu, amg, amg_by_component };
constexpr auto words(LeadingKind) {
  return std::array{"exact", "fsai", "ic", "ilu", "amg", "amg-u"};
}

/// Adaptive factored sparse approximate inverse (Janna, Ferronato, Sartoretto and Gambolati, ACM
/// TOMS 41, 2015): per row of G, at most `steps` times the `step_size` entries that lower the row's
/// factor ψ_i of the Kaporin number most, until ψ_i ≤ `tolerance` a_ii, from ψ_i = a_ii of the
/// diagonal alone.
struct FsaiOptions {
  int steps = 5;
  int step_size = 1;
  double tolerance = 0.01;
};

struct IluOptions {
  double drop_tolerance = 1e-3;  ///< relative to the row's norm.
  int max_row = 200;             ///< entries kept per row of L and of U.
};

/// z ≈ (K + E)⁻¹ r, a fixed linear map.
///
/// exact: sparse Cholesky, or LU where K + E is not symmetric positive definite. The others take
/// the symmetric part of K + E. ilu and both amg are hypre's; incomplete_cholesky is Lin and
/// Moré's (as many entries per column as K has, the largest ones, and a shift where a pivot fails).
/// Throws ResourceError when memory is short or K + E is singular.
/// @param j  given away, its matrix need not wait for the end of the set-up.
LinearMap leading_block(LeadingKind kind, SaddlePoint j, const FsaiOptions& fsai,
                        const IluOptions& ilu);

class HypreMatrix;
/// The same of a matrix in the solver's format: ilu and both amg, on all its ranks.
/// @param of  whose near-null space amg keeps. Collective, what is returned too.
LinearMap leading_block(LeadingKind kind, std::shared_ptr<HypreMatrix> a, const SaddlePoint& of,
                        const IluOptions& ilu);

/// G of the adaptive FSAI: lower triangular, A⁻¹ ≈ GᵀG, diag(G A Gᵀ) = 1.
/// @param a  symmetric positive definite, both triangles, sorted columns; ResourceError when it is
///           not.
SparseMatrix fsai_factor(const SparseMatrix& a, const FsaiOptions& options);

/// z = a⁻¹ r of a square sparse matrix: Cholesky if `symmetric` and positive definite, else LU.
/// Throws ResourceError when it is singular.
LinearMap direct_solver(const SparseMatrix& a, bool symmetric);

}  // namespace faultsim
