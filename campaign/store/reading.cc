#include <algorithm>
#include <charconv>
#include <limits>

#include "campaign/store/fault_rows.h"
#include "campaign/store/read_counts.h"
#include "campaign/store/read_stage.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;

faultsim::StageMetrics read_stage_metrics(const Statement& row, int first) {
  faultsim::StageMetrics m;
  m.activated = row.integer(first) != 0;
  if (const auto step = row.optional_integer(first + 1))
    m.activation_step = static_cast<int>(*step);
  m.activated_fault = row.text(first + 2);
  if (const auto step = row.optional_integer(first + 3)) m.opening_step = static_cast<int>(*step);
  m.opened_fault = row.text(first + 20);
  m.chi_bar = row.real(first + 4);
  m.chi_max = row.real(first + 5);
  m.area_chi_080 = row.real(first + 6);
  m.thickness_chi_080 = row.real(first + 7);
  m.activated_area = row.real(first + 8);
  m.slipping_area = row.real(first + 9);
  m.open_area = row.real(first + 10);
  m.opens = m.open_area > 0;
  m.max_slip = row.real(first + 11);
  m.slips = m.max_slip > 0;
  m.potency = row.real(first + 12);
  m.moment = row.real(first + 13);
  m.magnitude_if_at_once = row.optional_real(first + 14);
  m.n_events = static_cast<int>(row.integer(first + 15));
  m.event_moment = row.real(first + 16);
  m.event_magnitude = row.optional_real(first + 17);
  m.first_step = static_cast<int>(row.integer(first + 18));
  m.last_step = static_cast<int>(row.integer(first + 19));
  m.activation_resolved = row.optional_integer(first + 21).value_or(0) != 0;
  return m;
}

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> numbers_of(const std::string& json_array) {
  std::vector<double> numbers;
  const char* at = json_array.data();
  const char* end = at + json_array.size();
  while (at < end) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error == std::errc()) {
      numbers.push_back(number);
      at = next;
    } else {
      ++at;
    }
  }
  return numbers;
}

std::optional<faultsim::StepCreep> read_step_creep(const Statement& row, int first) {
  const auto time_steps = row.optional_integer(first);
  if (!time_steps) return std::nullopt;
  return faultsim::StepCreep{
      static_cast<int>(*time_steps), row.real(first + 1), row.integer(first + 2) != 0, {}};
}

faultsim::FaultMetrics read_fault_metrics(const Statement& row) {
  faultsim::FaultMetrics m;
  m.chi_bar = row.real(3);
  m.chi_max = row.real(4);
  m.chi_static_max = row.real(5);
  m.area_chi_080 = row.real(6);
  m.thickness_chi_080_max = row.real(7);
  m.thickness_chi_080_mean = row.real(8);
  m.slipping_area = row.real(9);
  m.open_area = row.real(10);
  m.activated_area = row.real(11);
  m.activated_length = row.real(12);
  m.activated = row.integer(13) != 0;
  m.max_slip = row.real(14);
  m.mean_slip = row.real(15);
  m.potency = row.real(16);
  m.moment = row.real(17);
  m.moment_step = row.real(18);
  m.activated_at_edge = row.integer(19) != 0;
  m.activation_resolved = row.optional_integer(23).value_or(0) != 0;  // NULL: not known
  return m;
}

std::vector<StoredRun> read_runs(Connection& db, std::int64_t case_id) {
  std::vector<StoredRun> runs;
  Statement& query = db.prepared(
      "SELECT id, attempt, ended_at, wall_s, status, coalesce(outcome, ''), reason, log_tail,"
      " coalesce(operator, ''), host, rank, signal, exit_code, fields_only FROM runs WHERE case_id "
      "= ?"
      " ORDER BY attempt");
  query.bind(case_id);
  while (query.step()) {
    StoredRun run;
    run.id = query.integer(0);
    run.attempt = static_cast<int>(query.integer(1));
    run.ended_at = query.real(2);
    run.wall_seconds = query.real(3);
    run.status = query.text(4);
    run.outcome = query.text(5);
    run.reason = query.text(6);
    run.log_tail = query.text(7);
    run.operator_fingerprint = query.text(8);
    run.host = query.text(9);
    run.rank = static_cast<int>(query.integer(10));
    run.signal = query.optional_integer(11);
    run.exit_code = query.optional_integer(12);
    run.fields_only = query.integer(13) != 0;
    runs.push_back(std::move(run));
  }
  return runs;
}

