#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulator/flow/outside_rule.h"
#include "simulator/laws/coulomb_law.h"
#include "simulator/laws/maxwell.h"
#include "simulator/scene/geometry.h"

/// The scene as plain structs: everything in SI, x east across the faults, y along strike, z up
/// (z = 0 is the surface of a `field`; depth = -z), tension positive, pressures positive.
/// Made from JSON by reading/read_scene.h, which has checked all of it. Units, ranges, defaults and
/// the JSON spelling of each field are in schemas/scene.schema.json.
namespace faultsim {

struct FlowField;

/// The same of flow results: how they are read and mapped.
inline constexpr int kFieldMethod = 2;
/// Raised by hand when a change may alter results on surfaces, and no others.
inline constexpr int kSurfaceMethod = 5;
constexpr auto words(OutsideRule) { return std::array{"nearest", "unchanged"}; }

enum class InitialStressKind { column, profile };
constexpr auto words(InitialStressKind) { return std::array{"column", "profile"}; }
/// Horizontal stress in the layers of viscous material.
enum class ViscousLayers {
  ratios,       ///< as in rock.
  lithostatic,  ///< σ_xx = σ_yy = σ_v whatever the ratios: salt that has come to rest.
};
constexpr auto words(ViscousLayers) { return std::array{"ratios", "lithostatic"}; }

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
void for_each_key(Of<InitialState> auto& s, auto&& visit) {
  visit({"kind", kWord}, s.kind);
  const bool is_column = s.kind == InitialStressKind::column;
  const bool has_ratios = !s.tensor;
  visit({"ratio_across", unless(has_ratios, kSilent)}, s.ratio_across);
  visit({"ratio_along", unless(has_ratios, kSilent)}, s.ratio_along);
  visit({"initial_biot", unless(has_ratios, kSilent)}, s.initial_biot);
  visit({"gravity", unless(is_column, kSilent)}, s.gravity);
  visit({"water_density", unless(is_column, kSilent)}, s.water_density);
  visit({"water_depth", unless(is_column && s.water_depth != 0, kSilent)}, s.water_depth);
  visit({"overpressure", unless(is_column, kSilent)}, s.overpressure);
  const bool is_linear = !is_column && has_ratios;
  visit({"vertical_stress", unless(is_linear, kSilent)}, s.vertical_stress);
  visit({"vertical_stress_gradient", unless(is_linear, kSilent)}, s.vertical_stress_gradient);
  visit({"pressure", unless(!is_column, kSilent)}, s.pressure);
  visit({"pressure_gradient", unless(!is_column, kSilent)}, s.pressure_gradient);
  visit({"tensor", unless(!is_column, kSilent)}, s.tensor);
  visit({"viscous_layers", unless(s.viscous_layers != ViscousLayers::ratios, kSilent) | kWord},
        s.viscous_layers);
}

constexpr auto words(WeakeningLaw) { return std::array{"angle", "coefficient"}; }
constexpr auto words(SlipMeasure) { return std::array{"current", "cumulated"}; }

/// The friction of a fault: its distance is 0 where the angles agree, its damping always. A fault's
/// own overrides the scene's key by key; angles may be given as coefficients.
void for_each_key(Of<CoulombLaw> auto& f, auto&& visit) {
  visit({"law"}, f.weakening);
  visit({"cohesion"}, f.cohesion);
  visit({"friction_angle", kByHand, "static"}, f.static_friction_angle);
  visit({"dynamic_friction_angle", kByHand, "dynamic"}, f.dynamic_friction_angle);
  visit({"slip_weakening_distance", kByHand, "distance"}, f.slip_weakening_distance);
  visit({"slip_measure"}, f.slip_measure);
  visit({"cohesion_after_opening"}, f.cohesion_after_opening);
  visit({"cohesion_after_slip"}, f.cohesion_after_slip);
}

enum class FaultPressureRule { mean, min, max, minus, plus, fraction, prescribed, none, table };
constexpr auto words(FaultPressureRule) {
  return std::array{"mean",     "min",        "max",  "minus", "plus",
                    "fraction", "prescribed", "none", "table"};
}

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
/// A fault's own fault_pressure overrides the scene's key by key.
void for_each_key(Of<FaultPressure> auto& p, auto&& visit) {
  visit({"rule"}, p.rule);
  visit({"fraction", unless(p.rule == FaultPressureRule::fraction, kIdle)}, p.fraction);
  const bool is_prescribed = p.rule == FaultPressureRule::prescribed;
  visit({"prescribed", kRequired | unless(is_prescribed, kIdle)}, p.prescribed);
  visit({"table", kByHand | unless(is_prescribed, kIdle)}, p.table);
  visit({"csv", kByHand | unless(p.rule == FaultPressureRule::table, kIdle), "profile"}, p.profile);
  visit({"depth_window", unless(is_prescribed, kIdle)}, p.depth_window);
}

struct Fault {
  std::string name;
  double dip_from_vertical = 0;  ///< rad (field); > 0 dips east. Box: see PatchGeometry.
  double fault_biot = 1;         ///< α_f.
  CoulombLaw friction;
  FaultPressure pressure;
  bool operator==(const Fault&) const = default;
};
void for_each_key(Of<Fault> auto& f, auto&& visit) {
  visit({"name"}, f.name);
  visit({"dip_from_vertical"}, f.dip_from_vertical);
  visit({"fault_biot", kByHand}, f.fault_biot);
  visit({"friction", kByHand}, f.friction);
  visit({"fault_pressure", kByHand, "pressure"}, f.pressure);
}

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
void for_each_key(Of<Stage> auto& s, auto&& visit) {
  visit({"name"}, s.name);
  visit({"duration", kByHand}, s.duration);
  visit({"steps"}, s.n_steps);
  visit({"stress_change"}, s.stress_change);
}

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
/// A compartment; its history is what the stages or a CSV file say.
void for_each_key(Of<PressureHistory> auto& h, auto&& visit) {
  visit({"region", kByHand}, h.region);
  visit({"time", kByHand}, h.time);
  visit({"pressure_change", kByHand}, h.pressure_change);
  visit({"scale"}, h.scale);
  visit({"lag"}, h.lag);
}

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
/// Which file it was does not matter, what was in it does.
void for_each_key(Of<FlowLoad> auto& l, auto&& visit) {
  visit({"method", kByHand}, kFieldMethod);
  visit({"outside"}, l.outside);
  visit({"origin"}, l.origin);
  visit({"azimuth"}, l.azimuth);
  visit({"y", kByHand}, l.y);
  visit({"file", kByHand, "fingerprint"}, l.fingerprint);
  visit({"reference", kByHand}, l.reference);
  visit({"reports", kByHand}, l.reports);
  visit({"time", kByHand}, l.time);
}

/// The field in the scene's coordinates. @pre it is given.
std::shared_ptr<const FlowField> field_in_scene(const FlowLoad& load);

struct ObservationPoint {
  std::string name;
  std::array<double, 3> position = {0, 0, 0};  ///< m; the nearest node is used and reported.
  bool operator==(const ObservationPoint&) const = default;
};
void for_each_key(Of<ObservationPoint> auto& p, auto&& visit) {
  visit({"name"}, p.name);
  visit({"position", kRequired}, p.position);
}

/// What to write. Never part of a case's identity.
struct OutputRequest {
  bool fault_fields = true;    ///< per load step, HDF5 + XDMF.
  bool volume_fields = false;  ///< displacement at the end of each stage.
  std::vector<ObservationPoint> observation_points;
  bool operator==(const OutputRequest&) const = default;
};
void for_each_key(Of<OutputRequest> auto& o, auto&& visit) {
  visit({"fault_fields"}, o.fault_fields);
  visit({"volume_fields"}, o.volume_fields);
}

/// What becomes of the turning points of histories that lie within the steps of a stage.
enum class TurningPoints {
  steps,   ///< each becomes the end of a load step.
  report,  ///< they are skipped, and the case is warned about.
};
constexpr auto words(TurningPoints) { return std::array{"steps", "report"}; }

constexpr auto words(MaxwellScheme) { return std::array{"exponential", "backward_euler"}; }

/// A parameter in which a surface of operators is continuous, and its range.
struct SurfaceParameter {
  enum class Kind { youngs_modulus, poisson_ratio, dip, offset };
  Kind kind = Kind::youngs_modulus;
  int index = 0;            ///< into Scene::materials, Scene::faults or FieldGeometry::blocks.
  double from = 0, to = 0;  ///< Pa, 1, rad or m; from < to.
  bool operator==(const SurfaceParameter&) const = default;
};

/// Cases that are run on a surface and on exact operators at its check points: it is fine enough
/// when they are alike. Texts of the scene's document (reading/surface_probes.h).
struct SurfaceProbes {
  double tolerance = 3e-3;  ///< in χ̄.
  /// Fingerprint of the cases, and of all in the document that neither they nor the surface's
  /// parameters replace: the surface depends on it.
  std::string cases;
  bool operator==(const SurfaceProbes&) const = default;
};
void for_each_key(Of<SurfaceProbes> auto& p, auto&& visit) {
  visit({"tolerance"}, p.tolerance);
  visit({"cases", kByHand}, p.cases);
}

/// Operators interpolated over parameters in place of exact ones (simulator/surface). Without
/// parameters: none.
struct SurfaceRequest {
  std::vector<SurfaceParameter> over;
  double tolerance = 1e-3;                   ///< relative, at check points.
  int most_operators = 300;                  ///< nodes at most.
  std::optional<SurfaceProbes> probes = {};  ///< none: `tolerance` alone says what is fine enough.
  bool wanted() const { return !over.empty(); }
  bool operator==(const SurfaceRequest&) const = default;
};
void for_each_key(Of<SurfaceRequest> auto& s, auto&& visit) {
  visit({"over", kByHand}, s.over);
  visit({"method", kByHand}, kSurfaceMethod);
  visit({"tolerance"}, s.tolerance);
  visit({"most_operators"}, s.most_operators);
  visit({"probes", kByHand}, s.probes);
}

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
  MaxwellScheme creep_scheme = MaxwellScheme::exponential;
  SurfaceRequest surface;
  bool operator==(const Numerics&) const = default;
};
/// What creeps is told by the keys of for_each_creep_key besides.
void for_each_key(Of<Numerics> auto& n, auto&& visit) {
  visit({"slip_tolerance"}, n.slip_tolerance);
  visit({"activation_length"}, n.activation_length);
  visit({"traction_tolerance"}, n.traction_tolerance);
  visit({"max_newton_iterations"}, n.max_newton_iterations);
  visit({"max_active_set_passes"}, n.max_active_set_passes);
  visit({"max_step_cuts"}, n.max_step_cuts);
  visit({"follow_events"}, n.follow_events);
  visit({"onset_tolerance"}, n.onset_tolerance);
  visit({"max_events"}, n.max_events);
  // The added steps follow from stages and histories, which are there.
  visit({"turning_points", unless(n.turning_points == TurningPoints::report, kSilent) | kWord},
        n.turning_points);
  visit({"max_added_steps", kSilent}, n.max_added_steps);
  visit({"b_bar"}, n.b_bar);
  visit({"half_domain"}, n.half_domain);
  visit({"plane_strain"}, n.plane_strain);
}

