#include <ctime>

#include "campaign/common/names.h"
#include "campaign/store/checksums.h"
#include "campaign/store/clock.h"
#include "campaign/store/queries.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

namespace {

/// Covers what the expanded copy is made of: base scenes and cases, in order.
std::string expanded_hash(const Submission& submission) {
  std::string text;
  for (const BaseScene& scene : submission.scenes) {
    text += faultsim::fingerprint(scene.source + '\n' + scene.document) + '\n';
  }
  text += parameters_to_json(submission.parameters) + '\n';
  for (const CaseRecord& one : submission.cases) text += one.identity + '\n';
  return faultsim::fingerprint(text);
}

/// Whether the campaign's own design became these very cases.
bool has_cases(Connection& db, std::int64_t campaign, const std::vector<CaseRecord>& cases) {
  Statement query = db.prepared(
      "SELECT c.identity FROM rounds r CROSS JOIN campaign_cases cc"
      " ON cc.campaign_id = r.campaign_id AND cc.position < r.first_position + r.n_cases"
      " CROSS JOIN cases c ON c.id = cc.case_id"
      " WHERE r.campaign_id = ? AND r.round = 0 ORDER BY cc.position");
  query.bind(campaign);
  for (const CaseRecord& one : cases) {
    if (!query.step() || query.text(0) != one.identity) return false;
  }
  return !query.step();
}

/// The campaign that is this submission, or a name that is free; nothing is counted. A campaign of
/// before the default changed, or that a command ran for itself, may keep other fields.
SubmitOutcome find_place(Connection& db, const Submission& submission) {
  constexpr int kMostRevisions = 100000;  // names NAME-2, NAME-3, ...: far beyond use
  const std::string resolved = faultsim::fingerprint(submission.spec_resolved);
  for (int revision = 1; revision < kMostRevisions; ++revision) {
    const std::string name =
        revision == 1 ? submission.name : concat(submission.name, '-', revision);
    const auto found = db.find<std::tuple<std::int64_t, std::string, std::string>>(
        "SELECT id, spec_resolved_hash, keep_fields FROM campaigns WHERE name = ?", name);
    if (!found) return {.name = name, .keep_fields = submission.keep_fields};
    const auto& [id, hash, kept] = *found;
    if (hash == resolved && has_cases(db, id, submission.cases)) {
      return {.campaign = id,
              .name = name,
              .existed = true,
              .keep_fields = stored_word<KeepFields>(kept, "keep_fields")};
    }
  }
  throw StorageError(
      concat("too many campaigns are named ", submission.name, "; choose another name"));
}

std::vector<std::int64_t> add_families(Connection& db, const std::vector<FamilyRecord>& families) {
  std::vector<std::int64_t> ids;
  for (const FamilyRecord& one : families) {
    db.run(
        "INSERT INTO families (fingerprint, predicted_unknowns, predicted_jump_unknowns,"
        " predicted_operator_s, predicted_memory_bytes, n_operators) VALUES (?, ?, ?, ?, ?, ?)"
        " ON CONFLICT (fingerprint) DO NOTHING",
        one.fingerprint, one.unknowns, one.jump_unknowns, one.operator_seconds, one.memory_bytes,
        one.n_operators);
    ids.push_back(db.changes() > 0 ? db.last_insert_id()
                                   : db.row<std::int64_t>("UPDATE families SET n_operators = ?"
                                                          " WHERE fingerprint = ? RETURNING id",
                                                          one.n_operators, one.fingerprint));
  }
  return ids;
}

constexpr const char* kInfoColumns =
    "SELECT id, name, submitted_at, state, source, parameters, rank_by, n_excluded, n_merged,"
    " on_failure, retries, case_time_limit_s, case_memory_limit_bytes, keep_fields,"
    " operator_time_limit_s, conclusion FROM campaigns ";

CampaignInfo read_info(const Statement& row) {
  CampaignInfo info;
  std::string state, parameters, on_failure, keep_fields;
  row.read(info.id, info.name, info.submitted_at, state, info.source, parameters, info.rank_by,
           info.n_excluded, info.n_merged, on_failure, info.policy.retries, info.policy.time_limit,
           info.policy.memory_limit, keep_fields, info.policy.operator_time_limit, info.conclusion);
  info.cancelled = state == "cancelled";
  info.parameters = parameters_from_json(parameters);
  info.policy.on_failure = stored_word<FailureAction>(on_failure, "failure policy");
  info.keep_fields = stored_word<KeepFields>(keep_fields, "keep_fields");
  return info;
}

/// Of a campaign that is in the store: how many cases have a result, and of these lack fields.
void count_known(Connection& db, SubmitOutcome& outcome) {
  std::tie(outcome.n_cached, outcome.n_fields) = db.row<std::tuple<long, long>>(
      "SELECT total(state = 'done' OR lacks_only_fields), total(lacks_only_fields)"
      " FROM campaign_case_states WHERE campaign_id = ?",
      outcome.campaign);
}

/// Puts cases into a campaign, behind those that it has.
class CaseAdder {
 public:
  CaseAdder(Connection& db, std::int64_t campaign, long n_before, FieldsState fields)
      : db_(db), campaign_(campaign), n_cases_(n_before), fields_(to_string(fields)) {}

