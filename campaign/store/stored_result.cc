#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "campaign/store/store.h"

/// Results as they come back from their tables.
namespace faultsweep {

using faultsim::FaultStageMetrics;

FaultStageMetrics read_fault_row(Connection& db, const ResultTables& tables, std::int64_t case_id,
                                 std::int64_t stage_id, std::int64_t fault_id) {
  Statement query = db.prepared(tables.read_fault);
  FaultStageMetrics fault;
  if (!query.bind(stage_id, fault_id, case_id).step()) return fault;
  int column = 1;
  tables.fault.read(query, column, fault);
  if (!fault.activated && !fault.opens) return fault;
  Statement onsets = db.prepared(tables.read_onsets);
  onsets.bind(stage_id, fault_id, case_id);
  while (onsets.step()) {
    auto& onset = onsets.integer(0) != 0 ? fault.opening : fault.activation;
    column = 1;
    tables.onset.read(onsets, column, onset.emplace());
  }
  return fault;
}

namespace {

void read_steps(Connection& db, const ResultTables& tables, std::int64_t case_id,
                CaseResult& result) {
  Statement steps = db.prepared(concat("SELECT l.time_steps", tables.step.selected("l"),
                                       tables.step_creep.selected("l"),
                                       " FROM load_steps l WHERE l.case_id = ? ORDER BY l.step"));
  steps.bind(case_id);
  while (steps.step()) {
    faultsim::StepResult& step = result.steps.emplace_back();
    int column = 1;
    tables.step.read(steps, column, step);
    if (steps.get<std::optional<int>>(0))
      tables.step_creep.read(steps, column, step.creep.emplace());
  }
  Statement faults =
      db.prepared(concat("SELECT h.fault, h.step, n.name, h.creep_normal_min_pa",
                         tables.history.selected("h"), tables.history_creep.selected("h"),
                         " FROM chi_history h JOIN names n ON n.id = h.fault_id WHERE h.case_id = ?"
                         " ORDER BY h.fault, h.step"));
  faults.bind(case_id);
  while (faults.step()) {
    const auto fault = static_cast<std::size_t>(faults.integer(0));
    if (result.fault_names.size() <= fault) result.fault_names.push_back(faults.text(2));
    for (faultsim::StepResult& step : result.steps) {
      if (step.step != faults.integer(1)) continue;
      int column = 4;
      tables.history.read(faults, column, step.faults.emplace_back());
      if (step.creep && faults.get<std::optional<double>>(3))
        tables.history_creep.read(faults, column, step.creep->faults.emplace_back());
    }
  }
}

void read_stages(Connection& db, const ResultTables& tables, std::int64_t case_id,
                 CaseResult& result) {
  const auto faults = db.rows<std::int64_t>(
      "SELECT fault_id FROM chi_history WHERE case_id = ?1 AND step = (SELECT min(step) FROM"
      " load_steps WHERE case_id = ?1) ORDER BY fault",  // the order of the scene
      case_id);
  Statement query = db.prepared(
      concat("SELECT n.id", tables.stage.selected("s"),
             " FROM names n CROSS JOIN stage_metrics s ON s.stage_id = n.id WHERE s.case_id = ?"
             " ORDER BY s.first_step"));
  query.bind(case_id);
  while (query.step()) {
    faultsim::StageMetrics stage;
    int column = 1;
    tables.stage.read(query, column, stage);
    for (const std::int64_t fault : faults) {
      FaultStageMetrics one = read_fault_row(db, tables, case_id, query.integer(0), fault);
      if (!one.fault.empty()) stage.faults.push_back(std::move(one));
    }
    if (stage.stage.empty()) {
      result.whole = std::move(stage);
    } else {
      result.stages.push_back(std::move(stage));
    }
  }
}

std::optional<faultsim::CaseSurface> read_surface(Connection& db, const ResultTables& tables,
                                                  std::int64_t case_id) {
  Statement query = db.prepared(concat("SELECT q.case_id", tables.surface.selected("q"),
                                       " FROM case_surfaces q WHERE q.case_id = ?"));
  if (!query.bind(case_id).step()) return std::nullopt;
  faultsim::CaseSurface surface;
  int column = 1;
  tables.surface.read(query, column, surface);
  return surface;
}

template <typename Struct>
std::vector<Struct> read_list(Connection& db, const char* table, const RowFields<Struct>& fields,
                              std::int64_t case_id) {
  Statement query = db.prepared(concat("SELECT e.number", fields.selected("e"), " FROM ", table,
                                       " e WHERE e.case_id = ? ORDER BY e.number"));
  query.bind(case_id);
  std::vector<Struct> list;
  while (query.step()) {
    int column = 1;
    fields.read(query, column, list.emplace_back());
  }
  return list;
}

}  // namespace

std::optional<CaseResult> Store::stored_result(std::int64_t case_id) const {
  Connection& db = *connection_;
  const ResultTables& tables = result_tables();
  Statement query = db.prepared(
      concat("SELECT coalesce(r.operator, ''), coalesce(r.numerics_version, 0), r.wall_s,"
             " m.unexpected_episode, m.unexpected_after",
             tables.whole.selected("m"),
             " FROM case_metrics m JOIN runs r ON r.id = m.run_id WHERE m.case_id = ?"));
  if (!query.bind(case_id).step()) return std::nullopt;
  CaseResult result;
  int column = 5;
  tables.whole.read(query, column, result);
  std::optional<int> episode;
  query.read(result.operator_fingerprint, result.numerics_version, result.seconds, episode);
  if (episode) result.unexpected = faultsim::Reactivation{*episode, query.get<int>(4)};
  result.surface = read_surface(db, tables, case_id);
  read_steps(db, tables, case_id, result);
  read_stages(db, tables, case_id, result);
  result.events = read_list(db, "slip_events", tables.event, case_id);
  result.episodes = read_list(db, "episodes", tables.episode, case_id);
  return result;
}

}  // namespace faultsweep
