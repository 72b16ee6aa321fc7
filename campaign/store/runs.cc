#include "campaign/store/checksums.h"
#include "campaign/store/clock.h"
#include "campaign/store/name_cache.h"
#include "campaign/store/row_digest.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;

const char* to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::refused:
      return "refused";
    case RunStatus::crashed:
      return "crashed";
    case RunStatus::hung:
      return "hung";
    case RunStatus::garbled:
      return "garbled";
    case RunStatus::memory:
      return "memory";
    case RunStatus::world:
      return "world";
    case RunStatus::bug:
      return "bug";
  }
  FAULTSIM_DEMAND(false, static_cast<int>(status));
  return "";
}

std::vector<WaitingFamily> Store::waiting_families(std::int64_t campaign) const {
  std::vector<WaitingFamily> families;
  Statement query = connection_->prepared(
      "SELECT f.id, f.fingerprint, f.predicted_unknowns, f.predicted_jump_unknowns,"
      " f.predicted_operator_s, f.predicted_memory_bytes, coalesce(f.operator, ''), s.case_id,"
      " s.lacks_only_fields, f.n_operators FROM campaign_case_states s JOIN families f ON f.id = "
      "s.family_id"
      " WHERE s.campaign_id = ? AND s.state = 'waiting' ORDER BY f.id, s.position");
  query.bind(campaign);
  while (query.step()) {
    if (families.empty() || families.back().family != query.integer(0)) {
      WaitingFamily family;
      family.family = query.integer(0);
      family.predicted = {query.text(1),
                          static_cast<long>(query.integer(2)),
                          static_cast<long>(query.integer(3)),
                          query.real(4),
                          query.real(5),
                          static_cast<int>(query.integer(9))};
      family.operator_fingerprint = query.text(6);
      families.push_back(std::move(family));
    }
    families.back().cases.push_back(query.integer(7));
    if (query.integer(8) != 0) families.back().fields_only.push_back(query.integer(7));
  }
  Statement cost = connection_->prepared(
      "SELECT avg(r.wall_s) FROM cases c JOIN runs r ON r.id = c.run_id"
      " WHERE c.family_id = ? AND r.status = 'completed'");
  for (WaitingFamily& family : families) {
    if (cost.bind(family.family).step()) family.seconds_per_case = cost.optional_real(0);
  }
  return families;
}

long Store::requeue_missing_fields(const CampaignInfo& campaign) {
  if (campaign.keep_fields == KeepFields::none) return 0;
  Transaction transaction(*connection_);
  Statement query = connection_->prepared(
      "SELECT position FROM campaign_cases WHERE campaign_id = ? AND fields = 'kept'");
  query.bind(campaign.id);
  std::vector<long> lost;
  while (query.step()) {
    const auto folder = fields_folder(campaign.name, query.integer(0));
    std::error_code error;  // what cannot be looked at is as good as gone
    const bool there = std::filesystem::exists(folder / "faults.h5", error) &&
                       std::filesystem::exists(folder / "faults.xmf", error);
    if (!there) lost.push_back(query.integer(0));
  }
  for (const long position : lost) {
    connection_
        ->prepared(
            "UPDATE campaign_cases SET fields = 'wanted' WHERE campaign_id = ? AND position = ?")
        .bind(campaign.id, position)
        .run();
  }
  transaction.commit();
  return static_cast<long>(lost.size());
}

CaseInput Store::case_input(std::int64_t campaign, std::int64_t case_id) const {
  Statement query = connection_->prepared(
      "SELECT c.scene_id, cc.position, c.changes, c.identity FROM cases c JOIN campaign_cases cc"
      " ON cc.case_id = c.id AND cc.campaign_id = ?2 WHERE c.id = ?1");
  FAULTSIM_DEMAND(query.bind(case_id, campaign).step(), case_id);
  CaseInput input{case_id, query.integer(0), static_cast<long>(query.integer(1)), query.text(2),
                  query.text(3)};
  return input;
}

void Store::record_runs(std::int64_t campaign, const std::vector<RunRecord>& runs) {
  if (runs.empty()) return;
  names_->begin();
  try {
    Transaction transaction(*connection_);
    const double now = seconds_since_1970();
    for (const RunRecord& run : runs) record_run(campaign, run, now);
    transaction.commit();
  } catch (...) {
    names_->roll_back();
    throw;
  }
}

