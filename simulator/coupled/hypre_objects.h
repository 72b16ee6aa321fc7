#pragma once

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>

#include <Eigen/Core>

#include "simulator/coupled/ranks.h"
#include "simulator/coupled/start_hypre.h"
#include "simulator/elasticity/elasticity.h"

/// hypre's matrices and vectors with owners, divided between ranks by rows.
namespace faultsim {

/// Throws ResourceError when hypre's error flag is set, and clears it. Lack of convergence is no
/// error.
void check_hypre(const char* doing);

/// A copy of a symmetric matrix as ParCSR.
class HypreMatrix {
 public:
  /// @param symmetric  both triangles, every diagonal there; on this process alone.
  explicit HypreMatrix(const SparseMatrix& symmetric);
  /// Collective.
  /// @param rows  n x own rows: column k is row first + k.
  /// @param room  own rows x own columns: a place for each of its entries, whose values do not
  ///              count.
  HypreMatrix(const SparseMatrix& rows, const RowRanges& ranges, const Ranks& ranks,
              const SparseMatrix& room = {});
  ~HypreMatrix();
  HypreMatrix(const HypreMatrix&) = delete;
  HypreMatrix& operator=(const HypreMatrix&) = delete;

  HYPRE_ParCSRMatrix get() const { return matrix_; }
  const RowRanges& ranges() const { return ranges_; }
  const Ranks& ranks() const { return ranks_; }
  int n_own() const { return ranges_.count(ranks_); }
  /// Entry of an own row in an own column, counted from the first; null: it has no place.
  double* entry(int row, int column) const;

 private:
  Ranks ranks_;
  RowRanges ranges_;
  HYPRE_ParCSRMatrix matrix_ = nullptr;
};

/// A vector of zeros, whose own part is filled from and read into Eigen's.
class HypreVector {
 public:
  HypreVector(const RowRanges& ranges, const Ranks& ranks);
  ~HypreVector();
  HypreVector(const HypreVector&) = delete;
  HypreVector& operator=(const HypreVector&) = delete;
  HYPRE_ParVector get() const { return vector_; }
  Eigen::Map<Eigen::VectorXd> values();

 private:
  HYPRE_IJVector owner_ = nullptr;
  HYPRE_ParVector vector_ = nullptr;
};

/// The own entries of a vector of hypre's, in place.
Eigen::Map<Eigen::VectorXd> values_of(HYPRE_ParVector vector);

}  // namespace faultsim
