#pragma once

#include <vector>

#include "simulator/corner_point/column_map.h"

namespace faultsim::corner_point {

/// What stands between two active columns and is no less than negligible.
struct SteppingEdges {
  std::vector<FaultEdge> faulted;  ///< enough for a fault; those that bridge gaps last.
  std::vector<FaultEdge> small;    ///< not enough.
  std::vector<int> connected;      ///< numbers of edges that connections cross, one a connection.
  int n_bridged = 0;               ///< of `faulted`: too small, but between the tips of chains.
};

SteppingEdges find_stepping_edges(const ColumnMap& map, const StructureOptions& options);

}  // namespace faultsim::corner_point
