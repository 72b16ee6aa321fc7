#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "simulator/common/fingerprint.h"
#include "simulator/scene/read_scene.h"

/// The resolved scene as text. Every struct of scene.h that says something about physics or
/// numerics has a function here. A field added to scene.h later is written only when it differs
/// from the value that reproduces the old behaviour, so that identities stored before stay valid.
namespace faultsim {
namespace {

using nlohmann::json;

/// -0 is 0; everything is a double, so that 1 and 1.0 are the same text.
double plain(double value) { return value == 0 ? 0.0 : value; }

template <typename Numbers>
json list(const Numbers& numbers) {
  json result = json::array();
  for (const double number : numbers) result.push_back(plain(number));
  return result;
}

json table(const TimeTable& table) {
  return {{"time", list(table.time)}, {"factor", list(table.factor)}};
}

json layers(const std::vector<Layer>& layers) {
  json result = json::array();
  for (const Layer& layer : layers) {
    result.push_back(
        {{"name", layer.name}, {"material", layer.material}, {"top", plain(layer.top_depth)}});
  }
  return result;
}

json field(const FieldGeometry& field) {
  json blocks = json::array();
  for (const Block& block : field.blocks) {
    blocks.push_back({{"name", block.name},
                      {"from", plain(block.from)},
                      {"to", plain(block.to)},
                      {"offset", plain(block.offset)}});
    if (block.overpressure) blocks.back()["overpressure"] = plain(*block.overpressure);
    if (block.mesh_offset) blocks.back()["mesh_offset"] = plain(*block.mesh_offset);
    if (block.thickness) blocks.back()["thickness"] = plain(*block.thickness);
  }
  return {{"kind", "field"},
          {"width", plain(field.width)},
          {"length", plain(field.length)},
          {"depth", plain(field.depth)},
          {"layers", layers(field.layers)},
          {"reservoir_layer", field.reservoir_layer},
          {"sideburden", field.sideburden},
          {"blocks", blocks},
          {"block_length", plain(field.block_length)},
          {"fault_length", plain(field.fault_length)},
          {"fault_overshoot", plain(field.fault_overshoot)},
          {"pivot_depth", plain(field.pivot_depth)}};
}

json condition(const BoundaryCondition& condition) {
  std::set<int> sides;
  for (const Side side : condition.sides) sides.insert(static_cast<int>(side));
  json result = {{"sides", sides}, {"kind", static_cast<int>(condition.kind)}};
  if (condition.kind == BoundaryKind::displacement) {
    result["components"] = condition.components;
    result["translation"] = list(condition.translation);
    result["gradient"] = list(condition.gradient);
    result["table"] = table(condition.table);
  } else if (condition.kind == BoundaryKind::stress) {
    result["stress"] = list(condition.stress);
    result["table"] = table(condition.table);
  }
  return result;
}

json box(const BoxGeometry& box) {
  json patches = json::array();
  for (const PatchGeometry& patch : box.patches) {
    patches.push_back({{"center", list(patch.center)},
                       {"strike", plain(patch.strike)},
                       {"dip_from_vertical", plain(patch.dip_from_vertical)},
                       {"length", plain(patch.length)},
                       {"width", plain(patch.width)},
                       {"shape", static_cast<int>(patch.shape)}});
  }
  json boundary = json::array();
  for (const BoundaryCondition& each : box.boundary) boundary.push_back(condition(each));
  json regions = json::array();
  for (const PressureRegion& region : box.regions) {
    json entry = {{"name", region.name}, {"shape", static_cast<int>(region.shape)}};
    if (region.shape == RegionShape::box) {
      entry["from"] = list(region.from);
      entry["to"] = list(region.to);
    } else {
      entry["center"] = list(region.center);
      entry["radius"] = plain(region.radius);
      entry["thickness"] = plain(region.thickness);
    }
    regions.push_back(entry);
  }
  return {{"kind", "box"},
          {"from", list(box.from)},
          {"to", list(box.to)},
          {"material", box.material},
          {"layers", layers(box.layers)},
          {"patches", patches},
          {"boundary", boundary},
          {"regions", regions}};
}

/// Only materials that something is made of: an unused one is a remark.
json materials(const Scene& scene) {
  const std::set<std::string> used = used_materials(scene);
  json result = json::object();
  for (const Material& material : scene.materials) {
    if (used.count(material.name) == 0) continue;
    json entry = {{"density", plain(material.density)},
                  {"youngs_modulus", plain(material.youngs_modulus)},
                  {"poisson_ratio", plain(material.poisson_ratio)},
                  {"biot", plain(material.biot)}};
    if (material.thermal_expansion != 0)
      entry["thermal_expansion"] = plain(material.thermal_expansion);
    if (material.viscosity) entry["viscosity"] = plain(*material.viscosity);
    result[material.name] = entry;
  }
  return result;
}

json initial_state(const InitialState& state) {
  const bool is_column = state.kind == InitialStressKind::column;
  json result = {{"kind", is_column ? "column" : "profile"}};
  if (state.lithostatic_viscous_layers) result["viscous_layers"] = "lithostatic";
  if (!state.tensor) {
    result["ratio_across"] = plain(state.ratio_across);
    result["ratio_along"] = plain(state.ratio_along);
    result["initial_biot"] = plain(state.initial_biot);
  }
  if (is_column) {
    result["gravity"] = plain(state.gravity);
    result["water_density"] = plain(state.water_density);
    result["overpressure"] = plain(state.overpressure);
    return result;
  }
  result["pressure"] = plain(state.pressure);
  result["pressure_gradient"] = plain(state.pressure_gradient);
  if (state.tensor) {
    result["tensor"] = list(*state.tensor);
  } else {
    result["vertical_stress"] = plain(state.vertical_stress);
    result["vertical_stress_gradient"] = plain(state.vertical_stress_gradient);
  }
  return result;
}

/// Thousands of numbers: told by the fingerprint of their bits, −0 as 0.
std::string profile(const FaultPressureTable& table) {
  std::vector<double> all = {static_cast<double>(table.place)};
  for (const auto* values : {&table.dip, &table.strike, &table.time, &table.change}) {
    all.push_back(static_cast<double>(values->size()));
    for (const double value : *values) all.push_back(value + 0.0);
  }
  return fingerprint(all.data(), all.size() * sizeof(double));
}

json fault(const Fault& fault) {
  const Friction& friction = fault.friction;
  const FaultPressure& pressure = fault.pressure;
  json rule = {{"rule", static_cast<int>(pressure.rule)}};
  if (pressure.rule == FaultPressureRule::fraction) rule["fraction"] = plain(pressure.fraction);
  if (pressure.rule == FaultPressureRule::prescribed) {
    rule["prescribed"] = plain(pressure.prescribed);
    rule["table"] = table(pressure.table);
    if (pressure.depth_window) rule["depth_window"] = list(*pressure.depth_window);
  }
  if (pressure.rule == FaultPressureRule::table) rule["profile"] = profile(pressure.profile);
  return {{"name", fault.name},
          {"dip_from_vertical", plain(fault.dip_from_vertical)},
          {"fault_biot", plain(fault.fault_biot)},
          {"pressure", rule},
          {"friction",
           {{"law", static_cast<int>(friction.law)},
            {"cohesion", plain(friction.cohesion)},
            {"static", plain(friction.static_friction_angle)},
            {"dynamic", plain(friction.dynamic_friction_angle)},
            {"distance", plain(friction.slip_weakening_distance)},
            {"slip_measure", static_cast<int>(friction.slip_measure)},
            {"cohesion_after_opening", friction.cohesion_after_opening},
            {"cohesion_after_slip", friction.cohesion_after_slip}}}};
}

json surface(const SurfaceRequest& surface) {
  json over = json::array();
  for (const SurfaceParameter& one : surface.over)
    over.push_back({static_cast<int>(one.kind), one.index, plain(one.from), plain(one.to)});
  return {{"over", over},
          {"method", kSurfaceMethod},
          {"tolerance", plain(surface.tolerance)},
          {"most_operators", surface.most_operators}};
}

json numerics(const Numerics& numerics) {
  json result = {{"slip_tolerance", plain(numerics.slip_tolerance)},
                 {"activation_length", plain(numerics.activation_length)},
                 {"traction_tolerance", plain(numerics.traction_tolerance)},
                 {"max_newton_iterations", numerics.max_newton_iterations},
                 {"max_active_set_passes", numerics.max_active_set_passes},
                 {"max_step_cuts", numerics.max_step_cuts},
                 {"follow_events", numerics.follow_events},
                 {"onset_tolerance", plain(numerics.onset_tolerance)},
                 {"max_events", numerics.max_events},
                 {"b_bar", numerics.b_bar},
                 {"half_domain", static_cast<int>(numerics.half_domain)},
                 {"plane_strain", static_cast<int>(numerics.plane_strain)}};
  // The added steps follow from stages and histories, which are there.
  if (numerics.turning_points == TurningPoints::report) result["turning_points"] = "report";
  if (numerics.surface.wanted()) result["surface"] = surface(numerics.surface);
  return result;
}

json creep(const Numerics& numerics) {
  return {{"switch", static_cast<int>(numerics.creep)},
          {"time_step", plain(numerics.creep_time_step)},
          {"refinements", numerics.creep_refinements},
          {"tolerance", plain(numerics.creep_tolerance)},
          {"scheme", static_cast<int>(numerics.creep_scheme)}};
}

json mesh(const MeshSizes& mesh) {
  json result = {{"strike", plain(mesh.strike)},           {"dip", plain(mesh.dip)},
                 {"normal", plain(mesh.normal)},           {"growth", plain(mesh.growth)},
                 {"fine_margin", plain(mesh.fine_margin)}, {"largest", plain(mesh.largest)}};
  // Cells of one size down dip keep the identity from before they could be graded.
  if (mesh.grades_corners()) {
    result["corner"] = plain(mesh.corner);
    result["corner_growth"] = plain(mesh.corner_growth);
  }
  return result;
}

json stage(const Stage& stage) {
  return {{"name", stage.name}, {"duration", plain(stage.duration)}, {"steps", stage.n_steps}};
}

json history(const PressureHistory& history) {
  return {{"region", history.region},
          {"time", list(history.time)},
          {"pressure_change", list(history.pressure_change)},
          {"scale", plain(history.scale)},
          {"lag", plain(history.lag)}};
}

/// Which file it was does not matter, what was in it does.
json flow_load(const FlowLoad& flow) {
  return {{"origin", {plain(flow.origin[0]), plain(flow.origin[1])}},
          {"azimuth", plain(flow.azimuth)},
          {"fingerprint", flow.fingerprint},
          {"method", kFieldMethod},
          {"outside", static_cast<int>(flow.outside)},
          {"reference", flow.reference},
          {"reports", flow.reports},
          {"time", list(flow.time)},
          {"y", plain(flow.y)}};
}

template <typename Struct>
std::string list_text(const std::vector<Struct>& all, json (*of)(const Struct&)) {
  json result = json::array();
  for (const Struct& each : all) result.push_back(of(each));
  return result.dump();
}

std::string geometry_text(const Scene& scene) {
  return (scene.geometry_kind == GeometryKind::field ? field(scene.field) : box(scene.box)).dump();
}

std::string identity_under(int numerics_version, const std::string& canonical) {
  return fingerprint(concat("numerics ", numerics_version, "\n", canonical));
}

}  // namespace

std::string CanonicalParts::text() const {
  const std::string optional = creep.empty() ? "" : "\"creep\":" + creep + ",";
  return concat("{", optional, "\"faults\":", faults, ",\"format\":1,\"geometry\":", geometry,
                ",\"initial_state\":", initial_state, ",\"materials\":", materials,
                ",\"mesh\":", mesh, ",\"numerics\":", numerics, ",\"pressure\":", pressure, fields,
                ",\"stages\":", stages, "}");
}

CanonicalParts canonical_parts(const Scene& scene) {
  CanonicalParts parts{.faults = list_text(scene.faults, fault),
                       .geometry = geometry_text(scene),
                       .initial_state = initial_state(scene.initial).dump(),
                       .materials = materials(scene).dump(),
                       .mesh = mesh(scene.mesh).dump(),
                       .numerics = numerics(scene.numerics).dump(),
                       .pressure = list_text(scene.pressure, history),
                       .stages = list_text(scene.stages, stage),
                       .creep = {},
                       .fields = {}};
  // An elastic scene has no creep to speak of: it keeps the identity from before there was any.
  if (has_viscous_material(scene)) parts.creep = creep(scene.numerics).dump();
  // The same of fields and temperatures.
  const auto add = [&](const std::string& name, const json& value) {
    parts.fields += ",\"" + name + "\":" + value.dump();
  };
  if (scene.pressure_field.is_given()) add("pressure_field", flow_load(scene.pressure_field));
  if (scene.temperature_field.is_given())
    add("temperature_field", flow_load(scene.temperature_field));
  for (const TemperatureHistory& history : scene.temperature)
    add(concat("temperature_", history.region), {list(history.time), list(history.change)});
  return parts;
}

CanonicalParts canonical_parts(const Scene& scene, const Scene& other, CanonicalParts of_other) {
  if (!have_same_body(scene, other)) return canonical_parts(scene);
  if (scene.faults != other.faults) of_other.faults = list_text(scene.faults, fault);
  if (scene.initial != other.initial) of_other.initial_state = initial_state(scene.initial).dump();
  return of_other;
}

std::string canonical_scene(const Scene& scene) { return canonical_parts(scene).text(); }

std::string case_identity(const CanonicalParts& parts) {
  return identity_under(kNumericsVersion, parts.text());
}

std::string case_identity(const Scene& scene) { return case_identity(canonical_parts(scene)); }

bool has_identity(const Scene& scene, const std::string& identity) {
  const std::string canonical = canonical_scene(scene);
  for (int version = kNumericsVersion; version >= 1; --version) {
    if (identity_under(version, canonical) == identity) return true;
  }
  return false;
}

}  // namespace faultsim