  /// The position of the case: that which it has already, or the next one.
  long add(const CaseRecord& one, std::int64_t family, std::int64_t scene) {
    insert_.bind(one.identity, family, scene, one.changes).run();
    std::int64_t id = db_.last_insert_id();
    if (db_.changes() == 0) {
      find_.bind(one.identity).step();
      id = find_.integer(0);
      if (place_.bind(campaign_, id).step()) return static_cast<long>(place_.integer(0));
    }
    link_.bind(campaign_, ++n_cases_, id, fields_).run();
    for (const CaseParameter& value : one.parameters) {
      parameter_.bind(campaign_, n_cases_, value.index, value.si, value.text).run();
    }
    return n_cases_;
  }
  long n_cases() const { return n_cases_; }

 private:
  Connection& db_;
  std::int64_t campaign_;
  long n_cases_;
  const char* fields_;
  Statement insert_ = db_.prepared(
      "INSERT INTO cases (identity, family_id, scene_id, changes) VALUES (?, ?, ?, ?)"
      " ON CONFLICT (identity) DO NOTHING");
  Statement find_ = db_.prepared("SELECT id FROM cases WHERE identity = ?");
  Statement place_ =
      db_.prepared("SELECT position FROM campaign_cases WHERE campaign_id = ? AND case_id = ?");
  Statement link_ = db_.prepared(
      "INSERT INTO campaign_cases (campaign_id, position, case_id, fields) VALUES (?, ?, ?, ?)");
  Statement parameter_ = db_.prepared(
      "INSERT INTO case_parameters (campaign_id, position, parameter, si, text)"
      " VALUES (?, ?, ?, ?, ?)");
};

}  // namespace

std::int64_t Store::add_scene(const BaseScene& scene) {
  Connection& db = *connection_;
  const std::string hash = faultsim::fingerprint(scene.source + '\n' + scene.document);
  db.run("INSERT INTO scenes (hash, source, document) VALUES (?, ?, ?) ON CONFLICT DO NOTHING",
         hash, scene.source, scene.document);
  return db.row<std::int64_t>("SELECT id FROM scenes WHERE hash = ?", hash);
}

