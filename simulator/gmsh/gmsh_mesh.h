#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "simulator/common/named_mesh.h"

namespace faultsim {

/// What a Gmsh file says of a body: cells of its physical volumes, facets of its physical surfaces,
/// groups in the order of their numbers, nodes in the order of the file. Of cells and facets of
/// second order the corners are kept, what the nodes amid their sides say is `largest_bend`.
/// Whether cells have a volume, and whether facets are faces of cells, is not looked at.
struct GmshMesh : NamedMesh {
  std::vector<std::int64_t> node_tags;  ///< per node, > 0: its number in the file, for messages.
  double largest_bend = 0;  ///< m: how far a node amid a side lies from the side's middle.
};

inline constexpr std::size_t kMostGmshBytes = 2'000'000'000;  ///< some 40 million tetrahedra.

/// Reads a file of format MSH 4.1: text, or binary in either order of bytes.
///
/// Cells are tetrahedra of 4 or 10 nodes or hexahedra of 8, one of the two in a file; facets are
/// triangles of 3 or 6 nodes and quadrangles of 4. Points, lines, and surfaces without a physical
/// group mean nothing. The facets of a surface in several physical groups are there once for each.
/// A physical group without a name is "physical volume 7".
///
/// Throws InputError with all that is wrong: in text by lines, in binary by bytes from the file's
/// begin. Of problems of a kind the first 20 are spelled out. Takes time and memory in proportion
/// to the file (tags: n log n), whatever numbers stand in it.
GmshMesh read_gmsh(const std::filesystem::path& file);

}  // namespace faultsim
