#include <ctime>

#include "campaign/store/checksums.h"
#include "campaign/store/clock.h"
#include "campaign/store/queries.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::StorageError;

const char* to_string(FailureAction action) {
  switch (action) {
    case FailureAction::abort:
      return "abort";
    case FailureAction::retry:
      return "retry";
    case FailureAction::proceed:
      return "continue";
  }
  FAULTSIM_DEMAND(false, static_cast<int>(action));
  return "";
}

FailureAction failure_action_from_string(const std::string& text) {
  for (const auto action : {FailureAction::abort, FailureAction::retry, FailureAction::proceed}) {
    if (text == to_string(action)) return action;
  }
  throw StorageError(concat("unknown failure policy '", text, "' in the store"));
}

const char* to_string(FieldsState state) {
  switch (state) {
    case FieldsState::none:
      return "none";
    case FieldsState::wanted:
      return "wanted";
    case FieldsState::kept:
      return "kept";
    case FieldsState::failed:
      return "failed";
  }
  FAULTSIM_DEMAND(false, static_cast<int>(state));
  return "";
}

FieldsState fields_state_from_string(const std::string& text) {
  for (const auto state :
       {FieldsState::none, FieldsState::wanted, FieldsState::kept, FieldsState::failed}) {
    if (text == to_string(state)) return state;
  }
  throw StorageError(concat("unknown state of fields '", text, "' in the store"));
}

namespace {

/// Covers what the expanded copy is made of: base scenes and parameter vectors, in order.
std::string expanded_hash(const Submission& submission) {
  std::string text;
  for (const BaseScene& scene : submission.scenes) {
    text += faultsim::fingerprint(scene.source + '\n' + scene.document) + '\n';
  }
  text += submission.parameters + '\n';
  for (const CaseRecord& one : submission.cases) {
    text += concat(one.scene, ' ', one.identity, ' ', one.parameter_values, '\n');
  }
  return faultsim::fingerprint(text);
}

/// The campaign that is this submission, or a name that is free.
struct Place {
  std::optional<std::int64_t> campaign;
  std::string name;
};

Place find_place(Connection& db, const Submission& submission, const std::string& resolved_hash,
                 const std::string& expanded) {
  constexpr int kMostRevisions = 100000;  // names NAME-2, NAME-3, ...: far beyond use
  Statement query = db.prepared(
      "SELECT id, spec_resolved_hash, spec_expanded_hash FROM campaigns WHERE name = ?");
  for (int revision = 1; revision < kMostRevisions; ++revision) {
    const std::string name =
        revision == 1 ? submission.name : concat(submission.name, '-', revision);
    if (!query.bind(name).step()) return {std::nullopt, name};
    if (query.text(1) == resolved_hash && query.text(2) == expanded)
      return {query.integer(0), name};
  }
  throw StorageError(concat("too many campaigns are called ", submission.name));
}

std::vector<std::int64_t> add_families(Connection& db, const Submission& submission) {
  std::vector<std::int64_t> ids;
  for (const FamilyRecord& family : submission.families) {
    db.prepared(
          "INSERT INTO families (fingerprint, predicted_unknowns, predicted_jump_unknowns,"
          " predicted_operator_s, predicted_memory_bytes, n_operators) VALUES (?, ?, ?, ?, ?, ?)"
          " ON CONFLICT (fingerprint) DO UPDATE SET n_operators = excluded.n_operators")
        .bind(family.fingerprint, family.unknowns, family.jump_unknowns, family.operator_seconds,
              family.memory_bytes, family.n_operators)
        .run();
    Statement query = db.prepared("SELECT id FROM families WHERE fingerprint = ?");
    query.bind(family.fingerprint).step();
    ids.push_back(query.integer(0));
  }
  return ids;
}

constexpr const char* kInfoColumns =
    "SELECT id, name, submitted_at, state, source, parameters, rank_by, n_excluded, n_merged,"
    " on_failure, retries, case_time_limit_s, case_memory_limit_bytes, keep_fields,"
    " operator_time_limit_s FROM campaigns ";

CampaignInfo read_info(const Statement& row) {
  CampaignInfo info;
  info.id = row.integer(0);
  info.name = row.text(1);
  info.submitted_at = row.real(2);
  info.cancelled = row.text(3) == "cancelled";
  info.source = row.text(4);
  info.parameters = row.text(5);
  info.rank_by = row.text(6);
  info.n_excluded = row.integer(7);
  info.n_merged = row.integer(8);
  info.policy.on_failure = failure_action_from_string(row.text(9));
  info.policy.retries = static_cast<int>(row.integer(10));
  info.policy.time_limit = row.optional_real(11);
  info.policy.memory_limit = row.optional_real(12);
  info.policy.operator_time_limit = row.optional_real(14);
  const auto keep = keep_fields_named(row.text(13));
  if (!keep) throw StorageError(concat("unknown keep_fields '", row.text(13), "' in the store"));
  info.keep_fields = *keep;
  return info;
}

/// Of a campaign that is in the store: how many cases have a result, and of these lack fields.
void count_known(Connection& db, SubmitOutcome& outcome) {
  Statement query = db.prepared(
      "SELECT total(state = 'done' OR lacks_only_fields), total(lacks_only_fields)"
      " FROM campaign_case_states WHERE campaign_id = ?");
  query.bind(outcome.campaign).step();
  outcome.n_cached = query.integer(0);
  outcome.n_fields = query.integer(1);
}

}  // namespace

