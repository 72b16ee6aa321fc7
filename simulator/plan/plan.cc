#include "simulator/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "simulator/common/fingerprint.h"
#include "simulator/plan/creep_plan.h"

namespace faultsim {
namespace {

/// The patches of a box that end along y within it: plane strain takes them as endless.
std::string ending_patches(const Scene& scene) {
  const double from = scene.box.from[1], to = scene.box.to[1];
  std::string names;
  for (std::size_t i = 0; i < scene.box.patches.size(); ++i) {
    const PatchGeometry& patch = scene.box.patches[i];
    const bool ends = patch.shape == PatchShape::ellipse ||
                      patch.center[1] - patch.length / 2 > from ||
                      patch.center[1] + patch.length / 2 < to;
    if (ends) names += (names.empty() ? "" : ", ") + scene.faults[i].name;
  }
  return names;
}

Reduction plan_plane_strain(const Scene& scene) {
  Reduction r{"plane_strain", scene.numerics.plane_strain == Switch::on, "", "",
              "/numerics/plane_strain"};
  if (r.applied) {
    r.reason = "asked for: one row of cells, front and back tied, no motion along strike";
    if (scene.geometry_kind == GeometryKind::field) {
      r.bound = "ignores the ends of blocks and faults; measure it with a 3D tier";
    } else if (const std::string names = ending_patches(scene); !names.empty()) {
      r.bound = "ignores the ends along y of " + names;
    } else {
      r.bound = "exact when nothing varies along y";
    }
  } else {
    r.reason = scene.geometry_kind == GeometryKind::field ? "blocks and faults end along strike"
                                                          : "not asked for";
  }
  return r;
}

Reduction plan_half_domain(const Scene& scene, bool plane_strain) {
  Reduction r{"half_domain", false, "", "exact by symmetry: areas, potency and M0 are doubled",
              "/numerics/half_domain"};
  if (scene.geometry_kind != GeometryKind::field) {
    r.reason = "a box is modelled as given";
  } else if (plane_strain) {
    r.reason = "plane strain has no extent along strike";
  } else if (scene.numerics.half_domain == Switch::off) {
    r.reason = "switched off";
  } else {
    r.applied = true;
    r.reason = "layers, blocks, faults, pressure and stress are symmetric about y = 0";
  }
  return r;
}

/// Unknowns on the faults of a plan, from the grid lines: z lines inside the fault's depth range
/// times y lines inside its length times the components kept.
long count_between(const std::vector<double>& lines, double from, double to) {
  return std::count_if(lines.begin(), lines.end(),
                       [&](double v) { return v > from + 1e-6 && v < to - 1e-6; });
}

long field_jumps(const Scene& scene, const Plan& plan, const GridLines& lines) {
  const FieldGeometry& field = scene.field;
  double top = 0, base = 0;
  for (std::size_t i = 0; i < field.layers.size(); ++i) {
    if (field.layers[i].name != field.reservoir_layer) continue;
    top = field.layers[i].top_depth;
    base = i + 1 < field.layers.size() ? field.layers[i + 1].top_depth : field.depth;
  }
  const bool has_ends = field.fault_length < field.length;  // else the model's ends cut it
  const double reach = has_ends ? field.fault_length / 2 : field.length;
  const long columns = plan.plane_strain ? 1 : count_between(lines.y, -reach, reach);
  long jumps = 0;
  for (std::size_t f = 0; f <= field.blocks.size(); ++f) {
    double shallow = 1e300, deep = -1e300;
    for (std::size_t b = f == 0 ? 0 : f - 1; b < std::min(f + 1, field.blocks.size()); ++b) {
      shallow = std::min(shallow, top + field.blocks[b].offset);
      deep = std::max(deep, base + field.blocks[b].offset);
    }
    jumps += columns * count_between(lines.z, -(deep + field.fault_overshoot),
                                     -(shallow - field.fault_overshoot));
  }
  return jumps * (plan.plane_strain ? 2 : 3);
}

long box_jumps(const Scene& scene, const Plan& plan, const GridLines& lines) {
  long jumps = 0;
  for (const PatchGeometry& patch : scene.box.patches) {
    const bool horizontal = patch.dip_from_vertical > 1.0;
    const double run = patch.width / 2 * std::cos(horizontal ? 0.0 : patch.dip_from_vertical);
    const auto& down = horizontal ? lines.x : lines.z;
    const double centre = horizontal ? patch.center[0] : patch.center[2];
    const long rows = count_between(down, centre - run, centre + run);
    const long columns = plan.plane_strain
                             ? 1
                             : count_between(lines.y, patch.center[1] - patch.length / 2,
                                             patch.center[1] + patch.length / 2);
    jumps += std::max(rows, 1L) * std::max(columns, 1L);
  }
  return jumps * (plan.plane_strain ? 2 : 3);
}

/// Fits to operator builds on one core of a 2020s server (results/benchmarks): sparse Cholesky with
/// nested dissection has factors of O(n^4/3) entries and O(n^2) flops in 3D, O(n log n) and
/// O(n^3/2) in a plane. The dense block of the jumps comes on top. Memory is meant to err upwards:
/// it was 0 to 25 % above the measured peak of seven plane and 3D builds up to 390,000 unknowns.
void predict_cost(Plan& plan) {
  const auto n = static_cast<double>(std::max(plan.n_unknowns, 1L));
  const auto g = static_cast<double>(plan.n_jump);
  const double program = 30e6;                              // bytes
  const double per_cell = plan.plane_strain ? 2e3 : 1.2e4;  // lists, pattern, two copies of K
  const double factor =
      plan.plane_strain ? 8 * 6.0 * n * std::log2(n + 2) : 2.8e9 * std::pow(n / 260e3, 4.0 / 3.0);
  // A viscous family keeps the factor, H and mesh of every step length beside the build of the last
  // one, and runs in it: 2 to 13 % above the measured peaks of 4 and 7 operators.
  const auto rungs = static_cast<double>(plan.creep.rungs.size());
  const double kept_per_cell = plan.plane_strain ? 1.2e3 : 300;
  const auto cells = static_cast<double>(plan.n_cells);
  plan.memory_bytes = program + factor + per_cell * cells + 3 * 8 * g * g +
                      rungs * (factor + 8 * g * g + kept_per_cell * cells);
  const double bulk =
      plan.plane_strain ? 1.2 * std::pow(n / 50e3, 1.3) : 30.0 * std::pow(n / 260e3, 1.8);
  plan.operator_seconds = (1 + rungs) * (bulk + g * g * g / 3e10);
}

nlohmann::json numbers(const std::vector<double>& values) { return nlohmann::json(values); }

nlohmann::json family_of_field(const FieldMeshSpec& spec) {
  nlohmann::json j = {{"kind", "field"},
                      {"extent", {spec.width, spec.length, spec.depth}},
                      {"layer_tops", numbers(spec.layer_tops)},
                      {"layer_materials", spec.layer_materials},
                      {"reservoir_layer", spec.reservoir_layer},
                      {"sideburden", spec.sideburden_material},
                      {"block_length", spec.block_length},
                      {"fault", {spec.fault_length, spec.fault_overshoot, spec.pivot_depth}},
                      {"fault_dips", numbers(spec.fault_dips)},
                      {"half", spec.half_domain}};
  for (const auto& block : spec.blocks) {
    j["blocks"].push_back({block.from, block.to, block.offset});
  }
  if (!spec.plane_strain && spec.fault_length >= spec.length) j["fault_ends"] = "none";
  return j;
}

nlohmann::json family_of_box(const Scene& scene, const BoxMeshSpec& spec) {
  nlohmann::json j = {{"kind", "box"},
                      {"from", spec.from},
                      {"to", spec.to},
                      {"layer_tops", spec.layer_tops_z},
                      {"layer_materials", spec.layer_materials},
                      {"patches", nlohmann::json::array()},
                      {"regions", nlohmann::json::array()},
                      {"boundary", nlohmann::json::array()}};
  for (const auto& p : spec.patches) {
    j["patches"].push_back({p.center, p.strike, p.dip_from_vertical, p.length, p.width, p.ellipse});
  }
  for (const auto& r : spec.regions) {
    j["regions"].push_back({r.disc, r.from, r.to, r.center, r.radius, r.thickness});
  }
  for (const BoundaryCondition& b : scene.box.boundary) {  // tables only scale the unit loads
    nlohmann::json sides;
    for (const Side side : b.sides) sides.push_back(static_cast<int>(side));
    j["boundary"].push_back(
        {sides, static_cast<int>(b.kind), b.components, b.translation, b.gradient, b.stress});
  }
  return j;
}

/// Absent where nothing creeps: elastic families are those from before there was creep.
nlohmann::json family_of_creep(const Scene& scene, const CreepPlan& creep) {
  const std::set<std::string> used = used_materials(scene);
  nlohmann::json viscosities = nlohmann::json::array();
  for (const Material& m : scene.materials) {
    const bool creeps = m.viscosity && used.count(m.name) != 0;
    viscosities.push_back(creeps ? nlohmann::json(*m.viscosity) : nlohmann::json());
  }
  return {{"viscosities", viscosities},
          {"scheme", static_cast<int>(scene.numerics.creep_scheme)},
          {"rungs", numbers(creep.rungs)}};
}

nlohmann::json family_of(const Scene& scene, const Plan& plan) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  nlohmann::json j;
  CellSizes sizes{};
  if (is_field) {
    const FieldMeshSpec spec = field_mesh_spec(scene, plan);
    j = family_of_field(spec);
    sizes = spec.sizes;
  } else {
    const BoxMeshSpec spec = box_mesh_spec(scene, plan);
    j = family_of_box(scene, spec);
    sizes = spec.sizes;
  }
  j["sizes"] = {sizes.strike, sizes.dip,         sizes.normal,
                sizes.growth, sizes.fine_margin, sizes.largest};
  j["plane_strain"] = plan.plane_strain;
  j["b_bar"] = scene.numerics.b_bar;
  for (const Material& m : scene.materials) {
    j["materials"].push_back({m.youngs_modulus, m.poisson_ratio});
  }
  if (plan.creep.active) j["creep"] = family_of_creep(scene, plan.creep);
  return j;
}

int material_index(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].name == name) return static_cast<int>(i);
  }
  FAULTSIM_DEMAND(false, "material ", name);
  return -1;
}

