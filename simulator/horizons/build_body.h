#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/horizons/found_throws.h"
#include "simulator/horizons/layered_body.h"
#include "simulator/mesh/uncut_mesh.h"

namespace faultsim::horizons {

/// What there is to know about a body that has been built.
struct BuiltBody {
  UncutMesh mesh;
  std::vector<int> layer;        ///< per cell.
  std::vector<int> compartment;  ///< per cell, or −1.
  double smallest_sicn = 1;      ///< scaled inverse condition number, over all cells.
  Eigen::Vector3d worst_place = Eigen::Vector3d::Zero();  ///< of that cell, m.
  std::size_t n_slivers = 0;                              ///< cells below 0.1.
  std::size_t n_extra_nodes = 0;   ///< inside of columns, where walls do not agree.
  int n_snapped = 0;               ///< depths joined to those of the other side of a fault.
  std::vector<FoundThrow> throws;  ///< per fault, and per horizon.
};

/// Tetrahedra of a layered body. Boundary groups are x-, x+, y-, y+, z-, z+; faults keep their
/// names and their order; every fault is exactly facets of cells. Equal input gives equal meshes.
///
/// Throws InputError with all problems found, before cells are made: numbers that make no sense;
/// traces that do not fit together (meeting_lines); a fault that leaves the box in depth, two that
/// cut each other there, pillars that cross; horizons that cross or touch; compartments that are
/// not apart; a horizon of points that has none in a part which faults without a throw cut off.
/// Also, at last, where cells would be turned inside out.
/// @param source  what the message is about: a file's name.
BuiltBody build_body(const LayeredBody& body, const std::string& source);

}  // namespace faultsim::horizons
