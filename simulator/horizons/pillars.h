#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/horizons/fault_shape.h"
#include "simulator/horizons/map_mesh.h"
#include "simulator/horizons/smooth_field.h"

namespace faultsim::horizons {

/// A depth, and the knots of pillars that it lies between.
struct PillarDepth {
  double z;
  std::size_t knot;  ///< the lower one.
  double part;       ///< of the way from it to the next.
};

/// A line through every vertex of the map from the base to the top, on which all nodes lie:
/// x(v, z) = x_v + u(v, z). On a fault n · u is what its surface has moved there (FaultShape), so
/// that pillars stay on it, also where they slide along it; on sides of the box n · u = 0. Where
/// two of these meet both hold: a T or an X follows the line where both surfaces meet. What is left
/// free is as smooth as can be: ∫|Δu|² is least at each knot, a depth where some fault ends or
/// bends, and u is linear in z between.
///
/// Where a fault changes its dip along its trace, and pillars slide along it, they bend between
/// knots too: on the fault they are put back on it at every depth. On a fault whose trace bends
/// they cut the corner of the trace then.
class Pillars {
 public:
  Pillars(const LayeredBody& body, const MapMesh& map);
  /// The place of a pillar at a depth; depths are found once for many pillars.
  PillarDepth depth(double z) const;
  Eigen::Vector2d in_map(int vertex, const PillarDepth& depth) const;
  Eigen::Vector2d in_map(int vertex, double z) const { return in_map(vertex, depth(z)); }
  Eigen::Vector3d at(int vertex, double z) const;
  /// How far a pillar is at a depth from the faults that it lies on and that change their dip, m.
  /// 0 but for rounding, unless two of them meet there and Newton's method did not find the place,
  /// as where they run side by side: then it is larger, or not finite.
  double off_faults(int vertex, double z) const;
  /// z of the knots, ascending.
  const std::vector<double>& depths() const { return depths_; }

 private:
  Eigen::Vector2d on_faults(std::size_t vertex, double z, const Eigen::Vector2d& moved) const;
  std::vector<Eigen::Vector2d> moved_at(double z) const;
  double value(const FieldRule& rule, double z, const Eigen::Vector2d& moved) const;

  std::vector<Eigen::Vector2d> vertices_;
  std::vector<FaultShape> shapes_;
  SmoothField field_;
  std::vector<bool> is_put_back_;  ///< per vertex, whether it is on a fault that changes its dip.
  std::vector<double> depths_;
  std::vector<std::vector<Eigen::Vector2d>> moved_;  ///< per knot, per vertex.
};

}  // namespace faultsim::horizons
