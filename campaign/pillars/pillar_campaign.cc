#include "campaign/pillars/pillar_campaign.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"
#include "simulator/common/units.h"
#include "simulator/plan/field_check.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"
#include "simulator/scene/field_depths.h"

namespace faultsweep {

using faultsim::JsonDocument;
using faultsim::Scene;

namespace {

using Role = PillarRole;

constexpr const char* kFoot = "/geometry/blocks/0/";
constexpr const char* kHanging = "/geometry/blocks/1/";
constexpr const char* kDip = "/faults/1/dip_from_vertical";

/// A parameter of the scene in all cases.
struct Setting {
  std::string pointer, unit;
  double value;
};

/// What a section is made of, from the base scene where the table does not say.
class Section {
 public:
  Section(const Scene& base, const JsonDocument& document) : base_(base) {
    const auto& field = base.field;
    const bool fits = base.geometry_kind == faultsim::GeometryKind::field &&
                      field.blocks.size() == 2 && base.faults.size() == 3;
    if (!fits) {
      throw InputError(document.source,
                       {{"/geometry", document.line_of("/geometry"),
                         "pillars are sections of a field with two blocks and a fault between",
                         "start from `faultsim init`, and keep two blocks"}});
    }
    while (field.layers[layer_].name != field.reservoir_layer) ++layer_;
    reservoir_ = faultsim::reservoir_range(field);
  }

  std::vector<Setting> settings(const PillarTable& table, std::size_t pillar,
                                const std::optional<RegionalStress>& stress) const {
    std::vector<Setting> all;
    const auto length = [&](Role role, const std::string& pointer) {
      if (const auto value = table.number(role, pillar)) all.push_back({pointer, "m", *value});
    };
    if (const auto depth = table.number(Role::depth, pillar)) {
      const double thickness = reservoir_.bottom - reservoir_.top;
      all.push_back({layer_top(layer_), "m", *depth});
      if (layer_ + 1 < base_.field.layers.size())
        all.push_back({layer_top(layer_ + 1), "m", *depth + thickness});
      all.push_back({"/geometry/pivot_depth", "m", *depth + 0.5 * thickness});
    }
    length(Role::offset, std::string(kHanging) + "offset");
    for (const auto& [block, role] :
         {std::pair(kFoot, Role::thickness_foot), std::pair(kHanging, Role::thickness_hanging)}) {
      length(Role::thickness, std::string(block) + "thickness");
      length(role, std::string(block) + "thickness");
    }
    if (const auto dip = table.number(Role::dip, pillar)) all.push_back({kDip, "deg", *dip});
    if (const auto dip = table.number(Role::dip_from_horizontal, pillar))
      all.push_back({kDip, "deg", std::round(1e9 * (90 - *dip)) / 1e9});
    if (stress) {
      const double alpha = angle_to(*stress, table, pillar);
      const double deviation = stress->largest - stress->smallest;
      all.push_back({"/initial_state/ratio_across", "",
                     stress->smallest + deviation * std::pow(std::sin(alpha), 2)});
      all.push_back({"/initial_state/ratio_along", "",
                     stress->smallest + deviation * std::pow(std::cos(alpha), 2)});
    }
    return all;
  }

  /// Between strike and the largest horizontal stress, rad.
  static double angle_to(const RegionalStress& stress, const PillarTable& table,
                         std::size_t pillar) {
    return (*table.number(Role::azimuth, pillar) - stress.azimuth) * faultsim::kDegree;
  }

 private:
  static std::string layer_top(std::size_t layer) {
    return faultsim::element("/geometry/layers", layer) + "/top";
  }

