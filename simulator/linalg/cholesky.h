#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

namespace faultsim {

/// Name, kernel and threads of the BLAS in use: "OpenBLAS 0.3.21 SkylakeX, 1 thread".
std::string blas_description();
/// Empty if libblas is OpenBLAS; otherwise a loud sentence on how to get it.
std::string blas_complaint();
void set_blas_threads(int n_threads);

struct FactorStatistics {
  double bytes = 0;         ///< of the numerical factor.
  double flops = 0;         ///< of the factorisation.
  double analyse_seconds = 0;
  double factor_seconds = 0;
};

/// Sparse supernodal Cholesky P K Pᵀ = L Lᵀ (CHOLMOD, 64-bit indices) that keeps a chosen set of
/// unknowns last, so that the trailing block of L is the factor of their Schur complement:
///
///   K = [[K_rr, K_rg], [K_gr, K_gg]],   H = K_gg − K_gr K_rr⁻¹ K_rg = L_gg L_ggᵀ.          (D6)
class TrailingCholesky {
 public:
  using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, long>;

  /// @param k        lower triangle, n x n; kept only during the call.
  /// @param n_last   the last n_last unknowns stay last, in their order.
  /// @param group    unknown r → group (node) for the ordering, size n − n_last; groups are ordered
  ///                 by METIS and their unknowns kept together. n_groups groups.
  TrailingCholesky(const SparseMatrix& k, int n_last, const std::vector<int>& group, int n_groups);
  ~TrailingCholesky();
  TrailingCholesky(const TrailingCholesky&) = delete;
  TrailingCholesky& operator=(const TrailingCholesky&) = delete;

  /// Index of the unknown at which the matrix was found not positive definite; −1 if it is.
  int failed_column() const;
  const FactorStatistics& statistics() const;

  /// L_gg (n_last x n_last, lower triangular, dense).
  Eigen::MatrixXd trailing_factor() const;
  /// The condensed load f_g − K_gr K_rr⁻¹ f_r (n_last): one forward substitution.
  Eigen::VectorXd condense(const Eigen::VectorXd& f);
  /// r = K_rr⁻¹ (f_r − K_rg g), returned as (r, g), size n.
  Eigen::VectorXd expand(const Eigen::VectorXd& f, const Eigen::VectorXd& g);
  /// K⁻¹ f.
  Eigen::VectorXd solve(const Eigen::VectorXd& f);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