void read_steps(Connection& db, std::int64_t case_id, CaseResult& result) {
  Statement& steps = db.prepared(
      "SELECT l.step, n.name, l.time_s, l.pressure_change_pa, l.outcome, l.reason, l.n_stick,"
      " l.n_slip, l.n_open, l.newton_iterations, l.active_set_passes, l.time_steps,"
      " l.time_error_pa, l.time_resolved FROM load_steps l"
      " JOIN names n ON n.id = l.stage_id WHERE l.case_id = ? ORDER BY l.step");
  steps.bind(case_id);
  while (steps.step()) {
    faultsim::StepResult step;
    step.step = static_cast<int>(steps.integer(0));
    step.stage = steps.text(1);
    step.time = steps.real(2);
    step.pressure_change = numbers_of(steps.text(3));
    step.outcome = faultsim::outcome_from_string(steps.text(4));
    step.reason = steps.text(5);
    step.n_stick = static_cast<int>(steps.integer(6));
    step.n_slip = static_cast<int>(steps.integer(7));
    step.n_open = static_cast<int>(steps.integer(8));
    step.counts.newton_iterations = static_cast<int>(steps.integer(9));
    step.counts.active_set_passes = static_cast<int>(steps.integer(10));
    step.creep = read_step_creep(steps, 11);
    result.steps.push_back(std::move(step));
  }
  Statement& faults = db.prepared(
      "SELECT h.fault, h.step, n.name, chi_bar, chi_max, chi_static_max, area_chi_080_m2,"
      " thickness_chi_080_max_m, thickness_chi_080_mean_m, slipping_area_m2, open_area_m2,"
      " activated_area_m2, activated_length_m, activated, max_slip_m, mean_slip_m, potency_m3,"
      " moment_nm, moment_step_nm, activated_at_edge, creep_normal_min_pa, creep_normal_max_pa,"
      " creep_shear_max_pa, activation_resolved FROM chi_history h JOIN names n ON n.id = "
      "h.fault_id"
      " WHERE h.case_id = ? ORDER BY h.fault, h.step");
  faults.bind(case_id);
  while (faults.step()) {
    const auto fault = static_cast<std::size_t>(faults.integer(0));
    if (result.fault_names.size() <= fault) result.fault_names.push_back(faults.text(2));
    for (faultsim::StepResult& step : result.steps) {
      if (step.step != faults.integer(1)) continue;
      step.faults.push_back(read_fault_metrics(faults));
      if (step.creep && faults.optional_real(20)) {
        step.creep->faults.push_back({faults.real(20), faults.real(21), faults.real(22)});
      }
    }
  }
}

void read_stages(Connection& db, std::int64_t case_id, CaseResult& result) {
  Statement& query = db.prepared(
      "SELECT n.name, s.activated, s.activation_step, coalesce(f.name, ''), s.opening_step,"
      " s.chi_bar, s.chi_max, s.area_chi_080_m2, s.thickness_chi_080_m, s.activated_area_m2,"
      " s.slipping_area_m2, s.open_area_m2, s.max_slip_m, s.potency_m3, s.moment_nm,"
      " s.magnitude_if_released_at_once_mw,"
      " s.n_events, s.event_moment_nm, s.event_magnitude_mw,"
      " s.first_step, s.last_step, coalesce(o.name, ''), s.activation_resolved, n.id"
      " FROM names n CROSS JOIN stage_metrics s ON s.stage_id = n.id"
      " LEFT JOIN names f ON f.id = s.activated_fault_id"
      " LEFT JOIN names o ON o.id = s.opened_fault_id WHERE s.case_id = ? ORDER BY "
      "s.first_step");
  query.bind(case_id);
  while (query.step()) {
    faultsim::StageMetrics stage = read_stage_metrics(query, 1);
    stage.stage = query.text(0);
    stage.faults = read_fault_rows(db, case_id, query.integer(23));
    if (stage.stage.empty()) {
      result.whole = std::move(stage);
    } else {
      result.stages.push_back(std::move(stage));
    }
  }
}

