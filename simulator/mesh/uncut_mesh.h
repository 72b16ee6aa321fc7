#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "simulator/mesh/mesh.h"

namespace faultsim {

/// Faces of cells by a name.
struct FacetGroup {
  std::string name;
  std::vector<std::array<int, 4>> facets;  ///< corners in any order; −1 behind those of a triangle.
};

/// A meshed body before its faults cut it, of cells of one shape.
struct UncutMesh {
  std::vector<Eigen::Vector3d> nodes;  ///< m, each the corner of a cell.
  CellShape shape = CellShape::tetrahedron;
  std::vector<int> corners;             ///< corners_of_cell(shape) per cell, in VTK order.
  std::vector<int> material;            ///< per cell.
  std::vector<int> region;              ///< per cell, pressure region or −1.
  std::vector<double> region_fraction;  ///< per cell, share of its volume in the region, [0, 1].
  std::vector<FacetGroup> boundary;     ///< of the outside; BoundaryGroup is the place in it.
  std::vector<FacetGroup> faults;       ///< inside; where faults meet, the first goes on.

  std::size_t n_cells() const { return material.size(); }
};

/// Cuts the faults. Tetrahedra get nodes in the middle of their straight sides, and jumps that are
/// linear on the faults. Tips, ends at another fault (T) and crossings (X) are found (sectors.h).
///
/// The sides of a fault: n points to larger x; of one that strikes along x, to larger y; of a
/// horizontal one up. The frame of a node: n is the mean over the facets around it by area, strike
/// n × ẑ (x̂ of a horizontal one). A_k integrates the linear hat.
///
/// Throws InputError with all problems: facets that are no face of a cell, or none inside (faults)
/// or outside (boundary), or of two faults; faces of three cells; a fault that branches or turns
/// its sides; nodes where no single fault separates the rock (a V).
/// @param source  what the message is about: a file's name.
Mesh cut(const UncutMesh& body, const std::string& source);

}  // namespace faultsim
