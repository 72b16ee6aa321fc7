#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/horizons/layered_body.h"
#include "simulator/horizons/map_mesh.h"

namespace faultsim::horizons {

/// The surface of a fault: at depth z its line in the map is that of the depth of traces, each
/// point moved across it by shift(along, z). Ruled: linear along the trace between the profiles of
/// LayeredFault, linear in z between their points, upright above its top and below its bottom.
class FaultShape {
 public:
  /// @param line  the fault's vertices in the map, in order: its trace, with points between.
  FaultShape(const LayeredBody& body, const LayeredFault& fault,
             const std::vector<Eigen::Vector2d>& line);

  std::size_t n_vertices() const { return across_.size(); }
  /// To the right, across the line at a vertex; of length 1 / cos of half the angle by which the
  /// line bends there, so that both pieces move by 1.
  const Eigen::Vector2d& across(std::size_t vertex) const { return across_[vertex]; }
  /// m along the line, of a vertex.
  double along(std::size_t vertex) const { return along_[vertex]; }
  /// m to the right; beyond the ends of the line as at them.
  double shift(double along, double z) const;
  /// The same at a vertex.
  double shift_at(std::size_t vertex, double z) const { return between(on_trace_[vertex], z); }
  /// z ascending: where it ends, and where profiles bend between.
  const std::vector<double>& depths() const { return depths_; }
  /// Whether it goes down alike all along its trace.
  bool is_alike() const { return is_alike_; }

 private:
  double between(double on_trace, double z) const;

  std::vector<Eigen::Vector2d> across_;
  std::vector<double> along_;       ///< per vertex.
  std::vector<double> on_trace_;    ///< per vertex, m along the trace as it was drawn.
  std::vector<double> profile_at_;  ///< per profile, the same.
  std::vector<double> depths_;
  std::vector<std::vector<double>> shifts_;  ///< per profile, per depth.
  bool is_alike_ = true;
};

/// Of all faults.
std::vector<FaultShape> fault_shapes(const LayeredBody& body, const MapMesh& map);

}  // namespace faultsim::horizons
