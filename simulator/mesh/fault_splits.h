#pragma once

#include <utility>
#include <vector>

#include "simulator/mesh/fault_facets.h"
#include "simulator/mesh/sectors.h"

namespace faultsim {

/// The corners of a body, and the sides of its tetrahedra, that faults cut.
struct FaultSplits {
  std::vector<SplitNode> corners;              ///< by node, ascending.
  std::vector<SplitNode> sides;                ///< SplitNode::node: into side_ends.
  std::vector<std::pair<int, int>> side_ends;  ///< of facets, ascending.
};

/// Problems are appended: places where no single fault separates the rock, and cells that meet a
/// fault at one corner only.
/// @param facets  by fault.
FaultSplits split_at_faults(const UncutMesh& body, const CellFaces& faces,
                            const std::vector<std::vector<FaultFacet>>& facets,
                            std::vector<Problem>& problems);

/// The sector of a cell at a node that is split; −1 = none.
int sector_of(const SplitNode& node, int cell);

}  // namespace faultsim
