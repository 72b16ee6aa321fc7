#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/map_mesh.h"

namespace faultsim::horizons {

/// How far a fault has gone towards its hanging wall since the depth of traces, along z: linear
/// between points, constant above its top and below its bottom.
class FaultShift {
 public:
  /// @param top, bottom  z of the box.
  FaultShift(const LayeredFault& fault, double top, double bottom, double trace_depth);
  double at(double z) const;
  const std::vector<DipPoint>& points() const { return points_; }  ///< z ascending.

 private:
  std::vector<DipPoint> points_;
};

/// A line through every vertex of the map from the base to the top, on which all nodes lie:
/// x(v, z) = x_v + Σ_f W_f(v) · shift_f(z). On a fault n_f · W_f = 1 (n towards the hanging wall)
/// and n_f · W_g = 0 of all others, so that pillars stay on its surface; on sides of the box n · W
/// = 0. Where two of these meet both hold: a T or an X follows the line where both surfaces meet.
/// What is left free is as smooth as can be: ∫|ΔW|² is least.
class Pillars {
 public:
  Pillars(const LayeredBody& body, const MapMesh& map);
  Eigen::Vector2d in_map(int vertex, double z) const;
  Eigen::Vector3d at(int vertex, double z) const;
  /// Of all faults at a depth, m; and a pillar's place there.
  std::vector<double> shifts_at(double z) const;
  Eigen::Vector2d in_map(int vertex, const std::vector<double>& shifts) const;
  const FaultShift& shift(int fault) const { return shifts_[fault]; }

 private:
  std::vector<Eigen::Vector2d> vertices_;
  std::vector<FaultShift> shifts_;
  std::vector<std::vector<Eigen::Vector2d>> w_;  ///< per fault, per vertex.
};

/// Towards the hanging wall, across the trace at each of its vertices; of length 1 / cos of half
/// the angle by which the trace bends there, so that both pieces move by 1.
std::vector<Eigen::Vector2d> hanging_directions(const LayeredFault& fault, const MapMesh& map,
                                                int line);

/// Before pillars are made: a fault that leaves the box in depth, two that cut each other in depth
/// where they do not meet at the depth of traces. Appended to problems, with place.
void check_faults_in_depth(const LayeredBody& body, const MapMesh& map,
                           std::vector<Problem>& problems);

/// Pillars that cross, or come closer than a tenth of their distance (by the area of triangles at
/// one depth), appended to problems with the worst place.
void check_pillars(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                   std::vector<Problem>& problems);

}  // namespace faultsim::horizons
