#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh.h"

namespace faultsim {

/// Cell sizes of a generated mesh, m: `normal` on the grid axis across the faults, `strike` and
/// `dip` on those nearest to strike and dip (vertical faults: y and z; flat ones of strike 0: y and
/// x). Box without patches: normal, strike, dip in x, y, z.
struct CellSizes {
  double strike;
  double dip;
  double normal;
  double growth;
  double fine_margin = 0;
  double largest = 0;  ///< 0 = no cap.
  double corner = 0;   ///< field: height of the cells at the edges of the reservoir, from which
                       ///< cells grow by corner_growth to `dip` within the faults' range; 0 or ≥
                       ///< dip: cells of about `dip` all over that range.
  double corner_growth = 1.5;
  bool grades_corners() const { return corner > 0 && corner < dip; }
};

/// The conceptual field in numbers; materials are indices.
struct FieldMeshSpec {
  double width, length, depth;     ///< m.
  std::vector<double> layer_tops;  ///< depths, m, ascending, first 0.
  std::vector<int> layer_materials;
  int reservoir_layer;  ///< index into layer_tops.
  int sideburden_material;
  struct Block {
    double from, to, offset;  ///< m.
    /// m, for which grid lines are laid out before they move to offset; none = offset.
    std::optional<double> mesh_offset = std::nullopt;
    std::optional<double> thickness = std::nullopt;  ///< m; none = of the layer.
  };
  std::vector<Block> blocks;  ///< contiguous; region index = block index.
  double block_length, fault_length, fault_overshoot, pivot_depth;  ///< m. A fault_length
                                                                    ///< of `length` has no ends.
  std::vector<std::string> fault_names;                             ///< blocks + 1.
  std::vector<double> fault_dips;  ///< rad from vertical, > 0 dips east.
  CellSizes sizes;
  bool half_domain;   ///< only y ≥ 0 (the symmetry plane is y_min).
  bool plane_strain;  ///< one cell in y at mid length, ties, thickness 1 m.
};

/// A box with fault patches and regions.
struct BoxMeshSpec {
  std::array<double, 3> from, to;    ///< m.
  std::vector<double> layer_tops_z;  ///< z of each layer's top, descending; empty = one material.
  std::vector<int> layer_materials;  ///< at least one.
  struct Patch {
    std::string name;
    std::array<double, 3> center;
    double strike, dip_from_vertical;  ///< rad, as scene's PatchGeometry.
    double length, width;              ///< m.
    bool ellipse;
  };
  std::vector<Patch> patches;
  struct Region {
    bool disc;
    std::array<double, 3> from, to;  ///< box
    std::array<double, 3> center;    ///< disc
    double radius, thickness;
  };
  std::vector<Region> regions;
  std::array<bool, 3> tied = {false, false, false};  ///< opposite faces in x, y, z tied.
  CellSizes sizes;
  bool plane_strain;
};

/// Where the grid lines go, before any mapping: the sizes of the problem without the mesh.
struct GridLines {
  std::vector<double> x, y, z;  ///< m, strictly increasing; z up.
};

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

/// Points a...b with spacing `fine` inside [fine_from, fine_to] (stretched to fit) and growing by
/// at most `growth` per cell outside, never above `largest` (0 = no cap); always contains `must`.
std::vector<double> graded_line(double a, double b, double fine_from, double fine_to, double fine,
                                double growth, double largest, const std::vector<double>& must);

}  // namespace faultsim
