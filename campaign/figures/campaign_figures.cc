#include "campaign/figures/campaign_figures.h"

#include <algorithm>
#include <unordered_map>

#include "campaign/answers/sample.h"
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

/// A parameter as a side of a map: numbers in the unit in which the cases give them, as in tables,
/// or, where some are words, all as words by their first place.
class MapParameter {
 public:
  MapParameter(std::size_t index, const StoredParameter& parameter)
      : index_(static_cast<int>(index)), parameter_(parameter) {}

  /// None where the case does not have the parameter.
  const CaseParameter* find(const CaseParameters& all) const {
    const auto one = std::ranges::find(all, index_, &CaseParameter::index);
    return one == all.end() ? nullptr : &*one;
  }
  void add(const CaseParameter& one) {
    unit_.add(one);
    has_words_ = has_words_ || !one.si;
    values_.push_back(one);
  }
  const std::string& name() const { return parameter_.name; }
  std::string label() const {
    const std::string words = parameter_label(parameter_.name);
    return has_words_ || unit().empty() ? words : concat(words, ", ", unit());
  }
  /// Of all that were added; `words` are the names of 0, 1, ….
  std::vector<double> places(std::vector<std::string>& words) const {
    std::unordered_map<std::string, double> known;
    return mapped(values_, [&](const CaseParameter& one) {
      if (!has_words_) return faultsim::from_si(*one.si, parameter_.dimension, unit());
      const auto [found, is_new] = known.try_emplace(one.text, static_cast<double>(known.size()));
      if (is_new) words.push_back(one.text);
      return found->second;
    });
  }

 private:
  std::string unit() const {
    return unit_.unit().value_or(faultsim::usual_unit(parameter_.dimension));
  }

  int index_;
  const StoredParameter& parameter_;
  CommonUnit unit_;
  bool has_words_ = false;
  std::vector<CaseParameter> values_;
};

/// The parameter of that name, or the first but others; none where nobody asked and there is none.
std::optional<MapParameter> parameter_of(const std::vector<StoredParameter>& parameters,
                                         const std::string& option, const std::string& name,
                                         const std::vector<std::string>& others) {
  std::vector names = mapped(parameters, &StoredParameter::name);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (name.empty() ? !contains(others, names[k]) : names[k] == name)
      return MapParameter(k, parameters[k]);
  }
  if (!name.empty()) require_name(option, "parameter", name, names);
  return std::nullopt;
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
  const std::string places = names_parameter(store, campaign);
  std::optional x = parameter_of(parameters, "--x", request.x, {request.y, places});
  if (!x) {
    throw InputError("--x", "the campaign has no parameter for an axis of a map",
                     "vary a parameter in the spec's design");
  }
  std::optional y = parameter_of(parameters, "--y", request.y, {x->name(), places});
  figure::OutcomeMap map;
  for_each_outcome(store, campaign, [&](const CaseRow& row, CaseClass kind) {
    const CaseParameter* at_x = x->find(row.parameters);
    const CaseParameter* at_y = y ? y->find(row.parameters) : nullptr;
    if (at_x == nullptr || (y && at_y == nullptr)) return;  // of a group that has other parameters
    x->add(*at_x);
    if (y) y->add(*at_y);
    map.kind.push_back(kind);
  });
  const std::size_t n = map.kind.size();
  map.title = concat("What became of ", figure::plain_number(static_cast<double>(n), 9),
                     n == 1 ? " case of " : " cases of ", campaign.name);
  map.x_label = x->label();
  map.x = x->places(map.x_words);
  if (y) {
    map.y_label = y->label();
    map.y = y->places(map.y_words);
  } else {
    map.y.assign(n, 0);
    map.y_words = {""};  // one row
  }
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
                     concat("see why: faultsweep explain ", name_));
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
