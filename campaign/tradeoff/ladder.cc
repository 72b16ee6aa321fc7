#include "campaign/tradeoff/ladder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/answer.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

using faultsim::find_tier;
using faultsim::JsonDocument;
using faultsim::MeshSizes;
using faultsim::Scene;

namespace {

/// Shortest text that reads back as the same number.
std::string shortest(double value) {
  const std::string text = json(value).dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}
std::string in_metres(double value) { return shortest(value) + " m"; }
std::string kilometres(double value) { return shortest(value / 1000) + " km"; }

std::string duration(double seconds) {
  const double years = seconds / kYear;
  return years >= 1 ? formatted("%.4g year%s", years, years == 1 ? "" : "s")
                    : formatted("%.3g days", seconds / 86400);
}

JsonDocument changed(const JsonDocument& scene, const std::vector<Change>& changes) {
  JsonDocument document = scene;
  for (const Change& change : changes)
    faultsim::put_value(document.value, change.pointer, change.value);
  return document;
}

std::vector<Change> operator+(std::vector<Change> a, const std::vector<Change>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// All sizes times a factor, and ratios of neighbours to its power: graded cells are then divided
/// like even ones.
MeshSizes scaled(MeshSizes sizes, double factor) {
  constexpr double kMostGrowth = 2, kMostCornerGrowth = 3;  // that a scene may have
  for (double* size : {&sizes.strike, &sizes.dip, &sizes.normal, &sizes.corner}) *size *= factor;
  if (!sizes.grades_corners()) return sizes;
  sizes.growth = std::min(kMostGrowth, std::pow(sizes.growth, factor));
  sizes.corner_growth = std::min(kMostCornerGrowth, std::pow(sizes.corner_growth, factor));
  return sizes;
}

/// Cells of these sizes, whatever the scene's own tier and mesh.
std::vector<Change> cells(const MeshSizes& sizes) {
  std::vector<Change> changes = {{"/tier", "custom"},
                                 {"/mesh/strike", in_metres(sizes.strike)},
                                 {"/mesh/dip", in_metres(sizes.dip)},
                                 {"/mesh/normal", in_metres(sizes.normal)}};
  if (!sizes.grades_corners()) return changes;
  changes.push_back({"/mesh/corner", in_metres(sizes.corner)});
  changes.push_back({"/mesh/corner_growth", sizes.corner_growth});
  changes.push_back({"/mesh/growth", sizes.growth});
  return changes;
}

/// "10", or "5 to 10" where cells are graded.
std::string dip_text(const MeshSizes& sizes) {
  return (sizes.grades_corners() ? shortest(sizes.corner) + " to " : "") + shortest(sizes.dip);
}

std::vector<Change> in_plane(bool plane_strain) {
  return {{"/numerics/plane_strain", plane_strain ? "on" : "off"}};
}

/// Makes the axes of one scene.
class LadderMaker {
 public:
  LadderMaker(const JsonDocument& document, const LadderLimits& limits)
      : document_(document), limits_(limits), scene_(faultsim::read_scene(document)) {
    std::vector<Problem> problems;
    const faultsim::Plan plan = faultsim::make_plan(scene_, problems);
    if (!problems.empty()) throw InputError(document.source, problems);
    is_field_ = scene_.geometry_kind == faultsim::GeometryKind::field;
    is_3d_ = !plan.plane_strain;
    creeps_ = plan.creep.active;
    plane_sizes_ = is_field_ ? find_tier("screening")->sizes : scene_.mesh;
    plane_sizes_.strike = scene_.mesh.strike;
    if (!is_field_) plane_sizes_.normal = plane_sizes_.dip;
    plane_ = cells(plane_sizes_) + in_plane(true);
    from_tier_ = is_field_ && scene_.tier != "custom";
    sizes_ = from_tier_ ? find_tier("standard")->sizes : scene_.mesh;
    coarse_3d_ = cells(scaled(sizes_, 4)) + in_plane(false);
  }

  std::vector<TradeAxis> all() {
    plane_cells();
    if (is_3d_) space_cells();
    if (is_3d_ && is_field_) half_domain();
    if (is_field_) domain_size();
    load_steps();
    if (creeps_) salt_steps();
    tolerance();
    b_bar();
    activation_length();
    for (TradeAxis& axis : axes_) {
      for (TradeChoice& choice : axis.choices) judge(choice);
    }
    return std::move(axes_);
  }

 private:
  TradeAxis& axis(const std::string& name, const std::string& question) {
    axes_.push_back({name, question, false, false, "", {}});
    return axes_.back();
  }

  static void add(TradeAxis& axis, const std::string& name, const std::vector<Change>& base,
                  const std::vector<Change>& changes, double size = 0) {
    TradeChoice choice;
    choice.name = name;
    choice.changes = base + changes;
    choice.size = size;
    axis.choices.push_back(choice);
  }

  void plane_cells() {
    TradeAxis& one = axis("cells, plane strain", "How fine must the cells be in plane strain?");
    one.converges = one.is_mesh = true;
    for (const double factor : {8.0, 4.0, 2.0, 1.0, 0.5, 0.25}) {
      MeshSizes sizes = scaled(plane_sizes_, factor);
      sizes.strike = scene_.mesh.strike;
      add(one, dip_text(sizes) + " m" + (is_field_ && factor == 1 ? " (screening)" : ""),
          cells(sizes), in_plane(true), sizes.dip);
    }
  }

  void space_cells() {
    TradeAxis& one = axis("cells, 3D", "How fine must the cells be in 3D?");
    one.converges = one.is_mesh = true;
    for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
      const bool is_reference = from_tier_ && factor == 0.5;
      const MeshSizes sizes = is_reference ? find_tier("reference")->sizes : scaled(sizes_, factor);
      std::string name =
          concat(shortest(sizes.strike), " x ", dip_text(sizes), " x ", in_metres(sizes.normal));
      if (from_tier_ && factor == 1) name += " (standard)";
      if (is_reference) name += " (reference)";
      add(one, name, cells(sizes), in_plane(false), sizes.dip);
    }
  }

  void half_domain() {
    TradeAxis& one = axis("half domain", "What does the half domain by symmetry cost?");
    add(one, "half", coarse_3d_, {{"/numerics/half_domain", "on"}});
    add(one, "full", coarse_3d_, {{"/numerics/half_domain", "off"}});
  }

  /// One dimension of the model, by factors of what is given.
  void extents(const std::string& name, const std::string& question, const std::string& pointer,
               double given, const std::vector<double>& factors, const std::vector<Change>& base) {
    TradeAxis& one = axis(name, question);
    for (const double factor : factors) {
      add(one, kilometres(factor * given) + (factor == 1 ? " (as given)" : ""), base,
          {{pointer, in_metres(factor * given)}});
    }
  }

  void domain_size() {
    const faultsim::FieldGeometry& field = scene_.field;
    extents("width of the model", "Are the sides far enough?", "/geometry/width", field.width,
            {0.5, 1, 2, 4}, plane_);
    extents("depth of the model", "Is the base deep enough?", "/geometry/depth", field.depth,
            {1, 1.5, 2, 4}, plane_);
    if (!is_3d_) return;
    extents("length of the model", "Are the ends along strike far enough?", "/geometry/length",
            field.length, {0.5, 1, 2}, coarse_3d_);
  }

  void load_steps() {
    TradeAxis& one = axis("load steps", "Are the load steps short enough?");
    for (const int factor : {1, 2, 4, 8}) {
      std::vector<Change> changes;
      for (std::size_t k = 0; k < scene_.stages.size(); ++k) {
        changes.push_back({concat("/stages/", k, "/steps"), factor * scene_.stages[k].n_steps});
      }
      add(one, factor == 1 ? "as given" : concat("1/", factor), plane_, changes);
    }
  }

  /// What error control does, a long step of the first order, then fixed steps.
  void salt_steps() {
    double longest = 0;
    for (const faultsim::Stage& stage : scene_.stages)
      longest = std::max(longest, stage.duration / stage.n_steps);
    const auto fixed = [](double step) {
      return std::vector<Change>{{"/numerics/creep_time_step", shortest(step) + " s"}};
    };
    TradeAxis& one = axis("salt steps", "How long may the time steps of creep be?");
    one.converges = true;
    add(one, "error control (as given)", plane_, {});
    add(one, duration(longest) + ", backward Euler", plane_,
        fixed(longest) + std::vector<Change>{{"/numerics/creep_scheme", "backward_euler"}});
    for (const double factor : {1.0, 0.5, 0.25, 0.125, 0.0625}) {
      add(one, duration(factor * longest), plane_, fixed(factor * longest), factor * longest);
    }
  }

  void tolerance() {
    TradeAxis& one = axis("tolerance of contact", "How accurately must contact be solved?");
    for (const double value : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
      add(one, shortest(value) + (value == 1e-8 ? " (default)" : ""), plane_,
          {{"/numerics/traction_tolerance", value}});
    }
  }

  void b_bar() {
    TradeAxis& one = axis("B-bar", "What does averaging dilatation over cells change?");
    add(one, "off", plane_, {{"/numerics/b_bar", false}});
    add(one, "on (default)", plane_, {{"/numerics/b_bar", true}});
  }

  void activation_length() {
    TradeAxis& one = axis("activation length",
                          "How much depends on the length that must slip to count as sliding?");
    one.reference = in_metres(scene_.numerics.activation_length);
    for (const double factor : {0.5, 1.0, 2.0}) {
      const std::string length = in_metres(factor * scene_.numerics.activation_length);
      add(one, length, plane_, {{"/numerics/activation_length", length}});
    }
  }

  /// Plans the choice: what it costs, or why it is left out.
  void judge(TradeChoice& choice) const {
    try {
      const Scene scene = faultsim::read_scene(changed(document_, choice.changes));
      std::vector<Problem> problems;
      const faultsim::Plan plan = faultsim::make_plan(scene, problems);
      if (!problems.empty()) throw InputError(document_.source, problems);
      choice.plane_strain = plan.plane_strain;
      choice.n_unknowns = plan.n_unknowns;
      choice.n_jump = plan.n_jump;
      choice.predicted_seconds = plan.operator_seconds;
      choice.predicted_bytes = plan.memory_bytes;
    } catch (const InputError& error) {
      const auto& problem = error.problems().front();
      choice.left_out = concat("refused: ", problem.pointer, ": ", problem.what);
      return;
    }
    if (limits_.memory_bytes > 0 && choice.predicted_bytes > limits_.memory_bytes) {
      choice.left_out =
          formatted("not affordable: %.3g GB predicted", choice.predicted_bytes / 1e9);
    } else if (choice.predicted_seconds > limits_.operator_seconds) {
      choice.left_out = formatted("not affordable: %.3g s predicted", choice.predicted_seconds);
    }
  }

  const JsonDocument& document_;
  LadderLimits limits_;
  Scene scene_;
  bool is_field_ = false, is_3d_ = false, creeps_ = false;
  bool from_tier_ = false;                 ///< then the 3D meshes are those of tiers.
  MeshSizes plane_sizes_, sizes_;          ///< of the middle choice in plane strain and in 3D.
  std::vector<Change> plane_, coarse_3d_;  ///< where the other axes are measured.
  std::vector<TradeAxis> axes_;
};

/// A group of a spec with one parameter, `choice`.
json group_of(const std::string& name, const json& variants) {
  json parameters;
  parameters["choice"]["variants"] = variants;
  return {{"name", name}, {"design", {{"kind", "grid"}, {"parameters", parameters}}}};
}

/// The case at a tier, as changes of the base scene: what it has differently, without its own mesh.
json at_tier(const json& base, json scene, const std::string& tier) {
  scene["tier"] = tier;
  scene["mesh"] = json::object();
  if (scene.contains("numerics")) scene["numerics"].erase("plane_strain");
  json changes = json::object();
  for (const auto& [key, value] : scene.items()) {
    if (!base.contains(key) || base[key] != value) changes["/" + key] = value;
  }
  return changes;
}

/// A step through n cases that visits all and keeps away from the strides of a grid: near the
/// golden section of n and coprime to it.
long scattering_stride(long n) {
  long stride = std::max(1L, std::lround(0.6180339887 * static_cast<double>(n)));
  while (std::gcd(stride, n) != 1) ++stride;
  return stride;
}

}  // namespace

