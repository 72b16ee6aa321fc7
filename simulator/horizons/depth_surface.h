#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/delaunay.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// What a depth between points comes from.
struct PointSupport {
  std::array<int, 3> corner;     ///< points of the surface; −1: none.
  std::array<double, 3> weight;  ///< sum 1.
  double away = 0;               ///< outside: how far away the edge is, m.
};

/// Scattered depths, ready to be looked up.
class PointSurface {
 public:
  /// @pre at least one point; those at one place agree.
  explicit PointSurface(std::vector<Eigen::Vector3d> points);
  double at(const Eigen::Vector2d& place) const;  ///< z, m.
  /// The points that at() comes from; `away` > 0 outside of all.
  PointSupport support_at(const Eigen::Vector2d& place) const;
  /// In an order of its own.
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  void sort_into_bins();
  PointSupport on_edge(const Eigen::Vector2d& place) const;

  std::vector<Eigen::Vector3d> points_;
  Triangles triangles_;
  std::vector<std::array<int, 2>>
      edge_;  ///< sides of the hull; of points on one line, between them.
  Eigen::Vector2d low_, bin_size_;
  int n_bins_ = 0;                      ///< along each axis.
  std::vector<std::vector<int>> bins_;  ///< triangles whose box touches the bin.
};

/// A horizon's z over the map, as layered_body.h says.
class DepthSurface {
 public:
  /// What is wrong with the numbers is appended to problems, at `pointer`; then at() is not to be
  /// asked.
  DepthSurface(const DepthOverMap& depth, const std::string& pointer,
               std::vector<Problem>& problems);
  /// m; finite everywhere.
  double at(const Eigen::Vector2d& place) const;
  /// Of scattered points, else null.
  const PointSurface* scattered() const { return scattered_.get(); }

 private:
  DepthOverMap depth_;
  std::shared_ptr<const PointSurface> scattered_;
};

}  // namespace faultsim::horizons
