#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace faultsim {

/// A body in cells of named volumes, with facets of named surfaces: what a mesh is before a scene
/// says what its names mean. Cells and facets are of first order.
struct NamedMesh {
  std::vector<Eigen::Vector3d> nodes;      ///< m, each the corner of a cell.
  int corners_per_cell = 0;                ///< 4 = tetrahedra, 8 = hexahedra (VTK order).
  std::vector<int> cells;                  ///< corners_per_cell for each cell, into nodes.
  std::vector<int> cell_group;             ///< per cell, into cell_groups.
  std::vector<std::string> cell_groups;    ///< names of the volumes that have cells, each once.
  std::vector<std::array<int, 4>> facets;  ///< corners, into nodes; -1 behind the last of a
                                           ///< triangle.
  std::vector<int> facet_group;            ///< per facet, into facet_groups.
  std::vector<std::string> facet_groups;   ///< the same of surfaces that have facets.
  std::string fingerprint;  ///< of a file's bytes; of a mesh that was built, fingerprint_of().
};

/// Of all that a mesh says, but for NamedMesh::fingerprint.
std::string fingerprint_of(const NamedMesh& mesh);

}  // namespace faultsim
