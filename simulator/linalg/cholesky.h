#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/unknown_groups.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/factor_run.h"
#include "simulator/linalg/sparse_forward.h"

namespace faultsim {

struct FactorStatistics {
  double bytes = 0;  ///< of the numerical factor.
  double factor_seconds = 0;
};

/// What a factorisation knows of the pattern of its matrix: the order of unknowns and the structure
/// of the factor. Given to several (FactorRun::analysis) it is made once as long as the pattern
/// stays; the factors are the same to the last bit. For one thread at a time.
class FactorAnalysis {
 public:
  FactorAnalysis();
  ~FactorAnalysis();
  FactorAnalysis(const FactorAnalysis&) = delete;
  FactorAnalysis& operator=(const FactorAnalysis&) = delete;
  int n_made() const;  ///< how often a new one was made.

 private:
  friend class TrailingCholesky;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Sparse supernodal Cholesky P K Pᵀ = L Lᵀ (CHOLMOD, 64-bit indices) that keeps a chosen set of
/// unknowns last, so that the trailing block of L is the factor of their Schur complement:
///
///   K = [[K_rr, K_rg], [K_gr, K_gg]],   H = K_gg − K_gr K_rr⁻¹ K_rg = L_gg L_ggᵀ. (docs/model.md,
///   8)
class TrailingCholesky {
 public:
  using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, long>;

  /// @param k        lower triangle, n x n, n ≥ 1, compressed; kept only during the call.
  /// @param n_last   the last n_last unknowns stay last, in their order.
  /// @param groups   of the n − n_last unknowns before; ordered as a graph without the last ones
  ///                 (trailing_order).
  /// Throws ResourceError when memory is short. A matrix that is not positive definite does not
  /// throw: see failed_column().
  /// Interrupted when `run` says so.
  TrailingCholesky(const SparseMatrix& k, int n_last, const UnknownGroups& groups,
                   const FactorRun& run = {});
  ~TrailingCholesky();
  TrailingCholesky(const TrailingCholesky&) = delete;
  TrailingCholesky& operator=(const TrailingCholesky&) = delete;

  /// Index of the unknown at which the matrix was found not positive definite, or singular to
  /// working precision; −1 if it is positive definite. Nothing below may be called unless −1.
  int failed_column() const;
  const FactorStatistics& statistics() const;

  /// L_gg (n_last x n_last, lower triangular, dense).
  Eigen::MatrixXd trailing_factor() const;
  /// y = L⁻¹ P f, in the order of the factor (the last n_last are the tail). For two loads a and b
  /// a_rᵀ K_rr⁻¹ b_r is the product of the first n − n_last entries of their y.
  Eigen::VectorXd forward(const Eigen::VectorXd& f);
  /// L_gg times the tail of y = forward(f): the condensed load f_g − K_gr K_rr⁻¹ f_r (n_last).
  Eigen::VectorXd condensed(const Eigen::VectorXd& y) const;
  /// The same of loads f with few entries, a column each: see condense_sparse().
  Eigen::MatrixXd condense(const std::vector<SparseLoad>& loads,
                           const std::function<void(double)>& progress) const;
  /// r = K_rr⁻¹ (f_r − K_rg g), returned as (r, g), size n.
  Eigen::VectorXd expand(const Eigen::VectorXd& f, const Eigen::VectorXd& g);
  /// The same from y = forward(f): the second half of the back-solve.
  Eigen::VectorXd expand_forward(Eigen::VectorXd y, const Eigen::VectorXd& g);
  /// K⁻¹ f.
  Eigen::VectorXd solve(const Eigen::VectorXd& f);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Version of the CHOLMOD in use: "3.0.14".
std::string cholmod_version_text();

}  // namespace faultsim