void read_slip_events(Connection& db, std::int64_t case_id, CaseResult& result) {
  Statement& query = db.prepared(
      "SELECT e.step, g.name, e.load_factor_before, e.load_factor_after, e.time_s,"
      " coalesce(f.name, ''), e.depth_m, e.nucleation_length_m,"
      " e.slipped_area_m2, e.max_slip_m, e.mean_slip_m, e.stress_drop_pa, e.potency_m3,"
      " e.moment_nm, e.magnitude_mw, e.duration_s, e.resolved, e.negative_pivots,"
      " e.n_lost_cohesion, e.residual_before, e.residual_after, e.energy_released_j,"
      " e.energy_dissipated_j, e.evidence_holds, coalesce(rm.name, ''), coalesce(rp.name, ''),"
      " e.change_minus_pa, e.change_plus_pa, e.absolute_minus_pa, e.absolute_plus_pa, "
      "e.change_in_fault_pa"
      " FROM slip_events e JOIN names g ON g.id ="
      " e.stage_id LEFT JOIN names f ON f.id = e.fault_id"
      " LEFT JOIN names rm ON rm.id = e.region_minus_id"
      " LEFT JOIN names rp ON rp.id = e.region_plus_id WHERE e.case_id = ? ORDER BY e.number");
  query.bind(case_id);
  while (query.step()) {
    faultsim::SlipEvent event;
    event.step = static_cast<int>(query.integer(0));
    event.stage = query.text(1);
    event.load_factor_before = query.real(2);
    event.load_factor_after = query.real(3);
    event.time = query.real(4);
    event.fault = query.text(5);
    event.depth = query.real(6);
    event.nucleation_length = query.real(7);
    event.slipped_area = query.real(8);
    event.max_slip = query.real(9);
    event.mean_slip = query.real(10);
    event.stress_drop = query.real(11);
    event.potency = query.real(12);
    event.moment = query.real(13);
    event.magnitude = query.optional_real(14);
    event.duration = query.real(15);
    event.resolved = query.integer(16) != 0;
    event.negative_pivots = static_cast<int>(query.integer(17));
    event.n_lost_cohesion = static_cast<int>(query.integer(18));
    event.residual_before = query.real(19);
    event.residual_after = query.real(20);
    event.energy_released = query.real(21);
    event.energy_dissipated = query.real(22);
    event.evidence_holds = query.integer(23) != 0;
    event.pressures = read_side_pressures(query, 24);
    result.events.push_back(std::move(event));
  }
}

