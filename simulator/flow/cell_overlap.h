#pragma once

#include <Eigen/Core>
#include <array>

#include "simulator/flow/flow_field.h"

namespace faultsim {

using CellCorners = std::array<Eigen::Vector3d, 8>;  ///< of a hexahedron in VTK's order, m.

/// Volume of a hexahedron, m3: of its six tetrahedra around the diagonal from corner 0 to 6, which
/// is exact where the faces are plane.
double cell_volume(const CellCorners& corners);

/// Volume of the part of the hexahedron that lies in the box, m3 >= 0: the same tetrahedra, cut at
/// the six planes. Exact to rounding; boxes that tile the cell add up to its volume.
double overlap_volume(const CellCorners& corners, const FlowCell& box);

}  // namespace faultsim
