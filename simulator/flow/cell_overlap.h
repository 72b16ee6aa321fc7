#pragma once

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Volume of a hexahedron, m3: of its six tetrahedra around the diagonal from corner 0 to 6, which
/// is exact where the faces are plane.
double cell_volume(const CellCorners& corners);

/// Volume of a flow cell, m3 >= 0. Tetrahedra that a twisted cell turns inside out count against
/// it, so that cells of a grid add up to what the grid fills.
double flow_cell_volume(const FlowCell& cell);

/// Volume of the part of the hexahedron that lies in the flow cell, m3 >= 0: the same tetrahedra,
/// cut at the planes of the box or of the flow cell's tetrahedra. Flow cells that tile the
/// hexahedron add up to its volume: boxes to rounding, hexahedra to 1e-12 of it per cell, below
/// which they touch.
double overlap_volume(const CellCorners& corners, const FlowCell& flow_cell);

}  // namespace faultsim