long Store::add_round(std::int64_t campaign, const Submission& submission,
                      const std::string& design, const std::string& reason) {
  Connection& db = *connection_;
  std::vector scenes =
      mapped(submission.scenes, [&](const BaseScene& scene) { return add_scene(scene); });
  const std::vector<std::int64_t> families = add_families(db, submission.families);
  const auto [round, first] = db.row<std::tuple<long, long>>(
      "SELECT coalesce(max(round), -1) + 1, coalesce(max(first_position + n_cases), 1)"
      " FROM rounds WHERE campaign_id = ?",
      campaign);
  CaseAdder adder(
      db, campaign, first - 1,
      are_of_all_cases(submission.keep_fields) ? FieldsState::wanted : FieldsState::none);
  std::vector<long> positions;
  for (const CaseRecord& one : submission.cases) {
    positions.push_back(adder.add(one, families.at(one.family), scenes.at(one.scene)));
  }
  const long n_rows =
      db.row<long>("SELECT coalesce(max(row), 0) FROM design_rows WHERE campaign_id = ?", campaign);
  Statement add_row = db.prepared(
      "INSERT INTO design_rows (campaign_id, design, row, position) VALUES (?, ?, ?, ?)");
  for (const DesignRow& one : submission.design_rows) {
    const auto place = static_cast<std::size_t>(one.position - 1);
    FAULTSIM_DEMAND(place < positions.size(), "row of case ", one.position);
    add_row.bind(campaign, one.design, n_rows + one.row, positions[place]).run();
  }
  const long n_new = adder.n_cases() - (first - 1);
  db.run(
      "INSERT INTO rounds (campaign_id, round, first_position, n_cases, design, reason,"
      " proposed_at) VALUES (?, ?, ?, ?, ?, ?, ?)",
      campaign, round, first, n_new, design, reason, seconds_since_1970());
  checksums_->seal_campaign(campaign);
  return n_new;
}

long Store::record_round(std::int64_t campaign, const Submission& submission,
                         const std::string& design, const std::string& reason) {
  const ConstraintsOff constraints_off(*connection_);
  Transaction transaction(*connection_);
  const long n_new = add_round(campaign, submission, design, reason);
  transaction.commit();
  return n_new;
}

void Store::conclude(std::int64_t campaign, const std::string& conclusion) {
  connection_->run("UPDATE campaigns SET conclusion = ? WHERE id = ?", conclusion, campaign);
}

std::vector<RoundRecord> Store::rounds(std::int64_t campaign) const {
  return connection_->rows<RoundRecord, long, long, std::string, std::string, double>(
      "SELECT first_position, n_cases, design, reason, proposed_at FROM rounds"
      " WHERE campaign_id = ? ORDER BY round",
      campaign);
}

SubmitOutcome Store::submit(const Submission& submission) {
  FAULTSIM_DEMAND(!submission.cases.empty() && !submission.scenes.empty(), submission.name);
  Connection& db = *connection_;
  const ConstraintsOff constraints_off(db);
  Transaction transaction(db);
  SubmitOutcome outcome = find_place(db, submission);
  if (outcome.existed) {
    db.run("UPDATE campaigns SET state = 'open', submitted_at = ? WHERE id = ?",
           seconds_since_1970(), outcome.campaign);
  } else {
    db.run(
        "INSERT INTO campaigns (name, submitted_at, source, spec_given, spec_given_hash,"
        " spec_resolved, spec_resolved_hash, spec_expanded_hash, parameters, rank_by, n_excluded,"
        " n_merged, on_failure, retries, case_time_limit_s, case_memory_limit_bytes, keep_fields,"
        " operator_time_limit_s)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        outcome.name, seconds_since_1970(), submission.source, submission.spec_given,
        faultsim::fingerprint(submission.spec_given), submission.spec_resolved,
        faultsim::fingerprint(submission.spec_resolved), expanded_hash(submission),
        parameters_to_json(submission.parameters), submission.rank_by, submission.n_excluded,
        submission.n_merged, to_string(submission.policy.on_failure), submission.policy.retries,
        submission.policy.time_limit,
        submission.policy.memory_limit
            ? std::optional(static_cast<std::int64_t>(*submission.policy.memory_limit))
            : std::nullopt,
        to_string(submission.keep_fields), submission.policy.operator_time_limit);
    outcome.campaign = db.last_insert_id();
    db.run(
        "INSERT INTO campaign_parameters SELECT ?1, key, value ->> 'name', value ->> 'dimension'"
        " FROM json_each(?2)",
        outcome.campaign, parameters_to_json(submission.parameters));
    add_round(outcome.campaign, submission, "", "");
  }
  count_known(db, outcome);
  transaction.commit();
  return outcome;
}

