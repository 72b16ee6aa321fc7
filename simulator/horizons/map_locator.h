#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/horizons/pillars.h"

namespace faultsim::horizons {

/// Where the pillar through a point of the rock stands on the map.
struct PlaceOnMap {
  int triangle;
  Eigen::Vector2d at;  ///< at the depth of traces, m.
};

/// Finds places on the map of points of the rock: x(u, z) of Pillars, linear between them, the
/// other way round. Exact, as at one depth the map is moved triangle by triangle.
class MapLocator {
 public:
  /// The map and the pillars must outlive it; pillars must not cross (check_pillars).
  MapLocator(const LayeredBody& body, const MapMesh& map, const std::vector<MapSide>& sides,
             const Pillars& pillars);
  /// A point outside of the box is as far outside of the map, at the triangle nearest to it.
  PlaceOnMap find(const Eigen::Vector3d& point) const;

 private:
  int start_at(const Eigen::Vector2d& at) const;

  Eigen::Vector2d low_, high_;
  const MapMesh& map_;
  const Pillars& pillars_;
  std::vector<std::array<int, 3>> across_;  ///< per triangle, over the side opposite to a corner.
  int n_bins_ = 1;                          ///< along each axis.
  std::vector<int> start_;                  ///< per bin a triangle near it.
};

}  // namespace faultsim::horizons
