#include <petscksp.h>

#include "tests/peers/study_system.h"

namespace faultsim {
namespace {

#define FAULTSIM_PETSC(call) PetscCallAbort(PETSC_COMM_SELF, call)

/// What is left of the rigid motions without the translations: three rotations, orthonormal. For
/// BoomerAMG, which keeps translations by itself and gets a larger hierarchy from all six.
std::vector<Vec> rotations_of(const std::vector<Vec>& motions) {
  std::vector<Vec> kept;  // the translations, and what is found
  for (int c = 0; c < 3; ++c) {
    kept.push_back(nullptr);
    FAULTSIM_PETSC(VecDuplicate(motions.front(), &kept.back()));
    FAULTSIM_PETSC(VecSetBlockSize(kept.back(), 3));
    FAULTSIM_PETSC(VecStrideSet(kept.back(), c, 1));
    FAULTSIM_PETSC(VecNormalize(kept.back(), nullptr));
  }
  for (const Vec motion : motions) {
    Vec mode = nullptr;
    FAULTSIM_PETSC(VecDuplicate(motion, &mode));
    FAULTSIM_PETSC(VecCopy(motion, mode));
    for (int pass = 0; pass < 2; ++pass) {
      for (const Vec other : kept) {
        PetscScalar share = 0;
        FAULTSIM_PETSC(VecDot(other, mode, &share));
        FAULTSIM_PETSC(VecAXPY(mode, -share, other));
      }
    }
    PetscReal norm = 0;
    FAULTSIM_PETSC(VecNormalize(mode, &norm));
    if (norm > 1e-6 && kept.size() < 6) kept.push_back(mode);
  }
  kept.erase(kept.begin(), kept.begin() + 3);
  return kept;
}

/// The rigid motions as what A all but annihilates: PETSc's multigrids ask for them.
void set_near_null(const StudySystem& system) {
  PetscBool rotations = PETSC_FALSE;
  FAULTSIM_PETSC(PetscOptionsGetBool(nullptr, nullptr, "-rotations_only", &rotations, nullptr));
  const std::vector<Vec> kept =
      rotations == PETSC_TRUE ? rotations_of(system.near_null) : system.near_null;
  MatNullSpace motions = nullptr;
  FAULTSIM_PETSC(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE,
                                    static_cast<PetscInt>(kept.size()), kept.data(), &motions));
  FAULTSIM_PETSC(MatSetNearNullSpace(system.leading, motions));
  FAULTSIM_PETSC(MatNullSpaceDestroy(&motions));
  FAULTSIM_PETSC(MatSetOption(system.leading, MAT_SPD, PETSC_TRUE));
}

/// The zero block, with its diagonal: some of PETSc's algorithms look for it.
Mat zero_block(PetscInt n) {
  Mat zero = nullptr;
  FAULTSIM_PETSC(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 1, nullptr, &zero));
  for (PetscInt i = 0; i < n; ++i) FAULTSIM_PETSC(MatSetValue(zero, i, i, 0, INSERT_VALUES));
  FAULTSIM_PETSC(MatAssemblyBegin(zero, MAT_FINAL_ASSEMBLY));
  FAULTSIM_PETSC(MatAssemblyEnd(zero, MAT_FINAL_ASSEMBLY));
  return zero;
}

Mat nested(const StudySystem& system) {
  PetscInt n_multipliers = 0;
  FAULTSIM_PETSC(MatGetSize(system.constraint, &n_multipliers, nullptr));
  Mat blocks[] = {system.leading, system.coupling, system.constraint, zero_block(n_multipliers)};
  Mat j = nullptr;
  FAULTSIM_PETSC(MatCreateNest(PETSC_COMM_SELF, 2, nullptr, 2, nullptr, blocks, &j));
  return j;
}