void read_episodes(Connection& db, std::int64_t case_id, CaseResult& result) {
  Statement& query = db.prepared(
      "SELECT g.name, f.name, e.first_step, e.last_step, e.depth_m, e.after_recovery,"
      " e.activated_area_m2, e.max_slip_m, e.moment_nm, e.magnitude_if_released_at_once_mw,"
      " coalesce(rm.name, ''), coalesce(rp.name, ''), e.change_minus_pa, e.change_plus_pa,"
      " e.absolute_minus_pa, e.absolute_plus_pa, e.change_in_fault_pa FROM episodes e"
      " JOIN names g ON g.id = e.stage_id JOIN names f ON f.id = e.fault_id"
      " LEFT JOIN names rm ON rm.id = e.region_minus_id"
      " LEFT JOIN names rp ON rp.id = e.region_plus_id"
      " WHERE e.case_id = ? ORDER BY e.number");
  query.bind(case_id);
  while (query.step()) {
    faultsim::Episode episode;
    episode.stage = query.text(0);
    episode.fault = query.text(1);
    episode.first_step = static_cast<int>(query.integer(2));
    episode.last_step = static_cast<int>(query.integer(3));
    episode.depth = query.optional_real(4).value_or(kUnknown);
    episode.after_recovery = query.integer(5) != 0;
    episode.activated_area = query.real(6);
    episode.max_slip = query.real(7);
    episode.moment = query.real(8);
    episode.magnitude_if_at_once = query.optional_real(9);
    episode.pressures = read_side_pressures(query, 10);
    result.episodes.push_back(std::move(episode));
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

bool read_case_metrics(Connection& db, std::int64_t case_id, CaseResult& result) {
  Statement& query = db.prepared(
      "SELECT m.outcome, m.reason, m.failed_step, m.plane_strain, m.weakening_resolved,"
      " m.max_nucleation_ratio, m.pressure_margin_pa, m.newton_iterations, m.active_set_passes,"
      " m.sub_steps, m.wasted_newton_iterations, m.warnings, coalesce(r.operator, ''),"
      " coalesce(r.numerics_version, 0), r.wall_s, m.unexpected_episode,"
      " m.max_penetration_m, m.unexpected_after FROM case_metrics m JOIN runs r ON r.id = "
      "m.run_id"
      " WHERE m.case_id = ?");
  if (!query.bind(case_id).step()) return false;
  result.outcome = faultsim::outcome_from_string(query.text(0));
  result.reason = query.text(1);
  if (const auto step = query.optional_integer(2)) result.failed_step = static_cast<int>(*step);
  result.plane_strain = query.integer(3) != 0;
  result.weakening_resolved = query.integer(4) != 0;
  result.max_nucleation_ratio = query.optional_real(5).value_or(0);
  if (const auto margin = query.optional_real(6)) result.pressure_margin = *margin;
  result.counts = {static_cast<int>(query.integer(7)), static_cast<int>(query.integer(8)),
                   static_cast<int>(query.integer(9)), static_cast<int>(query.integer(10))};
  result.warnings = lines_of(query.text(11));
  result.operator_fingerprint = query.text(12);
  result.numerics_version = static_cast<int>(query.integer(13));
  result.seconds = query.real(14);
  if (const auto episode = query.optional_integer(15)) {
    result.unexpected =
        faultsim::Reactivation{static_cast<int>(*episode), static_cast<int>(query.integer(17))};
  }
  result.max_penetration = query.optional_real(16).value_or(kUnknown);
  query.reset();
  return true;
}

/// The row of the case named by its position or the beginning of its identity.
StoredCase find_case(Connection& db, std::int64_t campaign, const std::string& name) {
  long position = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), position);
  const bool is_number = error == std::errc() && end == name.data() + name.size();
  constexpr std::size_t kShortestPrefix = 6;
  constexpr const char* kColumns =
      "SELECT c.id, cc.position, c.identity, f.fingerprint, c.state, c.changes,"
      " cc.parameter_values, cc.parameter_labels, c.scene_id, cc.fields, k.name FROM "
      "campaign_cases cc"
      " JOIN campaigns k ON k.id = cc.campaign_id JOIN cases c ON c.id = cc.case_id JOIN families "
      "f ON f.id = c.family_id"
      " WHERE cc.campaign_id = ?1 AND ";
  Statement query(db, concat(kColumns, is_number ? "cc.position = ?2"
                                                 : "c.identity >= ?2 AND c.identity < ?2 || '~'")
                          .c_str());
  query.bind_at(1, campaign);
  if (is_number) {
    query.bind_at(2, position);
  } else {
    query.bind_at(2, name);
  }
  if ((!is_number && name.size() < kShortestPrefix) || !query.step()) {
    throw faultsim::InputError("CASE", {{"", 0, concat("the campaign has no case '", name, "'"),
                                         concat("give its number from 1, or at least ",
                                                kShortestPrefix, " digits of its identity")}});
  }
  StoredCase found;
  found.id = query.integer(0);
  found.position = query.integer(1);
  found.identity = query.text(2);
  found.family = query.text(3);
  found.state = query.text(4);
  found.changes = query.text(5);
  found.parameter_values = query.text(6);
  found.parameter_labels = query.text(7);
  found.scene = query.integer(8);
  found.fields = fields_state_from_string(query.text(9));
  found.fields_folder = query.text(10);
  return found;
}

}  // namespace

