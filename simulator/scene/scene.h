#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "simulator/flow/outside_rule.h"

/// The scene as plain structs: everything in SI, x east across the faults, y along strike, z up
/// (z = 0 is the surface of a `field`; depth = -z), tension positive, pressures positive.
/// Made from JSON by read_scene.h, which has checked all of it. Units, ranges, defaults and the
/// JSON spelling of each field are in schemas/scene.schema.json.
namespace faultsim {

struct FlowField;

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

/// A horizontal layer by its top; it reaches to the next layer's top or the base of the model.
struct Layer {
  std::string name;
  std::string material;
  double top_depth = 0;  ///< m, at zero offset.
  bool operator==(const Layer&) const = default;
};

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
  bool operator==(const Block&) const = default;
};

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
  double block_length = 0;      ///< m, blocks cover |y| <= block_length/2.
  double fault_length = 0;      ///< m, faults cover |y| <= fault_length/2.
  /// m above the shallowest and below the deepest reservoir edge touched.
  double fault_overshoot = 150;
  double pivot_depth = 0;  ///< m, where a dipping fault keeps its x.
  bool operator==(const FieldGeometry&) const = default;
};

enum class PatchShape { rectangle, ellipse };

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

/// The six faces of a box: x- x+ y- y+ z- z+.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };

enum class BoundaryKind {
  free,          ///< no traction change.
  roller,        ///< no displacement normal to the face.
  fixed,         ///< no displacement.
  displacement,  ///< u = factor(t) (translation + gradient x) for the components listed.
  stress,        ///< traction change factor(t) Δσ n.
  tied,          ///< with the opposite face: same displacement (periodic).
};

/// A piecewise-linear function of time, constant outside. Empty = 1 at all times.
struct TimeTable {
  std::vector<double> time;    ///< s, strictly increasing.
  std::vector<double> factor;  ///< dimensionless.
  bool operator==(const TimeTable&) const = default;
};

struct BoundaryCondition {
  std::vector<Side> sides;
  BoundaryKind kind = BoundaryKind::roller;
  std::array<bool, 3> components = {true, true, true};  ///< of `displacement`: which of x, y, z.
  std::array<double, 3> translation = {0, 0, 0};        ///< m.
  std::array<double, 9> gradient = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< row-major ∂u_i/∂x_j.
  std::array<double, 9> stress = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< Pa, Δσ, symmetric, row-major.
  TimeTable table;
  bool operator==(const BoundaryCondition&) const = default;
};

enum class RegionShape { box, disc };

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

struct BoxGeometry {
  std::array<double, 3> from = {0, 0, 0};   ///< m, lower corner.
  std::array<double, 3> to = {0, 0, 0};     ///< m, upper corner.
  std::string material;                     ///< fills the box unless layers are given.
  std::vector<Layer> layers;                ///< top_depth is -z of the top; may be empty.
  std::vector<PatchGeometry> patches;       ///< one per Scene::faults, same order.
  std::vector<BoundaryCondition> boundary;  ///< faces not mentioned: free.
  std::vector<PressureRegion> regions;
  bool operator==(const BoxGeometry&) const = default;
};

enum class GeometryKind { field, box };
enum class Switch { automatic, on, off };

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

enum class InitialStressKind { column, profile };
/// Horizontal stress in the layers of viscous material.
enum class ViscousLayers {
  ratios,       ///< as in rock.
  lithostatic,  ///< σ_xx = σ_yy = σ_v whatever the ratios: salt that has come to rest.
};

