#pragma once

#include <set>
#include <vector>

#include "simulator/corner_point/column_map.h"

namespace faultsim::corner_point {

struct Compartments {
  std::vector<Compartment> all;
  std::vector<int> of_cell;  ///< into all; −1: inactive.
};

/// @param barriers  numbers of pillar edges that faults hold.
Compartments find_compartments(const ColumnMap& map, const std::set<int>& barriers,
                               CompartmentRule rule);

}  // namespace faultsim::corner_point
