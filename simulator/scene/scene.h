#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/laws/coulomb_law.h"
#include "simulator/scene/geometry.h"
#include "simulator/scene/loading.h"
#include "simulator/scene/numerics.h"

/// The scene as plain structs: everything in SI, x east across the faults, y along strike, z up
/// (z = 0 is the surface of a `field`; depth = -z), tension positive, pressures positive.
/// Made from JSON by reading/read_scene.h, which has checked all of it. Units, ranges, defaults and
/// the JSON spelling of each field are in schemas/scene.schema.json.
namespace faultsim {

enum class InitialStressKind { column, profile };
constexpr auto words(InitialStressKind) { return std::array{"column", "profile"}; }
/// Horizontal stress in the layers of viscous material.
enum class ViscousLayers {
  ratios,       ///< as in rock.
  lithostatic,  ///< σ_xx = σ_yy = σ_v whatever the ratios: salt that has come to rest.
};
constexpr auto words(ViscousLayers) { return std::array{"ratios", "lithostatic"}; }

/// Where the initial pressures of a field's blocks come from.
enum class InitialPressure {
  given,         ///< the column or profile, and what blocks have of their own.
  first_report,  ///< the flow result: means over blocks of the report that changes count from.
};
constexpr auto words(InitialPressure) { return std::array{"given", "first_report"}; }

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
  /// first_report: Block::overpressure of all blocks, and of a column `overpressure` as their mean,
  /// follow from the flow result.
  InitialPressure pressure_from = InitialPressure::given;
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
  visit({"pressure_from", unless(s.pressure_from != InitialPressure::given, kSilent) | kWord},
        s.pressure_from);
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
  /// Whether a fault is open before any production (initial_state/on_fault), where creep may be
  /// left out because of it; follows from the rest.
  bool opens_at_start = false;
  FlowLoad pressure_field, temperature_field;
  bool has_field() const { return pressure_field.is_given() || temperature_field.is_given(); }
  bool has_temperatures() const { return temperature_field.is_given() || !temperature.empty(); }
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
