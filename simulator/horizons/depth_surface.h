#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/delaunay.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// Scattered depths, ready to be looked up.
class PointSurface {
 public:
  /// @pre at least one point; those at one place agree.
  explicit PointSurface(std::vector<Eigen::Vector3d> points);
  double at(const Eigen::Vector2d& place) const;

 private:
  void sort_into_bins();
  double on_edge(const Eigen::Vector2d& place) const;

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

 private:
  DepthOverMap depth_;
  std::shared_ptr<const PointSurface> scattered_;
};

}  // namespace faultsim::horizons
