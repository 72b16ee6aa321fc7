#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "simulator/horizons/depth_surface.h"
#include "simulator/horizons/local_fit.h"
#include "simulator/horizons/map_barriers.h"

namespace faultsim::horizons {

/// The points of a horizon as they stand on the map, to be looked at from its places.
class SidedPoints {
 public:
  /// @param on_map  per point of the surface; both must outlive it.
  SidedPoints(const PointSurface& surface, const std::vector<Eigen::Vector2d>& on_map);

  /// Points that stand on a barrier (nearer than `away`) belong to neither side: left out.
  void leave_out(const MapBarriers& barriers, double away);
  bool is_left_out(std::size_t point) const { return is_out_[point]; }

  /// Whether the surface's depth at x, y is one of a place of the map: all points that it comes
  /// from are seen from there; and it is not the edge's, of points beyond which the barriers are
  /// nearer than the edge is.
  bool is_seen(const MapBarriers& barriers, const Eigen::Vector2d& from,
               const Eigen::Vector2d& xy) const;
  /// The fit to points seen from a place: up to 14 of the 400 nearest, each further from those
  /// taken before than 0.4 of its way, so that rows of points do not hide what is beyond them; as
  /// at 1.7 spacings of points from the nearest one, where that is further away. Empty
  /// if none is seen.
  std::optional<LocalFit> fit(const MapBarriers& barriers, const Eigen::Vector2d& from) const;
  /// The same to other values of the same points, one per point of the surface, > 0; and what they
  /// are at a place at x, y: no less than half of the least of those seen.
  std::optional<double> fitted(const std::vector<double>& values, const MapBarriers& barriers,
                               const Eigen::Vector2d& from, const Eigen::Vector2d& xy) const;
  /// The least and the largest depth of the points nearest to a place, of all sides.
  std::pair<double, double> depths_near(const Eigen::Vector2d& from) const;

 private:
  struct Candidate {
    double away;
    int point;
  };
  std::vector<Candidate> nearest(const Eigen::Vector2d& from, double within) const;
  std::vector<Candidate> seen(const MapBarriers& barriers, const Eigen::Vector2d& from) const;

  const PointSurface& surface_;
  const std::vector<Eigen::Vector2d>& on_map_;
  std::vector<bool> is_out_;
  Eigen::Vector2d low_;
  double bin_size_ = 1, extent_ = 1;
  int nx_ = 1, ny_ = 1;
  std::vector<std::vector<int>> bins_;
};

}  // namespace faultsim::horizons