StoredCase Store::stored_case(std::int64_t campaign, const std::string& name) const {
  Connection& db = *connection_;
  StoredCase found = find_case(db, campaign, name);
  found.fields_folder = fields_folder(found.fields_folder.string(), found.position);
  found.runs = read_runs(db, found.id);
  if (auto result = stored_result(found.id)) {
    found.has_result = true;
    found.result = std::move(*result);
  }
  found.result.identity = found.identity;
  return found;
}

std::optional<CaseResult> Store::stored_result(std::int64_t case_id) const {
  Connection& db = *connection_;
  CaseResult result;
  if (!read_case_metrics(db, case_id, result)) return std::nullopt;
  read_steps(db, case_id, result);
  read_stages(db, case_id, result);
  read_slip_events(db, case_id, result);
  read_episodes(db, case_id, result);
  return result;
}

std::vector<FailureCount> Store::failure_counts(std::int64_t campaign) const {
  std::vector<FailureCount> counts;
  Statement& query = connection_->prepared(
      "SELECT status, why, count(*) FROM ("
      "SELECT r.status, CASE WHEN r.outcome IS NULL THEN r.reason ELSE r.outcome END AS why"
      " FROM campaign_case_states s JOIN runs r ON r.id = s.run_id WHERE s.campaign_id = ?1"
      " AND s.state <> 'waiting' AND NOT s.lacks_only_fields AND NOT s.complete"
      " UNION ALL SELECT r.status, 'fields: ' || r.reason FROM campaign_case_states s"
      " JOIN runs r ON r.case_id = s.case_id WHERE s.campaign_id = ?1 AND s.state = 'failed'"
      " AND s.lacks_only_fields AND r.campaign_id = ?1 AND r.fields_only"
      " AND NOT EXISTS (SELECT 1 FROM runs later WHERE later.case_id = r.case_id"
      " AND later.campaign_id = ?1 AND later.fields_only AND later.attempt > r.attempt))"
      " GROUP BY 1, 2 ORDER BY 3 DESC, 1, 2 LIMIT 20");
  query.bind(campaign);
  while (query.step())
    counts.push_back({query.text(0), query.text(1), static_cast<long>(query.integer(2))});
  return counts;
}

std::vector<EventRecord> Store::events(std::int64_t campaign, int limit) const {
  std::vector<EventRecord> all;
  Statement& query = connection_->prepared(
      "SELECT at, kind, text FROM events WHERE campaign_id = ? ORDER BY id DESC LIMIT ?");
  query.bind(campaign, limit);
  while (query.step()) all.push_back({query.real(0), query.text(1), query.text(2)});
  return all;
}

std::vector<Store::FamilyProgress> Store::family_progress(std::int64_t campaign) const {
  std::vector<FamilyProgress> all;
  Statement& query = connection_->prepared(
      "SELECT f.fingerprint, coalesce(f.operator, ''), o.build_s, f.n_operators,"
      " f.predicted_memory_bytes, o.peak_bytes FROM families f"
      " LEFT JOIN operators o ON o.fingerprint = f.operator WHERE f.id = ?");
  for (const auto& [family, counts] : count_by_family(*connection_, campaign)) {
    FAULTSIM_DEMAND(query.bind(family).step(), family);
    FamilyProgress one;
    static_cast<CaseCounts&>(one) = counts;
    one.fingerprint = query.text(0);
    one.operator_fingerprint = query.text(1);
    one.build_seconds = query.optional_real(2);
    one.n_operators = static_cast<int>(query.integer(3));
    one.memory_bytes = query.real(4);
    one.peak_bytes = query.optional_integer(5);
    all.push_back(std::move(one));
  }
  query.reset();
  return all;
}

std::vector<std::string> Store::campaigns_with(std::int64_t case_id) const {
  std::vector<std::string> names;
  Statement& query = connection_->prepared(
      "SELECT k.name FROM campaign_cases cc JOIN campaigns k ON k.id = cc.campaign_id"
      " WHERE cc.case_id = ? ORDER BY k.id");
  query.bind(case_id);
  while (query.step()) names.push_back(query.text(0));
  return names;
}

}  // namespace faultsweep
