#pragma once

#include <vector>

#include "simulator/horizons/cut_map.h"
#include "simulator/horizons/depth_surface.h"
#include "simulator/horizons/pillars.h"

namespace faultsim::horizons {

/// Depths on pillars that cells must keep.
struct Levels {
  std::vector<std::vector<double>> horizons;  ///< per place of the cut map, from top to bottom, m.
  /// Per fault and vertex of its trace, where it ends in depth, m; the base and the top of the box
  /// where it does not.
  std::vector<std::vector<double>> bottom, top;
  int n_snapped = 0;  ///< depths that have been joined to those of another side.
};

/// Where horizons meet pillars, shifted by throws; those of points on sides of their own where a
/// fault has no throw (SidedHorizon).
///
/// Horizons that touch or cross, or leave the box, are appended to problems with the worst place;
/// so is a throw that goes on above or below the end of its fault. Depths on one pillar that come
/// from different sides and are closer than 0.12 of a cell are joined, horizons of both sides only
/// from 0.03 of a cell down where no fault of the pillar has a throw that is given: then it is that
/// of points, a measured one. Where the lines of both sides cross between two pillars of a fault,
/// they are joined at the nearer one, half way or as near to it as the layers of both sides allow;
/// at the other one where they do not, or where the nearer is a tip, at which both sides are one.
Levels find_levels(const LayeredBody& body, const MapMesh& map, const CutMap& cut,
                   const Pillars& pillars, const std::vector<DepthSurface>& horizons,
                   std::vector<Problem>& problems);

}  // namespace faultsim::horizons