CellSizes cell_sizes(const MeshSizes& sizes) {
  return {sizes.strike, sizes.dip, sizes.normal, sizes.growth, sizes.fine_margin, sizes.largest};
}

std::string human_bytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, bytes >= 1e9 ? "%.1f GB" : "%.0f MB",
                bytes / (bytes >= 1e9 ? 1e9 : 1e6));
  return text;
}

std::string human_time(double seconds) {
  char text[32];
  const bool long_ = seconds >= 7200;
  std::snprintf(text, sizeof text, "%.1f %s", long_ ? seconds / 3600 : seconds,
                long_ ? "hours" : "s");
  return text;
}

}  // namespace

FieldMeshSpec field_mesh_spec(const Scene& scene, const Plan& plan) {
  const FieldGeometry& field = scene.field;
  FieldMeshSpec spec{};
  spec.width = field.width;
  spec.length = field.length;
  spec.depth = field.depth;
  for (std::size_t i = 0; i < field.layers.size(); ++i) {
    spec.layer_tops.push_back(field.layers[i].top_depth);
    spec.layer_materials.push_back(material_index(scene, field.layers[i].material));
    if (field.layers[i].name == field.reservoir_layer) spec.reservoir_layer = static_cast<int>(i);
  }
  spec.sideburden_material = material_index(scene, field.sideburden);
  for (const Block& block : field.blocks)
    spec.blocks.push_back({block.from, block.to, block.offset});
  spec.block_length = field.block_length;
  spec.fault_length = field.fault_length;
  spec.fault_overshoot = field.fault_overshoot;
  spec.pivot_depth = field.pivot_depth;
  for (const Fault& fault : scene.faults) {
    spec.fault_names.push_back(fault.name);
    spec.fault_dips.push_back(fault.dip_from_vertical);
  }
  spec.sizes = cell_sizes(scene.mesh);
  spec.half_domain = plan.half_domain;
  spec.plane_strain = plan.plane_strain;
  return spec;
}

