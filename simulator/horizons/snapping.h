#pragma once

#include "simulator/horizons/levels.h"

namespace faultsim::horizons {

/// Joins depths on pillars of faults as find_levels says. Lines that still cross are appended to
/// problems.
void snap_levels(const LayeredBody& body, const MapMesh& map, const CutMap& cut, Levels& levels,
                 std::vector<Problem>& problems);

}  // namespace faultsim::horizons
