#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {

/// Sines and slopes below this are rounding of degrees to radians.
inline constexpr double kAngleTolerance = 1e-9;

/// A patch of a box in vectors.
struct PatchFrame {
  Eigen::Vector3d center;
  Eigen::Vector3d along;  ///< unit vector of the strike convention, horizontal.
  Eigen::Vector3d down;  ///< unit vector down dip in the plane (horizontal patch: right of strike).
  Eigen::Vector3d normal;  ///< n of FaultNode: positive component on the grid axis across.
  Eigen::Vector3d strike;  ///< strike of FaultNode.
  Eigen::Vector3d dip;     ///< dip of FaultNode = n × strike.
  double half_length, half_width;
  bool ellipse;
  bool horizontal;

  /// Half extents of the patch's bounding box, m.
  Eigen::Vector3d half_extent() const;
  /// True strictly inside, by more than a rounding `tolerance`, m. along_limit = false: unlimited
  /// along strike (plane strain).
  bool inside(const Eigen::Vector3d& position, double tolerance, bool along_limit) const;
};

/// In-plane shear of the columns of a fault that has both strike and dip, so that the ends of
/// rectangles lie on grid lines: x_b = ref + weight(ref) slope (clamp(x_c, low, high) − pivot).
struct ColumnShear {
  double slope = 0;
  double pivot = 0, low = 0, high = 0;
  std::vector<double> knot, weight;  ///< ascending in knot; linear between.

  double shift(double ref, double c) const;
  /// Reference coordinate of the column that passes (b, c) where the weight is 1.
  double reference(double b, double c) const { return b - slope * (c - pivot); }
};

/// The patches of a box in vectors, normals not yet oriented; impossible ones are reported.
std::vector<PatchFrame> patch_frames(const BoxMeshSpec& spec, std::vector<Problem>& problems);

/// The first grid axis on which every plane is within 45 degrees of the grid; 3 = none.
size_t common_axis(const std::vector<PatchFrame>& frames);

/// Sets normal, strike and dip: the plus side is the one of larger coordinate on the axis.
void orient(PatchFrame& frame, size_t axis);

/// JSON Pointer of a patch in the scene.
std::string patch_pointer(size_t patch);

inline double component(const Eigen::Vector3d& v, size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

}  // namespace faultsim
