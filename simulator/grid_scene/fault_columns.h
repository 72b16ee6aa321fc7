#pragma once

#include <set>

#include "simulator/corner_point/column_map.h"
#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// Numbers of the pillar edges that the model's faults hold in the grid.
std::set<int> edges_of_faults(const corner_point::ColumnMap& map,
                              const corner_point::GridStructure& structure,
                              const ModelLines& lines);

/// On which side of faults columns lie: 1 left, −1 right, 0 neither (far, or as far from both,
/// around a tip), by the number of columns between without crossing a fault.
/// @returns per fault of the model, per column.
std::vector<std::vector<int>> sides_of_columns(const corner_point::ColumnMap& map,
                                               const corner_point::GridStructure& structure,
                                               const ModelLines& lines);

}  // namespace faultsim::grid_scene