  const Scene& base_;
  std::size_t layer_ = 0;  ///< of the reservoir.
  faultsim::DepthInterval reservoir_;
};

/// Pointers of the table's other parameters. Throws InputError with the near misses.
std::vector<std::string> pointers_of(const PillarTable& table, const JsonDocument& base) {
  std::vector<std::string> pointers;
  std::vector<Problem> problems;
  for (const PillarTable::Parameter& one : table.parameters) {
    try {
      pointers.push_back(faultsim::resolve_parameter(base, one.name));
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) {
        problem.what = concat("column \"", one.name, "\": ", problem.what);
        problems.push_back(std::move(problem));
      }
    }
  }
  if (!problems.empty()) throw InputError(table.source, std::move(problems));
  return pointers;
}

/// A pillar's section.
struct PillarScene {
  Scene scene;
  faultsim::Plan plan;
};

/// A key that two columns give: by name and by pointer, or as a part of the section too.
void require_distinct(const PillarTable& table, const std::vector<Setting>& settings) {
  std::set<std::string> seen;
  std::vector<Problem> problems;
  for (const Setting& one : settings) {
    if (!seen.insert(one.pointer).second)
      problems.push_back({"", 0, concat("two columns give ", one.pointer), "keep one of the two"});
  }
  if (!problems.empty()) throw InputError(table.source, std::move(problems));
}

/// The scene of a pillar, looked at as `faultsim plan` does; what is wrong with it, or the scene.
std::optional<PillarScene> scene_of(JsonDocument document, const std::vector<Setting>& settings,
                                    std::vector<Problem>& problems) {
  for (const Setting& one : settings) {
    if (faultsim::put_value(document.value, one.pointer, spelled(one.value, one.unit))) continue;
    problems.push_back({one.pointer, 0, "the scene has no place for it", "fix the scene"});
    return std::nullopt;
  }
  PillarScene one{.scene = faultsim::read_scene(document, problems), .plan = {}};
  if (!problems.empty()) return std::nullopt;
  one.plan = faultsim::make_plan(one.scene, problems);
  if (!problems.empty()) return std::nullopt;
  return one;
}

struct FieldMember {
  const char* at;
  faultsim::FlowLoad Scene::*load;
};
constexpr FieldMember kFields[] = {{"/pressure_field", &Scene::pressure_field},
                                   {"/temperature_field", &Scene::temperature_field}};

/// What places a section in its flow results; the scene need not say it.
std::vector<std::pair<std::string, json>> placements(const Scene& scene) {
  std::vector<std::pair<std::string, json>> all;
  for (const FieldMember& field : kFields) {
    if (!(scene.*field.load).is_given()) continue;
    all.emplace_back(std::string(field.at) + "/origin", json{"0 m", "0 m"});
    all.emplace_back(std::string(field.at) + "/azimuth", "0 deg");
  }
  return all;
}

/// Puts a pillar's section where the pillar is: its fault, at the top of the footwall's reservoir,
/// at the pillar's x and y, and its y towards the strike. The base scene says where x = y = 0 of
/// the pillars lies in the coordinates of the field.
void place_in_fields(const Scene& base, const PillarTable& table, std::size_t pillar, Scene& scene,
                     std::vector<Setting>& settings) {
  const double top = faultsim::reservoir_range(scene.field, scene.field.blocks[0]).top;
  const double fault = faultsim::fault_x(scene, 1, top);
  const double x = *table.number(Role::x, pillar), y = *table.number(Role::y, pillar);
  for (const FieldMember& field : kFields) {
    faultsim::FlowLoad& load = scene.*field.load;
    if (!load.is_given()) continue;
    const faultsim::FlowLoad& pillars = base.*field.load;
    const double own = *table.number(Role::azimuth, pillar) * faultsim::kDegree;
    const double c = std::cos(pillars.azimuth), s = std::sin(pillars.azimuth);
    load.azimuth = pillars.azimuth + own;
    load.origin = {pillars.origin[0] + c * x + s * y - fault * std::cos(load.azimuth),
                   pillars.origin[1] - s * x + c * y + fault * std::sin(load.azimuth)};
    const std::string at = field.at;
    settings.push_back({at + "/origin/0", "m", load.origin[0]});
    settings.push_back({at + "/origin/1", "m", load.origin[1]});
    settings.push_back({at + "/azimuth", "deg", load.azimuth / faultsim::kDegree});
  }
}

constexpr const char* kPlaces =
    "id,fault,section_fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m\n";

/// A line of places.csv: where the fault crosses the two reservoirs.
std::string place_of(const PillarTable& table, std::size_t pillar, const Scene& scene) {
  faultsim::DepthInterval panel = faultsim::reservoir_range(scene.field, scene.field.blocks[0]);
  panel.unite(faultsim::reservoir_range(scene.field, scene.field.blocks[1]));
  const double dip = scene.faults[1].dip_from_vertical / faultsim::kDegree;
  std::string line = csv_field(table.ids[pillar]) + "," + csv_field(table.faults[pillar]) + "," +
                     csv_field(scene.faults[1].name);
  for (const double number :
       {*table.number(Role::x, pillar), *table.number(Role::y, pillar),
        table.number(Role::azimuth, pillar).value_or(0), dip, panel.top, panel.bottom}) {
    line += "," + exact_number(number);
  }
  return line + "\n";
}

std::string header_of(const std::vector<Setting>& settings) {
  std::string line;
  for (const Setting& one : settings) {
    line +=
        (line.empty() ? "" : ", ") + one.pointer + (one.unit.empty() ? "" : " [" + one.unit + "]");
  }
  return line + "\n";
}

std::string values_of(const std::vector<Setting>& settings) {
  std::string line =
      joined(settings, ", ", [](const Setting& one) { return shortest_text(one.value); });
  return line + "\n";
}

}  // namespace

