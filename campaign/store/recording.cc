#include <cmath>

#include "campaign/common/names.h"
#include "campaign/store/result_rows.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// A case's result as rows of its tables, and their removal.
namespace faultsweep {

using faultsim::Outcome;

int rank_class(Outcome outcome, bool activation_resolved) {
  if (!faultsim::in_equilibrium(outcome)) return outcome == Outcome::unstable ? 2 : 3;
  return activation_resolved && outcome != Outcome::unresolved_event ? 0 : 1;
}

void Store::forget_result(std::int64_t case_id) {
  Connection& db = *connection_;
  if (!db.find<int>("SELECT 1 FROM case_metrics WHERE case_id = ?", case_id)) return;
  // First what is found by rows that go later; by case alone where the key begins with it.
  const char* const of_faults =
      "fault_metrics WHERE stage_id IN (SELECT id FROM names) AND fault_id IN"
      " (SELECT fault_id FROM chi_history WHERE case_id = ?1) AND";
  for (const char* rows :
       {of_faults, "stage_metrics WHERE stage_id IN (SELECT id FROM names) AND",
        "slip_events WHERE", "episodes WHERE", "fault_onsets WHERE", "case_surfaces WHERE",
        "chi_history WHERE", "load_steps WHERE", "result_checksums WHERE", "case_metrics WHERE"}) {
    db.run(concat("DELETE FROM ", rows, " case_id = ?1"), case_id);
  }
  // Fields that campaigns kept are those of the result that goes.
  db.run("UPDATE campaign_cases SET fields = 'wanted' WHERE case_id = ? AND fields = 'kept'",
         case_id);
}

namespace {

/// A step that did not converge has no metrics.
std::size_t n_history_rows(const faultsim::StepResult& step) {
  return faultsim::in_equilibrium(step.outcome) ? step.faults.size() : 0;
}

/// Adds the rows of one result.
class ResultWriter {
 public:
  ResultWriter(Connection& db, const ResultTables& tables, const NameIds& ids, std::int64_t case_id)
      : db_(db), tables_(tables), ids_(ids), case_id_(case_id) {}
  void add_result(std::int64_t run_id, const CaseResult& result) {
    const auto& unexpected = result.unexpected;
    add_row(tables_.add_whole, tables_.whole, result, case_id_, run_id, result.steps.size(),
            result.episodes.size(), unexpected ? std::optional(unexpected->episode) : std::nullopt,
            unexpected ? std::optional(unexpected->after) : std::nullopt);
    if (result.surface) add_row(tables_.add_surface, tables_.surface, *result.surface, case_id_);
    add_stage(result.whole, result);
    for (const StageMetrics& stage : result.stages) add_stage(stage, result);
    add_list(tables_.add_event, tables_.event, result.events);
    add_list(tables_.add_episode, tables_.episode, result.episodes);
  }
  void add_histories(const CaseResult& result);
  const RowDigest& digest() const { return digest_; }

 private:
  template <typename Struct>
  void add_list(const RowInsert& insert, const RowFields<Struct>& fields,
                const std::vector<Struct>& list) {
    RowWriter add(db_, insert, digest_, list.size());
    int number = 0;
    for (const Struct& one : list) {
      add.begin(case_id_, ++number);
      fields.bind(add, &one, ids_);
      add.end();
    }
  }
  template <typename Struct, typename... Keys>
  void add_row(const RowInsert& insert, const RowFields<Struct>& fields, const Struct& one,
               const Keys&... keys) {
    RowWriter add(db_, insert, digest_, 1);
    add.begin(keys...);
    fields.bind(add, &one, ids_);
    add.end();
  }
  void add_stage(const StageMetrics& stage, const CaseResult& result);
  void add_onset(std::int64_t stage_id, bool opening, const std::string& fault,
                 const std::optional<faultsim::FaultOnset>& onset);
  void add_fault_histories(const CaseResult& result, std::size_t n_faults, std::size_t n_rows);

  Connection& db_;
  const ResultTables& tables_;
  const NameIds& ids_;
  std::int64_t case_id_;
  RowDigest digest_;
};

void ResultWriter::add_stage(const StageMetrics& stage, const CaseResult& result) {
  const double margin = result.pressure_margin;
  add_row(tables_.add_stage, tables_.stage, stage, case_id_,
          rank_class(result.outcome, stage.activation_resolved),
          std::isfinite(margin) ? std::optional(margin) : std::nullopt);
  const std::int64_t stage_id = ids_(stage.stage);
  RowWriter add_fault(db_, tables_.add_fault, digest_, stage.faults.size());
  for (std::size_t f = 0; f < stage.faults.size(); ++f) {
    const faultsim::FaultStageMetrics& fault = stage.faults[f];
    add_fault.begin(case_id_, stage_id, f, rank_class(result.outcome, fault.activation_resolved));
    tables_.fault.bind(add_fault, &fault, ids_);
    add_fault.end();
    add_onset(stage_id, false, fault.fault, fault.activation);
    add_onset(stage_id, true, fault.fault, fault.opening);
  }
}

void ResultWriter::add_onset(std::int64_t stage_id, bool opening, const std::string& fault,
                             const std::optional<faultsim::FaultOnset>& onset) {
  if (!onset) return;
  add_row(tables_.add_onset, tables_.onset, *onset, case_id_, stage_id, opening, ids_(fault));
}

void ResultWriter::add_histories(const CaseResult& result) {
  RowWriter add(db_, tables_.add_step, digest_, result.steps.size());
  std::size_t n_faults = 0, n_rows = 0;
  for (const faultsim::StepResult& step : result.steps) {
    add.begin(case_id_);
    tables_.step.bind(add, &step, ids_);
    tables_.step_creep.bind(add, step.creep ? &*step.creep : nullptr, ids_);
    add.end();
    n_faults = std::max(n_faults, n_history_rows(step));
    n_rows += n_history_rows(step);
  }
  FAULTSIM_DEMAND(n_faults <= result.fault_names.size(), n_faults);
  add_fault_histories(result, n_faults, n_rows);
}

/// In the order of the table: fault by fault.
void ResultWriter::add_fault_histories(const CaseResult& result, std::size_t n_faults,
                                       std::size_t n_rows) {
  RowWriter add(db_, tables_.add_history, digest_, n_rows);
  for (std::size_t k = 0; k < n_faults; ++k) {
    const std::int64_t fault = ids_(result.fault_names[k]);
    for (const faultsim::StepResult& step : result.steps) {
      if (k >= n_history_rows(step)) continue;
      const bool creeps = step.creep && k < step.creep->faults.size();
      add.begin(case_id_, k, step.step, fault);
      tables_.history.bind(add, &step.faults[k], ids_);
      tables_.history_creep.bind(add, creeps ? &step.creep->faults[k] : nullptr, ids_);
      add.end();
    }
  }
}

}  // namespace

RowDigest Store::record_result(std::int64_t case_id, std::int64_t run_id,
                               const CaseResult& result) {
  const NameIds ids = [this](const std::string& name) { return name_id(name); };
  ResultWriter writer(*connection_, result_tables(), ids, case_id);
  writer.add_result(run_id, result);
  writer.add_histories(result);
  return writer.digest();
}

const ResultTables& Store::result_tables() const {
  if (!tables_) tables_ = std::make_unique<ResultTables>(*connection_);
  return *tables_;
}

}  // namespace faultsweep
