#include "simulator/plan/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/mesh/patch_frame.h"
#include "simulator/plan/body_mesh.h"
#include "simulator/plan/combinations.h"
#include "simulator/plan/creep_plan.h"
#include "simulator/plan/planned_grid.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

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
  Reduction r;
  r.name = "plane_strain";
  r.switch_ = "/numerics/plane_strain";
  r.applied = scene.numerics.plane_strain == Switch::on;
  if (is_meshed(scene)) {
    r.reason = "a mesh is modelled as given";
    return r;
  }
  if (scene.geometry_kind == GeometryKind::field) {
    r.bound = "ignores the ends of blocks and faults; measure it with a 3D tier";
  } else if (const std::string names = ending_patches(scene); !names.empty()) {
    r.bound = "ignores the ends along y of " + names;
  } else {
    r.bound = "exact when nothing varies along y";
  }
  if (r.applied) {
    r.reason = "asked for: one row of cells, front and back tied, no motion along strike";
  } else {
    r.reason = scene.geometry_kind == GeometryKind::field ? "blocks and faults end along strike"
                                                          : "not asked for";
  }
  return r;
}

/// By how much the fields of a scene are not their own mirror images; "" where they are.
std::string asymmetry_text(const Scene& scene) {
  for (const FlowLoad* load : {&scene.pressure_field, &scene.temperature_field}) {
    if (!load->is_given() || load->is_symmetric()) continue;
    if (!load->asymmetry) return ": its grid is not";
    return concat(": it differs from its mirror image by up to ", 100 * *load->asymmetry,
                  " % of its largest value");
  }
  return "";
}

Reduction plan_half_domain(const Scene& scene, bool plane_strain) {
  Reduction r{"half_domain", false, "", "", "/numerics/half_domain", {}};
  const std::string exact = "exact by symmetry: areas, potency and M0 are doubled";
  if (scene.geometry_kind != GeometryKind::field) {
    r.reason = is_meshed(scene) ? "a mesh is modelled as given" : "a box is modelled as given";
  } else if (plane_strain) {
    r.reason = "plane strain has no extent along strike";
  } else if (scene.numerics.half_domain == Switch::off) {
    r.reason = "switched off";
    r.bound = exact;
  } else if (const std::string extent = asymmetric_extent(scene); !extent.empty()) {
    r.reason = extent + ", which is not symmetric about y = 0";
  } else if (const std::string text = asymmetry_text(scene); !text.empty()) {
    r.reason = "the flow result is not symmetric about y = 0" + text;
  } else if (std::ranges::any_of(scene.faults, [](const Fault& fault) {
               return !fault.pressure.profile.strike.empty();
             })) {
    r.reason = "a table of fault pressure that varies along strike need not be symmetric";
  } else {
    r.applied = true;
    r.bound = exact;
    r.reason = "layers, blocks, faults, pressure and stress are symmetric about y = 0";
  }
  return r;
}

/// A half domain that is asked for, and that symmetry forbids, is refused and not left out.
void require_half_domain(const Scene& scene, const Plan& plan, std::vector<Problem>& problems) {
  const bool is_asked = scene.numerics.half_domain == Switch::on && !plan.plane_strain &&
                        scene.geometry_kind == GeometryKind::field;
  if (!is_asked || plan.half_domain) return;
  problems.push_back({"/numerics/half_domain", 0,
                      "half of the domain is asked for, but " + plan.reductions.back().reason,
                      "set it to \"off\", and choose another tier than one for half domains"});
}

void predict_cost(const GridShape& shape, Plan& plan) {
  const OperatorCost cost = operator_cost(shape);
  const auto rungs = static_cast<double>(plan.creep.rungs.size());
  plan.factor_bytes = cost.factor_bytes;
  plan.operator_seconds = (1 + rungs) * cost.seconds;
  plan.memory_bytes =
      kProgramBytes + cost.peak_bytes + rungs * (cost.factor_bytes + cost.kept_bytes);
}

/// What a field costs on top: the influence of the cells it acts on, built beside the factor.
void predict_influence(const Scene& scene, const GridShape& shape, double n_cells, Plan& plan) {
  if (!scene.has_field() || plan.creep.active) return;  // creeping, the factors are asked
  const double n_observed = 3.0 * static_cast<double>(scene.output.observation_points.size());
  const InfluenceCost cost = influence_cost(shape, n_cells, n_observed);
  plan.influence_bytes = cost.bytes;
  plan.operator_seconds += cost.seconds;
  plan.memory_bytes = std::max(plan.memory_bytes, kProgramBytes + cost.peak_bytes);
}

