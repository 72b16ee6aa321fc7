#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Flow cells in a balanced tree of boxes, so that those near a place are found in O(log n). What
/// is found depends on the cells alone.
class FlowCellSearch {
 public:
  /// @param cells  at least one; must outlive the search.
  explicit FlowCellSearch(const std::vector<FlowCell>& cells);

  /// Numbers of the cells whose boxes overlap the box from low to high, m, ascending. Cells that
  /// only touch it are left out.
  std::vector<int> overlapping(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;

  /// Number of the cell the centre of whose box is nearest to the point: the first of equals.
  int nearest(const Eigen::Vector3d& point) const;

 private:
  /// The cells order_[begin, end) and the box around theirs. Its first child comes next in nodes_.
  struct Node {
    Eigen::AlignedBox3d box;
    int begin, end;
    int second_child;  ///< -1: a leaf.
  };
  void build(int begin, int end);
  Eigen::Vector3d centre_of(int cell) const;

  const std::vector<FlowCell>& cells_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace faultsim
