#include <cmath>

#include "campaign/store/name_cache.h"
#include "campaign/store/result_rows.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// A case's result as rows of its tables, and their removal.
namespace faultsweep {

using faultsim::CaseResult;
using faultsim::Outcome;
using faultsim::StageMetrics;

namespace {

/// See stage_metrics in schemas/store_3.sql and store_10.sql.
int rank_class(Outcome outcome, bool activation_resolved) {
  switch (outcome) {
    case Outcome::converged:
    case Outcome::event:
      return activation_resolved ? 0 : 1;
    case Outcome::unresolved_event:
      return 1;
    case Outcome::unstable:
      return 2;
    case Outcome::failed:
    case Outcome::unconverged:
    case Outcome::interrupted:
      return 3;
  }
  FAULTSIM_DEMAND(false, static_cast<int>(outcome));
  return 3;
}

}  // namespace

void Store::forget_result(std::int64_t case_id) {
  Connection& db = *connection_;
  if (!db.prepared("SELECT 1 FROM case_metrics WHERE case_id = ?").bind(case_id).step()) return;
  db.prepared("DELETE FROM slip_events WHERE case_id = ?").bind(case_id).run();
  db.prepared("DELETE FROM episodes WHERE case_id = ?").bind(case_id).run();
  db.prepared("DELETE FROM fault_onsets WHERE case_id = ?").bind(case_id).run();
  forget_fault_metrics(case_id);
  db.prepared("DELETE FROM chi_history WHERE case_id = ?").bind(case_id).run();
  db.prepared("DELETE FROM load_steps WHERE case_id = ?").bind(case_id).run();
  db.prepared("DELETE FROM stage_metrics WHERE stage_id IN (SELECT id FROM names) AND case_id = ?")
      .bind(case_id)
      .run();
  db.prepared("DELETE FROM result_checksums WHERE case_id = ?").bind(case_id).run();
  db.prepared("DELETE FROM case_metrics WHERE case_id = ?").bind(case_id).run();
  // Fields that campaigns kept are those of the result that goes.
  db.prepared("UPDATE campaign_cases SET fields = 'wanted' WHERE case_id = ? AND fields = 'kept'")
      .bind(case_id)
      .run();
}

void Store::record_result(std::int64_t case_id, std::int64_t run_id, const CaseResult& result) {
  const ResultTables& tables = result_tables();
  Statement add = connection_->prepared(tables.add_whole);
  const auto& unexpected = result.unexpected;
  add.bind(case_id, run_id, result.steps.size(), result.episodes.size(),
           unexpected ? std::optional(unexpected->episode) : std::nullopt,
           unexpected ? std::optional(unexpected->after) : std::nullopt);
  int bound = 6;
  tables.whole.bind(add, bound, &result, name_ids());
  add.run();
  record_stage(case_id, result.whole, result);
  for (const StageMetrics& stage : result.stages) record_stage(case_id, stage, result);
  record_list(case_id, tables.add_event, tables.event, result.events);
  record_list(case_id, tables.add_episode, tables.episode, result.episodes);
}

template <typename Struct>
void Store::record_list(std::int64_t case_id, const std::string& sql,
                        const RowFields<Struct>& fields, const std::vector<Struct>& list) {
  Statement add = connection_->prepared(sql);
  int number = 0;
  for (const Struct& one : list) {
    add.bind(case_id, ++number);
    int bound = 2;
    fields.bind(add, bound, &one, name_ids());
    add.run();
  }
}

void Store::record_stage(std::int64_t case_id, const StageMetrics& stage,
                         const CaseResult& result) {
  const ResultTables& tables = result_tables();
  Statement add = connection_->prepared(tables.add_stage);
  const double margin = result.pressure_margin;
  add.bind(case_id, rank_class(result.outcome, stage.activation_resolved),
           std::isfinite(margin) ? std::optional(margin) : std::nullopt);
  int bound = 3;
  tables.stage.bind(add, bound, &stage, name_ids());
  add.run();
  const std::int64_t stage_id = name_id(stage.stage);
  Statement add_fault = connection_->prepared(tables.add_fault);
  for (std::size_t f = 0; f < stage.faults.size(); ++f) {
    const faultsim::FaultStageMetrics& fault = stage.faults[f];
    add_fault.bind(case_id, stage_id, f, rank_class(result.outcome, fault.activation_resolved));
    bound = 4;
    tables.fault.bind(add_fault, bound, &fault, name_ids());
    add_fault.run();
    record_onset(case_id, stage_id, false, fault.fault, fault.activation);
    record_onset(case_id, stage_id, true, fault.fault, fault.opening);
  }
}

void Store::record_onset(std::int64_t case_id, std::int64_t stage_id, bool opening,
                         const std::string& fault,
                         const std::optional<faultsim::FaultOnset>& onset) {
  if (!onset) return;
  const ResultTables& tables = result_tables();
  Statement add = connection_->prepared(tables.add_onset);
  add.bind(case_id, stage_id, opening, name_id(fault));
  int bound = 4;
  tables.onset.bind(add, bound, &*onset, name_ids());
  add.run();
}

void Store::record_histories(std::int64_t case_id, const CaseResult& result) {
  const ResultTables& tables = result_tables();
  Statement add_step = connection_->prepared(tables.add_step);
  Statement add_fault = connection_->prepared(tables.add_history);
  std::vector<std::int64_t> faults;
  for (const std::string& name : result.fault_names) faults.push_back(name_id(name));
  for (const faultsim::StepResult& step : result.steps) {
    const faultsim::StepCreep* creep = step.creep ? &*step.creep : nullptr;
    add_step.bind(case_id);
    int bound = 1;
    tables.step.bind(add_step, bound, &step, name_ids());
    tables.step_creep.bind(add_step, bound, creep, name_ids());
    add_step.run();
    // A step that did not converge has no metrics.
    if (!faultsim::in_equilibrium(step.outcome)) continue;
    FAULTSIM_DEMAND(step.faults.size() <= faults.size(), step.faults.size());
    for (std::size_t k = 0; k < step.faults.size(); ++k) {
      const bool creeps = creep != nullptr && k < creep->faults.size();
      add_fault.bind(case_id, k, step.step, faults[k]);
      bound = 4;
      tables.history.bind(add_fault, bound, &step.faults[k], name_ids());
      tables.history_creep.bind(add_fault, bound, creeps ? &creep->faults[k] : nullptr, name_ids());
      add_fault.run();
    }
  }
}

/// Before the rows of stage_metrics and chi_history go, which say which there are.
void Store::forget_fault_metrics(std::int64_t case_id) {
  connection_
      ->prepared(
          "DELETE FROM fault_metrics WHERE stage_id IN (SELECT id FROM names) AND fault_id IN"
          " (SELECT fault_id FROM chi_history WHERE case_id = ?1) AND case_id = ?1")
      .bind(case_id)
      .run();
}

const ResultTables& Store::result_tables() const {
  if (!tables_) tables_ = std::make_unique<ResultTables>(*connection_);
  return *tables_;
}

NameIds Store::name_ids() {
  return [this](const std::string& name) { return name_id(name); };
}

}  // namespace faultsweep