std::map<std::int64_t, CaseCounts> count_by_family(Connection& connection, std::int64_t campaign) {
  Statement query = connection.prepared(
      "SELECT family_id, state, coalesce(outcome, ''), lacks_only_fields, fields"
      " FROM campaign_case_states"
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
    const std::string fields = query.text(4);
    counts.n_fields_failed += lacks_only_fields && fields == "failed";
    counts.n_fields_waiting += lacks_only_fields && fields == "wanted";
    counts.n_fields_kept += done && fields == "kept";
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
  n_fields_kept += more.n_fields_kept;
  return *this;
}

bool Store::lacks_results() const {
  return connection_->row<bool>("SELECT EXISTS (SELECT 1 FROM cases WHERE state <> 'done')");
}

SubmitOutcome Store::preview(const Submission& submission) const {
  Connection& db = *connection_;
  SubmitOutcome outcome = find_place(db, submission);
  if (outcome.existed) {
    count_known(db, outcome);
    return outcome;
  }
  Statement query = db.prepared("SELECT 1 FROM cases WHERE identity = ? AND state = 'done'");
  for (const CaseRecord& one : submission.cases) {
    outcome.n_cached += query.bind(one.identity).step() ? 1 : 0;
  }
  if (are_of_all_cases(submission.keep_fields)) outcome.n_fields = outcome.n_cached;
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
                              " has no campaign yet; add one with `faultsweep submit SPEC.json`"));
  }
  for (CampaignInfo& info : all) {
    if (info.name == name || (name.empty() && &info == &all.back())) {
      if (with_counts) {
        for (const auto& [family, counts] : count_by_family(*connection_, info.id)) info += counts;
      }
      return info;
    }
  }
  std::string names = joined(all, ", ", &CampaignInfo::name);
  throw InputError("--campaign", concat("there is no campaign '", name, "'"),
                   concat("there are: ", names));
}

void Store::cancel(std::int64_t campaign) {
  Transaction transaction(*connection_);
  connection_->run("UPDATE campaigns SET state = 'cancelled' WHERE id = ?", campaign);
  record_event(campaign, "cancelled", "by the user");
  transaction.commit();
}

bool Store::is_cancelled(std::int64_t campaign) const {
  return connection_->row<bool>("SELECT state = 'cancelled' FROM campaigns WHERE id = ?", campaign);
}

long Store::retry(std::int64_t campaign, bool unconverged_too, std::optional<long> position) {
  Transaction transaction(*connection_);
  connection_->run(
      "UPDATE cases SET state = 'waiting' WHERE id IN"
      " (SELECT c.id FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
      "  JOIN campaign_case_states s ON s.campaign_id = ?1 AND s.position = cc.position"
      "  WHERE cc.campaign_id = ?1 AND (?3 IS NULL OR cc.position = ?3)"
      "  AND (c.state = 'failed' OR (?2 AND c.state = 'done' AND NOT s.complete)))",
      campaign, unconverged_too, position);
  long count = connection_->changes();
  connection_->run(
      "UPDATE campaign_cases SET fields = 'wanted' WHERE campaign_id = ?1 AND fields = 'failed'"
      " AND (?2 IS NULL OR position = ?2)"
      " AND (SELECT state FROM cases WHERE id = case_id) = 'done'",
      campaign, position);
  count += connection_->changes();
  if (count > 0) record_event(campaign, "retry", concat(count, " cases wait again"));
  transaction.commit();
  return count;
}

BaseScene Store::base_scene(std::int64_t scene) const {
  return connection_->row<BaseScene, std::string, std::string>(
      "SELECT source, document FROM scenes WHERE id = ?", scene);
}

Store::SpecCopies Store::spec_copies(std::int64_t campaign) const {
  return connection_->row<SpecCopies, std::string, std::string, std::string>(
      "SELECT spec_given, spec_resolved, spec_expanded_hash FROM campaigns WHERE id = ?", campaign);
}

std::vector<DesignRow> Store::design_rows(std::int64_t campaign) const {
  return connection_->rows<DesignRow, int, long, long>(
      "SELECT design, row, position FROM design_rows WHERE campaign_id = ? ORDER BY design, row",
      campaign);
}

}  // namespace faultsweep
