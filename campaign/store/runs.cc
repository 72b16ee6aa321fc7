#include "campaign/common/names.h"
#include "campaign/store/checksums.h"
#include "campaign/store/clock.h"
#include "campaign/store/row_digest.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

std::vector<WaitingFamily> Store::waiting_families(std::int64_t campaign) const {
  std::vector<WaitingFamily> families;
  Statement query = connection_->prepared(
      "SELECT f.id, f.fingerprint, f.predicted_unknowns, f.predicted_jump_unknowns,"
      " f.predicted_operator_s, f.predicted_memory_bytes, coalesce(f.operator, ''), s.case_id,"
      " s.lacks_only_fields, f.n_operators FROM campaign_case_states s JOIN families f ON f.id = "
      "s.family_id"
      " WHERE s.campaign_id = ? AND (s.state = 'waiting'"
      " OR (s.lacks_only_fields AND s.fields = 'wanted')) ORDER BY f.id, s.position");
  query.bind(campaign);
  while (query.step()) {
    std::int64_t case_id = 0;
    bool fields_only = false;
    WaitingFamily family;
    FamilyRecord& predicted = family.predicted;
    query.read(family.family, predicted.fingerprint, predicted.unknowns, predicted.jump_unknowns,
               predicted.operator_seconds, predicted.memory_bytes, family.operator_fingerprint,
               case_id, fields_only, predicted.n_operators);
    if (families.empty() || families.back().family != family.family) {
      families.push_back(std::move(family));
    }
    families.back().cases.push_back(case_id);
    if (fields_only) families.back().fields_only.push_back(case_id);
  }
  for (WaitingFamily& family : families) {
    family.seconds_per_case = connection_->row<std::optional<double>>(
        "SELECT avg(r.wall_s) FROM cases c JOIN runs r ON r.id = c.run_id"
        " WHERE c.family_id = ? AND r.status = 'completed'",
        family.family);
  }
  return families;
}

CaseInput Store::case_input(std::int64_t campaign, std::int64_t case_id) const {
  return connection_->row<CaseInput, std::int64_t, std::int64_t, long, std::string, std::string>(
      "SELECT c.id, c.scene_id, cc.position, c.changes, c.identity FROM cases c"
      " JOIN campaign_cases cc ON cc.case_id = c.id AND cc.campaign_id = ? WHERE c.id = ?",
      campaign, case_id);
}

void Store::record_runs(std::int64_t campaign, const std::vector<RunRecord>& runs) {
  if (runs.empty()) return;
  try {
    Transaction transaction(*connection_);
    const double now = seconds_since_1970();
    for (const RunRecord& run : runs) record_run(campaign, run, now);
    transaction.commit();
  } catch (...) {
    names_.clear();  // some may have been rolled back
    throw;
  }
}

void Store::record_run(std::int64_t campaign, const RunRecord& run, double now) {
  FAULTSIM_DEMAND((run.status == RunStatus::completed) == run.result.has_value(), run.case_id);
  FAULTSIM_DEMAND(run.result || !run.has_fields, run.case_id);
  const auto [waiting, attempt] = connection_->row<std::tuple<bool, std::int64_t>>(
      "SELECT state = 'waiting', (SELECT coalesce(max(attempt), 0) + 1 FROM runs"
      " WHERE case_id = c.id) FROM cases c WHERE id = ?",
      run.case_id);
  if (!waiting && !run.fields_only) return;
  std::optional<std::string> outcome, used_operator;
  std::optional<int> numerics_version;
  if (run.result) {
    outcome = to_string(run.result->outcome);
    used_operator = run.result->operator_fingerprint;
    numerics_version = run.result->numerics_version;
  }
  connection_->run(
      "INSERT INTO runs (case_id, campaign_id, attempt, ended_at, wall_s, host, rank, status,"
      " outcome, reason, signal, exit_code, log_tail, operator, numerics_version, fields_only)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      run.case_id, campaign, attempt, now, run.wall_seconds, run.host, run.rank,
      to_string(run.status), outcome, run.reason, run.signal, run.exit_code, run.log_tail,
      used_operator, numerics_version, run.fields_only);
  const std::int64_t run_id = connection_->last_insert_id();
  if (run.result && !run.fields_only) {
    forget_result(run.case_id);
    checksums_->seal_result(run.case_id, record_result(run.case_id, run_id, *run.result));
  }
  if (run.final && !run.fields_only) {
    connection_->run("UPDATE cases SET state = ?, outcome = ?, run_id = ? WHERE id = ?",
                     run.result ? "done" : "failed", outcome, run_id, run.case_id);
  }
  if (run.has_fields || (run.fields_only && run.final)) {
    connection_->run("UPDATE campaign_cases SET fields = ? WHERE case_id = ? AND campaign_id = ?",
                     to_string(run.has_fields ? FieldsState::kept : FieldsState::failed),
                     run.case_id, campaign);
  }
}

void Store::record_operator(std::int64_t family, const OperatorRecord& record) {
  Transaction transaction(*connection_);
  using Seconds = std::optional<double>;
  connection_->run(
      "INSERT INTO operators (fingerprint, unknowns, jump_unknowns, bytes, peak_bytes, build_s,"
      " times_built, times_found, last_used_at) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)"
      " ON CONFLICT (fingerprint) DO UPDATE SET unknowns = ?2, jump_unknowns = ?3, bytes = ?4,"
      " peak_bytes = max(peak_bytes, ?5), build_s = coalesce(?6, build_s),"
      " times_built = times_built + ?7, times_found = times_found + ?8, last_used_at = ?9",
      record.fingerprint, record.unknowns, record.jump_unknowns, record.bytes, record.peak_bytes,
      record.from_cache ? Seconds() : Seconds(record.seconds), !record.from_cache,
      record.from_cache, seconds_since_1970());
  connection_->run("UPDATE families SET operator = ? WHERE id = ?", record.fingerprint, family);
  transaction.commit();
}

void Store::record_event(std::optional<std::int64_t> campaign, const std::string& kind,
                         const std::string& text) {
  connection_->run("INSERT INTO events (at, campaign_id, kind, text) VALUES (?, ?, ?, ?)",
                   seconds_since_1970(), campaign, kind, text);
}

}  // namespace faultsweep
