#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

/// The k-th Leja point of [-1, 1]: 0, 1, −1, then the place where Π |x − x_i| over the points
/// before is largest (the left one of two). Nested, and interpolation at them is stable: Lebesgue
/// constants grow slower than the square of their number (Chkifa 2013). Rounded to 1e-12, so that
/// they print and read back as the same numbers.
double leja_point(int k);

/// Polynomial interpolation on a nested, dimension-adaptive sparse grid of Leja points in [-1, 1]^d
/// (Gerstner & Griebel 2003; Chkifa, Cohen & Schwab 2014). A multi-index ν is one node, whose
/// coordinate on axis j is the ν_j-th Leja point; the indices are downward closed. With the Newton
/// polynomials h_k(x) = Π_{i<k} (x − x_i) / (x_k − x_i),
///
///   I f(x) = Σ_ν s_ν Π_j h_{ν_j}(x_j),      s_ν = f(x_ν) − I' f(x_ν),
///
/// I' the interpolant of the nodes before: s_ν, the surplus, is what the node adds.
class SparseGrid {
 public:
  using Index = std::vector<int>;

  /// One node, the centre.
  explicit SparseGrid(int n_axes);

  int n_axes() const { return static_cast<int>(indices_.front().size()); }
  int n_nodes() const { return static_cast<int>(indices_.size()); }
  /// In the order in which they were added.
  const std::vector<Index>& indices() const { return indices_; }
  /// Coordinates of a node (n_axes), in [-1, 1].
  Eigen::VectorXd node(int k) const { return place(indices_[k]); }
  static Eigen::VectorXd place(const Index& index);

  /// True when every index that is one less on one axis is there and this one is not.
  bool admits(const Index& index) const;
  /// The admissible indices that are one more than `index` on one axis, by axis.
  std::vector<Index> successors(const Index& index) const;
  /// Adds a node and returns its number. InternalError unless admits(index).
  int add(const Index& index);

  /// w (n_nodes): I f(x) = Σ_k w_k f(x_k); a unit vector at a node, exactly.
  Eigen::VectorXd weights(const Eigen::VectorXd& x) const;

 private:
  Eigen::VectorXd newton(const Eigen::VectorXd& x) const;  ///< Π_j h per node.

  std::vector<Index> indices_;
  Eigen::MatrixXd newton_at_nodes_;  ///< unit lower triangular: row = node, column = polynomial.
};

}  // namespace faultsim