/// Initial stress and pressure, functions of depth only (docs/model.md, section 6).
/// column: σ_v and p0 from the reference column of the field (zero offset).
/// profile: σ_v(z) = vertical + vertical_gradient (−z), p0 likewise; or a uniform full tensor.
struct InitialState {
  InitialStressKind kind = InitialStressKind::column;
  double ratio_across = 1;              ///< M1: σ'_x / σ'_v.
  double ratio_along = 1;               ///< M2: σ'_y / σ'_v.
  double initial_biot = 1;              ///< α_0 in σ_h = M(σ_v + α_0 p0) − α_0 p0.
  double gravity = 9.81;                ///< m/s2.
  double water_density = 1000;          ///< kg/m3, hydrostatic p0 (column).
  double water_depth = 0;               ///< m, of the sea above the surface z = 0 (column).
  double overpressure = 0;              ///< Pa, in the depth range of the reservoir at zero offset.
  double vertical_stress = 0;           ///< Pa at z = 0, negative in compression (profile).
  double vertical_stress_gradient = 0;  ///< Pa per m of depth, negative (profile).
  double pressure = 0;                  ///< Pa at z = 0 (profile).
  double pressure_gradient = 0;         ///< Pa per m of depth (profile).
  std::optional<std::array<double, 9>>
      tensor;  ///< Pa, uniform total σ0; replaces the profile's stress.
  ViscousLayers viscous_layers = ViscousLayers::ratios;  ///< lithostatic: never next to `tensor`.
  bool operator==(const InitialState&) const = default;
};

enum class FrictionLaw {
  angle,        ///< φ(s) = φ_s + (φ_d − φ_s) min(s/d_c, 1)           (docs/model.md, 6)
  coefficient,  ///< tan φ weakens linearly instead.
};
enum class SlipMeasure { current, cumulated };

struct Friction {
  FrictionLaw law = FrictionLaw::angle;
  double cohesion = 0;                 ///< Pa.
  double static_friction_angle = 0;    ///< rad; JSON may give friction_coefficient instead.
  double dynamic_friction_angle = 0;   ///< rad; equal to the static one = no weakening.
  double slip_weakening_distance = 0;  ///< m; > 0 where the angles differ.
  SlipMeasure slip_measure = SlipMeasure::current;
  bool cohesion_after_opening = false;
  bool cohesion_after_slip = true;  ///< false: the first slip ends cohesion.
  bool operator==(const Friction&) const = default;
};

enum class FaultPressureRule { mean, min, max, minus, plus, fraction, prescribed, none, table };

/// Δp_f(s, t) of a fault: linear in place and time, constant beyond the places and the last time.
struct FaultPressureTable {
  enum class Place {
    depth,      ///< of points of the fault.
    along_dip,  ///< their distance down dip from the centre of a box's patch.
  };
  Place place = Place::depth;
  std::vector<double> dip;  ///< m, strictly increasing.
  /// m, from the patch's centre (field: y), strictly increasing; empty: the same along strike.
  std::vector<double> strike;
  std::vector<double> time;    ///< s, strictly increasing from 0.
  std::vector<double> change;  ///< Pa, n_dip x n_strike x n_time, time fastest; 0 at time 0.
  std::vector<double> turns;   ///< s, of `time`: where it is not linear.
  bool operator==(const FaultPressureTable&) const = default;
};

struct FaultPressure {
  FaultPressureRule rule = FaultPressureRule::mean;
  double fraction = 0.5;       ///< rule fraction: Δp_min + f (Δp_max − Δp_min).
  double prescribed = 0;       ///< Pa, change; times table.
  TimeTable table;             ///< rule prescribed.
  FaultPressureTable profile;  ///< rule table.
  std::optional<std::array<double, 2>> depth_window;  ///< m; prescribed: top, bottom. None = where
                                                      ///< either side is reservoir.
  bool operator==(const FaultPressure&) const = default;
};

struct Fault {
  std::string name;
  double dip_from_vertical = 0;  ///< rad (field); > 0 dips east. Box: see PatchGeometry.
  double fault_biot = 1;         ///< α_f.
  Friction friction;
  FaultPressure pressure;
  bool operator==(const Fault&) const = default;
};

/// One named stage of the loading; steps are equal in time unless times are given.
struct Stage {
  std::string name;
  double duration = 0;  ///< s.
  int n_steps = 1;
  /// Change of the regional stress since the start, reached linearly at the stage's end: total,
  /// tension > 0, rows x y z, Pa; none: as at its start.
  std::optional<std::array<double, 9>> stress_change = {};
  bool operator==(const Stage&) const = default;
};

