#include "campaign/rounds/next_round.h"

#include <algorithm>

#include "campaign/report/selection.h"
#include "campaign/report/table_output.h"
#include "campaign/rounds/staged_sample.h"
#include "campaign/rounds/submission.h"
#include "simulator/scene/read_scene.h"

namespace faultsweep {

using faultsim::concat;
using nlohmann::ordered_json;  // the order of parameters is that of the spec

std::unique_ptr<Proposer> make_proposer(const CampaignSpec& spec) {
  if (spec.staged_sample) return std::make_unique<StagedSampler>(*spec.staged_sample);
  return nullptr;
}

namespace {

/// The spec of a stored campaign on its stored base scene, whatever has become of the files; with
/// rounds it has one group.
ordered_json stored_spec(const Store& store, const CampaignInfo& campaign, std::string& source) {
  ordered_json spec = ordered_json::parse(store.spec_copies(campaign.id).given);
  if (!spec.contains("rounds")) return spec;
  const BaseScene base = store.base_scene(store.stored_case(campaign.id, "1").scene);
  source = base.source;
  spec["base"] = ordered_json::parse(base.document);
  spec.erase("set");  // it is in the scene
  return spec;
}

std::vector<Answer> answers_of(const Store& store, const CampaignInfo& campaign,
                               const std::vector<RoundRecord>& rounds,
                               const std::string& condition) {
  Store::TableQuery query;
  query.by_design_row = true;
  const Selection selection = make_selection(store, campaign, "", "");
  const bool any_result = !selection.faults.empty();
  if (any_result) query.columns = {parse_condition(condition, campaign, selection)};
  std::vector<Answer> answers;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    Answer one;
    one.position = row.position;
    while (one.round + 1 < static_cast<int>(rounds.size()) &&
           rounds[one.round + 1].first_position <= row.position) {
      ++one.round;
    }
    one.parameters = row.parameters;
    one.failed = row.state == "failed";
    one.complete = row.complete();
    one.holds = any_result && one.complete && number_of(row.metrics[0]) == 1;
    answers.push_back(std::move(one));
  });
  return answers;
}

}  // namespace

bool add_next_round(Store& store, const std::string& name) {
  const CampaignInfo campaign = store.campaign(name, false);
  std::string source;
  ordered_json spec = stored_spec(store, campaign, source);
  if (!spec.contains("rounds")) return false;
  const std::unique_ptr<Proposer> proposer = make_proposer(parse_campaign(spec.dump(), source));
  const std::vector<RoundRecord> rounds = store.rounds(campaign.id);
  std::vector<ordered_json> designs = {spec.at("design")};
  for (std::size_t k = 1; k < rounds.size(); ++k)
    designs.push_back(ordered_json::parse(rounds[k].design));
  const Proposal proposal =
      proposer->propose(answers_of(store, campaign, rounds, proposer->condition()), designs);
  if (proposal.design.is_null()) {
    store.conclude(campaign.id, proposal.reason);
    return false;
  }
  spec["design"] = proposal.design;
  spec.erase("rounds");
  const Submission round = make_submission(expand(parse_campaign(spec.dump(), source)));
  FAULTSIM_DEMAND(round.parameters == campaign.parameters, round.parameters);
  const long n_new =
      store.record_round(campaign.id, round, proposal.design.dump(), proposal.reason);
  if (n_new == 0) {
    store.conclude(campaign.id, concat(proposal.reason, "; the next round has no new case"));
  }
  return n_new > 0;
}

void check_rounds(const Expansion& expansion) {
  const std::unique_ptr<Proposer> proposer = make_proposer(expansion.spec);
  if (!proposer) return;
  const faultsim::Scene scene = faultsim::read_scene(
      {expansion.spec.scene_source, scene_of(expansion, expansion.cases.front()), {}});
  Selection selection;  // as results will have them
  for (const faultsim::Fault& fault : scene.faults) selection.faults.push_back({0, fault.name});
  for (const faultsim::Stage& stage : scene.stages) selection.stages.push_back({0, stage.name});
  CampaignInfo campaign;
  campaign.parameters = make_submission(expansion).parameters;
  try {
    parse_condition(proposer->condition(), campaign, selection);
  } catch (const faultsim::InputError& error) {
    std::vector<faultsim::Problem> problems = error.problems();
    for (faultsim::Problem& one : problems) {
      one.pointer = "/rounds/probability_of";
      one.line = expansion.spec.document.line_of(one.pointer);
    }
    throw faultsim::InputError(expansion.spec.source, problems);
  }
}

}  // namespace faultsweep
