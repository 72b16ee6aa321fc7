#include "simulator/plan/combinations.h"

#include <algorithm>

namespace faultsim {
namespace {

constexpr Refusal kRefusals[] = {
    {Feature::creep, Feature::surface,
     "salt creeps: every length of a step has an operator of its own, and none of them is "
     "interpolated",
     "set /numerics/creep to \"off\", or remove the surface"},
    {Feature::creep, Feature::stress_change,
     "salt creeps: a change of the regional stress would relax in it, and acts on elastic rock "
     "only",
     "set /numerics/creep to \"off\", or remove stress_change"},
    {Feature::creep, Feature::coupled_path, "the coupled path does not support creeping salt",
     "switch creep off, or use the condensed path (--path condensed)"},
    {Feature::surface, Feature::coupled_path, "the coupled path has no operator to interpolate",
     "remove the surface, or use the condensed path (--path condensed)"},
    {Feature::flow_result, Feature::coupled_path, "the coupled path has no loads of single cells",
     "give the pressures by compartment, or use the condensed path (--path condensed)"},
    {Feature::mesh, Feature::plane_strain, "a mesh is modelled in 3D, as it is",
     "set /numerics/plane_strain to \"off\", or mesh a slab with rollers in front and behind"},
    {Feature::mesh, Feature::half_domain, "a mesh is modelled as it is",
     "mesh the half, with a roller on its plane of symmetry"},
    {Feature::creep, Feature::contact_problem,
     "a load step with creeping salt is not one contact problem but several",
     "export the elastic case: --set /numerics/creep=off"},
    {Feature::cohesion_loss, Feature::contact_problem, "a friction cone has no cohesion",
     "set the cohesion to 0, or export a step after it was lost", true},
};

/// A feature as the table calls it, and where a scene says it.
struct Named {
  Feature feature;
  const char* name;
  const char* pointer;
};
constexpr Named kNames[] = {
    {Feature::creep, "creep", "/numerics/creep"},
    {Feature::surface, "surface", "/numerics/surface"},
    {Feature::flow_result, "flow result", "/pressure_field"},
    {Feature::temperature, "temperature", "/stages"},
    {Feature::stress_change, "regional stress", "/stages"},
    {Feature::half_domain, "half domain", "/numerics/half_domain"},
    {Feature::plane_strain, "plane strain", "/numerics/plane_strain"},
    {Feature::weakening, "weakening", "/faults"},
    {Feature::cohesion_loss, "cohesion lost by slip", "/faults"},
    {Feature::mesh, "mesh of a file or of horizons", "/geometry"},
    {Feature::coupled_path, "coupled path", ""},
    {Feature::displacements, "displacement fields", "/output/volume_fields"},
    {Feature::contact_problem, "`export-contact`", ""},
    {Feature::influences, "`influence`", ""},
};
constexpr std::size_t kSceneFeatures = 10;

bool weakens(const Fault& fault) {
  return fault.friction.dynamic_friction_angle != fault.friction.static_friction_angle;
}
bool loses_cohesion(const Fault& fault) {
  return !fault.friction.cohesion_after_slip && fault.friction.cohesion > 0;
}

/// Where a scene says a feature: each fault that does.
std::vector<std::string> places_of(Feature feature, const Scene& scene) {
  if (feature == Feature::flow_result && !scene.pressure_field.is_given())
    return {"/temperature_field"};
  if (feature != Feature::weakening && feature != Feature::cohesion_loss) {
    return {std::ranges::find(kNames, feature, &Named::feature)->pointer};
  }
  std::vector<std::string> places;
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    const bool has =
        feature == Feature::weakening ? weakens(scene.faults[f]) : loses_cohesion(scene.faults[f]);
    if (has) places.push_back(concat("/faults/", f));
  }
  return places;
}

/// Of a pair, in either order; none: it runs.
const Refusal* refusal_of(Feature one, Feature other) {
  for (const Refusal& refusal : kRefusals) {
    if ((refusal.one == one && refusal.other == other) ||
        (refusal.one == other && refusal.other == one))
      return &refusal;
  }
  return nullptr;
}

}  // namespace

std::span<const Refusal> refusals() { return kRefusals; }

std::vector<Feature> features_of(const Scene& scene, const Plan& plan) {
  std::vector<Feature> features;
  const auto add = [&](bool has, Feature feature) {
    if (has) features.push_back(feature);
  };
  const std::vector<Fault>& faults = scene.faults;
  add(plan.creep.active, Feature::creep);
  add(scene.numerics.surface.wanted(), Feature::surface);
  add(scene.has_field(), Feature::flow_result);
  add(!scene.temperature.empty(), Feature::temperature);
  add(std::ranges::any_of(scene.stages,
                          [](const Stage& stage) { return stage.stress_change.has_value(); }),
      Feature::stress_change);
  const bool half_of_mesh = is_meshed(scene) && scene.numerics.half_domain == Switch::on;
  add(plan.half_domain || half_of_mesh, Feature::half_domain);
  add(plan.plane_strain, Feature::plane_strain);
  add(std::ranges::any_of(faults, weakens), Feature::weakening);
  add(std::ranges::any_of(faults, loses_cohesion), Feature::cohesion_loss);
  add(is_meshed(scene), Feature::mesh);
  add(scene.output.volume_fields, Feature::displacements);
  return features;
}

std::vector<Problem> unsupported(const Scene& scene, const Plan& plan,
                                 std::span<const Feature> asked) {
  std::vector<Feature> features = features_of(scene, plan);
  features.insert(features.end(), asked.begin(), asked.end());
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t j = i + 1; j < features.size(); ++j) {
      const Refusal* refusal = refusal_of(features[i], features[j]);
      if (refusal == nullptr || refusal->depends_on_case) continue;
      for (const std::string& place : places_of(refusal->one, scene))
        problems.push_back({place, 0, refusal->reason, refusal->cure});
    }
  }
  return problems;
}

std::string combinations_table() {
  std::string text = "| |", rule = "|---|";
  for (const Named& column : kNames) {
    text += concat(" ", column.name, " |");
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (std::size_t row = 0; row < kSceneFeatures; ++row) {
    text += concat("| ", kNames[row].name, " |");
    for (std::size_t column = 0; column < std::size(kNames); ++column) {
      const Refusal* refusal = refusal_of(kNames[row].feature, kNames[column].feature);
      const bool is_pair = column > row;
      const auto number = refusal == nullptr ? 0 : refusal - std::begin(kRefusals) + 1;
      text += !is_pair ? " |" : refusal == nullptr ? " runs |" : concat(" (", number, ") |");
    }
    text += "\n";
  }
  text += "\n";
  for (std::size_t i = 0; i < std::size(kRefusals); ++i)
    text += concat(i + 1, ". ", kRefusals[i].reason, ": ", kRefusals[i].cure, "\n");
  return text;
}

}  // namespace faultsim
