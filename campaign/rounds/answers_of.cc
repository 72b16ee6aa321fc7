#include "campaign/rounds/answers_of.h"

#include <unordered_map>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/query/selection.h"

namespace faultsweep {

namespace {

/// What is known of a question, by position; not known of cases that are not there.
std::unordered_map<long, Held> held_by_position(const Store& store, const CampaignInfo& campaign,
                                                const Question& question) {
  std::unordered_map<long, Held> held;
  if (store.faults(campaign.id).empty()) return held;  // no case has a result
  const Selection selection = make_selection(store, campaign, question.stage, question.fault);
  const VerdictColumns verdict(store, campaign, selection, {question.condition});
  Store::TableQuery query = case_query(campaign, selection, "");
  query.columns = verdict.columns();
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    held.emplace(row.position, verdict.held(row, 0));
  });
  return held;
}

/// A row for each of `design_rows`, or for each case.
std::vector<RowAnswers> stored_answers(const Store& store, const CampaignInfo& campaign,
                                       const std::vector<RoundRecord>& rounds,
                                       const std::vector<Question>& questions, bool by_design_row,
                                       std::unordered_map<std::string, std::size_t>& by_identity) {
  const std::vector known = mapped(
      questions, [&](const Question& one) { return held_by_position(store, campaign, one); });
  Store::TableQuery query;
  query.by_design_row = by_design_row;
  std::vector<RowAnswers> answers;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    RowAnswers one;
    one.position = row.position;
    while (one.round + 1 < static_cast<int>(rounds.size()) &&
           rounds[static_cast<std::size_t>(one.round) + 1].first_position <= row.position) {
      ++one.round;
    }
    one.parameters = row.parameters;
    one.failed = row.state == "failed";
    one.complete = row.complete();
    for (const auto& held : known) {
      const auto found = held.find(row.position);
      one.held.push_back(found == held.end() ? Held::unknown : found->second);
    }
    by_identity.emplace(row.identity, answers.size());
    answers.push_back(std::move(one));
  });
  return answers;
}

}  // namespace

std::optional<StoredRounds> stored_rounds(const Store& store, const CampaignInfo& campaign) {
  StoredRounds stored;
  const Store::SpecCopies copies = store.spec_copies(campaign.id);
  stored.spec = ordered_json::parse(copies.given);
  if (!stored.spec.contains("rounds") && !stored.spec.contains("limits")) return std::nullopt;
  // A case that an earlier campaign had is stored as changes of that one's scene: not of ours.
  const ordered_json scene = ordered_json::parse(copies.resolved).at("groups").at(0).at("scene");
  const BaseScene first = store.base_scene(store.stored_case(campaign.id, "1").scene);
  stored.source = ordered_json::parse(first.document) == scene ? first.source : campaign.source;
  stored.spec["base"] = scene;
  stored.spec.erase("set");  // it is in the scene
  stored.rounds = store.rounds(campaign.id);
  stored.designs = {stored.spec.at("design")};
  for (std::size_t k = 1; k < stored.rounds.size(); ++k)
    stored.designs.push_back(ordered_json::parse(stored.rounds[k].design));
  return stored;
}

CampaignSpec parse_spec(const StoredRounds& stored) {
  return parse_campaign(stored.spec.dump(), stored.source);
}

std::vector<RowAnswers> answers_of(const Store& store, const CampaignInfo& campaign,
                                   const StoredRounds& stored, const Proposer& proposer,
                                   bool has_limits) {
  std::unordered_map<std::string, std::size_t> by_identity;
  std::vector<RowAnswers> cases = stored_answers(store, campaign, stored.rounds,
                                                 proposer.questions(), !has_limits, by_identity);
  if (!has_limits) return cases;
  std::vector<RowAnswers> answers;
  for (std::size_t k = 0; k < stored.designs.size(); ++k) {
    const ordered_json spec =
        k == 0 ? stored.spec : proposer.spec_of_round(stored.spec, stored.designs[k]);
    const Expansion expansion = expand(parse_campaign(spec.dump(), stored.source));
    const std::vector<long>& picked = expansion.spec.groups.front().picked;
    const std::vector<int>& rows = expansion.case_of_row.front();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] < 0) continue;
      const std::string& identity = expansion.cases[static_cast<std::size_t>(rows[i])].identity;
      RowAnswers one = cases[by_identity.at(identity)];
      one.round = static_cast<int>(k);
      one.row = picked.empty() ? static_cast<long>(i) : picked[i];
      answers.push_back(std::move(one));
    }
  }
  return answers;
}

}  // namespace faultsweep