/// The figures of a saving, or none.
nlohmann::json saving_to_json(const std::optional<Reduction::Saving>& saving) {
  if (!saving) return nullptr;
  const auto figures = [](const PlannedSize& size) {
    return nlohmann::json{{"n_unknowns", size.n_unknowns},
                          {"predicted_operator_s", size.operator_seconds},
                          {"predicted_memory_bytes", size.memory_bytes}};
  };
  return {{"text", saving_text(*saving)},
          {"with", figures(saving->with)},
          {"without", figures(saving->without)}};
}

/// The switch of a reduction in a scene. @pre the name is one of make_plan's.
Switch& switch_of(const std::string& reduction, Numerics& numerics) {
  if (reduction == "plane_strain") return numerics.plane_strain;
  if (reduction == "half_domain") return numerics.half_domain;
  FAULTSIM_DEMAND(reduction == "creep_off", "reduction ", reduction);
  return numerics.creep;
}

/// The scene with the decision about one reduction turned round.
Scene flipped(Scene scene, const Reduction& reduction) {
  const bool switch_is_on = reduction.name == "creep_off" ? reduction.applied : !reduction.applied;
  switch_of(reduction.name, scene.numerics) = switch_is_on ? Switch::on : Switch::off;
  return scene;
}

std::string human_time(double seconds) {
  return seconds >= 7200 ? formatted("%.1f hours", seconds / 3600) : formatted("%.1f s", seconds);
}

MeshRequest mesh_request(const Scene& scene, const Plan& plan) {
  MeshRequest request{.sizes = scene.mesh, .plane_strain = plan.plane_strain};
  for (const Layer& layer : layers_of(scene))
    request.layer_materials.push_back(material_index(scene, layer.material));
  for (const Fault& fault : scene.faults) request.fault_names.push_back(fault.name);
  return request;
}

/// The side that the rule `minus` takes, whatever the strikes: the normals of all faults of a mesh
/// point along one axis of its grid.
std::string minus_side(const Scene& scene, const Plan& plan) {
  if (scene.faults.empty()) return "";
  if (scene.geometry_kind == GeometryKind::field) return "x-";
  if (is_meshed(scene)) return "";  // each fault's own
  std::vector<Problem> said_elsewhere;
  const std::size_t axis = common_axis(patch_frames(box_mesh_spec(scene, plan), said_elsewhere));
  return axis < 3 ? std::string(1, "xyz"[axis]) + "-" : "";
}

std::vector<std::string> sections_of_fields(const Scene& scene) {
  std::vector<std::string> texts;
  const auto add = [&](const char* name, const FlowLoad& load) {
    if (!load.is_given()) return;
    texts.push_back(concat(name, " is taken at y = ", load.y,
                           " m of the scene, as the mean of half a metre on either side"));
  };
  add("pressure_field", scene.pressure_field);
  add("temperature_field", scene.temperature_field);
  return texts;
}

/// What is left out of a scene, and whether it creeps.
Plan plan_reductions(const Scene& scene) {
  Plan plan;
  plan.reductions.push_back(plan_plane_strain(scene));
  plan.plane_strain = plan.reductions.back().applied;
  plan.reductions.push_back(plan_half_domain(scene, plan.plane_strain));
  plan.half_domain = plan.reductions.back().applied;
  if (!has_viscous_material(scene)) return plan;
  const CreepEstimate estimate = estimate_creep(scene);
  plan.reductions.push_back(plan_creep_off(scene, estimate));
  plan.creep.active = !plan.reductions.back().applied;
  plan.creep.bound = estimate.bound;
  if (plan.creep.active) plan.creep.rungs = creep_rungs(scene);
  return plan;
}

void count_steps(const Scene& scene, Plan& plan) {
  const std::vector<StepEnd> steps = step_ends(scene);
  plan.n_steps = static_cast<int>(steps.size());
  plan.n_added_steps = static_cast<int>(std::ranges::count_if(steps, &StepEnd::added));
}

}  // namespace

namespace {

/// What holds a surface and measures it: the centre, an exact and an interpolated H with their
/// factors, and the directions by blocks (model/direction_blocks: runs of kRun jumps, kColumns of a
/// basis of two runs in results/surfaces).
double surface_bytes(double n_jump, double n_directions) {
  constexpr double kRun = 192, kColumns = 50;
  const double n_runs = std::ceil(n_jump / kRun), n_pairs = n_runs * (n_runs - 1) / 2;
  const double near = n_directions * n_jump * std::min(kRun, n_jump);
  const double far = n_pairs * kColumns * (2 * kRun + n_directions * kColumns);
  return 5 * sizeof(double) * n_jump * n_jump + sizeof(float) * (near + far);
}

}  // namespace

