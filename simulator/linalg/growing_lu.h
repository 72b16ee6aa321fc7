#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

/// LU factors of a dense matrix that may grow by rows and columns at its end, by LAPACK. Growing
/// from n to n + m costs what a factorisation of size n + m costs more than one of size n. Pivots
/// are sought within what was appended at once.
/// @tparam Scalar  double, or float for a preconditioner.
template <typename Scalar>
class GrowingLu {
 public:
  using Matrix = Eigen::MatrixX<Scalar>;
  using Block = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

  /// Size of the matrix factorised.
  int size() const { return static_cast<int>(pivots_.size()); }
  void clear() { pivots_.clear(); }
  /// Makes room for m more rows and columns. @returns the whole matrix, (size() + m)²; the caller
  /// writes the new rows and the new columns, and leaves the leading block, which is the factor.
  Block border(int m);
  /// Factorises what was written into border(m), with the factor so far. @returns whether it is
  /// regular to working precision; if not, there is no factor.
  bool grow(int m);
  /// Factorises a copy of a whole matrix, square, anew. @returns as grow.
  bool factor(const Matrix& matrix);
  /// x := M⁻¹ x. @pre x has size() entries.
  void solve(Eigen::VectorX<Scalar>& x) const;

 private:
  Matrix factors_;           ///< of which the leading block is in use.
  std::vector<int> pivots_;  ///< as LAPACK counts them, from 1.
};

}  // namespace faultsim
