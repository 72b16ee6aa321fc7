#pragma once

#include <array>
#include <optional>
#include <vector>

#include "simulator/mesh/mesh_spec.h"
#include "simulator/mesh/patch_frame.h"
#include "simulator/mesh/shear.h"

namespace faultsim {

/// Everything about a box's grid but the grid itself.
struct BoxLayout {
  size_t axis = 0;                 ///< grid axis across the patches.
  size_t column_axis = 1;          ///< along strike.
  size_t row_axis = 2;             ///< down dip.
  std::vector<PatchFrame> frames;  ///< per patch.
  std::vector<size_t> plane_of;    ///< per patch, index into bent plane list.
  std::optional<Shear> shear;      ///< none without patches.
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
CellRegions cell_regions(const BoxMeshSpec& spec, const GridLines& lines);

/// Area of the part of a disc of this radius around (0, 0) that lies in [x0, x1] x [y0, y1], exact.
double disc_rectangle_area(double radius, double x0, double x1, double y0, double y1);

}  // namespace faultsim