/// Coefficients of polynomials of degree p in d variables together, (d + p)! / (d! p!), p being
/// what surfaces took: 4 where χ̄ is to be within 3e-3, 6.2 at 5e-4, or where norms are to be within
/// 1e-3 (results/eight-families, decision 19).
int predicted_operators(const SurfaceRequest& surface) {
  if (!surface.wanted()) return 1;
  constexpr double kDegreesPerDigit = 2.8;
  const double degree = surface.probes
                            ? 4 + kDegreesPerDigit * std::log10(3e-3 / surface.probes->tolerance)
                            : 6.2 + kDegreesPerDigit * std::log10(1e-3 / surface.tolerance);
  const double p = std::max(degree, 1.0), d = static_cast<double>(surface.over.size());
  const double n = std::exp(std::lgamma(d + p + 1) - std::lgamma(d + 1) - std::lgamma(p + 1));
  return static_cast<int>(std::lround(std::min<double>(surface.most_operators, n))) +
         n_surface_checks(surface);
}

FieldMeshSpec field_mesh_spec(const Scene& scene, const Plan& plan) {
  FieldMeshSpec spec{scene.field, mesh_request(scene, plan)};
  spec.sideburden_material = material_index(scene, spec.sideburden);
  for (const Fault& fault : scene.faults) spec.fault_dips.push_back(fault.dip_from_vertical);
  spec.half_domain = plan.half_domain;
  return spec;
}

BoxMeshSpec box_mesh_spec(const Scene& scene, const Plan& plan) {
  BoxMeshSpec spec{scene.box, mesh_request(scene, plan)};
  if (spec.layers.empty()) spec.layer_materials = {material_index(scene, spec.material)};
  for (const BoundaryCondition& b : spec.boundary) {
    if (b.kind != BoundaryKind::tied) continue;
    for (const Side side : b.sides) spec.tied[static_cast<std::size_t>(side) / 2] = true;
  }
  return spec;
}

Mesh scene_mesh(const Scene& scene, const Plan& plan) {
  if (is_meshed(scene)) return body_mesh(scene);
  return scene.geometry_kind == GeometryKind::field ? make_mesh(field_mesh_spec(scene, plan))
                                                    : make_mesh(box_mesh_spec(scene, plan));
}

std::string family_of(const Scene& scene) {
  return fingerprint(canonical_family(scene, plan_reductions(scene)));
}

Plan make_plan(const Scene& scene, std::vector<Problem>& problems) {
  Plan plan = plan_reductions(scene);
  plan.initial = initial_regions(scene);
  if (plan.plane_strain) plan.sections = sections_of_fields(scene);
  require_half_domain(scene, plan, problems);
  for (Problem& problem : unsupported(scene, plan)) problems.push_back(std::move(problem));

  const std::optional<PlannedGrid> grid = planned_grid(scene, plan, problems);
  if (!grid) return plan;
  const GridShape& shape = grid->shape;
  plan.n_cells = grid->n_cells;
  plan.n_jump = std::lround(shape.n_jump());
  plan.n_unknowns = std::lround(shape.unknowns_per_node * shape.n_nodes()) + plan.n_jump;
  count_steps(scene, plan);
  plan.minus_side = minus_side(scene, plan);
  predict_cost(shape, plan);
  predict_influence(scene, shape, grid->n_loaded, plan);
  plan.n_operators = predicted_operators(scene.numerics.surface);
  plan.operator_seconds *= plan.n_operators;
  if (scene.numerics.surface.wanted()) {
    const double bytes = surface_bytes(shape.n_jump(), plan.n_operators);
    plan.memory_bytes = std::max(plan.memory_bytes, kProgramBytes + bytes);
  }
  plan.family = fingerprint(canonical_family(scene, plan));
  return plan;
}

Plan make_plan(const Scene& scene, std::vector<Problem>& problems, const Scene& other,
               const Plan& of_other) {
  const bool is_alike = have_same_body(scene, other) && scene.output == other.output;
  // What creep may change depends on the stress.
  if (!is_alike || has_viscous_material(scene)) return make_plan(scene, problems);
  Plan reduced = plan_reductions(scene);
  // Pressures of faults need not be symmetric.
  if (reduced.half_domain != of_other.half_domain || reduced.plane_strain != of_other.plane_strain)
    return make_plan(scene, problems);
  Plan plan = of_other;
  plan.reductions = std::move(reduced.reductions);
  count_steps(scene, plan);
  plan.initial = initial_regions(scene);
  plan.warnings.clear();
  return plan;
}

InfluenceCost plan_influence(const Scene& scene, const Plan& plan, long n_cells) {
  std::vector<Problem> problems;
  return influence_cost(planned_grid(scene, plan, problems)->shape, static_cast<double>(n_cells),
                        3.0 * static_cast<double>(scene.output.observation_points.size()));
}

