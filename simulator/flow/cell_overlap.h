#pragma once

#include <Eigen/Core>
#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Volume of a hexahedron, m3: of its six tetrahedra around the diagonal from corner 0 to 6, which
/// is exact where the faces are plane.
double cell_volume(const CellCorners& corners);

/// Volume of the part of the hexahedron that lies in the box, m3 >= 0: the same tetrahedra, cut at
/// the six planes. Exact to rounding; boxes that tile the cell add up to its volume.
double overlap_volume(const CellCorners& corners, const FlowCell& box);
/// The same with a hexahedron: the tetrahedra of both, cut at each other's planes. Hexahedra of a grid
/// whose faces are shared, corner for corner, add up too, as equal faces are divided alike.
double overlap_volume(const CellCorners& corners, const CellCorners& other);

}  // namespace faultsim
