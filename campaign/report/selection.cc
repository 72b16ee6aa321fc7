#include "campaign/report/selection.h"

#include <algorithm>
#include <sstream>

#include "campaign/expression/expression.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;

void check_stage(const Store& store, const CampaignInfo& campaign, const std::string& stage) {
  if (stage.empty()) return;
  const std::vector<std::string> stages = store.stages(campaign.id);
  if (std::count(stages.begin(), stages.end(), stage) > 0) return;
  std::string names;
  for (const std::string& name : stages) {
    if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
  }
  throw InputError("--stage",
                   {{"", 0, concat("there is no stage '", stage, "' in the results"),
                     names.empty() ? "no case has a result yet" : "there are: " + names}});
}

SqlFragment parse_condition(const std::string& where, const Symbols& symbols) {
  if (where.empty()) return {};
  const Expression condition = Expression::parse(where, symbols);
  if (condition.type().kind != Kind::boolean) {
    throw InputError("--where", {{"", 0, concat("'", where, "' is no condition"),
                                  "compare it with something: \"chi_bar > 0.8\""}});
  }
  return condition.sql();
}

namespace {

MetricInfo metric_named(const std::string& name) {
  std::vector<std::string> names;
  for (const MetricInfo& metric : metric_catalogue()) {
    if (metric.name == name) return metric;
    names.push_back(metric.name);
  }
  const auto meant = nearest(name, names);
  throw InputError("--metrics", {{"", 0, concat("there is no metric '", name, "'"),
                                  meant ? concat("did you mean '", *meant, "'?")
                                        : "`faultsweep rank --list-metrics` lists them"}});
}

}  // namespace

bool creeps(const Store& store, const CampaignInfo& campaign) {
  const auto families = store.family_progress(campaign.id);
  return std::any_of(families.begin(), families.end(),
                     [](const auto& family) { return family.n_operators > 1; });
}

std::vector<MetricInfo> choose_metrics(const std::string& list, bool with_missing,
                                       bool with_creep) {
  std::vector<MetricInfo> chosen;
  if (list.empty()) {
    for (const MetricInfo& metric : metric_catalogue()) {
      const bool fits = with_creep || !metric.name.starts_with("creep_");
      if (fits && (with_missing || !metric.may_be_missing)) chosen.push_back(metric);
    }
    return chosen;
  }
  std::istringstream names(list);
  for (std::string name; std::getline(names, name, ',');) {
    const std::size_t first = name.find_first_not_of(' ');
    const std::size_t last = name.find_last_not_of(' ');
    chosen.push_back(
        metric_named(first == std::string::npos ? "" : name.substr(first, last - first + 1)));
  }
  return chosen;
}

}  // namespace faultsweep