void add_savings(const Scene& scene, Plan& plan) {
  for (Reduction& reduction : plan.reductions) {
    if (reduction.bound.empty()) continue;
    std::vector<Problem> problems;
    const Plan other = make_plan(flipped(scene, reduction), problems);
    if (!problems.empty()) continue;
    reduction.saving =
        reduction.applied ? Reduction::Saving{plan, other} : Reduction::Saving{other, plan};
  }
}

std::string saving_text(const Reduction::Saving& saving) {
  const PlannedSize &with = saving.with, &without = saving.without;
  const double share = 100 * (1 - with.memory_bytes / without.memory_bytes);
  const double times = without.operator_seconds / with.operator_seconds;
  return formatted("%.*f %% of the memory, %.*f times less operator time", share < 99 ? 0 : 1,
                   share, times < 10 ? 1 : 0, times);
}

std::string operator_fingerprint(const Scene& scene, const Plan& plan, const std::string& blas) {
  nlohmann::json j = {
      {"family", plan.family}, {"numerics_version", kNumericsVersion}, {"blas", blas}};
  for (const ObservationPoint& point : scene.output.observation_points) {
    j["observation_points"].push_back({point.name, point.position});
  }
  return fingerprint(j.dump());
}

std::string size_to_text(double bytes) {
  return bytes >= 1e9 ? formatted("%.1f GB", bytes / 1e9) : formatted("%.0f MB", bytes / 1e6);
}

std::string sides_to_text(const Plan& plan) {
  if (plan.minus_side.empty()) return "";
  const char axis = plan.minus_side.front();
  const std::array<const char*, 2> names = axis == 'x'   ? std::array{"west", "east"}
                                           : axis == 'y' ? std::array{"south", "north"}
                                                         : std::array{"below", "above"};
  return concat("sides of faults: minus is that of smaller ", axis, " (", names[0],
                "), plus that of larger ", axis, " (", names[1], "), whatever the strike\n");
}

nlohmann::json plan_to_json(const Plan& plan) {
  nlohmann::json j = {
      {"half_domain", plan.half_domain},
      {"plane_strain", plan.plane_strain},
      {"n_cells", plan.n_cells},
      {"n_unknowns", plan.n_unknowns},
      {"n_jump_unknowns", plan.n_jump},
      {"n_load_steps", plan.n_steps},
      {"n_added_steps", plan.n_added_steps},
      {"predicted_operator_s", plan.operator_seconds},
      {"predicted_memory_bytes", plan.memory_bytes},
      {"minus_side", plan.minus_side},
      {"family", plan.family},
      {"creep",
       {{"active", plan.creep.active}, {"rungs_s", plan.creep.rungs}, {"bound_pa", nullptr}}},
      {"initial_state", initial_state_to_json(plan.initial)},
      {"field_sections", plan.sections},
      {"warnings", plan.warnings},
      {"reductions", nlohmann::json::array()}};
  if (plan.creep.bound) j["creep"]["bound_pa"] = *plan.creep.bound;
  for (const Reduction& r : plan.reductions) {
    j["reductions"].push_back({{"name", r.name},
                               {"applied", r.applied},
                               {"reason", r.reason},
                               {"bound", r.bound},
                               {"saving", saving_to_json(r.saving)},
                               {"switch", r.switch_}});
  }
  return j;
}

std::string plan_to_text(const Plan& plan) {
  std::string text;
  for (const Reduction& r : plan.reductions) {
    text += r.name + ": " + (r.applied ? "yes" : "no") + ", " + r.reason + "\n";
    if (!r.bound.empty()) text += "  bound: " + r.bound + "\n";
    if (r.saving)
      text += (r.applied ? "  saves " : "  would save ") + saving_text(*r.saving) + "\n";
    if (!r.bound.empty()) text += "  switch: " + r.switch_ + "\n";
  }
  text += initial_state_to_text(plan.initial) + sides_to_text(plan);
  text += formatted("cells %ld, unknowns %ld (of which jumps %ld), load steps %d", plan.n_cells,
                    plan.n_unknowns, plan.n_jump, plan.n_steps);
  if (plan.n_added_steps > 0) {
    text += concat(" (", plan.n_added_steps, " added where histories turn)");
  }
  text += "\n" + creep_text(plan.creep);
  text += formatted("operator: about %s of one core and %s at its peak; family %.12s\n",
                    human_time(plan.operator_seconds).c_str(),
                    size_to_text(plan.memory_bytes).c_str(), plan.family.c_str());
  if (plan.influence_bytes > 0) {
    text += "with the influence of the cells that the field acts on, which takes about " +
            size_to_text(plan.influence_bytes) + "\n";
  }
  for (const std::string& section : plan.sections) text += section + "\n";
  for (const std::string& warning : plan.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace faultsim
