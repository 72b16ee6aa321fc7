#pragma once

#include <cmath>
#include <string>

#include "simulator/common/fingerprint.h"
#include "simulator/result/result.h"

namespace faultsweep::testing {

/// Two regions at their own pressures.
inline faultsim::SidePressures made_up_pressures(double change) {
  return {"west", "east", change, change / 3, 2e7 + change, 2e7 + change / 3, change / 2};
}

/// A result with the shape of a real one (2 faults, 3 stages, n_steps steps after the initial one),
/// whose numbers are a function of `strength` alone: the larger, the more is activated.
inline faultsim::CaseResult made_up_result(double strength, int n_steps = 12) {
  using faultsim::Outcome;
  const char* stages[] = {"primary_production", "cushion_gas_injection", "gas_storage"};
  faultsim::CaseResult result;
  result.title = "made up";
  result.identity = faultsim::fingerprint(std::to_string(strength));
  result.operator_fingerprint = faultsim::fingerprint("operator");
  result.numerics_version = faultsim::kNumericsVersion;
  result.outcome = Outcome::converged;
  result.region_names = {"west", "east"};
  result.fault_names = {"F1", "F2"};
  result.plane_strain = false;
  const double most = std::max(0.0, strength - 0.5);
  if (most <= 0) result.pressure_margin = 1e6 * (1 - strength);
  for (int k = 0; k <= n_steps; ++k) {
    faultsim::StepResult step;
    const double load = static_cast<double>(k) / n_steps;
    step.step = k;
    step.stage = k == 0 ? "initial" : stages[(k - 1) * 3 / n_steps];
    step.time = 3.15576e7 * k;
    step.pressure_change = {-2e7 * load, -1e7 * load};
    step.outcome = Outcome::converged;
    step.n_stick = 100;
    for (int f = 0; f < 2; ++f) {
      faultsim::FaultMetrics m;
      m.chi_bar = std::min(1.0, strength * load / (f + 1));
      m.chi_max = std::min(1.0, 1.1 * m.chi_bar);
      m.activated_area = 1e5 * most * load / (f + 1);
      m.max_slip = 0.01 * most * load;
      m.moment = 1e15 * most * load;
      m.activated = most * load > 0;
      step.faults.push_back(m);
    }
    result.steps.push_back(step);
  }
  faultsim::StageMetrics whole;
  whole.first_step = 0;
  whole.last_step = n_steps;
  whole.activated = most > 0;
  if (whole.activated) {
    whole.activation_step = 1;
    whole.activated_fault = "F1";
    whole.magnitude_if_at_once = faultsim::moment_magnitude(1e15 * most);
  }
  whole.chi_bar = std::min(1.0, strength);
  whole.chi_max = std::min(1.0, 1.1 * strength);
  whole.activated_area = 1.5e5 * most;
  whole.max_slip = 0.01 * most;
  whole.slips = whole.max_slip > 0;
  whole.moment = 1e15 * most;
  for (int f = 0; f < 2; ++f) {
    faultsim::FaultStageMetrics fault;
    fault.fault = result.fault_names[f];
    fault.activated = most > 0;
    if (most > 0) fault.activation = faultsim::FaultOnset{1, 2000.0 + f, made_up_pressures(-1e6)};
    fault.chi_bar = whole.chi_bar / (f + 1);
    fault.chi_max = whole.chi_max / (f + 1);
    fault.activated_area = 1e5 * most / (f + 1);
    fault.max_slip = whole.max_slip / (f + 1);
    fault.slips = fault.max_slip > 0;
    fault.moment = whole.moment / (f + 1);
    whole.faults.push_back(fault);
  }
  result.whole = whole;
  for (int s = 0; s < 3; ++s) {
    faultsim::StageMetrics stage = whole;
    stage.stage = stages[s];
    stage.first_step = s * n_steps / 3 + 1;
    stage.last_step = (s + 1) * n_steps / 3;
    stage.moment = whole.moment * (s + 1) / 6;
    for (faultsim::FaultStageMetrics& fault : stage.faults) {
      fault.max_slip *= (s + 1) / 3.0;
      fault.moment *= (s + 1) / 6.0;
    }
    result.stages.push_back(stage);
  }
  return result;
}

/// A made-up result with two slip events, two episodes, creeping salt, an interpolated operator and
/// a flow result, every field of which differs from its default and, flags aside, from all other
/// fields.
inline faultsim::CaseResult made_up_result_with_events(double strength) {
  faultsim::CaseResult result = made_up_result(strength);
  result.outcome = faultsim::Outcome::unresolved_event;
  result.weakening_resolved = false;
  result.max_nucleation_ratio = 0.7;
  result.max_penetration = 1e-10 / 3;
  result.unexpected = faultsim::Reactivation{2, 1};
  result.steps[3].outcome = faultsim::Outcome::unresolved_event;
  result.steps[3].faults[1].activated_at_edge = true;
  result.steps[3].faults[1].activation_resolved = false;
  result.whole.activation_resolved = result.stages[1].activation_resolved = false;
  result.stages[1].faults[1].activation_resolved = false;
  result.whole.n_events = 2;
  result.whole.event_moment = 2e13 / 3;
  result.whole.event_magnitude = faultsim::moment_magnitude(2e13 / 3);
  result.stages[0].n_events = 1;
  result.stages[0].event_moment = 1e13 / 3;
  double next = 1.0 / 3;
  const auto number = [&next] { return next += 1; };
  const auto pressures = [&number] {
    return faultsim::SidePressures{"west",   "east",   -number(), number(),
                                   number(), number(), number()};
  };
  result.whole.opens = true;
  result.whole.opening_step = 3;
  result.whole.opened_fault = "F2";
  result.whole.open_area = number();
  faultsim::FaultStageMetrics& jumping = result.whole.faults[1];
  for (double* value : {&jumping.area_chi_080, &jumping.thickness_chi_080, &jumping.slipping_area,
                        &jumping.open_area, &jumping.potency, &jumping.event_moment}) {
    *value = number();
  }
  jumping.opens = true;
  jumping.n_events = 2;
  jumping.event_magnitude = number();
  jumping.opening = faultsim::FaultOnset{3, number(), pressures(), 0.25, 0.75, -number()};
  for (faultsim::StepResult& step : result.steps) {
    step.creep = faultsim::StepCreep{static_cast<int>(number()), number(), false, {}};
    for (std::size_t f = 0; f < step.faults.size(); ++f) {
      step.creep->faults.push_back({-number(), number(), number()});
    }
  }
  for (const char* stage : {"primary_production", "gas_storage"}) {
    faultsim::SlipEvent e;
    e.step = static_cast<int>(number());
    e.stage = stage;
    for (double* value : {&e.load_factor_before, &e.load_factor_after, &e.time, &e.depth,
                          &e.nucleation_length, &e.slipped_area, &e.max_slip, &e.mean_slip,
                          &e.stress_drop, &e.potency, &e.moment, &e.duration, &e.residual_before,
                          &e.residual_after, &e.energy_released, &e.energy_dissipated}) {
      *value = number();
    }
    e.fault = "F2";
    e.pressures = pressures();
    e.magnitude = number();
    e.resolved = false;
    e.negative_pivots = static_cast<int>(number());
    e.n_lost_cohesion = static_cast<int>(number());
    e.evidence_holds = true;
    result.events.push_back(e);
    faultsim::Episode episode;
    episode.stage = stage;
    episode.fault = "F1";
    episode.first_step = static_cast<int>(number());
    episode.last_step = static_cast<int>(number());
    episode.depth = number();
    episode.pressures = pressures();
    episode.after_recovery = true;
    for (double* value : {&episode.activated_area, &episode.max_slip, &episode.moment}) {
      *value = number();
    }
    episode.magnitude_if_at_once = number();
    result.episodes.push_back(episode);
  }
  faultsim::CaseSurface& surface = result.surface.emplace();
  for (int* value : {&surface.n_operators, &surface.n_basis, &surface.n_checks}) {
    *value = static_cast<int>(number());
  }
  for (double* value : {&surface.tolerance, &surface.stiffness, &surface.traction,
                        &surface.observation, &surface.slip}) {
    *value = 1e-6 * number();
  }
  result.field_coverage = 1 / number();
  result.field_assumed = 1 / number();
  return result;
}

}  // namespace faultsweep::testing
