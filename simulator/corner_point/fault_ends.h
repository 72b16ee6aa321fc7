#pragma once

#include <vector>

#include "simulator/corner_point/column_map.h"

namespace faultsim::corner_point {

/// Fills in how the faults end, and finds where they meet. The end of a trace at another fault is
/// moved along its last piece onto the other's trace. Places along the traces and lengths are
/// filled in after that.
std::vector<Junction> meet_faults(const ColumnMap& map, std::vector<Fault>& faults);

/// Prolongs the faults at their tips, in the direction of the trace's last piece, to the edge of
/// the active map or another fault.
/// @param reference_z  of the traces.
void extend_tips(const ColumnMap& map, std::vector<Fault>& faults, double reference_z);

}  // namespace faultsim::corner_point
