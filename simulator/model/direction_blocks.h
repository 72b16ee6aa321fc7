#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/model/stored_matrix.h"

namespace faultsim {

/// Directions B_1 … B_K of H, symmetric n x n, by blocks between *runs* of jumps. Jumps are
/// numbered along strike and downwards, so a run is a strip of a fault, and what one strip does to
/// another is smooth: blocks on the diagonal are kept as they are, one of two runs t < s in bases
/// that all directions share (linalg/shared_bases),
///
///   B_k(t, s) ≈ U_ts C_k,ts V_tsᵀ,
///
/// all in single precision. What H takes grows with n² K, this with n K and a little more.
struct DirectionBlocks {
  using Ranks = std::array<int, 2>;  ///< columns of U and of V.

  int count = 0;             ///< K.
  std::vector<int> begin;    ///< the first jump of each run, and n.
  std::vector<Ranks> ranks;  ///< of the pairs t < s, by s and then by t.
  StoredFloats near;         ///< a column: of each run B_1, …, B_K, by columns.
  StoredFloats far;          ///< a column: of each pair U, V, C_1ᵀ, …, C_Kᵀ, by columns.

  int size() const { return begin.back(); }  ///< n.
  int n_runs() const { return static_cast<int>(begin.size()) - 1; }
  int run_of(int jump) const;
  int n_in(int run) const { return begin[run + 1] - begin[run]; }
  static std::size_t pair(int t, int s) { return static_cast<std::size_t>(s) * (s - 1) / 2 + t; }

  /// Whether the runs are those of n jumps, and there is a pair of ranks for each two of them.
  bool is_partition_of(int n) const;
  Eigen::Index near_size() const;  ///< entries of `near` and `far` that the sizes ask for.
  Eigen::Index far_size() const;
};

/// n jumps in runs of equal length, of as many as pay.
std::vector<int> jump_runs(int n);

/// Σ_k c_k B_k, whose columns are made run by run. @pre blocks outlive this.
class DirectionSum {
 public:
  DirectionSum(const DirectionBlocks& blocks, Eigen::VectorXd factors);

  /// Adds the columns of a run. Entries (i, j) and (j, i) get the same bits, whichever run was
  /// asked for first. @param columns  n x n_in(run).
  void add_columns(int run, Eigen::Ref<Eigen::MatrixXd> columns) const;
  /// The diagonal of the sum (n).
  Eigen::VectorXd diagonal() const;

 private:
  Eigen::MatrixXd near(int run) const;
  Eigen::MatrixXd far(int t, int s) const;

  const DirectionBlocks& blocks_;
  Eigen::VectorXd factors_;
  std::vector<Eigen::Index> near_begin_, far_begin_;
};

}  // namespace faultsim
