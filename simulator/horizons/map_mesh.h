#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/delaunay.h"
#include "simulator/horizons/layered_body.h"
#include "simulator/horizons/traces.h"

namespace faultsim::horizons {

/// The map in triangles, at the depth of traces. Lines are sides of triangles all along.
struct MapMesh {
  std::vector<Eigen::Vector2d> vertices;
  Triangles triangles;
  std::vector<std::vector<int>> lines;  ///< per line its vertices in order.
  std::vector<double> size;             ///< per vertex, of cells there as BodyCells says, m.
  int n_faults = 0;                     ///< the first lines.
};

/// Sides of triangles: their ends (the lower first) and the triangles at them, ascending by ends.
struct MapSide {
  int a, b;
  int left = -1;   ///< triangle on the left of a → b; −1: none.
  int right = -1;  ///< on the right.
};
std::vector<MapSide> sides_of(const Triangles& triangles);
/// The side with these ends, or null.
const MapSide* find_side(const std::vector<MapSide>& sides, int a, int b);

/// Triangulates the box in the map with the lines in it. Delaunay, refined by circumcentres until
/// triangles are as large as sizes say and have angles above about 25 degrees, then smoothed. Where
/// lines come so close that cells would be smaller than an eighth of those at faults, that is
/// appended to problems. Equal input gives equal meshes.
MapMesh mesh_map(const LayeredBody& body, const MapLines& lines, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