BoxMeshSpec box_mesh_spec(const Scene& scene, const Plan& plan) {
  const BoxGeometry& box = scene.box;
  BoxMeshSpec spec{};
  spec.from = box.from;
  spec.to = box.to;
  for (const Layer& layer : box.layers) {
    spec.layer_tops_z.push_back(-layer.top_depth);
    spec.layer_materials.push_back(material_index(scene, layer.material));
  }
  if (box.layers.empty()) spec.layer_materials.push_back(material_index(scene, box.material));
  for (std::size_t i = 0; i < box.patches.size(); ++i) {
    const PatchGeometry& p = box.patches[i];
    spec.patches.push_back({scene.faults[i].name, p.center, p.strike, p.dip_from_vertical, p.length,
                            p.width, p.shape == PatchShape::ellipse});
  }
  for (const PressureRegion& r : box.regions) {
    spec.regions.push_back(
        {r.shape == RegionShape::disc, r.from, r.to, r.center, r.radius, r.thickness});
  }
  for (const BoundaryCondition& b : box.boundary) {
    if (b.kind != BoundaryKind::tied) continue;
    for (const Side side : b.sides) spec.tied[static_cast<std::size_t>(side) / 2] = true;
  }
  spec.sizes = cell_sizes(scene.mesh);
  spec.plane_strain = plan.plane_strain;
  return spec;
}