void for_each_creep_key(Of<Numerics> auto& n, auto&& visit) {
  visit({"creep", 0, "switch"}, n.creep);
  visit({"creep_time_step", 0, "time_step"}, n.creep_time_step);
  visit({"creep_refinements", 0, "refinements"}, n.creep_refinements);
  visit({"creep_tolerance", 0, "tolerance"}, n.creep_tolerance);
  visit({"creep_scheme", 0, "scheme"}, n.creep_scheme);
}

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
  /// The date of time 0, s since 1970-01-01, where it is known; never part of a case's identity.
  std::optional<double> start_date = {};
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

/// Points at which the error of a surface is measured.
inline int n_surface_checks(const SurfaceRequest& surface) {
  return 4 + 2 * static_cast<int>(surface.over.size());
}

/// The value of a surface's parameter in a scene, and another one put in its place, SI.
double value_of(const SurfaceParameter& one, const Scene& scene);
void set_value(const SurfaceParameter& one, double value, Scene& scene);
/// Names of the pressure regions: the field's blocks or the box's regions.
std::vector<std::string> region_names(const Scene& scene);
/// Of the field or the box; of a box there may be none.
const std::vector<Layer>& layers_of(const Scene& scene);
/// Whether the body is a mesh from a file.
inline bool is_meshed(const Scene& scene) { return scene.box.mesh.has_value(); }
/// Whether the geometry is made of a material; the scene may list others.
bool is_used(const Scene& scene, const Material& material);
std::vector<Material> used_materials(const Scene& scene);
/// Whether one of those has a viscosity.
bool has_viscous_material(const Scene& scene);

}  // namespace faultsim
