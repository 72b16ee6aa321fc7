#include "campaign/pillars/pillar_campaign.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/pillars/pillar_section.h"
#include "campaign/pillars/place_line.h"
#include "campaign/spec/pointers.h"
#include "simulator/common/dates.h"
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

/// First sliding pressures are searched within their load steps, unless the scene says how far.
constexpr const char* kSearched = "/numerics/activation_tolerance";
constexpr const char* kSearchedTo = "0.1 bar";
constexpr const char* kNames = "pillar";  ///< the parameter of the campaign that names its cases.

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
    if (faultsim::put_value(document.value, one.pointer, one.in_scene())) continue;
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

/// What places a section in its flow results; the scene need not say it. Histories that end at
/// dates of their own leave the reports behind out.
std::vector<std::pair<std::string, json>> placements(const Scene& scene, const json& document,
                                                     bool ends_differ) {
  std::vector<std::pair<std::string, json>> all;
  for (const FieldMember& field : kFields) {
    if (!(scene.*field.load).is_given()) continue;
    all.emplace_back(std::string(field.at) + "/origin", json{"0 m", "0 m"});
    all.emplace_back(std::string(field.at) + "/azimuth", "0 deg");
    const std::string end = std::string(field.at) + "/end";
    if (ends_differ && faultsim::value_at(document, end) == nullptr) all.emplace_back(end, "cut");
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

/// Where the fault crosses the two reservoirs.
PlaceLine place_of(const PillarTable& table, std::size_t pillar, const Scene& scene) {
  faultsim::DepthInterval panel = faultsim::reservoir_range(scene.field, scene.field.blocks[0]);
  panel.unite(faultsim::reservoir_range(scene.field, scene.field.blocks[1]));
  return {.id = table.ids[pillar],
          .fault = table.faults[pillar],
          .section_fault = scene.faults[1].name,
          .x = table.number(Role::x, pillar),
          .y = table.number(Role::y, pillar),
          .azimuth = table.number(Role::azimuth, pillar).value_or(0),
          .dip = scene.faults[1].dip_from_vertical / faultsim::kDegree,
          .top_depth = panel.top,
          .base_depth = panel.bottom,
          .start_date = scene.start_date ? faultsim::date_text(*scene.start_date) : "",
          .refused = ""};
}

/// What is known of a line of the table that is not all there.
PlaceLine place_of(const PillarTable::Refused& line) {
  const auto number = [&](Role role) -> std::optional<double> {
    const auto found = line.numbers.find(role);
    return found == line.numbers.end() ? std::nullopt : std::optional(found->second);
  };
  return {.id = line.id,
          .fault = line.fault,
          .section_fault = "",
          .x = number(Role::x),
          .y = number(Role::y),
          .azimuth = number(Role::azimuth),
          .dip = std::nullopt,
          .top_depth = std::nullopt,
          .base_depth = std::nullopt,
          .start_date = "",
          .refused = line.problems.front().what};
}

/// A problem of a pillar's scene as one of its line: by the column whose parameter it is about.
Problem in_table(Problem problem, const std::vector<Setting>& settings, const PillarTable& table,
                 long line) {
  problem.line = static_cast<int>(line);
  for (const FieldMember& field : kFields) {
    if (problem.pointer != field.at) continue;
    problem.what = concat(problem.pointer, ": ", problem.what);
    problem.pointer = concat(table.heading(Role::x), ", ", table.heading(Role::y));
    problem.cure = concat("leave the pillar out, or state where x = y = 0 of the pillars lies: ",
                          problem.cure);
    return problem;
  }
  for (const Setting& one : settings) {
    const bool is_of_it =
        problem.pointer.size() >= one.pointer.size() && overlap(problem.pointer, one.pointer);
    if (one.heading.empty() || !is_of_it) continue;
    problem.pointer = one.heading;
    return problem;
  }
  if (!problem.pointer.empty()) problem.what = concat(problem.pointer, ": ", problem.what);
  problem.pointer.clear();
  return problem;
}

std::string header_of(const std::vector<Setting>& settings) {
  std::string line = kNames;
  for (const Setting& one : settings)
    line += ", " + one.pointer + (one.unit.empty() ? "" : " [" + one.unit + "]");
  return line + "\n";
}

/// Makes a case of one pillar after the other.
class CampaignMaker {
 public:
  CampaignMaker(const PillarTable& table, const JsonDocument& base,
                const std::optional<RegionalStress>& stress)
      : table_(table),
        stress_(stress),
        section_(plane_section(base)),
        scene_(faultsim::read_scene(section_)),
        sections_(scene_, base),
        pointers_(pointers_of(table, base)) {
    if (faultsim::value_at(base.value, kSearched) == nullptr) set_[kSearched] = kSearchedTo;
    for (const auto& [pointer, value] : placements(scene_, base.value, !table.until.empty())) {
      set_[pointer] = value;
      faultsim::put_value(section_.value, pointer, value);
    }
    require_columns();
    for (const PillarTable::Refused& one : table.refused) {
      campaign_.refused.push_back({one.id, one.line, one.problems});
      places_.emplace_back(one.line, place_of(one).text());
    }
  }

  void add(std::size_t pillar);

  /// @param scene_file  as campaign.json is to name it.
  PillarCampaign take(const std::string& scene_file, const std::string& name) {
    std::ranges::sort(campaign_.refused, {}, &RefusedPillar::line);
    std::ranges::sort(places_, {}, &std::pair<long, std::string>::first);
    campaign_.places = PlaceLine::header();
    for (const auto& [line, text] : places_) campaign_.places += text;
    std::string title = concat("Pillars of ", table_.source);
    if (!campaign_.refused.empty())
      title += concat("; ", campaign_.refused.size(), " of ", places_.size(),
                      " are refused and not among the cases");
    campaign_.spec =
        json{{"format", 1},
             {"name", name},
             {"title", title},
             {"base", scene_file},
             {"set", set_},
             {"design", {{"kind", "places"}, {"file", "samples.csv"}, {"names", kNames}}}}
            .dump(2) +
        "\n";
    return std::move(campaign_);
  }

 private:
  static JsonDocument plane_section(const JsonDocument& base) {
    JsonDocument section = base;
    faultsim::set_value(section, "/numerics/plane_strain", "on");
    return section;
  }
  void require_columns() const;
  std::vector<Setting> settings_of(std::size_t pillar) const;
  void note_shear(std::size_t pillar);

  const PillarTable& table_;
  const std::optional<RegionalStress>& stress_;
  JsonDocument section_;
  Scene scene_;
  Section sections_;
  std::vector<std::string> pointers_;  ///< of the table's other parameters.
  json set_ = {{"/numerics/plane_strain", "on"}};
  std::vector<std::pair<long, std::string>> places_;  ///< by line of the table.
  PillarCampaign campaign_;
};

void CampaignMaker::require_columns() const {
  const bool has_azimuth = table_.numbers.contains(Role::azimuth);
  const char* const cure = "add a column \"azimuth [deg]\"";
  if (stress_ && !has_azimuth)
    throw InputError(table_.source, "stress ratios by direction need the strike of each pillar",
                     cure);
  if (scene_.has_field() && !has_azimuth)
    throw InputError(table_.source, "a flow result needs the strike of each pillar", cure);
  sections_.require_date(table_);
}

std::vector<Setting> CampaignMaker::settings_of(std::size_t pillar) const {
  std::vector<Setting> settings = sections_.settings(table_, pillar, stress_);
  for (std::size_t k = 0; k < pointers_.size(); ++k) {
    const PillarTable::Parameter& one = table_.parameters[k];
    settings.push_back({pointers_[k], one.unit, one.values[pillar], one.heading});
  }
  if (settings.empty() && !scene_.has_field())
    throw InputError(table_.source, "all pillars are the same",
                     "add columns: depth, offset, thickness, dip, azimuth or any "
                     "parameter that `faultsim parameters` lists");
  return settings;
}

void CampaignMaker::note_shear(std::size_t pillar) {
  if (!stress_) return;
  const double alpha = Section::angle_to(*stress_, table_, pillar);
  campaign_.largest_shear_left_out = std::max(
      campaign_.largest_shear_left_out,
      std::abs((stress_->largest - stress_->smallest) * std::sin(alpha) * std::cos(alpha)));
}

void CampaignMaker::add(std::size_t pillar) {
  std::vector<Setting> settings = settings_of(pillar);
  if (pillar == 0) require_distinct(table_, settings);
  std::vector<Problem> problems;
  std::optional<PillarScene> one = scene_of(section_, settings, problems);
  if (one && scene_.has_field()) {
    place_in_fields(scene_, table_, pillar, one->scene, settings);
    problems = faultsim::check_fields(one->scene, one->plan).problems;
  }
  const long line = table_.lines[pillar];
  PlaceLine place =
      one ? place_of(table_, pillar, one->scene) : place_of(table_.as_refused(pillar));
  if (!problems.empty()) {
    for (Problem& problem : problems)
      problem = in_table(std::move(problem), settings, table_, line);
    place.refused = problems.front().what;
    campaign_.refused.push_back({table_.ids[pillar], line, std::move(problems)});
  } else {
    note_shear(pillar);
    if (campaign_.n_cases++ == 0) campaign_.samples = header_of(settings);
    campaign_.samples += csv_field(table_.ids[pillar]);
    for (const Setting& setting : settings) campaign_.samples += ", " + setting.in_table();
    campaign_.samples += "\n";
  }
  places_.emplace_back(line, place.text());
}

}  // namespace

PillarCampaign make_pillar_campaign(const PillarTable& table, const JsonDocument& base,
                                    const std::string& scene_file, const std::string& name,
                                    const std::optional<RegionalStress>& stress,
                                    const std::function<void(std::size_t)>& progress) {
  CampaignMaker maker(table, base, stress);
  for (std::size_t i = 0; i < table.n_pillars(); ++i) {
    if (progress) progress(i);
    maker.add(i);
  }
  return maker.take(scene_file, name);
}

}  // namespace faultsweep
