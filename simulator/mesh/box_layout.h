#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/mesh/mesh_spec.h"
#include "simulator/mesh/shear.h"

namespace faultsim {

/// A patch of a box in vectors.
struct PatchFrame {
  Eigen::Vector3d center;
  Eigen::Vector3d along;   ///< unit vector of the strike convention, horizontal.
  Eigen::Vector3d down;    ///< unit vector down dip in the plane (horizontal patch: right of strike).
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

/// Everything about a box's grid but the grid itself.
struct BoxLayout {
  size_t axis = 0;         ///< grid axis across the patches.
  size_t column_axis = 1;  ///< along strike.
  size_t row_axis = 2;     ///< down dip.
  std::vector<PatchFrame> frames;         ///< per patch.
  std::vector<size_t> plane_of;           ///< per patch, index into bent plane list.
  std::optional<Shear> shear;             ///< none without patches.
  std::optional<ColumnShear> column_shear;
  GridLines lines;
};

/// Works out the layout; problems are appended, and then the layout is not complete.
BoxLayout box_layout(const BoxMeshSpec& spec, std::vector<Problem>& problems);

/// Distance within which a point counts as on a patch's edge, m: above the merging of grid lines.
double edge_tolerance(const BoxMeshSpec& spec);

/// Per cell: region (-1 = none) and the share of its reference volume in it, exact.
struct CellRegions {
  std::vector<int> region;
  std::vector<double> fraction;
};
CellRegions cell_regions(const BoxMeshSpec& spec, const std::array<std::vector<double>, 3>& lines);

/// Lower and upper corner of a region.
std::array<std::array<double, 3>, 2> region_bounds(const BoxMeshSpec::Region& region);

/// Area of the part of a disc of this radius around (0, 0) that lies in [x0, x1] x [y0, y1], exact.
double disc_rectangle_area(double radius, double x0, double x1, double y0, double y1);

}  // namespace faultsim
