#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

/// LU factors in single precision of a dense matrix that grows by rows and columns at its end, by
/// LAPACK: a preconditioner. Growing from n to n + m costs what a factorisation of size n + m costs
/// more than one of size n. Pivots are sought within what was appended at once.
class GrowingLu {
 public:
  using Block = Eigen::Map<Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

  /// Size of the matrix factorised.
  int size() const { return static_cast<int>(pivots_.size()); }
  void clear() { pivots_.clear(); }
  /// Makes room for m more rows and columns. @returns the whole matrix, (size() + m)²; the caller
  /// writes the new rows and the new columns, and leaves the leading block, which is the factor.
  Block border(int m);
  /// Factorises what was written into border(m), with the factor so far. @returns whether it is
  /// regular to working precision; if not, there is no factor.
  bool grow(int m);
  /// x := M⁻¹ x. @pre x has size() entries.
  void solve(Eigen::VectorXf& x) const;

 private:
  Eigen::MatrixXf factors_;  ///< of which the leading block is in use.
  std::vector<int> pivots_;  ///< as LAPACK counts them, from 1.
};

}  // namespace faultsim
