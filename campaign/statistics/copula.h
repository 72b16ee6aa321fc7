#pragma once

#include <optional>
#include <span>
#include <vector>

namespace faultsweep {

/// A Gaussian copula: uniform numbers that are correlated, whatever the marginals they are put
/// through afterwards. With Spearman's rank correlations ρ the normal numbers behind them have
/// r = 2 sin(π ρ / 6) (Pearson 1907).
class GaussianCopula {
 public:
  /// @param rank_correlations  symmetric, ones on the diagonal; [row][column].
  /// Nothing where no numbers can have these correlations (the matrix of r is not positive
  /// definite).
  static std::optional<GaussianCopula> make(
      const std::vector<std::vector<double>>& rank_correlations);

  /// Independent uniform numbers in [0, 1) become correlated ones in (0, 1), each uniform; the
  /// first stays as it is. @pre one for each row of the matrix.
  void correlate(std::span<double> u) const;

 private:
  std::vector<std::vector<double>> factor_;  ///< Cholesky's, lower.
};

}  // namespace faultsweep
