#pragma once

#include <vector>

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// What was recognised, left out and chosen, in sentences: GridStructure::report.
std::vector<StructureRemark> structure_report(const CornerPointGrid& grid,
                                              const GridStructure& structure,
                                              const StructureOptions& options);

}  // namespace faultsim::corner_point
