#pragma once

#include <vector>

#include "simulator/horizons/ladders.h"

namespace faultsim::horizons {

/// The tetrahedra over triangles of the map.
struct Columns {
  std::vector<int> corners;                  ///< 4 per cell, in VTK order.
  std::vector<int> layer;                    ///< per cell.
  std::vector<int> triangle;                 ///< of the map, per cell.
  std::vector<Eigen::Vector3d> extra_nodes;  ///< behind those of pillars.
};

/// Fills each column between its three walls: from the base on, the pillar that both of its walls
/// let go up makes a tetrahedron of the triangle reached and its next node. Where each wall wants
/// another pillar first, what lies up to the next triangle on all three walls is filled from a node
/// in its middle.
Columns fill_columns(const MapMesh& map, const CutMap& cut, const std::vector<MapSide>& sides,
                     const PillarNodes& nodes, const std::vector<Ladder>& ladders,
                     const std::vector<Eigen::Vector3d>& positions);

}  // namespace faultsim::horizons
