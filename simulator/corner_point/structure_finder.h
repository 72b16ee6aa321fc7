#pragma once

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// Recognises the structure of a grid. Deterministic; time and memory in proportion to the grid.
/// @throws InputError with all options that are out of range, and where compartments are to be
/// regions that the grid has not.
GridStructure recognise_structure(const CornerPointGrid& grid, const StructureOptions& options);

}  // namespace faultsim::corner_point
