#pragma once

#include <set>
#include <vector>

#include "simulator/corner_point/column_map.h"

namespace faultsim::corner_point {

struct Horizons {
  std::vector<Horizon> all;  ///< from the top down.
  double largest_gap = 0;    ///< m, between a layer's bottom and the next one's top.
};

/// The surfaces of the layers over the active map: a point for each pillar and each group of
/// columns around it that no fault separates and that are of one compartment. Where the layer's
/// cell is inactive, the column is of the compartment of its next active cell.
/// @param barriers  numbers of pillar edges that faults hold.
/// @param gap  m: a layer's bottom is a horizon of its own if a larger gap lies below it.
Horizons find_horizons(const ColumnMap& map, const std::set<int>& barriers,
                       const std::vector<int>& compartment_of_cell, double gap);

/// What the layers are like.
std::vector<Layer> find_layers(const ColumnMap& map, double no_thickness);

}  // namespace faultsim::corner_point
