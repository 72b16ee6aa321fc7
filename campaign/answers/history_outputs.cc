#include "campaign/answers/sensitivity_parts.h"

#include <algorithm>

#include "campaign/common/names.h"
namespace faultsweep {

namespace {

/// The fault that each metric is of. Throws one InputError with all that is wrong.
std::vector<std::int64_t> faults_of(const std::vector<ScopedMetric>& metrics,
                                    const Selection& selection) {
  const std::vector<std::string> kept = history_metrics();
  std::vector<Problem> problems;
  std::vector<std::int64_t> faults;
  for (const ScopedMetric& one : metrics) {
    const auto own = one.scope ? one.scope->fault : std::nullopt;
    faults.push_back(own ? *own : selection.fault ? selection.fault->id : -1);
    if (!contains(kept, one.metric)) {
      problems.push_back({"", 0, concat(one.name, " is not kept load step by load step"),
                          concat("choose from ", joined(kept, ", "))});
    } else if (one.scope && one.scope->stage) {
      problems.push_back({"", 0, concat(one.name, " belongs to a stage, a load step does not"),
                          "leave out `in ...`; select the steps of a stage by --stage"});
    } else if (faults.back() < 0) {
      problems.push_back(
          {"", 0, concat(one.name, " at a load step belongs to a fault"),
           concat("name the fault: ", selection.faults.front().name, ".", one.name)});
    }
  }
  if (!problems.empty()) throw InputError("--metrics", std::move(problems));
  return faults;
}

/// Throws where some case lacks a step: step 5 of one would be compared with another's.
void require_shared(const std::vector<Store::LoadStep>& steps) {
  long n_cases = 0;
  for (const Store::LoadStep& one : steps) n_cases = std::max(n_cases, one.n_cases);
  const auto other =
      std::ranges::find_if(steps, [&](const auto& one) { return one.n_cases < n_cases; });
  if (other == steps.end()) return;
  throw InputError(
      "--by-step",
      concat("load step ", other->step, " is one of ", other->stage, " in ", other->n_cases, " of ",
             n_cases, " cases only: their stages have different steps"),
      "select cases with the same steps by --where, or one --stage");
}

}  // namespace

HistoryOutputs history_outputs(const Store& store, const CampaignInfo& campaign,
                               const SensitivityRequest& request, const Selection& selection) {
  // Faults are known from results.
  if (selection.faults.empty()) refuse_unrun("--by-step", "no case has a result", campaign);
  SensitivityRequest asked = request;
  if (asked.metrics.empty())
    asked.metrics = selection.fault ? "chi_bar" : of_each_fault(selection.faults, "chi_bar");
  HistoryOutputs found;
  found.metrics = asked_outputs(store, campaign, asked, selection);
  const std::vector<std::int64_t> faults = faults_of(found.metrics, selection);
  found.steps = store.load_steps(campaign.id, case_query(campaign, selection, request.cases.where));
  require_shared(found.steps);
  constexpr std::size_t kMostColumns = 1900;  // a query has at most 2,000
  if (found.metrics.size() * found.steps.size() > kMostColumns) {
    throw InputError("--by-step",
                     concat(found.metrics.size(), " metrics at ", found.steps.size(),
                            " load steps are more than ", kMostColumns, " numbers"),
                     "ask for fewer --metrics, or the steps of one --stage");
  }
  const auto whole =
      std::ranges::find_if(selection.stages, [](const NamedId& one) { return one.name.empty(); });
  FAULTSIM_DEMAND(found.steps.empty() || whole != selection.stages.end(), campaign.name);
  for (std::size_t m = 0; m < found.metrics.size(); ++m) {
    for (const Store::LoadStep& step : found.steps) {
      ScopedMetric output = found.metrics[m];
      output.sql = history_sql(output.metric, faults[m], whole->id, step.step);
      output.name += concat(" at step ", step.step);
      found.outputs.push_back(std::move(output));
    }
  }
  return found;
}

}  // namespace faultsweep
