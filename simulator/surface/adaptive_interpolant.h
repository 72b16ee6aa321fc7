#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "simulator/surface/sparse_grid.h"

namespace faultsim {

/// A function of [-1, 1]^d on a sparse grid that grows where the function asks for it: the node
/// with the largest surplus among those whose successors are not there gets them (Gerstner &
/// Griebel 2003, with one node per index). Deterministic: ties go to the node that came first.
class AdaptiveInterpolant {
 public:
  using Function = std::function<Eigen::VectorXd(const Eigen::VectorXd& x)>;
  using Size = std::function<double(const Eigen::VectorXd& difference)>;

  /// Asks for the value at the centre.
  /// @param size  of a difference of two values: what surpluses are compared by.
  AdaptiveInterpolant(int n_axes, Function function, Size size);

  /// Grows until no surplus of a node without successors is above `tolerance`, or there are `most`
  /// nodes. @returns the largest one left (infinite where only the centre is there).
  double grow(double tolerance, int most);

  const SparseGrid& grid() const { return grid_; }
  const std::vector<Eigen::VectorXd>& values() const { return values_; }  ///< by node.

 private:
  void add(const SparseGrid::Index& index);
  void expand(std::size_t node);
  bool may_add(const SparseGrid::Index& index) const;

  Function function_;
  Size size_;
  SparseGrid grid_;
  std::vector<Eigen::VectorXd> values_;
  std::vector<double> own_;  ///< surplus by node.
  std::vector<double>
      surplus_;               ///< the same, or a tenth of that of a node before where that is more.
  std::vector<bool> is_old_;  ///< by node: its successors were looked at.
};

}  // namespace faultsim
