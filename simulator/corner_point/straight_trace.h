#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim::corner_point {

/// The line of fewest pieces, near to fewest, from which no middle of a chain's edges is farther
/// than a tolerance.
///
/// A chain that runs obliquely to the grid is a staircase whose middles lie on the oblique line;
/// its pillars do not. So the pieces are fitted to the middles (least squares, weighted by the
/// edges' lengths, places along the line as along the chain) and reach as far as the chain.
/// Corners are added, each where it helps most, until the line misses by no more.
/// @param chain  m, pillars in order, at least two, no two in a row the same.
/// @param tolerance  m, > 0.
/// @returns m, at least two points.
std::vector<Eigen::Vector2d> straight_trace(const std::vector<Eigen::Vector2d>& chain,
                                            double tolerance);

/// The place on a line that is next to a point.
struct PlaceOnLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< m.
  double along = 0;                                 ///< m from the line's first point.
  double distance = 0;                              ///< m >= 0.
  int piece = 0;                                    ///< between points piece and piece + 1.
};
PlaceOnLine nearest_on_line(const std::vector<Eigen::Vector2d>& line, const Eigen::Vector2d& point);

/// The direction of a line between the places a reach before and after one, a unit vector.
Eigen::Vector2d tangent_of(const std::vector<Eigen::Vector2d>& line, double along, double reach);

double line_length(const std::vector<Eigen::Vector2d>& line);

/// (points[n] + points[n + 1]) / 2.
std::vector<Eigen::Vector2d> middles_of(const std::vector<Eigen::Vector2d>& points);

/// > 0 where b points to the left of a.
inline double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace faultsim::corner_point