/// Pressure change history of one compartment or region: piecewise linear in time from 0 at t = 0.
struct PressureHistory {
  std::string region;
  std::vector<double> time;             ///< s, strictly increasing, first > 0 or = 0.
  std::vector<double> pressure_change;  ///< Pa, Δp.
  double scale = 1;                     ///< multiplies Δp.
  double lag = 0;                       ///< s, ≥ 0: Δp(t) = scale · history(t − lag).
  bool from_csv = false;  ///< a CSV file replaced what the stages say; for messages only.
  bool operator==(const PressureHistory&) const = default;
};

/// Temperature change history of one region: piecewise linear in time from 0 at t = 0.
struct TemperatureHistory {
  int region = 0;              ///< index into Scene::pressure.
  std::vector<double> time;    ///< s, strictly increasing.
  std::vector<double> change;  ///< K, ΔT.
  bool operator==(const TemperatureHistory&) const = default;
};

/// The result of a flow simulator as a load: pressures or temperatures of all regions, cell by
/// cell.
struct FlowLoad {
  std::shared_ptr<const FlowField> field = nullptr;  ///< none: the regions have histories.
  std::string fingerprint;                           ///< of the file's bytes.
  OutsideRule outside = OutsideRule::nearest;
  std::array<double, 2> origin = {0, 0};  ///< m, of the scene in the field's coordinates.
  double azimuth = 0;                     ///< rad, of the scene's y there, from y clockwise.
  double y = 0;                           ///< m, of the section of plane strain; else 0.
  bool outside_given = false;  ///< whether the scene says `outside`: never part of its identity.
  int reference = 0;           ///< report whose values are the initial ones, of change 0.
  /// The reports that are taken, from the reference on, and their times since the scene's start, s:
  /// strictly increasing, the first >= 0. The field is linear in between.
  std::vector<int> reports;
  std::vector<double> time;
  /// asymmetry() of the field about the scene's y = 0, where half of a domain may be modelled;
  /// follows from the rest.
  std::optional<double> asymmetry = {};
  bool is_given() const { return field != nullptr; }
  /// Whether it is its own mirror image, but for rounding of its values.
  bool is_symmetric() const { return asymmetry && *asymmetry <= 1e-9; }
  /// Fields are told by their fingerprints.
  bool operator==(const FlowLoad& other) const {
    return fingerprint == other.fingerprint && outside == other.outside && origin == other.origin &&
           azimuth == other.azimuth && y == other.y && reference == other.reference &&
           reports == other.reports && time == other.time;
  }
};

struct ObservationPoint {
  std::string name;
  std::array<double, 3> position = {0, 0, 0};  ///< m; the nearest node is used and reported.
  bool operator==(const ObservationPoint&) const = default;
};

/// What to write. Never part of a case's identity.
struct OutputRequest {
  bool fault_fields = true;    ///< per load step, HDF5 + XDMF.
  bool volume_fields = false;  ///< displacement at the end of each stage.
  std::vector<ObservationPoint> observation_points;
  bool operator==(const OutputRequest&) const = default;
};

/// What becomes of the turning points of histories that lie within the steps of a stage.
enum class TurningPoints {
  steps,   ///< each becomes the end of a load step.
  report,  ///< they are skipped, and the case is warned about.
};

/// How the viscous strain of a step follows from the stresses (docs/model.md, 13).
enum class CreepScheme {
  exponential,     ///< exact for a strain rate that is constant in the step.
  backward_euler,  ///< first order: what many codes do, to measure the difference.
};

/// A parameter in which a surface of operators is continuous, and its range.
struct SurfaceParameter {
  enum class Kind { youngs_modulus, poisson_ratio, dip, offset };
  Kind kind = Kind::youngs_modulus;
  int index = 0;            ///< into Scene::materials, Scene::faults or FieldGeometry::blocks.
  double from = 0, to = 0;  ///< Pa, 1, rad or m; from < to.
  bool operator==(const SurfaceParameter&) const = default;
};

/// Operators interpolated over parameters in place of exact ones (simulator/surface). Without
/// parameters: none.
struct SurfaceRequest {
  std::vector<SurfaceParameter> over;
  double tolerance = 1e-3;   ///< relative, at check points.
  int most_operators = 300;  ///< nodes at most.
  bool wanted() const { return !over.empty(); }
  bool operator==(const SurfaceRequest&) const = default;
};

