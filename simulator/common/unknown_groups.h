#pragma once

#include <array>
#include <vector>

namespace faultsim {

/// Unknowns of a matrix that are ordered together: those of a node.
struct UnknownGroups {
  std::vector<int> of;  ///< per unknown, 0 … n−1.
  int n = 0;
  /// Per group of a node in the middle of a cell's side those at the ends of the side (−1 = an end
  /// without unknowns), per group of a corner two −1; empty where all nodes are corners.
  std::vector<std::array<int, 2>> ends = {};
};

}  // namespace faultsim