KSP krylov(Mat j, int max_iterations) {
  KSP ksp = nullptr;
  FAULTSIM_PETSC(KSPCreate(PETSC_COMM_SELF, &ksp));
  FAULTSIM_PETSC(KSPSetOperators(ksp, j, j));
  FAULTSIM_PETSC(KSPSetType(ksp, KSPGMRES));
  FAULTSIM_PETSC(KSPGMRESSetRestart(ksp, max_iterations));
  FAULTSIM_PETSC(KSPSetPCSide(ksp, PC_RIGHT));
  FAULTSIM_PETSC(KSPSetTolerances(ksp, 1e-8, 0, PETSC_DEFAULT, max_iterations));
  PC pc = nullptr;
  FAULTSIM_PETSC(KSPGetPC(ksp, &pc));
  FAULTSIM_PETSC(PCSetType(pc, PCFIELDSPLIT));
  IS rows[2];
  FAULTSIM_PETSC(MatNestGetISs(j, rows, nullptr));
  FAULTSIM_PETSC(PCFieldSplitSetIS(pc, "u", rows[0]));
  FAULTSIM_PETSC(PCFieldSplitSetIS(pc, "l", rows[1]));
  FAULTSIM_PETSC(KSPSetFromOptions(ksp));
  return ksp;
}

/// Fields are set up where they are first applied: the first application less a second one.
double set_up(KSP ksp, Vec r) {
  PC pc = nullptr;
  Vec z = nullptr;
  FAULTSIM_PETSC(KSPGetPC(ksp, &pc));
  FAULTSIM_PETSC(VecDuplicate(r, &z));
  const double start = processor_seconds();
  FAULTSIM_PETSC(KSPSetUp(ksp));
  FAULTSIM_PETSC(PCApply(pc, r, z));
  const double middle = processor_seconds();
  FAULTSIM_PETSC(PCApply(pc, r, z));
  const double end = processor_seconds();
  FAULTSIM_PETSC(VecDestroy(&z));
  return (middle - start) - (end - middle);
}

PeerRow::Counts solve(KSP ksp, Mat j, Vec b, PeerRow& row) {
  Vec x = nullptr, r = nullptr;
  FAULTSIM_PETSC(VecDuplicate(b, &x));
  FAULTSIM_PETSC(VecDuplicate(b, &r));
  FAULTSIM_PETSC(KSPSetResidualHistory(ksp, nullptr, PETSC_DECIDE, PETSC_TRUE));
  FAULTSIM_PETSC(KSPSolve(ksp, b, x));
  const PetscReal* history = nullptr;
  PetscInt n = 0;
  FAULTSIM_PETSC(KSPGetResidualHistory(ksp, &history, &n));
  PeerRow::Counts counts;
  for (PetscInt k = n - 1; k >= 0; --k) {
    if (history[k] <= 1e-6 * history[0]) counts.to_1e6 = static_cast<int>(k);
    if (history[k] <= 1e-8 * history[0]) counts.to_1e8 = static_cast<int>(k);
  }
  PetscReal norm = 0, residual = 0;
  FAULTSIM_PETSC(MatMult(j, x, r));
  FAULTSIM_PETSC(VecAYPX(r, -1, b));
  FAULTSIM_PETSC(VecNorm(b, NORM_2, &norm));
  FAULTSIM_PETSC(VecNorm(r, NORM_2, &residual));
  row.true_residual = PetscMax(row.true_residual, residual / norm);
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  FAULTSIM_PETSC(KSPGetConvergedReason(ksp, &reason));
  if (reason < 0) row.failure = KSPConvergedReasons[reason];
  FAULTSIM_PETSC(VecDestroy(&x));
  FAULTSIM_PETSC(VecDestroy(&r));
  return counts;
}

}  // namespace

PeerRow petsc_row(const StudySystem& system, int max_iterations) {
  set_near_null(system);
  const Mat j = nested(system);
  const KSP ksp = krylov(j, max_iterations);
  PeerRow row;
  row.setup_seconds = set_up(ksp, system.random);
  const double start = processor_seconds();
  row.random = solve(ksp, j, system.random, row);
  row.solve_seconds = processor_seconds() - start;
  row.physical = solve(ksp, j, system.physical, row);
  return row;
}

}  // namespace faultsim
