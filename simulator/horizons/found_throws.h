#pragma once

#include <vector>

#include "simulator/horizons/levels.h"

namespace faultsim::horizons {

/// What a horizon has been thrown by along a fault: how much deeper it lies on the right of the
/// trace, seen along it, on one pillar, m (negative: on the left).
struct FoundThrow {
  int fault;
  int horizon;
  double middle;   ///< at the point of the trace that is nearest to half of its length.
  double least;    ///< along the trace, without tips, where it is nothing.
  double largest;  ///< the same.
};

/// Of all faults, and of all horizons of each.
std::vector<FoundThrow> found_throws(const LayeredBody& body, const MapMesh& map,
                                     const std::vector<MapSide>& sides, const CutMap& cut,
                                     const Levels& levels);

}  // namespace faultsim::horizons