std::int64_t Store::add_scene(const BaseScene& scene) {
  Connection& db = *connection_;
  const std::string hash = faultsim::fingerprint(scene.source + '\n' + scene.document);
  db.prepared("INSERT INTO scenes (hash, source, document) VALUES (?, ?, ?) ON CONFLICT DO NOTHING")
      .bind(hash, scene.source, scene.document)
      .run();
  Statement query = db.prepared("SELECT id FROM scenes WHERE hash = ?");
  query.bind(hash).step();
  const std::int64_t id = query.integer(0);
  return id;
}

void Store::add_cases(std::int64_t campaign, const Submission& submission) {
  Connection& db = *connection_;
  std::vector<std::int64_t> scenes;
  for (const BaseScene& scene : submission.scenes) scenes.push_back(add_scene(scene));
  const std::vector<std::int64_t> families = add_families(db, submission);
  Statement insert = db.prepared(
      "INSERT INTO cases (identity, family_id, scene_id, changes) VALUES (?, ?, ?, ?)"
      " ON CONFLICT (identity) DO NOTHING");
  Statement find = db.prepared("SELECT id FROM cases WHERE identity = ?");
  Statement link = db.prepared(
      "INSERT INTO campaign_cases (campaign_id, position, case_id, parameter_values,"
      " parameter_labels, fields) VALUES (?, ?, ?, ?, ?, ?)");
  const char* fields = to_string(submission.keep_fields == KeepFields::none ? FieldsState::none
                                                                            : FieldsState::wanted);
  long position = 0;
  for (const CaseRecord& one : submission.cases) {
    insert
        .bind(one.identity, families.at(static_cast<std::size_t>(one.family)),
              scenes.at(static_cast<std::size_t>(one.scene)), one.changes)
        .run();
    std::int64_t id = db.last_insert_id();
    if (db.changes() == 0) {
      find.bind(one.identity).step();
      id = find.integer(0);
    }
    link.bind(campaign, ++position, id, one.parameter_values, one.parameter_labels, fields).run();
  }
  Statement add_row = db.prepared(
      "INSERT INTO design_rows (campaign_id, design, row, position) VALUES (?, ?, ?, ?)");
  for (const DesignRow& one : submission.design_rows) {
    add_row.bind(campaign, one.design, one.row, one.position).run();
  }
}

