#include "simulator/plan/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/mesh/patch_frame.h"
#include "simulator/plan/combinations.h"
#include "simulator/plan/creep_plan.h"
#include "simulator/scene/field_depths.h"

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
    r.reason = "a box is modelled as given";
  } else if (plane_strain) {
    r.reason = "plane strain has no extent along strike";
  } else if (scene.numerics.half_domain == Switch::off) {
    r.reason = "switched off";
    r.bound = exact;
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

/// Lines strictly between two coordinates, as a range [first, second).
std::pair<int, int> lines_between(const std::vector<double>& lines, double from, double to) {
  const auto first = std::ranges::upper_bound(lines, from + 1e-6);
  const auto last = std::lower_bound(first, lines.end(), to - 1e-6);
  return {static_cast<int>(first - lines.begin()), static_cast<int>(last - lines.begin())};
}

/// The line at a coordinate, or next to it: where a fault lies on the grid before it is sheared.
std::pair<int, int> line_at(const std::vector<double>& lines, double at) {
  const auto first = std::ranges::lower_bound(lines, at - 1e-6);
  const int line =
      std::min(static_cast<int>(first - lines.begin()), static_cast<int>(lines.size()) - 1);
  return {line, line + 1};
}

std::vector<FaultWindow> field_faults(const Scene& scene, const Plan& plan,
                                      const GridLines& lines) {
  const FieldGeometry& field = scene.field;
  const bool has_ends = field.fault_length < field.length;  // else the model's ends cut it
  const double reach = has_ends ? field.fault_length / 2 : field.length;
  const auto columns = plan.plane_strain ? std::pair{0, 1} : lines_between(lines[1], -reach, reach);
  std::vector<FaultWindow> faults;
  for (std::size_t f = 0; f <= field.blocks.size(); ++f) {
    const DepthInterval range = fault_range(field, f);
    faults.push_back({{line_at(lines[0], fault_x(field, f)), columns,
                       lines_between(lines[2], -range.bottom, -range.top)}});
  }
  return faults;
}

/// A patch covers the grid plane nearest to its own, from edge to edge.
FaultWindow box_fault(const PatchGeometry& patch, const Plan& plan, const GridLines& lines) {
  constexpr double kQuarter = 0.78539816339744831;  // pi/4
  const bool is_flat = patch.dip_from_vertical > kQuarter || patch.dip_from_vertical < -kQuarter;
  const bool strikes_along_x = std::abs(std::sin(patch.strike)) > std::abs(std::cos(patch.strike));
  const std::size_t column_axis = strikes_along_x ? 0 : 1;
  const std::size_t row_axis = is_flat ? 1 - column_axis : 2;
  const std::size_t axis = 3 - column_axis - row_axis;
  const double dip = patch.dip_from_vertical;
  const double along = strikes_along_x ? std::sin(patch.strike) : std::cos(patch.strike);
  std::array<double, 3> half{};
  half[column_axis] = patch.length / 2 * std::abs(along);
  half[row_axis] = patch.width / 2 * std::abs(is_flat ? std::sin(dip) : std::cos(dip));
  FaultWindow w;
  for (std::size_t a = 0; a < 3; ++a) {
    w.lines[a] =
        a == axis ? line_at(lines[a], patch.center[a])
                  : lines_between(lines[a], patch.center[a] - half[a], patch.center[a] + half[a]);
  }
  if (plan.plane_strain) w.lines[1] = {0, 1};
  if (patch.shape == PatchShape::ellipse && !plan.plane_strain) w.share = kQuarter;
  return w;
}

GridLines lines_of(const Scene& scene, const Plan& plan, std::vector<Problem>& problems) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  return is_field ? grid_lines(field_mesh_spec(scene, plan), problems)
                  : grid_lines(box_mesh_spec(scene, plan), problems);
}

GridShape grid_shape(const Scene& scene, const Plan& plan, const GridLines& lines) {
  GridShape shape;
  const int n_y = plan.plane_strain ? 1 : static_cast<int>(lines[1].size());
  shape.n_lines = {static_cast<int>(lines[0].size()), n_y, static_cast<int>(lines[2].size())};
  shape.unknowns_per_node = plan.plane_strain ? 2 : 3;
  shape.n_loads = static_cast<int>(scene.pressure.size() + scene.box.boundary.size() +
                                   3 * scene.output.observation_points.size());
  if (scene.geometry_kind == GeometryKind::field) {
    shape.faults = field_faults(scene, plan, lines);
  } else {
    for (const PatchGeometry& patch : scene.box.patches) {
      shape.faults.push_back(box_fault(patch, plan, lines));
    }
  }
  return shape;
}

/// Intervals between lines whose middle lies between two coordinates.
double intervals(const std::vector<double>& lines, double from, double to) {
  int n = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double middle = 0.5 * (lines[i - 1] + lines[i]);
    n += middle > from && middle < to;
  }
  return n;
}

/// About how many cells lie in pressure regions, from the lines of the grid before it is sheared
/// and shifted: what a field of pressures or temperatures has an influence of.
double reservoir_cells(const Scene& scene, const GridLines& lines, bool plane_strain) {
  const auto box = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
    const double along = plane_strain ? 1 : intervals(lines[1], y0, y1);
    return intervals(lines[0], x0, x1) * along * intervals(lines[2], z0, z1);
  };
  double n = 0;
  if (scene.geometry_kind == GeometryKind::field) {
    const double half = scene.field.block_length / 2;
    for (const Block& block : scene.field.blocks) {
      const DepthInterval range = reservoir_range(scene.field, block);
      n += box(block.from, block.to, -half, half, -range.bottom, -range.top);
    }
    return n;
  }
  for (const PressureRegion& region : scene.box.regions) {
    constexpr double kDiscOfSquare = 0.785;  // pi/4
    const auto [low, high] = bounds_of(region);
    n += (region.shape == RegionShape::disc ? kDiscOfSquare : 1) *
         box(low[0], high[0], low[1], high[1], low[2], high[2]);
  }
  return n;
}

/// The program, and the build of the last operator beside what the others keep.
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

int material_index(const Scene& scene, const std::string& name) {
  return static_cast<int>(&material_named(scene, name) - scene.materials.data());
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

  const GridLines lines = lines_of(scene, plan, problems);
  if (std::ranges::any_of(lines, [](const auto& line) { return line.size() < 2; })) return plan;
  const GridShape shape = grid_shape(scene, plan, lines);
  plan.n_cells =
      static_cast<long>((lines[0].size() - 1) * (lines[1].size() - 1) * (lines[2].size() - 1));
  plan.n_jump = std::lround(shape.n_jump());
  plan.n_unknowns = std::lround(shape.unknowns_per_node * shape.n_nodes()) + plan.n_jump;
  for (const StepEnd& step : step_ends(scene)) {
    ++plan.n_steps;
    plan.n_added_steps += step.added;
  }
  plan.minus_side = minus_side(scene, plan);
  predict_cost(shape, plan);
  predict_influence(scene, shape, reservoir_cells(scene, lines, plan.plane_strain), plan);
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
  Plan plan = of_other;
  plan.initial = initial_regions(scene);
  plan.warnings.clear();
  return plan;
}

InfluenceCost plan_influence(const Scene& scene, const Plan& plan, long n_cells) {
  std::vector<Problem> problems;
  const GridLines lines = lines_of(scene, plan, problems);
  return influence_cost(grid_shape(scene, plan, lines), static_cast<double>(n_cells),
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
