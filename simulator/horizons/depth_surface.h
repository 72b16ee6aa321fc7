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

  /// @param values  one per point of the surface.
  double of(const std::vector<double>& values) const;
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
  const std::vector<double>& depths() const { return depths_; }  ///< z of points().
  /// Values of the points as they were given, in the order of points().
  std::vector<double> in_order(const std::vector<double>& given) const;

 private:
  void sort_into_bins();
  PointSupport on_edge(const Eigen::Vector2d& place) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> depths_;
  std::vector<std::size_t> given_;  ///< per point, its number among those given.
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
  /// @param above  the horizon above, which a HungDepth hangs from; null: none.
  DepthSurface(const DepthOverMap& depth, const std::string& pointer,
               std::vector<Problem>& problems, const DepthSurface* above = nullptr);
  /// m; finite everywhere.
  double at(const Eigen::Vector2d& place) const;
  /// Of scattered points, and of what hangs from some those; else null.
  const PointSurface* scattered() const { return scattered_.get(); }
  /// Of a HungDepth: how much deeper than the horizon above, per point of scattered(), m; else
  /// empty.
  const std::vector<double>& thickness() const { return thickness_; }

 private:
  void hang(const HungDepth& hung, const DepthSurface* above, const std::string& pointer,
            std::vector<Problem>& problems);

  DepthOverMap depth_;
  std::shared_ptr<const PointSurface> scattered_;
  std::vector<double> thickness_, below_points_;  ///< the latter below the points themselves.
};

/// All horizons of a body; problems as of DepthSurface, each at "/horizons/K/depth".
std::vector<DepthSurface> depth_surfaces(const LayeredBody& body, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