std::vector<TradeAxis> make_ladder(const JsonDocument& scene, const LadderLimits& limits) {
  return LadderMaker(scene, limits).all();
}

json ladder_spec(const std::string& name, const JsonDocument& scene,
                 const std::vector<TradeAxis>& axes) {
  json groups = json::array();
  for (const TradeAxis& axis : axes) {
    json variants = json::object();
    for (const TradeChoice& choice : axis.choices) {
      if (!choice.left_out.empty()) continue;
      json& changes = variants[choice.name] = json::object();
      for (const Change& change : choice.changes) changes[change.pointer] = change.value;
    }
    if (variants.empty()) continue;
    groups.push_back(group_of(axis.name, variants));
  }
  return {{"format", 1},
          {"name", name},
          {"base", scene.value},
          {"design", {{"kind", "groups"}, {"groups", groups}}},
          {"policy", {{"on_failure", "continue"}}}};
}

std::string sample_group(const std::string& tier) { return "ranking, " + tier; }

void add_sample(const Expansion& campaign, const json& base, long n_cases,
                const std::vector<std::string>& tiers, json& spec) {
  const auto n = static_cast<long>(campaign.cases.size());
  const long stride = scattering_stride(n);
  for (const std::string& tier : tiers) {
    json variants = json::object();
    for (long k = 0; k < std::min(n, n_cases); ++k) {
      const auto index = static_cast<std::size_t>(k * stride % n);
      variants[concat("case ", index + 1)] =
          at_tier(base, scene_of(campaign, campaign.cases[index]), tier);
    }
    spec["design"]["groups"].push_back(group_of(sample_group(tier), variants));
  }
}

}  // namespace faultsweep
