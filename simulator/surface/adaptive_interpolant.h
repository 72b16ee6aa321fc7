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
  /// Looks at the function at a new node, x, and says by how much it is off there:
  /// the size of f(x) − Σ_k w_k f(x_k) over the nodes before. What the values are, and where they
  /// are kept, is its own business.
  using Surplus = std::function<double(const Eigen::VectorXd& x, const Eigen::VectorXd& weights)>;

  /// Starts with the centre, whose value is not asked for.
  AdaptiveInterpolant(int n_axes, Surplus surplus);

  /// Grows until no surplus of a node without all of its successors is above `tolerance`, or there
  /// are `most` nodes, never more. @returns the largest one left (infinite where the centre lacks
  /// successors).
  double grow(double tolerance, int most);

  const SparseGrid& grid() const { return grid_; }

 private:
  void add(const SparseGrid::Index& index);
  void expand(std::size_t node, int most);
  bool may_add(const SparseGrid::Index& index) const;

  Surplus look_;
  SparseGrid grid_;
  std::vector<double> own_;  ///< surplus by node.
  std::vector<double>
      surplus_;               ///< the same, or a tenth of that of a node before where that is more.
  std::vector<bool> is_old_;  ///< by node: its successors were looked at.
};

}  // namespace faultsim
