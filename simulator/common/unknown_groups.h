#pragma once

#include <array>
#include <vector>

namespace faultsim {

/// Unknowns of a matrix that are ordered together: those of a node.
struct UnknownGroups {
  std::vector<int> of;  ///< per unknown, 0 … n−1.
  int n = 0;
  /// Of the node in the middle of a side of a cell the groups at its ends, −1 = none. As long as
  /// there are groups, or empty: no node is in the middle of a side.
  std::vector<std::array<int, 2>> ends = {};
};

}  // namespace faultsim
