#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

/// LU factors with partial pivoting of a dense square matrix, by LAPACK.
class DenseLu {
 public:
  /// Factorises a copy of the matrix. @returns whether it is regular to working precision; if not,
  /// there is no factor.
  bool factor(const Eigen::Ref<const Eigen::MatrixXd>& matrix);
  void clear() { pivots_.clear(); }
  /// Size of the matrix factorised; 0 without a factor.
  Eigen::Index size() const { return static_cast<Eigen::Index>(pivots_.size()); }
  /// x := M⁻¹ x. @pre x has size() entries.
  void solve(Eigen::VectorXd& x) const;

 private:
  Eigen::MatrixXd factors_;  ///< of which size() x size() are in use.
  std::vector<int> pivots_;
};

}  // namespace faultsim
