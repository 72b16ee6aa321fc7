#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/named_mesh.h"
#include "simulator/scene/scene_key.h"

/// What a scene is made of, in space: materials, the field or box, cells.
namespace faultsim {

struct Material {
  std::string name;
  double density = 0;               ///< kg/m3, bulk.
  double youngs_modulus = 0;        ///< Pa.
  double poisson_ratio = 0;         ///< in [0, 0.4999].
  double biot = 1;                  ///< Biot coefficient b in [0, 1].
  double thermal_expansion = 0;     ///< α_T >= 0, linear, 1/K.
  std::optional<double> viscosity;  ///< η > 0, Pa s, Maxwell: ε̇_v = s/(2η); none = elastic.
  bool operator==(const Material&) const = default;
};
/// Its name is the key of the object.
void for_each_key(Of<Material> auto& m, auto&& visit) {
  visit({"density"}, m.density);
  visit({"youngs_modulus", kRequired | kFamily}, m.youngs_modulus);
  visit({"poisson_ratio", kRequired | kFamily}, m.poisson_ratio);
  visit({"biot"}, m.biot);
  visit({"thermal_expansion", unless(m.thermal_expansion != 0, kSilent)}, m.thermal_expansion);
  visit({"viscosity"}, m.viscosity);
}

/// A horizontal layer by its top; it reaches to the next layer's top or the base of the model.
struct Layer {
  std::string name;
  std::string material;
  double top_depth = 0;  ///< m, at zero offset.
  bool operator==(const Layer&) const = default;
};
void for_each_key(Of<Layer> auto& l, auto&& visit) {
  visit({"name"}, l.name);
  visit({"material"}, l.material);
  visit({"top", kRequired}, l.top_depth);
}

/// One compartment of a field: x in [from, to], the reservoir shifted down by `offset`.
struct Block {
  std::string name;   ///< also the name of its pressure region.
  double from = 0;    ///< m.
  double to = 0;      ///< m.
  double offset = 0;  ///< m, > 0 is down: of the reservoir's top.
  /// Pa, of its own: what its initial pressure is above hydrostatic (profile: above the profile),
  /// at all depths of its reservoir. None = that of the column at the same depth.
  std::optional<double> overpressure = std::nullopt;
  /// m: grid lines are laid out for this offset and then moved to `offset` (FieldMeshSpec). None =
  /// for `offset`.
  std::optional<double> mesh_offset = std::nullopt;
  /// m, of its reservoir from its top down. None = that of the reservoir layer.
  std::optional<double> thickness = std::nullopt;
  /// m: where it begins and ends along y, beside it is sideburden. None = at ∓block_length/2.
  std::optional<double> y_from = std::nullopt;
  std::optional<double> y_to = std::nullopt;
  bool operator==(const Block&) const = default;
};
void for_each_key(Of<Block> auto& b, auto&& visit) {
  visit({"name"}, b.name);
  visit({"from", kRequired | kFamily}, b.from);
  visit({"to", kRequired | kFamily}, b.to);
  visit({"offset", kFamily}, b.offset);
  visit({"overpressure"}, b.overpressure);
  visit({"mesh_offset", kFamily}, b.mesh_offset);
  visit({"thickness"}, b.thickness);
  visit({"y_from"}, b.y_from);
  visit({"y_to"}, b.y_to);
}

/// How far a fault of a field reaches where that is not as of the others.
struct FaultExtent {
  std::optional<double> y_from = std::nullopt;     ///< m. None = at −fault_length/2.
  std::optional<double> y_to = std::nullopt;       ///< m. None = at fault_length/2.
  std::optional<double> overshoot = std::nullopt;  ///< m. None = fault_overshoot.
  bool operator==(const FaultExtent&) const = default;
};
void for_each_key(Of<FaultExtent> auto& e, auto&& visit) {
  visit({"y_from"}, e.y_from);
  visit({"y_to"}, e.y_to);
  visit({"overshoot"}, e.overshoot);
}

/// The conceptual Dutch field: layers, a row of contiguous reservoir blocks, a
/// fault at every block boundary (n_blocks + 1 faults, from west to east, see Scene::faults).
struct FieldGeometry {
  double width = 0;             ///< m, extent in x, centred on 0.
  double length = 0;            ///< m, extent in y, centred on 0.
  double depth = 0;             ///< m, base of the model.
  std::vector<Layer> layers;    ///< from the surface down.
  std::string reservoir_layer;  ///< the layer that the blocks shift and that is depleted.
  std::string sideburden;       ///< material beside the blocks at reservoir level.
  std::vector<Block> blocks;    ///< west to east, contiguous.
  double block_length = 0;      ///< m, blocks cover |y| <= block_length/2 unless they say.
  double fault_length = 0;      ///< m, faults cover |y| <= fault_length/2 unless they say.
  /// m above the shallowest and below the deepest reservoir edge touched.
  double fault_overshoot = 150;
  double pivot_depth = 0;  ///< m, where a dipping fault keeps its x.
  /// One per Scene::faults, same order; empty where all are as fault_length and fault_overshoot
  /// say.
  std::vector<FaultExtent> fault_extents;
  /// Whether a block takes an end from block_length.
  bool uses_block_length() const {
    for (const Block& block : blocks)
      if (!block.y_from || !block.y_to) return true;
    return blocks.empty();
  }
  /// Whether a fault takes an end from fault_length.
  bool uses_fault_length() const {
    for (const FaultExtent& fault : fault_extents)
      if (!fault.y_from || !fault.y_to) return true;
    return fault_extents.empty();
  }
  bool operator==(const FieldGeometry&) const = default;
};
void for_each_key(Of<FieldGeometry> auto& f, auto&& visit) {
  visit({"kind", kByHand}, "field");
  visit({"width", kRequired}, f.width);
  visit({"length", kRequired}, f.length);
  visit({"depth", kRequired}, f.depth);
  visit({"layers", kByHand}, f.layers);
  visit({"reservoir_layer"}, f.reservoir_layer);
  visit({"sideburden"}, f.sideburden);
  visit({"blocks", kByHand}, f.blocks);
  visit({"block_length", kRequired | unless(f.uses_block_length(), kIdle)}, f.block_length);
  visit({"fault_length", kRequired | unless(f.uses_fault_length(), kIdle)}, f.fault_length);
  visit({"fault_overshoot"}, f.fault_overshoot);
  visit({"pivot_depth", kByHand}, f.pivot_depth);
  visit({"fault_extents", kByHand | unless(!f.fault_extents.empty(), kSilent)}, f.fault_extents);
}

enum class PatchShape { rectangle, ellipse };
constexpr auto words(PatchShape) { return std::array{"rectangle", "ellipse"}; }

/// Where a fault patch of a `box` lies. A node splits iff strictly inside the patch; a patch that
/// cuts the whole body is made larger than the body.
struct PatchGeometry {
  std::array<double, 3> center = {0, 0, 0};  ///< m.
  double strike = 0;             ///< rad from north (+y) clockwise towards east (+x): 0 = along y.
  double dip_from_vertical = 0;  ///< rad; 0 vertical, > 0 dips to the right of strike (east for
                                 ///< strike 0), pi/2 = horizontal.
  double length = 0;             ///< m along strike (full length).
  double width = 0;              ///< m down dip (full width).
  PatchShape shape = PatchShape::rectangle;
  bool operator==(const PatchGeometry&) const = default;
};
void for_each_key(Of<PatchGeometry> auto& p, auto&& visit) {
  visit({"center", kRequired | kFamily}, p.center);
  visit({"strike", kFamily}, p.strike);
  visit({"dip_from_vertical", kFamily}, p.dip_from_vertical);
  visit({"length", kRequired | kFamily}, p.length);
  visit({"width", kRequired | kFamily}, p.width);
  visit({"shape", kFamily}, p.shape);
}

/// The six faces of a box: x- x+ y- y+ z- z+.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };
constexpr auto words(Side) { return std::array{"x-", "x+", "y-", "y+", "z-", "z+"}; }

enum class BoundaryKind {
  free,          ///< no traction change.
  roller,        ///< no displacement normal to the face.
  fixed,         ///< no displacement.
  displacement,  ///< u = factor(t) (translation + gradient x) for the components listed.
  stress,        ///< traction change factor(t) Δσ n.
  tied,          ///< with the opposite face: same displacement (periodic).
};
constexpr auto words(BoundaryKind) {
  return std::array{"free", "roller", "fixed", "displacement", "stress", "tied"};
}

/// A piecewise-linear function of time, constant outside. Empty = 1 at all times.
struct TimeTable {
  std::vector<double> time;    ///< s, strictly increasing.
  std::vector<double> factor;  ///< dimensionless.
  bool operator==(const TimeTable&) const = default;
};
void for_each_key(Of<TimeTable> auto& t, auto&& visit) {
  visit({"time", kByHand}, t.time);
  visit({"factor", kByHand}, t.factor);
}

struct BoundaryCondition {
  std::vector<Side> sides;            ///< of a box.
  std::vector<std::string> surfaces;  ///< of a mesh, by the names of physical surfaces.
  BoundaryKind kind = BoundaryKind::roller;
  std::array<bool, 3> components = {true, true, true};  ///< of `displacement`: which of x, y, z.
  std::array<double, 3> translation = {0, 0, 0};        ///< m.
  std::array<double, 9> gradient = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< row-major ∂u_i/∂x_j.
  std::array<double, 9> stress = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< Pa, Δσ, symmetric, row-major.
  TimeTable table;
  bool operator==(const BoundaryCondition&) const = default;
};
void for_each_key(Of<BoundaryCondition> auto& c, auto&& visit) {
  visit({"sides", kByHand | unless(c.surfaces.empty(), kSilent) | kFamily}, c.sides);
  visit({"surfaces", kByHand | unless(!c.surfaces.empty(), kSilent)}, c.surfaces);
  visit({"kind", kFamily}, c.kind);
  const bool moves = c.kind == BoundaryKind::displacement;
  const bool pulls = c.kind == BoundaryKind::stress;
  visit({"components", kByHand | unless(moves, kSilent) | kFamily}, c.components);
  visit({"translation", unless(moves, kSilent) | kFamily}, c.translation);
  visit({"gradient", unless(moves, kSilent) | kFamily}, c.gradient);
  visit({"stress", unless(pulls, kSilent) | kFamily}, c.stress);
  // It only scales the unit load.
  visit({"table", kByHand | unless(moves || pulls, kSilent)}, c.table);
}

enum class RegionShape { box, disc };
constexpr auto words(RegionShape) { return std::array{"box", "disc"}; }

/// A pressure region of a `box` body: cells take the volume fraction that lies inside.
struct PressureRegion {
  std::string name;
  RegionShape shape = RegionShape::box;
  std::array<double, 3> from = {0, 0, 0};  ///< box: corner; on a sheared mesh x and y are taken
  std::array<double, 3> to = {0, 0, 0};  ///< in the unsheared grid, so a region ends on the fault.
  std::array<double, 3> center = {0, 0, 0};  ///< disc: centre of a vertical cylinder
  double radius = 0;                         ///< disc, m.
  double thickness = 0;                      ///< disc, m.
  bool operator==(const PressureRegion&) const = default;
};
void for_each_key(Of<PressureRegion> auto& r, auto&& visit) {
  visit({"name"}, r.name);
  visit({"shape", kFamily}, r.shape);
  const bool is_disc = r.shape == RegionShape::disc;
  visit({"from", kRequired | unless(!is_disc, kIdle) | kFamily}, r.from);
  visit({"to", kRequired | unless(!is_disc, kIdle) | kFamily}, r.to);
  visit({"center", kRequired | unless(is_disc, kIdle) | kFamily}, r.center);
  visit({"radius", kRequired | unless(is_disc, kIdle) | kFamily}, r.radius);
  visit({"thickness", kRequired | unless(is_disc, kIdle) | kFamily}, r.thickness);
}

/// The corners of what holds a shape, m.
struct Bounds {
  std::array<double, 3> low, high;
};
Bounds bounds_of(const PressureRegion& region);
/// As of a rectangle.
Bounds bounds_of(const PatchGeometry& patch);

/// A volume of a mesh, by its name (in a file that of a physical volume).
struct MeshVolume {
  std::string name;
  std::string material;
  std::string compartment;  ///< a pressure region; "" = none.
  bool operator==(const MeshVolume&) const = default;
};
void for_each_key(Of<MeshVolume> auto& v, auto&& visit) {
  visit({"name"}, v.name);
  visit({"material", kRequired}, v.material);
  visit({"compartment"}, v.compartment);
}

/// Under which identities and families keep the bytes of a mesh: another name when what is computed
/// on meshes alone changes, so that grids keep theirs (kNumericsVersion is for both). 2: unknowns
/// ordered by corners. 3: profiles of faults that bend. 4: families have rock by number.
inline constexpr const char* kMeshInText = "file, numerics 4";

/// A mesh in place of the grid of a box: from a file, or built of horizons.
struct BodyMesh {
  std::string name;                          ///< of its file, as the scene names it; for messages.
  std::shared_ptr<const NamedMesh> content;  ///< never null.
  std::vector<MeshVolume> volumes;           ///< in the order of content->cell_groups.
  long n_sides = 0;                          ///< of its cells, each once.
  std::vector<std::string> remarks;          ///< what is not as it was given.
  bool operator==(const BodyMesh& other) const {
    return content->fingerprint == other.content->fingerprint && volumes == other.volumes;
  }
};
void for_each_key(Of<BodyMesh> auto& m, auto&& visit) {
  visit({"file", kByHand, kMeshInText}, m.content->fingerprint);
  visit({"volumes", kByHand}, m.volumes);
}

/// A body with patches of fault: a box with a grid, or a mesh. Of a mesh `from` and
/// `to` are its bounds, `patches` the mean planes of its faults, and `regions` the bounds of its
/// compartments; nothing is meshed by these.
struct BoxGeometry {
  std::array<double, 3> from = {0, 0, 0};   ///< m, lower corner.
  std::array<double, 3> to = {0, 0, 0};     ///< m, upper corner.
  std::string material;                     ///< fills the box unless layers are given.
  std::vector<Layer> layers;                ///< top_depth is -z of the top; may be empty.
  std::vector<PatchGeometry> patches;       ///< one per Scene::faults, same order.
  std::vector<BoundaryCondition> boundary;  ///< faces not mentioned: free.
  std::vector<PressureRegion> regions;
  std::optional<BodyMesh> mesh;
  bool operator==(const BoxGeometry&) const = default;
};
void for_each_key(Of<BoxGeometry> auto& b, auto&& visit) {
  visit({"kind", kByHand}, "box");
  visit({"from", kRequired}, b.from);
  visit({"to", kRequired}, b.to);
  visit({"material"}, b.material);
  visit({"layers", kByHand}, b.layers);
  visit({"patches", kByHand}, b.patches);
  visit({"boundary", kByHand}, b.boundary);
  visit({"regions", kByHand}, b.regions);
  visit({"mesh", kByHand | unless(b.mesh.has_value(), kSilent)}, b.mesh);
}

enum class GeometryKind { field, box };
enum class Switch { automatic, on, off };
constexpr auto words(Switch) { return std::array{"automatic", "on", "off"}; }

/// Cell sizes. A `tier` fills them; explicit values win.
struct MeshSizes {
  double strike = 0;       ///< m, along y at the faults (box: y).
  double dip = 0;          ///< m, down dip at reservoir level (box: z in the fine window); with
                           ///< `corner` the largest there.
  double normal = 0;       ///< m, first cell beside a fault.
  double growth = 1.3;     ///< largest ratio of neighbouring cell sizes away from the faults.
  double fine_margin = 0;  ///< m, box: how far beyond patches and regions the fine size is kept.
  double largest = 0;      ///< m, cap of graded cells; 0 = none.
  double corner = 0;  ///< m, field: down dip at the corners of compartments; 0 or ≥ dip: as dip.
  double corner_growth = 1.5;  ///< largest ratio of neighbouring cells between corners and `dip`.
  bool grades_corners() const { return corner > 0 && corner < dip; }
  bool operator==(const MeshSizes&) const = default;
};
void for_each_key(Of<MeshSizes> auto& s, auto&& visit) {
  visit({"strike", kFamily}, s.strike);
  visit({"dip", kFamily}, s.dip);
  visit({"normal", kFamily}, s.normal);
  visit({"growth", kFamily}, s.growth);
  visit({"fine_margin", kFamily}, s.fine_margin);
  visit({"largest", kFamily}, s.largest);
  // Cells of one size down dip keep the identity from before they could be graded.
  visit({"corner", unless(s.grades_corners(), kSilent)}, s.corner);
  visit({"corner_growth", unless(s.grades_corners(), kSilent)}, s.corner_growth);
}

}  // namespace faultsim