/// Knobs of the numerics that are part of a case's identity (those of creep only where something
/// is made of viscous material).
struct Numerics {
  double slip_tolerance = 1e-4;      ///< m, of `activated`.
  double activation_length = 40;     ///< m, of `activated` and χ̄.
  double traction_tolerance = 1e-8;  ///< relative to the local traction level.
  int max_newton_iterations = 30;
  int max_active_set_passes = 100;
  int max_step_cuts = 6;
  bool follow_events = true;        ///< false: a case ends where equilibrium jumps.
  double onset_tolerance = 2.5e-4;  ///< of a load step, to which the onset of an event is located.
  int max_events = 256;             ///< per load step.
  TurningPoints turning_points = TurningPoints::steps;
  int max_added_steps = 1000;  ///< more than that at turning points are refused.
  bool b_bar = true;
  Switch half_domain = Switch::automatic;  ///< field: symmetry about y = 0.
  Switch plane_strain = Switch::off;       ///< one cell in y, front and back tied, u_y = 0.
  Switch creep = Switch::automatic;        ///< of viscous materials; off: they are elastic.
  double creep_time_step = 0;    ///< s, longest step of creep; 0 = found by error control.
  int creep_refinements = 1;     ///< error control: how often a load step may be halved, 0 to 6;
                                 ///< not given: 4 in plane strain, 1 in 3D.
  double creep_tolerance = 2e4;  ///< Pa, largest difference of fault traction between one step of
                                 ///< creep and two of half its length that is accepted.
  CreepScheme creep_scheme = CreepScheme::exponential;
  SurfaceRequest surface;
  bool operator==(const Numerics&) const = default;
};

/// Something that the user of a scene should know before running it: what has no effect, what is
/// left out. No problem: the scene can be run.
struct Remark {
  std::string pointer;  ///< JSON Pointer of what it is about; may be empty.
  std::string what;     ///< continues the pointer: "has no effect: ...".
};

struct Scene {
  std::string title;
  std::string tier = "custom";
  std::vector<Material> materials;
  GeometryKind geometry_kind = GeometryKind::field;
  FieldGeometry field;  ///< used when geometry_kind == field.
  BoxGeometry box;      ///< used when geometry_kind == box.
  MeshSizes mesh;
  std::vector<Fault> faults;
  InitialState initial;
  std::vector<Stage> stages;
  std::vector<PressureHistory> pressure;  ///< per region; empty histories next to a flow load.
  std::vector<TemperatureHistory> temperature;  ///< of regions whose temperature changes.
  FlowLoad pressure_field, temperature_field;
  bool has_field() const { return pressure_field.is_given() || temperature_field.is_given(); }
  Numerics numerics;
  OutputRequest output;
  std::vector<Remark> remarks;      ///< never part of a case's identity.
  std::size_t n_table_remarks = 0;  ///< of them, the first: of reading tables.
};

/// Whether two scenes agree in geometry, mesh, materials, loading and numerics: not looked at are
/// title, tier, output and remarks, the initial state, and of the faults what is not a geometry.
bool have_same_body(const Scene& a, const Scene& b);

/// "/compartments/east/lag has no effect: ...".
std::string remark_text(const Remark& remark);

/// s per kelvin of an isotropic eigenstress −s I, Pa/K: 3 K α_T.
double thermal_stress(const Material& material);
/// The material of that name. @pre it exists.
const Material& material_named(const Scene& scene, const std::string& name);
/// Raised by hand when a change may alter results on surfaces, and no others.
inline constexpr int kSurfaceMethod = 3;
/// The same of flow results: how they are read and mapped.
inline constexpr int kFieldMethod = 2;

/// Points at which the error of a surface is measured.
inline int n_surface_checks(const SurfaceRequest& surface) {
  return 4 + 2 * static_cast<int>(surface.over.size());
}

/// The value of a surface's parameter in a scene, and another one put in its place, SI.
double value_of(const SurfaceParameter& one, const Scene& scene);
void set_value(const SurfaceParameter& one, double value, Scene& scene);
/// Names of the materials that the geometry is made of; the scene may list others.
std::set<std::string> used_materials(const Scene& scene);
/// Whether one of those has a viscosity.
bool has_viscous_material(const Scene& scene);

}  // namespace faultsim
