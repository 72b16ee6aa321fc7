#pragma once

#include "simulator/flow/cell_columns.h"

namespace faultsim {

/// Sets the dips of columns: of the plane through a column that fits those around it. Of the planes
/// through one or two of those that share a pillar with it, that one is taken to which most columns
/// lie near, these and the next ones, and of equals the flatter one; then the plane with the least
/// sum of squares of those that share a pillar and lie near it (kMeets). So what lies beyond a
/// fault does not count. O(n). @pre set_borders().
void find_dips(std::vector<CellColumn>& columns, const std::vector<CellPillar>& pillars);

/// Of a column's height: planes that are nearer to each other are one surface.
inline constexpr double kMeets = 0.1;

}  // namespace faultsim
