#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh.h"
#include "simulator/scene/geometry.h"

namespace faultsim {

/// What it takes to mesh a field or a box besides its geometry, which is as the reader of scenes
/// lets it pass.
struct MeshRequest {
  std::vector<int> layer_materials = {};      ///< index per layer; one of a box without layers.
  std::vector<std::string> fault_names = {};  ///< a field: blocks + 1.
  MeshSizes sizes = {};
  bool plane_strain = false;  ///< one cell in y, ties; of a field at mid length, thickness 1 m.
};

struct FieldMeshSpec : FieldGeometry, MeshRequest {
  int sideburden_material = 0;
  std::vector<double> fault_dips = {};  ///< rad from vertical, > 0 dips east.
  bool half_domain = false;             ///< only y ≥ 0 (the symmetry plane is y_min).
};

struct BoxMeshSpec : BoxGeometry, MeshRequest {
  std::array<bool, 3> tied = {false, false, false};  ///< opposite faces in x, y, z tied.
};

/// Where the grid lines go, before any mapping: the sizes of the problem without the mesh.
using GridLines = std::array<std::vector<double>, 3>;  ///< x, y, z, m, strictly increasing; z up.

/// Grid lines of a spec; cheap, used by `plan`. Problems (impossible geometry) are appended, with
/// pointers into the scene document ("/geometry/blocks/1/offset"; a box's patches are its
/// "/faults"), and the lines are then empty. Too many cells are a problem that is found before they
/// are made; what needs the mesh itself (quality, ties) is left to make_mesh.
///
/// Field: lines are laid out for the blocks' mesh_offset; between the depths that must be lines
/// (layers, reservoir edges, tips of faults) they then follow those smoothly to the blocks' offset,
/// z + δ_low + (δ_high − δ_low) s²(3 − 2s): cells correspond one to one over a range of offsets,
/// those at reservoir edges nearly keep their height, and positions are analytic in the offset. A
/// problem where the order of those depths changes or a gap more than halves or grows 2.5 times.
///
/// Box: fine in the plane of the patches within their bounds and fine_margin; without patches
/// within those of the regions in all directions; without either even. Edges of patches, regions
/// and layers are lines. Regions and layers are taken in unsheared coordinates:
/// there a patch lies where its plane passes the centre of the first patch parallel to it (its own,
/// if it is alone).
GridLines grid_lines(const FieldMeshSpec& spec, std::vector<Problem>& problems);
GridLines grid_lines(const BoxMeshSpec& spec, std::vector<Problem>& problems);

/// Makes the mesh. Throws InputError when geometry is impossible or a cell is bad.
Mesh make_mesh(const FieldMeshSpec& spec);
Mesh make_mesh(const BoxMeshSpec& spec);
/// What make_mesh(spec) says of faults, nodes, materials and regions, without cells, boundary and a
/// look at their quality; nothing where its topology is not that of `like`.
std::optional<Mesh> make_faults(const FieldMeshSpec& spec, const Mesh& like);

}  // namespace faultsim
