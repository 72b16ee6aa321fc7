#pragma once

#include <Eigen/Core>

namespace faultsim {

/// Matrices A_1 … A_K of one shape in bases that all of them share:
///
///   A_k ≈ U C_k Vᵀ,     UᵀU = I, VᵀV = I.
struct SharedBases {
  Eigen::MatrixXd u, v;   ///< n_rows x r, n_columns x q.
  Eigen::MatrixXd cores;  ///< C_1ᵀ … C_Kᵀ side by side, q x (r K).
};

/// The smallest bases, one after the other, with Σ_k |A_k − U C_k Vᵀ|² ≤ left_out (Frobenius): the
/// leading directions of the columns of all A_k, then those of the rows of what is left of them
/// (sequentially truncated higher-order SVD: Vannieuwenhoven, Vandebril & Meerbergen, SIAM J. Sci.
/// Comput. 34, 2012). From Gram matrices, so that nothing below 1e-8 of the largest is told apart.
/// @param side_by_side  A_1 … A_K, n_rows x (n_columns K).
SharedBases shared_bases(const Eigen::MatrixXd& side_by_side, Eigen::Index n_columns,
                         double left_out);

/// A Bᵀ by one call of the BLAS: equal bits for equal arguments.
Eigen::MatrixXd times_transpose(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace faultsim
