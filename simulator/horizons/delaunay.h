#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace faultsim::horizons {

/// Triangles of a plane or of a map: corners counter-clockwise.
using Triangles = std::vector<std::array<int, 3>>;

/// The Delaunay triangulation of points, whose triangles fill the convex hull. Equal input gives
/// equal triangles. Points are told apart down to 2e-9 of their extent; of points closer than that
/// one is a corner. None of points on one line. Time O(n log n).
Triangles delaunay(const std::vector<Eigen::Vector2d>& points);

/// Twice the area of a triangle in the plane, > 0 if counter-clockwise, m2.
inline double cross_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace faultsim::horizons
