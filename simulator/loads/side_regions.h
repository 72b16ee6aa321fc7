#pragma once

#include <vector>

#include "simulator/model/fault_operator.h"

namespace faultsim {

/// The pressure region that a fault node touches on each side; -1 = none.
struct SideRegions {
  int minus = -1, plus = -1;
};

/// Per node the regions with the largest area beside it: over the pairs of neighbouring cells, area
/// times the share of the cell in the region.
/// @param region_of_load  of LoadFactors.
std::vector<SideRegions> side_regions(const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load);

}  // namespace faultsim
