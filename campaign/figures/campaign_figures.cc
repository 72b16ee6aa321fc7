#include "campaign/figures/campaign_figures.h"

#include <algorithm>

#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/bar_chart.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result_files/field_reader.h"

namespace faultsweep {

using faultsim::figure::CaseClass;
namespace figure = faultsim::figure;

namespace {

/// A parameter as an axis: numbers in its usual unit, or words by their first place.
struct ParameterAxis {
  std::size_t index = 0;
  StoredParameter parameter;
  std::vector<std::string> words;

  double value(const CaseParameter& one) {
    if (one.si) {
      return faultsim::from_si(*one.si, parameter.dimension,
                               faultsim::usual_unit(parameter.dimension));
    }
    const auto found = std::ranges::find(words, one.text);
    if (found != words.end()) return static_cast<double>(found - words.begin());
    words.push_back(one.text);
    return static_cast<double>(words.size() - 1);
  }
  std::string label() const {
    const std::string unit = faultsim::usual_unit(parameter.dimension);
    std::string name = parameter.name;
    std::ranges::replace(name, '_', ' ');
    return unit.empty() || parameter.is_text ? name : name + ", " + unit;
  }
};

ParameterAxis axis_of(const std::vector<StoredParameter>& parameters, const std::string& option,
                      const std::string& name, const std::string& other) {
  std::vector names = mapped(parameters, &StoredParameter::name);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (name.empty() ? names[k] != other : names[k] == name) return {k, parameters[k], {}};
  }
  if (!name.empty()) require_name(option, "parameter", name, names);
  throw InputError(option, "the campaign has fewer than two parameters",
                   "a map needs one for each side");
}

/// What became of each case that has a result, row by row.
template <typename Visit>
void for_each_outcome(const Store& store, const CampaignInfo& campaign, const Visit& visit) {
  Store::TableQuery query;
  for (const char* metric : {"slides", "jumps"}) {
    query.columns.push_back({metric_sql(metric), {}});
  }
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    if (!row.rank_class) return;
    const bool slides = number_of(row.metrics[0]) > 0, jumps = number_of(row.metrics[1]) > 0;
    visit(row, !row.complete()        ? CaseClass::ended_early
               : *row.rank_class == 1 ? CaseClass::undecided
               : jumps                ? CaseClass::event
               : slides               ? CaseClass::slides
                                      : CaseClass::holds);
  });
}

}  // namespace

std::string draw_outcome_map(const Store& store, const CampaignInfo& campaign,
                             const MapRequest& request) {
  const std::vector<StoredParameter>& parameters = campaign.parameters;
  ParameterAxis x = axis_of(parameters, "--x", request.x, request.y);
  ParameterAxis y = axis_of(parameters, "--y", request.y, x.parameter.name);
  figure::OutcomeMap map;
  for_each_outcome(store, campaign, [&](const CaseRow& row, CaseClass kind) {
    std::optional<double> at_x, at_y;
    for (const CaseParameter& one : row.parameters) {
      if (one.index == static_cast<int>(x.index)) at_x = x.value(one);
      if (one.index == static_cast<int>(y.index)) at_y = y.value(one);
    }
    if (!at_x || !at_y) return;  // of a group that has other parameters
    map.x.push_back(*at_x);
    map.y.push_back(*at_y);
    map.kind.push_back(kind);
  });
  map.title = concat("What became of ", figure::plain_number(static_cast<double>(map.x.size()), 9),
                     " cases of ", campaign.name);
  map.x_label = x.label();
  map.y_label = y.label();
  map.x_words = x.words;
  map.y_words = y.words;
  return figure::draw(map);
}

std::array<long, figure::kCaseClasses> count_outcomes(const Store& store,
                                                      const CampaignInfo& campaign) {
  std::array<long, figure::kCaseClasses> counts = {};
  for_each_outcome(store, campaign, [&](const CaseRow&, CaseClass kind) {
    ++counts[static_cast<std::size_t>(kind)];
  });
  return counts;
}

StoredPicture::StoredPicture(const Store& store, const CampaignInfo& campaign,
                             const StoredCase& one)
    : name_(concat(campaign.name, "/", one.position)), result_(one.result) {
  if (!one.has_result) {
    throw InputError("case", concat("case ", one.position, " has no result yet"),
                     concat("faultsweep explain ", name_, " says why"));
  }
  const BaseScene base = store.base_scene(one.scene);
  scene_ = faultsim::read_scene({base.source, scene_from_changes(base.document, one.changes), {}});
  if (result_.region_names.empty()) {  // the store keeps pressures in the order of the scene's
    for (const faultsim::PressureHistory& region : scene_.pressure) {
      result_.region_names.push_back(region.region);
    }
  }
  std::error_code error;  // what cannot be looked at is not there
  if (std::filesystem::exists(one.fields_folder / "faults.h5", error)) {
    fields_ = std::make_unique<faultsim::FieldReader>(one.fields_folder / "faults.h5");
  }
}

faultsim::CasePicture StoredPicture::picture() const {
  return {result_, scene_, fields_.get(), name_};
}

}  // namespace faultsweep
