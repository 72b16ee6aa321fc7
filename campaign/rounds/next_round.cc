#include "campaign/rounds/next_round.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/query/selection.h"
#include "campaign/rounds/answers_of.h"
#include "campaign/rounds/limit_searcher.h"
#include "campaign/rounds/staged_sample.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {

std::unique_ptr<Proposer> make_proposer(const CampaignSpec& spec) {
  if (spec.staged_sample) return std::make_unique<StagedSampler>(*spec.staged_sample);
  if (!spec.limits.empty()) return std::make_unique<LimitSearcher>(make_limit_searcher(spec));
  return nullptr;
}

LimitSearcher make_limit_searcher(const CampaignSpec& spec) {
  std::vector<LimitSearch> limits = spec.limits;
  std::vector<std::string> all;
  for (LimitSearch& one : limits) {
    if (one.faults.empty() && all.empty()) {
      std::vector<Problem> problems;
      const faultsim::Scene scene =
          faultsim::read_scene({spec.scene_source, spec.groups.front().scene, {}}, problems);
      for (const faultsim::Fault& fault : scene.faults) all.push_back(fault.name);
    }
    if (one.faults.empty()) one.faults = all;
  }
  return LimitSearcher(std::move(limits));
}

bool add_next_round(Store& store, const std::string& name) {
  const CampaignInfo campaign = store.campaign(name, false);
  std::optional<StoredRounds> stored = stored_rounds(store, campaign);
  if (!stored) return false;
  const CampaignSpec given = parse_spec(*stored);
  const bool has_limits = !given.limits.empty();
  const std::unique_ptr<Proposer> proposer = make_proposer(given);
  while (true) {
    const Proposal proposal = proposer->propose(
        answers_of(store, campaign, *stored, *proposer, has_limits), stored->designs);
    if (proposal.design.is_null()) {
      store.conclude(campaign.id, proposal.reason);
      return false;
    }
    const ordered_json spec = proposer->spec_of_round(stored->spec, proposal.design);
    const Submission round = make_submission(expand(parse_campaign(spec.dump(), stored->source)));
    FAULTSIM_DEMAND(round.parameters == campaign.parameters, campaign.name);
    const long n_new =
        store.record_round(campaign.id, round, proposal.design.dump(), proposal.reason);
    if (n_new > 0) return true;
    stored = stored_rounds(store, campaign);  // its cases were there: they are answers already
  }
}

namespace {

void check_question(const Question& question, const CampaignInfo& campaign, Selection selection) {
  if (!question.stage.empty())
    require_name("stage", "stage", question.stage, mapped(selection.stages, &NamedId::name));
  if (!question.fault.empty()) {
    require_name("faults", "fault", question.fault, mapped(selection.faults, &NamedId::name));
    selection.fault = NamedId{0, question.fault};
  }
  parse_condition(question.condition, campaign, selection);
}

/// A search whose values are left out in part could not tell what lies behind.
void check_whole_searches(const Expansion& expansion) {
  std::size_t n_values = 0;
  for (const LimitSearch& one : expansion.spec.limits) n_values += one.scan.size();
  const std::vector<int>& rows = expansion.case_of_row.front();
  for (std::size_t first = 0; n_values > 0 && first < rows.size(); first += n_values) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
    const auto n_excluded = std::count(begin, begin + static_cast<std::ptrdiff_t>(n_values), -1);
    if (n_excluded == 0 || n_excluded == static_cast<std::ptrdiff_t>(n_values)) continue;
    throw InputError(expansion.spec.source,
                     {{"/exclude", expansion.spec.document.line_of("/exclude"),
                       concat("leaves out ", n_excluded, " of the ", n_values,
                              " values of a search (row ", first / n_values + 1, " of the design)"),
                       "exclude whole rows of the design, and end the range of a limit where "
                       "values become invalid"}});
  }
}

}  // namespace

void check_rounds(const Expansion& expansion) {
  const std::unique_ptr<Proposer> proposer = make_proposer(expansion.spec);
  if (!proposer) return;
  check_whole_searches(expansion);
  const faultsim::Scene scene = faultsim::read_scene(
      {expansion.spec.scene_source, scene_of(expansion, expansion.cases.front()), {}});
  Selection selection;  // as results will have them
  for (const faultsim::Fault& fault : scene.faults) selection.faults.push_back({0, fault.name});
  for (const faultsim::Stage& stage : scene.stages) selection.stages.push_back({0, stage.name});
  CampaignInfo campaign;
  campaign.parameters = make_submission(expansion, CaseDetail::identity).parameters;
  std::vector<Problem> problems;
  for (const Question& question : proposer->questions()) {
    try {
      check_question(question, campaign, selection);
    } catch (const InputError& error) {
      for (Problem one : error.problems()) {
        const bool is_said = contains(problems, one.what, &Problem::what);
        if (is_said) continue;
        one.pointer = question.pointer;
        one.line = expansion.spec.document.line_of(one.pointer);
        problems.push_back(std::move(one));
      }
    }
  }
  if (!problems.empty()) throw InputError(expansion.spec.source, problems);
}

}  // namespace faultsweep
