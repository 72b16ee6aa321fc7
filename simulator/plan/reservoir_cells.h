#pragma once

#include "simulator/mesh/mesh_spec.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// About how many cells lie in pressure regions, from the lines of the grid before it is sheared
/// and shifted: what a field of pressures or temperatures has an influence of.
double reservoir_cells(const Scene& scene, const GridLines& lines, bool plane_strain);

}  // namespace faultsim
