#pragma once

#include <vector>

#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/edge_graph.h"

namespace faultsim::corner_point {

/// A chain as a fault, but for how it ends (fault_ends.h): edges in order from the end further
/// west (then south), trace, offsets and dips.
Fault described_fault(const ColumnMap& map, const EdgeChain& chain, double reference_z,
                      double straightening);

/// The fault's pillars, one more than its edges.
std::vector<int> pillars_of(const Fault& fault);

}  // namespace faultsim::corner_point