PillarCampaign make_pillar_campaign(const PillarTable& table, const JsonDocument& base,
                                    const std::string& scene_file, const std::string& name,
                                    const std::optional<RegionalStress>& stress,
                                    const std::function<void(std::size_t)>& progress) {
  if (stress && !table.numbers.contains(Role::azimuth))
    throw InputError(table.source, "ratios by direction need the strike of each pillar",
                     "add a column \"azimuth [deg]\"");
  JsonDocument section = base;
  faultsim::set_value(section, "/numerics/plane_strain", "on");
  const Scene scene = faultsim::read_scene(section);
  json set = {{"/numerics/plane_strain", "on"}};
  for (const auto& [pointer, value] : placements(scene)) {
    set[pointer] = value;
    faultsim::put_value(section.value, pointer, value);
  }
  if (scene.has_field() && !table.numbers.contains(Role::azimuth))
    throw InputError(table.source, "a flow result needs the strike of each pillar",
                     "add a column \"azimuth [deg]\"");
  const Section sections(scene, base);
  const std::vector<std::string> pointers = pointers_of(table, base);
  PillarCampaign campaign;
  campaign.places = kPlaces;
  for (const PillarTable::Refused& one : table.refused)
    campaign.refused.push_back({one.id, one.problem.line, one.problem});
  for (std::size_t i = 0; i < table.n_pillars(); ++i) {
    if (progress) progress(i);
    std::vector<Setting> settings = sections.settings(table, i, stress);
    for (std::size_t k = 0; k < pointers.size(); ++k)
      settings.push_back({pointers[k], table.parameters[k].unit, table.parameters[k].values[i]});
    if (settings.empty() && !scene.has_field())
      throw InputError(table.source, "nothing differs from pillar to pillar",
                       "add columns: depth, offset, thickness, dip, azimuth or any "
                       "parameter that `faultsim parameters` lists");
    if (i == 0) require_distinct(table, settings);
    std::vector<Problem> problems;
    std::optional<PillarScene> one = scene_of(section, settings, problems);
    if (one && scene.has_field()) {
      place_in_fields(scene, table, i, one->scene, settings);
      problems = faultsim::check_fields(one->scene, one->plan).problems;
    }
    if (!problems.empty()) {
      campaign.refused.push_back({table.ids[i], table.lines[i], problems.front()});
      continue;
    }
    if (stress) {
      const double alpha = Section::angle_to(*stress, table, i);
      campaign.largest_shear_left_out = std::max(
          campaign.largest_shear_left_out,
          std::abs((stress->largest - stress->smallest) * std::sin(alpha) * std::cos(alpha)));
    }
    if (campaign.n_cases++ == 0) campaign.samples = header_of(settings);
    campaign.samples += values_of(settings);
    campaign.places += place_of(table, i, one->scene);
  }
  campaign.spec = json{{"format", 1},
                       {"name", name},
                       {"title", concat("Pillars of ", table.source)},
                       {"base", scene_file},
                       {"set", set},
                       {"design", {{"kind", "samples"}, {"file", "samples.csv"}}}}
                      .dump(2) +
                  "\n";
  return campaign;
}

}  // namespace faultsweep
