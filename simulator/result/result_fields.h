#pragma once

#include "simulator/common/struct_of.h"
#include "simulator/result/field.h"
#include "simulator/result/result.h"

/// The one list of the fields of a result: for_each_field(struct, visit) calls visit(Field, member)
/// for each member. JSON (result_json.cc), bytes between processes (result_bytes.cc), the store's
/// columns (campaign/store/result_rows.h) and metrics (campaign/spec/metrics.cc) are written from
/// it. What is measured of a stage stands in measures.h.
namespace faultsim {

void for_each_field(Of<FaultMetrics> auto& m, auto&& visit) {
  visit(Field{"chi_bar"}, m.chi_bar);
  visit(Field{"chi_max"}, m.chi_max);
  visit(Field{"chi_static_max"}, m.chi_static_max);
  visit(Field{"area_chi_080_m2"}, m.area_chi_080);
  visit(Field{"thickness_chi_080_max_m"}, m.thickness_chi_080_max);
  visit(Field{"thickness_chi_080_mean_m"}, m.thickness_chi_080_mean);
  visit(Field{"slipping_area_m2"}, m.slipping_area);
  visit(Field{"open_area_m2"}, m.open_area);
  visit(Field{"activated_area_m2"}, m.activated_area);
  visit(Field{"activated_length_m"}, m.activated_length);
  visit(Field{"activated"}, m.activated);
  visit(Field{"activation_resolved"}, m.activation_resolved);
  visit(Field{"activated_at_edge"}, m.activated_at_edge);
  visit(Field{"max_slip_m"}, m.max_slip);
  visit(Field{"mean_slip_m"}, m.mean_slip);
  visit(Field{"potency_m3"}, m.potency);
  visit(Field{"moment_nm"}, m.moment);
  visit(Field{"moment_step_nm"}, m.moment_step);
}

void for_each_field(Of<SolveCounts> auto& c, auto&& visit) {
  visit(Field{"newton_iterations"}, c.newton_iterations);
  visit(Field{"active_set_passes"}, c.active_set_passes);
  visit(Field{"sub_steps"}, c.sub_steps);
  visit(Field{"wasted_newton_iterations"}, c.wasted_newton_iterations);
}

void for_each_field(Of<FaultCreep> auto& c, auto&& visit) {
  visit(Field{"normal_min_pa"}, c.normal_min);
  visit(Field{"normal_max_pa"}, c.normal_max);
  visit(Field{"shear_max_pa"}, c.shear_max);
}

void for_each_field(Of<StepCreep> auto& c, auto&& visit) {
  visit(Field{"time_steps"}, c.time_steps);
  visit(Field{"time_error_pa"}, c.time_error);
  visit(Field{"time_resolved"}, c.time_resolved);
  visit(Field{"faults"}, c.faults);
}

void for_each_field(Of<StepCoupled> auto& c, auto&& visit) {
  visit(Field{"krylov_iterations"}, c.krylov_iterations);
  visit(Field{"setup_s"}, c.setup_seconds);
  visit(Field{"solve_s"}, c.solve_seconds);
}

void for_each_field(Of<CaseCoupled> auto& c, auto&& visit) {
  visit(Field{"leading"}, c.leading);
  visit(Field{"schur"}, c.schur);
  visit(Field{"displacement_dofs"}, c.n_displacements);
  visit(Field{"multiplier_dofs"}, c.n_multipliers);
  visit(Field{"krylov_iterations"}, c.krylov_iterations);
  visit(Field{"most_krylov_iterations"}, c.most_krylov_iterations);
  visit(Field{"setup_s"}, c.setup_seconds);
  visit(Field{"solve_s"}, c.solve_seconds);
}

void for_each_field(Of<CaseSurface> auto& s, auto&& visit) {
  visit(Field{"operators"}, s.n_operators);
  visit(Field{"basis"}, s.n_basis);
  visit(Field{"checks"}, s.n_checks);
  visit(Field{"tolerance"}, s.tolerance);
  visit(Field{"error_of_stiffness"}, s.stiffness);
  visit(Field{"error_of_traction"}, s.traction);
  visit(Field{"error_of_observation"}, s.observation);
  visit(Field{"error_of_slip"}, s.slip);
  visit(Field{"error_of_stability"}, s.stability);
  visit(Field{.key = "cases", .since = 18}, s.n_cases);
  visit(Field{.key = "tolerance_of_chi_bar", .since = 18}, s.chi_tolerance);
  visit(Field{.key = "error_of_chi_bar", .since = 18}, s.chi_bar);
  visit(Field{.key = "error_of_largest_slip", .since = 18}, s.largest_slip);
  visit(Field{.key = "flags_that_differ", .since = 18}, s.flags_that_differ);
}

void for_each_field(Of<StepResult> auto& s, auto&& visit) {
  visit(Field{"step"}, s.step);
  visit(Field{"stage"}, s.stage);
  visit(Field{"time_s"}, s.time);
  visit(Field{"pressure_change_pa"}, s.pressure_change);
  visit(Field{.key = "temperature_change_k", .since = 20}, s.temperature_change);
  visit(Field{"outcome"}, s.outcome);
  visit(Field{"reason"}, s.reason);
  visit(Field{"n_stick"}, s.n_stick);
  visit(Field{"n_slip"}, s.n_slip);
  visit(Field{"n_open"}, s.n_open);
  visit(Field{"faults"}, s.faults);
  visit(Field{"observed_m"}, s.observed);
  visit(Field{"creep"}, s.creep);
  visit(Field{.key = "coupled", .since = 13}, s.coupled);
  visit(Field{"counts"}, s.counts);
  visit(Field{"wall_s"}, s.seconds);
}

void for_each_field(Of<SidePressures> auto& s, auto&& visit) {
  visit(Field{"region_minus"}, s.region_minus);
  visit(Field{"region_plus"}, s.region_plus);
  visit(Field{"change_minus_pa"}, s.change_minus);
  visit(Field{"change_plus_pa"}, s.change_plus);
  visit(Field{"absolute_minus_pa"}, s.absolute_minus);
  visit(Field{"absolute_plus_pa"}, s.absolute_plus);
  visit(Field{.key = "change_in_fault_pa", .may_be_nan = true}, s.change_in_fault);
}

void for_each_field(Of<FaultOnset> auto& o, auto&& visit) {
  visit(Field{"step"}, o.step);
  visit(Field{"depth_m"}, o.depth);
  visit(Field{"pressures"}, o.pressures);
  visit(Field{.key = "load_factor_before", .since = 21}, o.load_before);
  visit(Field{.key = "load_factor_after", .since = 21}, o.load_after);
  visit(Field{.key = "change_before_pa", .since = 21}, o.change_before);
}

void for_each_field(Of<FaultStageMetrics> auto& s, auto&& visit) {
  visit(Field{"fault"}, s.fault);
  visit(Field{"activation"}, s.activation);
  visit(Field{"opening"}, s.opening);
  for_each_measure(s, visit);
}

void for_each_field(Of<StageMetrics> auto& s, auto&& visit) {
  visit(Field{"stage"}, s.stage);
  visit(Field{"first_step"}, s.first_step);
  visit(Field{"last_step"}, s.last_step);
  visit(Field{"activation_step"}, s.activation_step);
  visit(Field{"activated_fault"}, s.activated_fault);
  visit(Field{"opening_step"}, s.opening_step);
  visit(Field{"opened_fault"}, s.opened_fault);
  visit(Field{"magnitude_if_released_at_once_mw"}, s.magnitude_if_at_once);
  for_each_measure(s, visit);
  visit(Field{"faults"}, s.faults);
}

void for_each_field(Of<SlipEvent> auto& e, auto&& visit) {
  visit(Field{"step"}, e.step);
  visit(Field{"stage"}, e.stage);
  visit(Field{"load_factor_before"}, e.load_factor_before);
  visit(Field{"load_factor_after"}, e.load_factor_after);
  visit(Field{"time_s"}, e.time);
  visit(Field{"fault"}, e.fault);
  visit(Field{"depth_m"}, e.depth);
  visit(Field{"pressures"}, e.pressures);
  visit(Field{"nucleation_length_m"}, e.nucleation_length);
  visit(Field{"slipped_area_m2"}, e.slipped_area);
  visit(Field{"max_slip_m"}, e.max_slip);
  visit(Field{"mean_slip_m"}, e.mean_slip);
  visit(Field{"stress_drop_pa"}, e.stress_drop);
  visit(Field{"potency_m3"}, e.potency);
  visit(Field{"moment_nm"}, e.moment);
  visit(Field{"magnitude_mw"}, e.magnitude);
  visit(Field{"duration_s"}, e.duration);
  visit(Field{"resolved"}, e.resolved);
  visit(Field{"negative_pivots"}, e.negative_pivots);
  visit(Field{"n_lost_cohesion"}, e.n_lost_cohesion);
  visit(Field{"residual_before"}, e.residual_before);
  visit(Field{"residual_after"}, e.residual_after);
  visit(Field{"energy_released_j"}, e.energy_released);
  visit(Field{"energy_dissipated_j"}, e.energy_dissipated);
  visit(Field{"evidence_holds"}, e.evidence_holds);
}

void for_each_field(Of<Episode> auto& e, auto&& visit) {
  visit(Field{"stage"}, e.stage);
  visit(Field{"fault"}, e.fault);
  visit(Field{"first_step"}, e.first_step);
  visit(Field{"last_step"}, e.last_step);
  visit(Field{.key = "depth_m", .may_be_nan = true}, e.depth);
  visit(Field{"pressures"}, e.pressures);
  visit(Field{"after_recovery"}, e.after_recovery);
  visit(Field{"activated_area_m2"}, e.activated_area);
  visit(Field{"max_slip_m"}, e.max_slip);
  visit(Field{"moment_nm"}, e.moment);
  visit(Field{"magnitude_if_released_at_once_mw"}, e.magnitude_if_at_once);
}

void for_each_field(Of<Reactivation> auto& r, auto&& visit) {
  visit(Field{"episode"}, r.episode);
  visit(Field{"after_episode"}, r.after);
}

void for_each_field(Of<CaseResult> auto& c, auto&& visit) {
  visit(Field{"title"}, c.title);
  visit(Field{"identity"}, c.identity);
  visit(Field{"operator_fingerprint"}, c.operator_fingerprint);
  visit(Field{"numerics_version"}, c.numerics_version);
  visit(Field{"outcome"}, c.outcome);
  visit(Field{"reason"}, c.reason);
  visit(Field{"failed_step"}, c.failed_step);
  visit(Field{"plane_strain"}, c.plane_strain);
  visit(Field{"weakening_resolved"}, c.weakening_resolved);
  visit(Field{.key = "max_nucleation_ratio", .may_be_nan = true}, c.max_nucleation_ratio);
  visit(Field{.key = "max_penetration_m", .may_be_nan = true}, c.max_penetration);
  visit(Field{.key = "pressure_margin_pa", .may_be_nan = true}, c.pressure_margin);
  visit(Field{"regions"}, c.region_names);
  visit(Field{"faults"}, c.fault_names);
  visit(Field{"observations"}, c.observation_names);
  visit(Field{"steps"}, c.steps);
  visit(Field{"stages"}, c.stages);
  visit(Field{"whole"}, c.whole);
  visit(Field{"events"}, c.events);
  visit(Field{"episodes"}, c.episodes);
  visit(Field{"unexpected"}, c.unexpected);
  visit(Field{"counts"}, c.counts);
  visit(Field{.key = "coupled", .since = 13}, c.coupled);
  visit(Field{.key = "surface", .since = 13}, c.surface);
  visit(Field{.key = "field_coverage", .since = 16}, c.field_coverage);
  visit(Field{.key = "field_assumed", .since = 20}, c.field_assumed);
  visit(Field{"warnings"}, c.warnings);
  visit(Field{"wall_s"}, c.seconds);
}

}  // namespace faultsim