SubmitOutcome Store::submit(const Submission& submission) {
  FAULTSIM_DEMAND(!submission.cases.empty() && !submission.scenes.empty(), submission.name);
  Connection& db = *connection_;
  const std::string resolved_hash = faultsim::fingerprint(submission.spec_resolved);
  const std::string expanded = expanded_hash(submission);
  SubmitOutcome outcome;
  Transaction transaction(db);
  const Place place = find_place(db, submission, resolved_hash, expanded);
  outcome.name = place.name;
  outcome.existed = place.campaign.has_value();
  if (outcome.existed) {
    outcome.campaign = *place.campaign;
    db.prepared("UPDATE campaigns SET state = 'open', submitted_at = ? WHERE id = ?")
        .bind(seconds_since_1970(), outcome.campaign)
        .run();
  } else {
    db.prepared(
          "INSERT INTO campaigns (name, submitted_at, source, spec_given, spec_given_hash,"
          " spec_resolved, spec_resolved_hash, spec_expanded_hash, parameters, rank_by, n_excluded,"
          " n_merged, on_failure, retries, case_time_limit_s, case_memory_limit_bytes, keep_fields,"
          " operator_time_limit_s)"
          " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(place.name, seconds_since_1970(), submission.source, submission.spec_given,
              faultsim::fingerprint(submission.spec_given), submission.spec_resolved, resolved_hash,
              expanded, submission.parameters, submission.rank_by, submission.n_excluded,
              submission.n_merged, to_string(submission.policy.on_failure),
              submission.policy.retries, submission.policy.time_limit,
              submission.policy.memory_limit
                  ? std::optional(static_cast<std::int64_t>(*submission.policy.memory_limit))
                  : std::nullopt,
              to_string(submission.keep_fields), submission.policy.operator_time_limit)
        .run();
    outcome.campaign = db.last_insert_id();
    add_cases(outcome.campaign, submission);
    checksums_->seal_campaign(outcome.campaign);
  }
  count_known(db, outcome);
  transaction.commit();
  return outcome;
}

std::map<std::int64_t, CaseCounts> count_by_family(Connection& connection, std::int64_t campaign) {
  Statement query = connection.prepared(
      "SELECT family_id, state, coalesce(outcome, ''), lacks_only_fields FROM campaign_case_states"
      " WHERE campaign_id = ?");
  query.bind(campaign);
  std::map<std::int64_t, CaseCounts> all;
  while (query.step()) {
    CaseCounts& counts = all[query.integer(0)];
    const std::string state = query.text(1), outcome = query.text(2);
    const bool done = state == "done", failed = state == "failed";
    const bool lacks_only_fields = query.integer(3) != 0;
    ++counts.n_cases;
    counts.n_done += done;
    counts.n_failed += failed;
    counts.n_waiting += !done && !failed;
    counts.n_converged += done && outcome == "converged";
    counts.n_event += done && outcome == "event";
    counts.n_unresolved += done && outcome == "unresolved_event";
    counts.n_fields_failed += lacks_only_fields && failed;
    counts.n_fields_waiting += lacks_only_fields && !failed;
  }
  return all;
}

CaseCounts& CaseCounts::operator+=(const CaseCounts& more) {
  n_cases += more.n_cases;
  n_done += more.n_done;
  n_failed += more.n_failed;
  n_waiting += more.n_waiting;
  n_converged += more.n_converged;
  n_event += more.n_event;
  n_unresolved += more.n_unresolved;
  n_fields_waiting += more.n_fields_waiting;
  n_fields_failed += more.n_fields_failed;
  return *this;
}

bool Store::lacks_results() const {
  Statement query =
      connection_->prepared("SELECT EXISTS (SELECT 1 FROM cases WHERE state <> 'done')");
  query.step();
  const bool lacks = query.integer(0) != 0;
  return lacks;
}

SubmitOutcome Store::preview(const Submission& submission) const {
  Connection& db = *connection_;
  const Place place = find_place(db, submission, faultsim::fingerprint(submission.spec_resolved),
                                 expanded_hash(submission));
  SubmitOutcome outcome;
  outcome.name = place.name;
  outcome.existed = place.campaign.has_value();
  if (outcome.existed) {
    outcome.campaign = *place.campaign;
    count_known(db, outcome);
    return outcome;
  }
  Statement query = db.prepared("SELECT 1 FROM cases WHERE identity = ? AND state = 'done'");
  for (const CaseRecord& one : submission.cases) {
    outcome.n_cached += query.bind(one.identity).step() ? 1 : 0;
  }
  if (submission.keep_fields != KeepFields::none) outcome.n_fields = outcome.n_cached;
  return outcome;
}

