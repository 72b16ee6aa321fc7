#pragma once

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>

#include <Eigen/Core>

#include "simulator/coupled/start_hypre.h"
#include "simulator/elasticity/elasticity.h"

/// hypre's matrices and vectors with owners. All live on one rank (MPI_COMM_SELF).
namespace faultsim {

/// Throws ResourceError when hypre's error flag is set, and clears it. Lack of convergence is no
/// error.
void check_hypre(const char* doing);

/// A copy of a symmetric matrix as ParCSR.
class HypreMatrix {
 public:
  /// @param symmetric  both triangles, sorted columns, every diagonal there.
  explicit HypreMatrix(const SparseMatrix& symmetric);
  ~HypreMatrix();
  HypreMatrix(const HypreMatrix&) = delete;
  HypreMatrix& operator=(const HypreMatrix&) = delete;
  HYPRE_ParCSRMatrix get() const { return matrix_; }

 private:
  HYPRE_ParCSRMatrix matrix_ = nullptr;
};

/// A vector of zeros, filled from and read into Eigen's.
class HypreVector {
 public:
  explicit HypreVector(int size);
  ~HypreVector();
  HypreVector(const HypreVector&) = delete;
  HypreVector& operator=(const HypreVector&) = delete;
  HYPRE_ParVector get() const { return vector_; }
  Eigen::Map<Eigen::VectorXd> values();

 private:
  HYPRE_IJVector owner_ = nullptr;
  HYPRE_ParVector vector_ = nullptr;
};

/// The entries of a vector of hypre's, in place.
Eigen::Map<Eigen::VectorXd> values_of(HYPRE_ParVector vector);

}  // namespace faultsim
