#include "campaign/answers/sensitivity.h"

#include <algorithm>

#include "campaign/answers/one_at_a_time.h"
#include "campaign/answers/sample.h"
#include "campaign/answers/screening.h"
#include "campaign/answers/sensitivity_parts.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/ranking.h"

namespace faultsweep {

namespace {

void refuse_what_is_no_sample(const Sensitivity& s) {
  if (s.request.by_step && !s.sampling.is_random && !s.sampling.is_factorial) {
    throw InputError("--by-step",
                     concat("the cases of ", s.campaign.name, " are neither a sample nor a grid"),
                     "leave it out: effects and changes are those of metrics over a stage");
  }
  if (!s.sampling.is_random && !s.sampling.is_factorial) {
    throw InputError(
        "sensitivity",
        s.sampling.dependence.empty()
            ? concat("the cases of ", s.campaign.name, " are not a sample of its parameters")
            : concat("the cases of ", s.campaign.name,
                     " do not vary independently: ", s.sampling.dependence),
        "give its spec one design monte-carlo, latin-hypercube, sobol, grid, morris or "
        "one-at-a-time");
  }
  const long n = s.sample.n_rows - s.sample.n_without - s.sample.n_early;
  if (n == 0) refuse_unrun("sensitivity", "no case has a full history", s.campaign);
  if (s.sampling.is_random && n < kFewestForRankIndex) {
    throw InputError(
        "sensitivity",
        concat(n, n == 1 ? " case with a full history is" : " cases with a full history are",
               " too few: intervals of indices need at least ", kFewestForRankIndex),
        concat("run at least ", kFewestForRankIndex));
  }
}

/// Sensitivity::dependence. What is drawn independently depends on each other where cases are left
/// out by their parameters.
std::string dependence_of(const Store& store, const CampaignInfo& campaign,
                          const SensitivityRequest& request) {
  const std::vector<json> designs = designs_of(store, campaign);
  const auto any = [&](const auto& holds) { return std::ranges::any_of(designs, holds); };
  if (any([](const json& one) { return one.contains("correlated"); }))
    return "Inputs are correlated";
  if (any([](const json& one) { return one.at("kind") == "samples"; }))
    return "Inputs are samples from a file and may be correlated";
  const json spec = json::parse(store.spec_copies(campaign.id).resolved);
  if (spec.at("groups").size() > 1)
    return "Groups of cases are combined, so inputs may be correlated";
  if (!spec.value("exclude", json::array()).empty())
    return "Cases are excluded, so inputs are correlated";
  if (!request.cases.where.empty()) return "Only some cases are selected, so inputs are correlated";
  return "";
}

}  // namespace

Sensitivity analyse_sensitivity(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request) {
  Sensitivity s{campaign, request, sampling_of(store, campaign, request.cases), {}, {}, {}};
  const Selection selection =
      make_selection(store, campaign, request.cases.stage, request.cases.fault);
  HistoryOutputs histories;
  if (request.by_step) histories = history_outputs(store, campaign, request, selection);
  s.sample = read_sample(store, campaign, request.cases,
                         request.by_step ? std::move(histories.outputs)
                                         : asked_outputs(store, campaign, request, selection));
  refuse_what_is_no_sample(s);
  s.plane_strain = kinds_of(store, campaign, selection, request.cases.where).plane_strain;
  s.dependence = dependence_of(store, campaign, request);
  for (const StoredParameter& one : s.sample.parameters) s.parameters.push_back(one.name);
  s.steps = std::move(histories.steps);
  for (const ScopedMetric& one : histories.metrics) s.over_steps.push_back({one, 0, 0, 0, {}});
  add_indices(store, s);
  s.sample.x.clear(), s.sample.y.clear();
  return s;
}

Answer what_matters(const Store& store, const CampaignInfo& campaign,
                    const SensitivityRequest& request) {
  const auto with_approximation = [&](Answer answer) {
    answer.note_if(approximation_note(store, campaign));
    return answer;
  };
  if (!request.by_step) {
    if (const auto found = screen(store, campaign, request))
      return with_approximation(to_answer(*found));
    if (const auto found = compare_one_at_a_time(store, campaign, request))
      return with_approximation(to_answer(*found));
  }
  return to_answer(analyse_sensitivity(store, campaign, request));
}

}  // namespace faultsweep
