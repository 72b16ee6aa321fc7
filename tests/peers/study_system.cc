#include "tests/peers/study_system.h"

#include <petscviewer.h>

#include <ctime>

namespace faultsim {
namespace {

PetscViewer open_file(const std::string& path) {
  PetscViewer viewer = nullptr;
  PetscCallAbort(PETSC_COMM_SELF,
                 PetscViewerBinaryOpen(PETSC_COMM_SELF, path.c_str(), FILE_MODE_READ, &viewer));
  return viewer;
}

Mat load_matrix(const std::string& path, int block_size) {
  PetscViewer file = open_file(path);
  Mat matrix = nullptr;
  PetscCallAbort(PETSC_COMM_SELF, MatCreate(PETSC_COMM_SELF, &matrix));
  PetscCallAbort(PETSC_COMM_SELF, MatSetType(matrix, MATSEQAIJ));
  PetscCallAbort(PETSC_COMM_SELF, MatLoad(matrix, file));
  PetscCallAbort(PETSC_COMM_SELF, MatSetBlockSize(matrix, block_size));
  PetscCallAbort(PETSC_COMM_SELF, PetscViewerDestroy(&file));
  return matrix;
}

std::vector<Vec> load_vectors(const std::string& path, int n) {
  PetscViewer file = open_file(path);
  std::vector<Vec> vectors(n, nullptr);
  for (Vec& vector : vectors) {
    PetscCallAbort(PETSC_COMM_SELF, VecCreate(PETSC_COMM_SELF, &vector));
    PetscCallAbort(PETSC_COMM_SELF, VecSetType(vector, VECSEQ));
    PetscCallAbort(PETSC_COMM_SELF, VecLoad(vector, file));
  }
  PetscCallAbort(PETSC_COMM_SELF, PetscViewerDestroy(&file));
  return vectors;
}

}  // namespace

StudySystem load_study(const std::string& folder) {
  StudySystem system;
  system.leading = load_matrix(folder + "/leading.petsc", 3);
  system.coupling = load_matrix(folder + "/coupling.petsc", 1);
  system.constraint = load_matrix(folder + "/constraint.petsc", 1);
  system.near_null = load_vectors(folder + "/near-null.petsc", 6);
  system.random = load_vectors(folder + "/random.petsc", 1).front();
  system.physical = load_vectors(folder + "/physical.petsc", 1).front();
  return system;
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace faultsim
