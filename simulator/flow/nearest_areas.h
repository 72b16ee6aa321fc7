#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

using ConvexPolygon = std::vector<Eigen::Vector2d>;  ///< corners, counter-clockwise.

/// Of places in a plane, the areas that are nearer to them than to any other (Voronoi).
struct NearestAreas {
  std::vector<ConvexPolygon> area;  ///< per place; none: all places lie on one line.
  double rim = 0;                   ///< m: how far they go beyond the places' convex hull.
};

/// An area ends a rim beyond the convex hull of all places, half the median distance to the nearest
/// place, and at the distance to its eighth neighbour: so holes and bays that are wider than the
/// places are apart belong to none. Of a grid that is turned, these are its cells; neighbours share
/// their borders to rounding. O(n) for places of some even density.
/// @param places  m, none twice.
NearestAreas nearest_areas(const std::vector<Eigen::Vector2d>& places);

/// m2 >= 0.
double polygon_area(const ConvexPolygon& polygon);

}  // namespace faultsim
