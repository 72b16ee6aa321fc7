#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// Pillar edges one after the other: edges[n] is between pillars[n] and pillars[n + 1].
struct EdgeChain {
  std::vector<int> pillars;
  std::vector<int> edges;  ///< into the list that was given.

  bool is_closed() const { return pillars.front() == pillars.back(); }
};

struct EdgeChains {
  std::vector<EdgeChain> chains;
  std::vector<std::vector<int>> short_chains;  ///< edges of each that was too short.
  std::vector<std::vector<int>> in_junctions;  ///< edges between chains that meet, of no chain.
};

/// Joins edges to chains. Spurs of fewer than fewest_edges beside a longer chain are cut off.
/// Where more than two chains meet, those go on in each other that turn least, if by no more than
/// 60 degrees; the others end there. Junctions fewer than 2 fewest_edges apart count as one, since
/// lines that cross at an acute angle share stairs: both chains take the edges between.
/// @param place  m, of each pillar on the map.
EdgeChains join_edges(const std::vector<FaultEdge>& edges,
                      const std::vector<Eigen::Vector2d>& place, int fewest_edges);

/// The sets of edges that share pillars.
std::vector<std::vector<int>> connected_edges(const std::vector<FaultEdge>& edges);

}  // namespace faultsim::corner_point