Plan make_plan(const Scene& scene, std::vector<Problem>& problems) {
  Plan plan;
  plan.reductions.push_back(plan_plane_strain(scene));
  plan.plane_strain = plan.reductions.back().applied;
  plan.reductions.push_back(plan_half_domain(scene, plan.plane_strain));
  plan.half_domain = plan.reductions.back().applied;

  if (has_viscous_material(scene)) {
    const CreepEstimate estimate = estimate_creep(scene);
    plan.reductions.push_back(plan_creep_off(scene, estimate));
    plan.creep.active = !plan.reductions.back().applied;
    plan.creep.bound = estimate.bound;
    if (plan.creep.active) plan.creep.rungs = creep_rungs(scene);
  }

  const bool is_field = scene.geometry_kind == GeometryKind::field;
  const GridLines lines = is_field ? grid_lines(field_mesh_spec(scene, plan), problems)
                                   : grid_lines(box_mesh_spec(scene, plan), problems);
  if (lines.x.size() < 2 || lines.y.size() < 2 || lines.z.size() < 2) return plan;
  const auto nx = static_cast<long>(lines.x.size()), ny = static_cast<long>(lines.y.size()),
             nz = static_cast<long>(lines.z.size());
  plan.n_cells = (nx - 1) * (ny - 1) * (nz - 1);
  plan.n_jump = is_field ? field_jumps(scene, plan, lines) : box_jumps(scene, plan, lines);
  plan.n_unknowns = (plan.plane_strain ? 2 * nx * nz : 3 * nx * ny * nz) + plan.n_jump;
  for (const Stage& stage : scene.stages) plan.n_steps += stage.n_steps;
  predict_cost(plan);
  plan.family = fingerprint(family_of(scene, plan).dump());
  return plan;
}

std::string operator_fingerprint(const Scene& scene, const Plan& plan, const std::string& blas) {
  nlohmann::json j = {
      {"family", plan.family}, {"numerics_version", kNumericsVersion}, {"blas", blas}};
  for (const ObservationPoint& point : scene.output.observation_points) {
    j["observation_points"].push_back({point.name, point.position});
  }
  return fingerprint(j.dump());
}

nlohmann::json plan_to_json(const Plan& plan) {
  nlohmann::json j = {{"half_domain", plan.half_domain},
                      {"plane_strain", plan.plane_strain},
                      {"n_cells", plan.n_cells},
                      {"n_unknowns", plan.n_unknowns},
                      {"n_jump_unknowns", plan.n_jump},
                      {"n_load_steps", plan.n_steps},
                      {"predicted_operator_s", plan.operator_seconds},
                      {"predicted_memory_bytes", plan.memory_bytes},
                      {"family", plan.family},
                      {"creep",
                       {{"active", plan.creep.active},
                        {"rungs_s", numbers(plan.creep.rungs)},
                        {"bound_pa", nullptr}}},
                      {"reductions", nlohmann::json::array()}};
  if (plan.creep.bound) j["creep"]["bound_pa"] = *plan.creep.bound;
  for (const Reduction& r : plan.reductions) {
    j["reductions"].push_back({{"name", r.name},
                               {"applied", r.applied},
                               {"reason", r.reason},
                               {"bound", r.applied ? r.bound : ""},
                               {"switch", r.switch_}});
  }
  return j;
}

std::string plan_to_text(const Plan& plan) {
  std::string text;
  for (const Reduction& r : plan.reductions) {
    text += r.name + ": " + (r.applied ? "yes" : "no") + ", " + r.reason;
    if (r.applied && !r.bound.empty()) text += " (" + r.bound + ")";
    text += "  [switch: " + r.switch_ + "]\n";
  }
  char line[256];
  std::snprintf(line, sizeof line, "cells %ld, unknowns %ld (of which jumps %ld), load steps %d\n",
                plan.n_cells, plan.n_unknowns, plan.n_jump, plan.n_steps);
  text += line + creep_text(plan.creep);
  std::snprintf(line, sizeof line, "operator: about %s and %s at its peak; family %.12s\n",
                human_time(plan.operator_seconds).c_str(), human_bytes(plan.memory_bytes).c_str(),
                plan.family.c_str());
  return text + line;
}

}  // namespace faultsim
