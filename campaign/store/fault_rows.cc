#include "campaign/store/fault_rows.h"

#include <limits>

#include "campaign/store/store.h"

/// Metrics per fault and stage: fault_metrics, fault_onsets.
namespace faultsweep {

using faultsim::FaultOnset;
using faultsim::FaultStageMetrics;
using faultsim::SidePressures;

SidePressures read_side_pressures(const Statement& row, int first) {
  return {row.text(first),
          row.text(first + 1),
          row.optional_real(first + 2),
          row.optional_real(first + 3),
          row.optional_real(first + 4),
          row.optional_real(first + 5),
          row.optional_real(first + 6).value_or(std::numeric_limits<double>::quiet_NaN())};
}

namespace {

FaultStageMetrics read_metrics(const Statement& row) {
  FaultStageMetrics m;
  m.fault = row.text(0);
  m.activated = row.integer(1) != 0;
  m.chi_bar = row.real(2);
  m.chi_max = row.real(3);
  m.area_chi_080 = row.real(4);
  m.thickness_chi_080 = row.real(5);
  m.activated_area = row.real(6);
  m.slipping_area = row.real(7);
  m.open_area = row.real(8);
  m.max_slip = row.real(9);
  m.potency = row.real(10);
  m.moment = row.real(11);
  m.n_events = static_cast<int>(row.integer(12));
  m.event_moment = row.real(13);
  m.event_magnitude = row.optional_real(14);
  m.activation_resolved = row.optional_integer(15).value_or(0) != 0;  // NULL: not known
  m.slips = m.max_slip > 0;
  m.opens = m.open_area > 0;
  return m;
}

void read_onsets(Connection& db, std::int64_t case_id, std::int64_t stage_id, std::int64_t fault_id,
                 FaultStageMetrics& fault) {
  if (!fault.activated && !fault.opens) return;
  Statement& query = db.prepared(
      "SELECT o.opening, o.step, o.depth_m, coalesce(rm.name, ''), coalesce(rp.name, ''),"
      " o.change_minus_pa, o.change_plus_pa, o.absolute_minus_pa, o.absolute_plus_pa,"
      " o.change_in_fault_pa"
      " FROM fault_onsets o LEFT JOIN names rm ON rm.id = o.region_minus_id"
      " LEFT JOIN names rp ON rp.id = o.region_plus_id"
      " WHERE o.case_id = ? AND o.stage_id = ? AND o.fault_id = ?");
  query.bind(case_id, stage_id, fault_id);
  while (query.step()) {
    (query.integer(0) != 0 ? fault.opening : fault.activation) = FaultOnset{
        static_cast<int>(query.integer(1)), query.real(2), read_side_pressures(query, 3)};
  }
}

}  // namespace

std::vector<FaultStageMetrics> read_fault_rows(Connection& db, std::int64_t case_id,
                                               std::int64_t stage_id) {
  std::vector<std::int64_t> ids;
  Statement& faults = db.prepared(
      "SELECT fault_id FROM chi_history WHERE case_id = ?1 AND step = (SELECT min(step) FROM"
      " load_steps WHERE case_id = ?1) ORDER BY fault");
  faults.bind(case_id);
  while (faults.step()) ids.push_back(faults.integer(0));
  std::vector<FaultStageMetrics> all;
  for (const std::int64_t id : ids) {
    FaultStageMetrics one = read_fault_row(db, case_id, stage_id, id);
    if (!one.fault.empty()) all.push_back(std::move(one));
  }
  return all;
}

FaultStageMetrics read_fault_row(Connection& db, std::int64_t case_id, std::int64_t stage_id,
                                 std::int64_t fault_id) {
  Statement& query = db.prepared(
      "SELECT f.name, q.activated, q.chi_bar, q.chi_max, q.area_chi_080_m2, q.thickness_chi_080_m,"
      " q.activated_area_m2, q.slipping_area_m2, q.open_area_m2, q.max_slip_m, q.potency_m3,"
      " q.moment_nm, q.n_events, q.event_moment_nm, q.event_magnitude_mw,"
      " q.activation_resolved FROM fault_metrics q"
      " JOIN names f ON f.id = q.fault_id"
      " WHERE q.stage_id = ? AND q.fault_id = ? AND q.case_id = ?");
  FaultStageMetrics fault;
  if (query.bind(stage_id, fault_id, case_id).step()) {
    fault = read_metrics(query);
    read_onsets(db, case_id, stage_id, fault_id, fault);
  }
  query.reset();
  return fault;
}

void Store::record_fault(std::int64_t case_id, std::int64_t stage_id, std::size_t position,
                         int rank_class, const FaultStageMetrics& m) {
  Statement& add = connection_->prepared(
      "INSERT INTO fault_metrics (stage_id, fault_id, case_id, fault, rank_class, activated,"
      " chi_bar, chi_max, area_chi_080_m2, thickness_chi_080_m, activated_area_m2,"
      " slipping_area_m2, open_area_m2, max_slip_m, potency_m3, moment_nm, n_events,"
      " event_moment_nm, event_magnitude_mw, activation_resolved)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  const std::int64_t fault_id = name_id(m.fault);
  add.bind(stage_id, fault_id, case_id, position, rank_class, m.activated, m.chi_bar, m.chi_max,
           m.area_chi_080, m.thickness_chi_080, m.activated_area, m.slipping_area, m.open_area,
           m.max_slip, m.potency, m.moment, m.n_events, m.event_moment, m.event_magnitude,
           m.activation_resolved)
      .run();
  record_onset(case_id, stage_id, false, fault_id, m.activation);
  record_onset(case_id, stage_id, true, fault_id, m.opening);
}

void Store::record_onset(std::int64_t case_id, std::int64_t stage_id, bool opening,
                         std::int64_t fault_id, const std::optional<FaultOnset>& onset) {
  if (!onset) return;
  const SidePressures& p = onset->pressures;
  connection_
      ->prepared(
          "INSERT INTO fault_onsets (case_id, stage_id, opening, fault_id, step, depth_m,"
          " region_minus_id, region_plus_id, change_minus_pa, change_plus_pa, absolute_minus_pa,"
          " absolute_plus_pa, change_in_fault_pa) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(case_id, stage_id, opening, fault_id, onset->step, onset->depth,
            optional_name_id(p.region_minus), optional_name_id(p.region_plus), p.change_minus,
            p.change_plus, p.absolute_minus, p.absolute_plus, p.change_in_fault)
      .run();
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

std::optional<std::int64_t> Store::optional_name_id(const std::string& name) {
  return name.empty() ? std::nullopt : std::optional(name_id(name));
}

}  // namespace faultsweep
