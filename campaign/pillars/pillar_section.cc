#include "campaign/pillars/pillar_section.h"

#include <cmath>

#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "campaign/spec/pointers.h"
#include "simulator/common/table_reader.h"
#include "simulator/common/units.h"
#include "simulator/scene/field_depths.h"

namespace faultsweep {

using faultsim::JsonDocument;
using faultsim::Scene;

namespace {

using Role = PillarRole;

constexpr const char* kFoot = "/geometry/blocks/0/";
constexpr const char* kHanging = "/geometry/blocks/1/";
constexpr const char* kDip = "/faults/1/dip_from_vertical";

/// To twelve digits: a sum of a depth and a thickness is 2394.8, as either was given.
double rounded(double value) { return faultsim::parse_number(rounded_number(value)).value(); }

void add_ratios(const RegionalStress& stress, double alpha, std::vector<Setting>& all) {
  const double deviation = stress.largest - stress.smallest;
  all.push_back({"/initial_state/ratio_across", "",
                 stress.smallest + deviation * std::pow(std::sin(alpha), 2)});
  all.push_back({"/initial_state/ratio_along", "",
                 stress.smallest + deviation * std::pow(std::cos(alpha), 2)});
}
std::string layer_top(std::size_t layer) {
  return faultsim::element("/geometry/layers", layer) + "/top";
}

}  // namespace

json Setting::in_scene() const { return date.empty() ? spelled(value, unit) : json(date); }
std::string Setting::in_table() const { return date.empty() ? shortest_text(value) : date; }

Section::Section(const Scene& base, const JsonDocument& document) : base_(base) {
  const auto& field = base.field;
  const bool fits = base.geometry_kind == faultsim::GeometryKind::field &&
                    field.blocks.size() == 2 && base.faults.size() == 3;
  if (!fits) {
    throw InputError(
        document.source,
        {{"/geometry", document.line_of("/geometry"),
          "pillars need the section of a field with two blocks and a fault between them",
          "start from `faultsim init`, and keep two blocks"}});
  }
  while (field.layers[layer_].name != field.reservoir_layer) ++layer_;
  reservoir_ = faultsim::reservoir_range(field);
  last_stage_ = faultsim::element("/stages", base.stages.size() - 1);
  ends_at_date_ = faultsim::value_at(document.value, last_stage_ + "/until") != nullptr;
}

void Section::require_date(const PillarTable& table) const {
  if (table.until.empty() || ends_at_date_) return;
  throw InputError(table.source,
                   concat("histories of pillars end at dates, but ", last_stage_,
                          " of the scene ends after a duration"),
                   "write \"until\": \"2005-07-31\" instead of \"duration\"");
}

std::vector<Setting> Section::settings(const PillarTable& table, std::size_t pillar,
                                       const std::optional<RegionalStress>& stress) const {
  std::vector<Setting> all;
  const auto add = [&](Role role, const std::string& pointer, const char* unit, double value) {
    all.push_back({pointer, unit, rounded(value), table.heading(role)});
  };
  const auto length = [&](Role role, const std::string& pointer) {
    if (const auto value = table.number(role, pillar)) add(role, pointer, "m", *value);
  };
  if (const auto depth = table.number(Role::depth, pillar)) {
    const double thickness = reservoir_.bottom - reservoir_.top;
    add(Role::depth, layer_top(layer_), "m", *depth);
    if (layer_ + 1 < base_.field.layers.size())
      add(Role::depth, layer_top(layer_ + 1), "m", *depth + thickness);
    add(Role::depth, "/geometry/pivot_depth", "m", *depth + 0.5 * thickness);
  }
  length(Role::offset, std::string(kHanging) + "offset");
  for (const auto& [block, role] :
       {std::pair(kFoot, Role::thickness_foot), std::pair(kHanging, Role::thickness_hanging)}) {
    length(Role::thickness, std::string(block) + "thickness");
    length(role, std::string(block) + "thickness");
  }
  if (const auto dip = table.number(Role::dip, pillar)) add(Role::dip, kDip, "deg", *dip);
  if (const auto dip = table.number(Role::dip_from_horizontal, pillar))
    add(Role::dip_from_horizontal, kDip, "deg", 90 - *dip);
  if (stress) add_ratios(*stress, angle_to(*stress, table, pillar), all);
  if (!table.until.empty())
    all.push_back(
        {last_stage_ + "/until", "date", 0, table.heading(Role::until), table.until[pillar]});
  return all;
}

double Section::angle_to(const RegionalStress& stress, const PillarTable& table,
                         std::size_t pillar) {
  return (*table.number(Role::azimuth, pillar) - stress.azimuth) * faultsim::kDegree;
}

}  // namespace faultsweep
