#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/contact/contact_problem.h"
#include "simulator/linalg/short_columns.h"

namespace faultsim {

/// G, what nodes that move do to each other: H between all dofs of some nodes, N/m, three for each,
/// 0 where a node has fewer. G grows as nodes begin to move and is read many times for each entry
/// of H gathered, so it is kept short: by symmetry of each pair of nodes only H(earlier, later), as
/// integers of 16 bits. That will do for a tangent, whose equations are measured in double
/// precision. The problem's team of threads shares what there is to do; bits do not depend on it.
class MovingBlock {
 public:
  static constexpr int kDofs = 3;  ///< per node.
  static constexpr std::size_t kShared =
      1000;  ///< places from which on it pays to share a product.

  explicit MovingBlock(const ContactProblem& problem);

  void clear();
  int n_nodes() const { return static_cast<int>(node_.size()); }
  /// Where a node is in G; −1: nowhere. Its dofs begin at three times this.
  int place(int node) const { return place_[node]; }
  /// H between the dofs of the node there.
  const Eigen::Matrix3f& own(int place) const { return own_[place]; }
  /// H between dofs of all nodes before that place (rows) and those of the node there.
  const ShortColumns& before(int place) const { return before_[place]; }

  /// Adds nodes. @pre none of them is there, and no twins.
  void add(const std::vector<int>& nodes);
  /// What vectors over the dofs must have room for: n_vector() entries.
  Eigen::Index n_vector() const { return ShortColumns::padded(Eigen::Index{kDofs} * n_nodes()); }
  /// z := G x at the dofs of the nodes at these places; elsewhere z is anything.
  /// @pre x is 0 elsewhere.
  void multiply(const std::vector<int>& places, const Eigen::VectorXf& x, Eigen::VectorXf& z) const;

 private:
  using Columns = std::array<const double*, kDofs>;  ///< of H, of a node's dofs; null: no dof.
  void gather(int place, const Columns& columns);

  const ContactProblem& problem_;
  std::vector<int> node_;   ///< per place.
  std::vector<int> place_;  ///< per node of the problem.
  std::vector<int> dofs_;   ///< kDofs per place, −1 where there is none.
  std::vector<Eigen::Matrix3f> own_;
  std::vector<ShortColumns> before_;
};

}  // namespace faultsim
