#include "campaign/answers/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"

namespace faultsweep {

namespace {

void collect_designs(const json& design, std::vector<json>& designs) {
  if (design.at("kind") != "nested") {
    designs.push_back(design);
    return;
  }
  for (const json& one : design.at("designs")) collect_designs(one, designs);
}

/// The value of a parameter that a case's group does not have: below all values, and like itself.
constexpr double kOfNoGroup = -std::numeric_limits<double>::infinity();

// What derived_parameters() says.
constexpr char kDerived = 1, kName = 2;

/// Which rows and parameters a sample has.
enum class Keep {
  what_tells,  ///< full histories, and parameters that vary.
  all,         ///< rows without a history to its end have no outputs.
};

/// Fills a sample row by row.
class SampleReader {
 public:
  SampleReader(const CampaignInfo& campaign, std::vector<ScopedMetric> outputs, Keep keep)
      : keep_(keep) {
    sample_.parameters = campaign.parameters;
    sample_.outputs = std::move(outputs);
    sample_.x.resize(sample_.parameters.size());
    sample_.y.resize(sample_.outputs.size());
    words_.resize(sample_.x.size());
  }

  void add(const CaseRow& row) {
    ++sample_.n_rows;
    sample_.n_without += row.rank_class ? 0 : 1;
    sample_.n_early += row.rank_class && !row.complete() ? 1 : 0;
    if (!row.complete() && keep_ == Keep::what_tells) return;
    sample_.n_unresolved += row.complete() && *row.rank_class == 1 ? 1 : 0;
    for (std::vector<double>& one : sample_.x) one.push_back(kOfNoGroup);
    for (const CaseParameter& one : row.parameters) {
      const auto p = static_cast<std::size_t>(one.index);
      const auto word = static_cast<double>(words_[p].size());  // where it comes first
      sample_.x[p].back() = one.si ? *one.si : words_[p].emplace(one.text, word).first->second;
    }
    for (std::size_t m = 0; m < sample_.y.size(); ++m)
      sample_.y[m].push_back(row.complete() ? number_of(row.metrics[m]) : std::nan(""));
  }

  /// Without parameters that follow from others, and names.
  Sample take(const std::vector<char>& derived) {
    for (std::size_t k = sample_.x.size(); k-- > 0;) {
      const std::vector<double>& values = sample_.x[k];
      const bool tells = keep_ == Keep::all || std::ranges::any_of(values, [&](double value) {
                           return value != values.front();
                         });
      if (tells && derived[k] == 0) continue;
      if (tells && derived[k] == kDerived)
        sample_.derived.insert(sample_.derived.begin(), sample_.parameters[k].name);
      sample_.x.erase(sample_.x.begin() + static_cast<long>(k));
      sample_.parameters.erase(sample_.parameters.begin() + static_cast<long>(k));
    }
    return std::move(sample_);
  }

 private:
  Keep keep_;
  Sample sample_;
  std::vector<std::map<std::string, double>> words_;  ///< per parameter, their numbers.
};

}  // namespace

std::vector<json> designs_of(const Store& store, const CampaignInfo& campaign) {
  const json spec = json::parse(store.spec_copies(campaign.id).resolved);
  std::vector<json> designs;
  for (const json& group : spec.at("groups")) collect_designs(group, designs);
  return designs;
}

std::vector<json> designs_of_group(const json& group) {
  std::vector<json> designs;
  collect_designs(group, designs);
  return designs;
}

std::vector<char> derived_parameters(const std::vector<json>& designs,
                                     const CampaignInfo& campaign) {
  std::set<std::string> chosen = {"group"};
  for (const json& design : designs)
    for (const json& one : design.value("parameters", json::array())) chosen.insert(one.at("name"));
  std::set<std::string> names;
  for (const json& design : designs)
    if (design.contains("names")) names.insert(design.at("names"));
  return mapped(campaign.parameters, [&](const StoredParameter& one) -> char {
    return names.contains(one.name) ? kName : chosen.contains(one.name) ? 0 : kDerived;
  });
}

std::string names_parameter(const Store& store, const CampaignInfo& campaign) {
  for (const json& design : designs_of(store, campaign))
    if (design.contains("names")) return design.at("names");
  return "";
}

std::string derived_note(const std::vector<std::string>& names) {
  std::string list = joined(names, ", ");
  return list.empty() ? ""
                      : concat("Computed from others, so not told apart from them: ", list, ".");
}

long rows_per_base_sample(const json& design) {
  const auto n = static_cast<long>(design.at("parameters").size());
  return (design.value("second_order", false) ? 2 * n : n) + 2;
}

SampleRows::SampleRows(const Store& store, const CampaignInfo& campaign) {
  const std::vector<json> designs = designs_of(store, campaign);
  const bool is_sobol = designs.size() == 1 && designs.front().at("kind") == "sobol";
  const long block = is_sobol ? rows_per_base_sample(designs.front()) : 1;
  others_ = is_sobol ? 0 : 1;
  for (const DesignRow& row : store.design_rows(campaign.id)) {
    const long place = (row.row - 1) % block;
    const auto position = static_cast<std::size_t>(row.position);
    if (position >= counts_.size()) counts_.resize(position + 1, -1);
    if (counts_[position] < 0) counts_[position] = 0;
    if (place == 0 || place == block - 1) ++counts_[position];
  }
}

int SampleRows::count(long position) const {
  const auto place = static_cast<std::size_t>(position);
  return place < counts_.size() && counts_[place] >= 0 ? counts_[place] : others_;
}

Sample read_sample(const Store& store, const CampaignInfo& campaign, const SampledCases& request,
                   const std::string& metrics) {
  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  return read_sample(store, campaign, request, choose_metrics(selection, metrics, true, false));
}

Sample read_sample(const Store& store, const CampaignInfo& campaign, const SampledCases& request,
                   std::vector<ScopedMetric> outputs) {
  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  const auto query = case_query(campaign, selection, request.where, outputs);
  const SampleRows rows(store, campaign);
  SampleReader reader(campaign, std::move(outputs), Keep::what_tells);
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    for (int k = 0; k < rows.count(row.position); ++k) reader.add(row);
  });
  return reader.take(derived_parameters(designs_of(store, campaign), campaign));
}

Sample read_design(const Store& store, const CampaignInfo& campaign, const Selection& selection,
                   std::vector<ScopedMetric> outputs) {
  Store::TableQuery query = case_query(campaign, selection, "", outputs);
  query.by_design_row = true;
  SampleReader reader(campaign, std::move(outputs), Keep::all);
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) { reader.add(row); });
  return reader.take(derived_parameters(designs_of(store, campaign), campaign));
}

}  // namespace faultsweep