void Store::record_run(std::int64_t campaign, const RunRecord& run, double now) {
  FAULTSIM_DEMAND((run.status == RunStatus::completed) == run.result.has_value(), run.case_id);
  FAULTSIM_DEMAND(run.result || !run.has_fields, run.case_id);
  Statement state = connection_->prepared(
      "SELECT state, (SELECT coalesce(max(attempt), 0) FROM runs WHERE case_id = c.id)"
      " FROM cases c WHERE id = ?");
  FAULTSIM_DEMAND(state.bind(run.case_id).step(), run.case_id);
  const bool waiting = state.text(0) == "waiting";
  const std::int64_t attempt = state.integer(1) + 1;
  if (!waiting && !run.fields_only) return;
  const std::int64_t run_id = add_run(campaign, run, attempt, now);
  if (!run.fields_only) decide_case(run, run_id);
  if (run.has_fields || (run.fields_only && run.final)) decide_fields(campaign, run);
}

std::int64_t Store::add_run(std::int64_t campaign, const RunRecord& run, std::int64_t attempt,
                            double now) {
  const CaseResult* result = run.result ? &*run.result : nullptr;
  using Text = std::optional<std::string>;
  connection_
      ->prepared(
          "INSERT INTO runs (case_id, campaign_id, attempt, ended_at, wall_s, host, rank, status,"
          " outcome, reason, signal, exit_code, log_tail, operator, numerics_version, fields_only)"
          " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(run.case_id, campaign, attempt, now, run.wall_seconds, run.host, run.rank,
            to_string(run.status), result ? Text(faultsim::to_string(result->outcome)) : Text(),
            run.reason, run.signal, run.exit_code, run.log_tail,
            result ? Text(result->operator_fingerprint) : Text(),
            result ? std::optional(result->numerics_version) : std::nullopt, run.fields_only)
      .run();
  return connection_->last_insert_id();
}

void Store::decide_case(const RunRecord& run, std::int64_t run_id) {
  const CaseResult* result = run.result ? &*run.result : nullptr;
  using Text = std::optional<std::string>;
  if (result != nullptr) {
    forget_result(run.case_id);
    checksums_->seal_result(run.case_id, record_result(run.case_id, run_id, *result));
  }
  if (!run.final) return;
  connection_->prepared("UPDATE cases SET state = ?, outcome = ?, run_id = ? WHERE id = ?")
      .bind(result != nullptr ? "done" : "failed",
            result ? Text(faultsim::to_string(result->outcome)) : Text(), run_id, run.case_id)
      .run();
}

void Store::decide_fields(std::int64_t campaign, const RunRecord& run) {
  connection_
      ->prepared("UPDATE campaign_cases SET fields = ? WHERE case_id = ? AND campaign_id = ?")
      .bind(to_string(run.has_fields ? FieldsState::kept : FieldsState::failed), run.case_id,
            campaign)
      .run();
}

void Store::record_operator(std::int64_t family, const OperatorRecord& record) {
  Transaction transaction(*connection_);
  using Seconds = std::optional<double>;
  connection_
      ->prepared(
          "INSERT INTO operators (fingerprint, unknowns, jump_unknowns, bytes, peak_bytes, build_s,"
          " times_built, times_found, last_used_at) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)"
          " ON CONFLICT (fingerprint) DO UPDATE SET unknowns = ?2, jump_unknowns = ?3, bytes = ?4,"
          " peak_bytes = max(peak_bytes, ?5), build_s = coalesce(?6, build_s),"
          " times_built = times_built + ?7, times_found = times_found + ?8, last_used_at = ?9")
      .bind(record.fingerprint, record.unknowns, record.jump_unknowns, record.bytes,
            record.peak_bytes, record.from_cache ? Seconds() : Seconds(record.seconds),
            record.from_cache ? 0 : 1, record.from_cache ? 1 : 0, seconds_since_1970())
      .run();
  connection_->prepared("UPDATE families SET operator = ? WHERE id = ?")
      .bind(record.fingerprint, family)
      .run();
  transaction.commit();
}

void Store::record_event(std::optional<std::int64_t> campaign, const std::string& kind,
                         const std::string& text) {
  connection_->prepared("INSERT INTO events (at, campaign_id, kind, text) VALUES (?, ?, ?, ?)")
      .bind(seconds_since_1970(), campaign, kind, text)
      .run();
}

}  // namespace faultsweep
