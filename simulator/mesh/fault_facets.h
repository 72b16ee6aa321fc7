#pragma once

#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/cell_faces.h"
#include "simulator/mesh/uncut_mesh.h"

namespace faultsim {

/// A facet of a fault between its two cells.
struct FaultFacet {
  int face;                    ///< into CellFaces::faces.
  std::array<int, 4> corners;  ///< counter-clockwise seen from the plus side.
  int minus_cell, plus_cell;
};

/// Facets by fault, all sides of one fault alike (UncutMesh says which is plus). What is wrong with
/// them is appended to `problems`, and the facets in question are left out.
std::vector<std::vector<FaultFacet>> fault_facets(const UncutMesh& body, const CellFaces& faces,
                                                  std::vector<Problem>& problems);

/// The faces of each group of the boundary; what is wrong with them is appended to `problems`.
std::vector<std::vector<CellFace>> boundary_facets(const UncutMesh& body, const CellFaces& faces,
                                                   std::vector<Problem>& problems);

/// n dA of a facet, by the order of its corners, m2.
Eigen::Vector3d area_vector(const std::vector<Eigen::Vector3d>& nodes,
                            const std::array<int, 4>& corners);

/// "x 10, y 20, z -30 m", of the middle of a facet.
std::string place_of(const std::vector<Eigen::Vector3d>& nodes, const std::array<int, 4>& corners);
std::string place_text(const Eigen::Vector3d& at);

}  // namespace faultsim
