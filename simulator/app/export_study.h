#pragma once

#include <filesystem>

#include "simulator/coupled/saddle_point.h"

namespace faultsim {

/// Writes J, scaled as GMRES sees it, with what a solver of others needs, as PETSc's binary files
/// into a folder that is made:
///
///   leading.petsc     K + E, n_u x n_u
///   coupling.petsc    s (C − F), n_u x n_λ          s: scale_of_multipliers
///   constraint.petsc  s Cᵀ, n_λ x n_u
///   near-null.petsc   six vectors: the rigid motions, orthonormal
///   random.petsc, physical.petsc   right-hand sides (f, s g), n_u + n_λ, as solver_study.h
///
/// Throws StorageError.
void export_study(const std::filesystem::path& folder, const TwoSidedBulk& bulk,
                  const SaddlePoint& j);

}  // namespace faultsim
