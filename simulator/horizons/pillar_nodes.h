#pragma once

#include <vector>

#include "simulator/horizons/levels.h"

namespace faultsim::horizons {

/// The nodes on pillars: levels, the depths at which faults end on pillars beside them too (0.3 of
/// a cell or more from horizons), and points between that make cells as large as they should be.
struct PillarNodes {
  std::vector<std::vector<double>> z;          ///< per vertex, ascending from base to top, m.
  std::vector<int> first;                      ///< per vertex, number of its lowest node.
  std::vector<std::vector<int>> horizon_rank;  ///< per place and horizon, into z.
  std::vector<std::vector<int>> bottom_rank, top_rank;  ///< per fault and vertex of its trace.
  int n_nodes = 0;
};

PillarNodes nodes_on_pillars(const LayeredBody& body, const MapMesh& map, const CutMap& cut,
                             const Levels& levels);

/// The layer of what lies between a node of a pillar and the next one, seen from a place.
/// @param horizon_rank  of the place.
int layer_above(const std::vector<int>& horizon_rank, int rank);

}  // namespace faultsim::horizons