std::vector<CampaignInfo> Store::campaigns() const {
  std::vector<CampaignInfo> all;
  Statement query(*connection_, concat(kInfoColumns, "ORDER BY submitted_at, id"));
  while (query.step()) all.push_back(read_info(query));
  return all;
}

CampaignInfo Store::campaign(const std::string& name, bool with_counts) const {
  std::vector<CampaignInfo> all = campaigns();
  if (all.empty()) {
    throw StorageError(concat("the store ", folder_.string(),
                              " has no campaign yet; `faultsweep submit SPEC.json` adds one"));
  }
  for (CampaignInfo& info : all) {
    if (info.name == name || (name.empty() && &info == &all.back())) {
      if (with_counts) {
        for (const auto& [family, counts] : count_by_family(*connection_, info.id)) info += counts;
      }
      return info;
    }
  }
  std::string names;
  for (const CampaignInfo& info : all) names += (names.empty() ? "" : ", ") + info.name;
  throw faultsim::InputError("--campaign", {{"", 0, concat("there is no campaign '", name, "'"),
                                             concat("there are: ", names)}});
}

void Store::cancel(std::int64_t campaign) {
  Transaction transaction(*connection_);
  connection_->prepared("UPDATE campaigns SET state = 'cancelled' WHERE id = ?")
      .bind(campaign)
      .run();
  record_event(campaign, "cancelled", "by the user");
  transaction.commit();
}

bool Store::is_cancelled(std::int64_t campaign) const {
  Statement query = connection_->prepared("SELECT state = 'cancelled' FROM campaigns WHERE id = ?");
  FAULTSIM_DEMAND(query.bind(campaign).step(), campaign);
  const bool cancelled = query.integer(0) != 0;
  return cancelled;
}

long Store::retry(std::int64_t campaign, bool unconverged_too, std::optional<long> position) {
  Transaction transaction(*connection_);
  Statement update = connection_->prepared(
      "UPDATE cases SET state = 'waiting' WHERE id IN"
      " (SELECT c.id FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
      "  JOIN campaign_case_states s ON s.campaign_id = ?1 AND s.position = cc.position"
      "  WHERE cc.campaign_id = ?1 AND (?3 IS NULL OR cc.position = ?3)"
      "  AND (c.state = 'failed' OR (?2 AND c.state = 'done' AND NOT s.complete)))");
  update.bind(campaign, unconverged_too, position).run();
  long count = connection_->changes();
  connection_
      ->prepared(
          "UPDATE campaign_cases SET fields = 'wanted' WHERE campaign_id = ?1 AND fields = 'failed'"
          " AND (?2 IS NULL OR position = ?2)"
          " AND (SELECT state FROM cases WHERE id = case_id) = 'done'")
      .bind(campaign, position)
      .run();
  count += connection_->changes();
  if (count > 0) record_event(campaign, "retry", concat(count, " cases wait again"));
  transaction.commit();
  return count;
}

BaseScene Store::base_scene(std::int64_t scene) const {
  Statement query = connection_->prepared("SELECT source, document FROM scenes WHERE id = ?");
  FAULTSIM_DEMAND(query.bind(scene).step(), scene);
  BaseScene base{query.text(0), query.text(1)};
  return base;
}

Store::SpecCopies Store::spec_copies(std::int64_t campaign) const {
  Statement query = connection_->prepared(
      "SELECT spec_given, spec_resolved, spec_expanded_hash FROM campaigns WHERE id = ?");
  FAULTSIM_DEMAND(query.bind(campaign).step(), campaign);
  SpecCopies copies{query.text(0), query.text(1), query.text(2)};
  return copies;
}

std::vector<DesignRow> Store::design_rows(std::int64_t campaign) const {
  Statement query = connection_->prepared(
      "SELECT design, row, position FROM design_rows WHERE campaign_id = ? ORDER BY design, row");
  query.bind(campaign);
  std::vector<DesignRow> rows;
  while (query.step()) {
    rows.push_back({static_cast<int>(query.integer(0)), query.integer(1), query.integer(2)});
  }
  return rows;
}

}  // namespace faultsweep
