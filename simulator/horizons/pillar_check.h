#pragma once

#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/pillars.h"

namespace faultsim::horizons {

/// Before pillars are made: a fault that leaves the box in depth, two that cut each other in depth
/// where they do not meet at the depth of traces. Appended to problems, with place.
void check_faults_in_depth(const LayeredBody& body, const MapMesh& map,
                           std::vector<Problem>& problems);

/// Pillars that cross, or come closer than a tenth of their distance (by the area of triangles at
/// one depth), appended to problems with the worst place; before that check_meetings() at depths
/// where pillars bend.
void check_pillars(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                   std::vector<Problem>& problems);

/// Pillars of a T or an X that are not on both faults (Pillars::off_faults), at depths z per vertex
/// of the map; appended to problems, the first place of each fault.
void check_meetings(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                    const std::vector<std::vector<double>>& z, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
