#pragma once

#include <vector>

namespace faultsim {

/// LU factors without pivoting of a dense matrix that grows by one row and one column at a time,
///
///   M = L U,  L unit lower, U upper;
///
/// L is kept by rows and U by columns, so that appending reads and writes contiguous memory and the
/// factor can be cut back to any leading block at no cost. For a symmetric matrix all pivots are
/// positive iff it is positive definite. Appending to size m costs 2 m² flops.
class BorderedLu {
 public:
  int size() const { return size_; }
  void truncate(int size) { size_ = size; }
  void clear() { truncate(0); }
  /// Where to write the new row M(m, 0..m−1) and the new column M(0..m−1, m) before append().
  double* row();
  double* column();
  /// Appends what row() and column() hold, and the diagonal entry. @returns the pivot; when it is 0
  /// or not finite, nothing was appended.
  double append(double diagonal);
  /// x := M⁻¹ x (size()).
  void solve(double* x) const;

 private:
  void reserve();
  int size_ = 0;
  std::vector<double> lower_;  ///< row i at i (i + 1) / 2.
  std::vector<double> upper_;  ///< column j at j (j + 1) / 2, diagonal last.
};

}  // namespace faultsim
