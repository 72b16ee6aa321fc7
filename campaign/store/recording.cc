#include <cmath>

#include "campaign/store/name_cache.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// A case's result as rows of its tables, and their removal.
namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;
using faultsim::Outcome;
using faultsim::SidePressures;
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

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string join(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

std::string json_array(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? "," : "") + concat(value);
  return text + "]";
}

}  // namespace

void Store::forget_result(std::int64_t case_id) {
  Connection& db = *connection_;
  Statement& query = db.prepared("SELECT 1 FROM case_metrics WHERE case_id = ?");
  const bool stored = query.bind(case_id).step();
  query.reset();
  if (!stored) return;
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
  connection_
      ->prepared(
          "INSERT INTO case_metrics (case_id, run_id, outcome, reason, n_steps, failed_step,"
          " plane_strain, weakening_resolved, max_nucleation_ratio, pressure_margin_pa,"
          " newton_iterations, active_set_passes, sub_steps, wasted_newton_iterations, warnings,"
          " unexpected_episode, unexpected_after, n_episodes, max_penetration_m)"
          " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(case_id, run_id, faultsim::to_string(result.outcome), result.reason,
            result.steps.size(), result.failed_step, result.plane_strain, result.weakening_resolved,
            finite(result.max_nucleation_ratio), finite(result.pressure_margin),
            result.counts.newton_iterations, result.counts.active_set_passes,
            result.counts.sub_steps, result.counts.wasted_newton_iterations, join(result.warnings),
            result.unexpected ? std::optional(result.unexpected->episode) : std::nullopt,
            result.unexpected ? std::optional(result.unexpected->after) : std::nullopt,
            result.episodes.size(), finite(result.max_penetration))
      .run();
  record_stage(case_id, result.whole, result);
  for (const StageMetrics& stage : result.stages) record_stage(case_id, stage, result);
  record_slip_events(case_id, result);
  record_episodes(case_id, result);
}

void Store::record_stage(std::int64_t case_id, const StageMetrics& stage,
                         const CaseResult& result) {
  const std::int64_t stage_id = name_id(stage.stage);
  const std::optional<std::int64_t> activated = optional_name_id(stage.activated_fault);
  const std::optional<std::int64_t> opened = optional_name_id(stage.opened_fault);
  connection_
      ->prepared(
          "INSERT INTO stage_metrics (stage_id, case_id, rank_class, activated, activation_step,"
          " activated_fault_id, opening_step, opened_fault_id, chi_bar, chi_max, area_chi_080_m2,"
          " thickness_chi_080_m, activated_area_m2, slipping_area_m2, open_area_m2, max_slip_m,"
          " potency_m3, moment_nm, magnitude_if_released_at_once_mw, n_events, event_moment_nm,"
          " event_magnitude_mw, pressure_margin_pa, first_step, last_step, activation_resolved)"
          " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(stage_id, case_id, rank_class(result.outcome, stage.activation_resolved),
            stage.activated, stage.activation_step, activated, stage.opening_step, opened,
            stage.chi_bar, stage.chi_max, stage.area_chi_080, stage.thickness_chi_080,
            stage.activated_area, stage.slipping_area, stage.open_area, stage.max_slip,
            stage.potency, stage.moment, stage.magnitude_if_at_once, stage.n_events,
            stage.event_moment, stage.event_magnitude, finite(result.pressure_margin),
            stage.first_step, stage.last_step, stage.activation_resolved)
      .run();
  for (std::size_t f = 0; f < stage.faults.size(); ++f) {
    const faultsim::FaultStageMetrics& fault = stage.faults[f];
    record_fault(case_id, stage_id, f, rank_class(result.outcome, fault.activation_resolved),
                 fault);
  }
}

void Store::record_histories(std::int64_t case_id, const CaseResult& result) {
  Statement& add_step = connection_->prepared(
      "INSERT INTO load_steps (case_id, step, stage_id, time_s, pressure_change_pa, outcome, "
      "reason,"
      " n_stick, n_slip, n_open, newton_iterations, active_set_passes, time_steps, time_error_pa,"
      " time_resolved) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement& add_fault = connection_->prepared(
      "INSERT INTO chi_history (case_id, fault, step, fault_id, chi_bar, chi_max, chi_static_max,"
      " area_chi_080_m2, thickness_chi_080_max_m, thickness_chi_080_mean_m, slipping_area_m2,"
      " open_area_m2, activated_area_m2, activated_length_m, activated, max_slip_m, mean_slip_m,"
      " potency_m3, moment_nm, moment_step_nm, activated_at_edge, creep_normal_min_pa,"
      " creep_normal_max_pa, creep_shear_max_pa, activation_resolved)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const faultsim::StepResult& step : result.steps) {
    const std::optional<faultsim::StepCreep>& creep = step.creep;
    add_step
        .bind(case_id, step.step, name_id(step.stage), step.time, json_array(step.pressure_change),
              faultsim::to_string(step.outcome), step.reason, step.n_stick, step.n_slip,
              step.n_open, step.counts.newton_iterations, step.counts.active_set_passes,
              creep ? std::optional(creep->time_steps) : std::nullopt,
              creep ? std::optional(creep->time_error) : std::nullopt,
              creep ? std::optional(creep->time_resolved) : std::nullopt)
        .run();
    // A step that did not converge has no metrics.
    if (!faultsim::in_equilibrium(step.outcome)) continue;
    for (std::size_t k = 0; k < step.faults.size(); ++k) {
      const faultsim::FaultMetrics& m = step.faults[k];
      FAULTSIM_DEMAND(k < result.fault_names.size(), k);
      std::optional<double> normal_min, normal_max, shear_max;
      if (creep && k < creep->faults.size()) {
        const faultsim::FaultCreep& c = creep->faults[k];
        normal_min = c.normal_min;
        normal_max = c.normal_max;
        shear_max = c.shear_max;
      }
      add_fault
          .bind(case_id, k, step.step, name_id(result.fault_names[k]), m.chi_bar, m.chi_max,
                m.chi_static_max, m.area_chi_080, m.thickness_chi_080_max, m.thickness_chi_080_mean,
                m.slipping_area, m.open_area, m.activated_area, m.activated_length, m.activated,
                m.max_slip, m.mean_slip, m.potency, m.moment, m.moment_step, m.activated_at_edge,
                normal_min, normal_max, shear_max, m.activation_resolved)
          .run();
    }
  }
}

void Store::record_slip_events(std::int64_t case_id, const CaseResult& result) {
  Statement& add = connection_->prepared(
      "INSERT INTO slip_events (case_id, number, step, stage_id, load_factor_before,"
      " load_factor_after, time_s, fault_id, depth_m, nucleation_length_m,"
      " slipped_area_m2, max_slip_m, mean_slip_m, stress_drop_pa, potency_m3, moment_nm,"
      " magnitude_mw, duration_s, resolved, negative_pivots, n_lost_cohesion, residual_before,"
      " residual_after, energy_released_j, energy_dissipated_j, evidence_holds, region_minus_id,"
      " region_plus_id, change_minus_pa, change_plus_pa, absolute_minus_pa, absolute_plus_pa,"
      " change_in_fault_pa)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, "
      "?, ?, ?, ?, ?)");
  int number = 0;
  for (const faultsim::SlipEvent& e : result.events) {
    const SidePressures& p = e.pressures;
    add.bind(case_id, ++number, e.step, name_id(e.stage), e.load_factor_before, e.load_factor_after,
             e.time, optional_name_id(e.fault), e.depth, e.nucleation_length, e.slipped_area,
             e.max_slip, e.mean_slip, e.stress_drop, e.potency, e.moment, e.magnitude, e.duration,
             e.resolved, e.negative_pivots, e.n_lost_cohesion, e.residual_before, e.residual_after,
             e.energy_released, e.energy_dissipated, e.evidence_holds,
             optional_name_id(p.region_minus), optional_name_id(p.region_plus), p.change_minus,
             p.change_plus, p.absolute_minus, p.absolute_plus, finite(p.change_in_fault))
        .run();
  }
}

void Store::record_episodes(std::int64_t case_id, const CaseResult& result) {
  Statement& add = connection_->prepared(
      "INSERT INTO episodes (case_id, number, stage_id, fault_id, first_step, last_step,"
      " depth_m, after_recovery, activated_area_m2, max_slip_m, moment_nm,"
      " magnitude_if_released_at_once_mw, region_minus_id, region_plus_id, change_minus_pa,"
      " change_plus_pa, absolute_minus_pa, absolute_plus_pa,"
      " change_in_fault_pa)"
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int number = 0;
  for (const faultsim::Episode& e : result.episodes) {
    const SidePressures& p = e.pressures;
    add.bind(case_id, ++number, name_id(e.stage), name_id(e.fault), e.first_step, e.last_step,
             finite(e.depth), e.after_recovery, e.activated_area, e.max_slip, e.moment,
             e.magnitude_if_at_once, optional_name_id(p.region_minus),
             optional_name_id(p.region_plus), p.change_minus, p.change_plus, p.absolute_minus,
             p.absolute_plus, finite(p.change_in_fault))
        .run();
  }
}

}  // namespace faultsweep
