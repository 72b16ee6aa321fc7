#include "simulator/loading/run_case.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/fingerprint.h"
#include "simulator/common/interrupt.h"
#include "simulator/common/stopwatch.h"
#include "simulator/contact/contact.h"
#include "simulator/loading/episodes.h"
#include "simulator/loading/history.h"
#include "simulator/loading/initial_traction.h"
#include "simulator/loading/metrics.h"
#include "simulator/loading/slip_events.h"
#include "simulator/loading/stage_summary.h"
#include "simulator/loading/warnings.h"
#include "simulator/scene/read_scene.h"

namespace faultsim {
namespace {

/// η = G/2c_s = ½ √(ρ G) per node, Pa s/m (Rice 1993). Density enters as a root and only scales the
/// duration of events, so one value stands for all rocks.
Eigen::VectorXd radiation_damping(const FaultGeometry& geometry) {
  constexpr double kDensity = 2500;  // kg/m3
  Eigen::VectorXd damping(static_cast<Eigen::Index>(geometry.nodes.size()));
  for (Eigen::Index k = 0; k < damping.size(); ++k) {
    const OperatorNode& node = geometry.nodes[static_cast<std::size_t>(k)];
    damping[k] = 0.5 * std::sqrt(kDensity * node.effective_shear_modulus);
  }
  return damping;
}

ContactLaws contact_laws(const Scene& scene, const FaultGeometry& geometry) {
  ContactLaws laws;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const Friction& friction = scene.faults[f].friction;
    CoulombLaw law;
    law.weakening =
        friction.law == FrictionLaw::angle ? WeakeningLaw::angle : WeakeningLaw::coefficient;
    law.cohesion = friction.cohesion;
    law.static_friction_angle = friction.static_friction_angle;
    law.dynamic_friction_angle = friction.dynamic_friction_angle;
    if (friction.slip_weakening_distance > 0)
      law.slip_weakening_distance = friction.slip_weakening_distance;
    const auto n = static_cast<std::size_t>(geometry.faults[f].n_nodes);
    laws.node.insert(laws.node.end(), n, law);
    laws.cumulated.insert(laws.cumulated.end(), n, friction.slip_measure == SlipMeasure::cumulated);
    laws.keep_cohesion.insert(laws.keep_cohesion.end(), n, friction.cohesion_after_opening);
    laws.lose_cohesion_slipping.insert(laws.lose_cohesion_slipping.end(), n,
                                       !friction.cohesion_after_slip);
  }
  if (scene.numerics.follow_events) laws.damping = radiation_damping(geometry);
  return laws;
}

ContactOptions contact_options(const Numerics& numerics) {
  return {numerics.traction_tolerance,    numerics.max_newton_iterations,
          numerics.max_active_set_passes, numerics.max_step_cuts,
          numerics.onset_tolerance,       numerics.max_events};
}

std::vector<std::string> fault_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Fault& fault : scene.faults) names.push_back(fault.name);
  return names;
}

void add_counts(SolveCounts& sum, const SolveCounts& part) {
  sum.newton_iterations += part.newton_iterations;
  sum.active_set_passes += part.active_set_passes;
  sum.sub_steps += part.sub_steps;
  sum.wasted_newton_iterations += part.wasted_newton_iterations;
}

/// The loads of one step: what the faults would carry if they stayed closed.
struct StepLoads {
  std::vector<double> pressure_change;    // per region, Pa
  std::vector<double> factors;            // per operator load
  Eigen::VectorXd locked;                 // t_L, n_dofs, Pa
  Eigen::VectorXd fault_pressure_change;  // n_nodes, Pa
};

/// One case on its way through the load steps.
class CaseRun {
 public:
  CaseRun(const Scene& scene, const FaultOperator& op, const StepObserver& observer)
      : scene_(scene),
        op_(op),
        observer_(observer),
        laws_(contact_laws(scene, op.geometry)),
        load_factors_(scene, op),
        initial_(initial_traction(scene, op.geometry)),
        meter_(op, laws_, scene.numerics.slip_tolerance, scene.numerics.activation_length),
        solver_(op, laws_, contact_options(scene.numerics)),
        state_(initial_state(op)),
        episodes_(meter_, fault_names(scene), op.geometry.plane_strain),
        whole_("", 0, nullptr, true, op.geometry.plane_strain) {}

  CaseResult run(Monitor& monitor);
  StepStart start_of(int step);

 private:
  void name_result();
  StepLoads loads_at(const LoadStep& step) const;
  void check_fault_pressure(const LoadStep& step, const StepLoads& loads) const;
  bool advance(const LoadStep& step, const StepLoads* before, const StepLoads& loads);
  void record_events(const LoadStep& step, const StepLoads* before, const StepLoads& loads,
                     const std::vector<ContactJump>& jumps);
  void record(const LoadStep& step, const StepLoads& loads, const Eigen::VectorXd& jump_before,
              StepResult& result);
  FaultFields fields(const StepLoads& loads) const;
  void name_events();
  void note_weakening(const Eigen::VectorXd& traction, bool trial);

  const Scene& scene_;
  const FaultOperator& op_;
  const StepObserver& observer_;
  ContactLaws laws_;
  LoadFactors load_factors_;
  InitialTraction initial_;
  FaultMeter meter_;
  ContactSolver solver_;
  ContactState state_;
  NodalState nodal_;
  CaseResult result_;
  EpisodeTracker episodes_;
  StageSummary whole_;
  std::optional<StageSummary> stage_;
  double last_time_ = 0;  ///< s, of the last step.
};

StepLoads CaseRun::loads_at(const LoadStep& step) const {
  StepLoads loads;
  loads.pressure_change = pressure_changes(scene_, step.time);
  loads.factors = load_factors_.at(step.time, loads.pressure_change);
  loads.locked = initial_.traction;
  for (std::size_t k = 0; k < loads.factors.size(); ++k) {
    if (loads.factors[k] != 0)
      loads.locked += loads.factors[k] * op_.locked.col(static_cast<Eigen::Index>(k));
  }
  loads.fault_pressure_change = fault_pressure_change(
      scene_, op_.geometry, load_factors_.region_of_load(), step.time, loads.pressure_change);
  for (std::size_t f = 0; f < op_.geometry.faults.size(); ++f) {
    const OperatorFault& fault = op_.geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      loads.locked[op_.geometry.nodes[static_cast<std::size_t>(k)].dof[0]] +=
          scene_.faults[f].fault_biot * loads.fault_pressure_change[k];
    }
  }
  return loads;
}

void CaseRun::check_fault_pressure(const LoadStep& step, const StepLoads& loads) const {
  const double slack = 1.0;  // Pa
  for (std::size_t f = 0; f < op_.geometry.faults.size(); ++f) {
    if (scene_.faults[f].pressure.rule != FaultPressureRule::prescribed) continue;
    const OperatorFault& fault = op_.geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const double p = initial_.pressure[k] + loads.fault_pressure_change[k];
      if (p >= -slack) continue;
      throw InputError(
          "scene",
          {{concat("/faults/", f, "/fault_pressure"), 0,
            concat("the prescribed fault pressure of ", fault.name, " falls to ", p / 1e5,
                   " bar at depth ", -op_.geometry.nodes[static_cast<std::size_t>(k)].position.z(),
                   " m in load step ", step.step),
            "prescribe a smaller drop or a narrower depth window"}});
    }
  }
}

FaultFields CaseRun::fields(const StepLoads& loads) const {
  const auto n = static_cast<Eigen::Index>(op_.geometry.nodes.size());
  FaultFields f;
  f.traction = f.jump = Eigen::Matrix3Xd::Zero(3, n);
  f.state.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& dof = op_.geometry.nodes[static_cast<std::size_t>(k)].dof;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const int d = dof[static_cast<std::size_t>(c)];
      if (d < 0) continue;
      f.traction(c, k) = state_.traction[d];
      f.jump(c, k) = state_.jump[d];
    }
    f.state[k] = static_cast<int>(state_.state[static_cast<std::size_t>(k)]);
  }
  f.critical_index = nodal_.critical_index;
  f.static_critical_index = nodal_.static_critical_index;
  f.fault_pressure_change = loads.fault_pressure_change;
  return f;
}

/// Cell edges against the nucleation length (design section 4) where it slips; with a trial
/// traction, where that would make it slip.
void CaseRun::note_weakening(const Eigen::VectorXd& traction, bool trial) {
  for (std::size_t k = 0; k < op_.geometry.nodes.size(); ++k) {
    const CoulombLaw& law = laws_.node[k];
    if (law.dynamic_friction_angle >= law.static_friction_angle) continue;
    const OperatorNode& node = op_.geometry.nodes[k];
    const double normal = std::min(traction[node.dof[0]], 0.0);
    bool slips = state_.state[k] == FaultState::slip;
    if (trial && !slips) {
      const double shear = std::hypot(node.dof[1] >= 0 ? traction[node.dof[1]] : 0.0,
                                      node.dof[2] >= 0 ? traction[node.dof[2]] : 0.0);
      slips = shear > limit_shear_traction(law, normal, 0).value;
    }
    if (!slips) continue;
    result_.max_nucleation_ratio =
        std::max(result_.max_nucleation_ratio,
                 nucleation_ratio(node, law, op_.geometry.plane_strain, normal));
  }
}

void CaseRun::record(const LoadStep& step, const StepLoads& loads,
                     const Eigen::VectorXd& jump_before, StepResult& result) {
  meter_.evaluate(state_, nodal_);
  result.faults = meter_.measure(nodal_, state_, jump_before);
  for (const FaultState s : state_.state) {
    result.n_stick += s == FaultState::stick;
    result.n_slip += s == FaultState::slip;
    result.n_open += s == FaultState::open;
  }
  for (const OperatorNode& node : op_.geometry.nodes) {
    result_.max_penetration = std::max(result_.max_penetration, -state_.jump[node.dof[0]]);
  }
  const Eigen::Map<const Eigen::VectorXd> factors(loads.factors.data(),
                                                  static_cast<Eigen::Index>(loads.factors.size()));
  if (!op_.observations.empty()) {
    const Eigen::VectorXd u = op_.observed_load * factors + op_.observed_jump * state_.jump;
    result.observed.assign(u.begin(), u.end());
  }
  if (result.n_slip > 0) note_weakening(state_.traction, false);
  const auto first = std::find_if(result_.events.begin(), result_.events.end(),
                                  [&](const SlipEvent& e) { return e.step == step.step; });
  const std::span<const SlipEvent> events(first, result_.events.end());
  whole_.add(result, meter_, state_, result_.fault_names, events);
  if (step.step > 0) {
    episodes_.add(result, state_, jump_before);
    if (!stage_) {
      stage_.emplace(step.stage, step.step, &jump_before, false, op_.geometry.plane_strain);
    }
    stage_->add(result, meter_, state_, result_.fault_names, events);
  }
  if (observer_) observer_(result, fields(loads));
}

/// Loads are linear within a step, so onset lies where its load factor says.
void CaseRun::record_events(const LoadStep& step, const StepLoads* before, const StepLoads& loads,
                            const std::vector<ContactJump>& jumps) {
  for (const ContactJump& jump : jumps) {
    SlipEvent event = measure_event(op_, laws_, meter_, jump);
    event.step = step.step;
    event.stage = step.stage;
    const double share = jump.load_before;
    event.time = last_time_ + share * (step.time - last_time_);
    for (std::size_t r = 0; r < loads.pressure_change.size(); ++r) {
      const double start = before != nullptr ? before->pressure_change[r] : 0;
      const double onset = start + share * (loads.pressure_change[r] - start);
      if (r == 0 || onset < event.pressure_change) event.pressure_change = onset;
    }
    result_.events.push_back(std::move(event));
  }
}

bool CaseRun::advance(const LoadStep& step, const StepLoads* before, const StepLoads& loads) {
  const Stopwatch watch;
  StepResult result;
  result.step = step.step;
  result.stage = step.stage;
  result.time = step.time;
  result.pressure_change = loads.pressure_change;
  const Eigen::VectorXd jump_before = state_.jump;
  const Eigen::VectorXd locked_before =
      before != nullptr ? before->locked : Eigen::VectorXd::Zero(op_.geometry.n_dofs);
  const ContactReport report = solver_.solve_step(locked_before, loads.locked, state_);
  result.outcome = report.outcome;
  result.reason = report.reason;
  result.counts = report.counts;
  add_counts(result_.counts, report.counts);
  const bool good = in_equilibrium(report.outcome);
  record_events(step, before, loads, report.jumps);
  result.seconds = watch.seconds();
  if (good) {
    record(step, loads, jump_before, result);
  } else {
    result_.outcome = report.outcome;
    result_.reason = concat("load step ", step.step, " (", step.stage, "): ", report.reason);
    result_.failed_step = step.step;
    // What slips in a step that has no end: judged by the traction of faults held as they were.
    note_weakening(state_.traction + (loads.locked - locked_before), true);
  }
  last_time_ = step.time;
  result_.steps.push_back(std::move(result));
  return good;
}

/// A case with events is never called converged; with cells too coarse for its weakening, or with
/// an event whose evidence does not hold, it is marked.
void CaseRun::name_events() {
  const bool evident = std::all_of(result_.events.begin(), result_.events.end(),
                                   [](const SlipEvent& e) { return e.evidence_holds; });
  if (result_.events.empty() || result_.outcome != Outcome::converged) return;
  result_.outcome =
      result_.weakening_resolved && evident ? Outcome::event : Outcome::unresolved_event;
}

/// Identity and names, which the metrics of a step refer to.
void CaseRun::name_result() {
  result_.title = scene_.title;
  result_.identity = case_identity(scene_);
  result_.operator_fingerprint = op_.fingerprint;
  result_.numerics_version = kNumericsVersion;
  result_.plane_strain = op_.geometry.plane_strain;
  for (const PressureHistory& history : scene_.pressure)
    result_.region_names.push_back(history.region);
  result_.fault_names = fault_names(scene_);
  for (const ObservationRow& row : op_.observations) result_.observation_names.push_back(row.name);
}

CaseResult CaseRun::run(Monitor& monitor) {
  const Stopwatch watch;
  name_result();
  const std::vector<LoadStep> steps = load_steps(scene_);
  std::vector<StepLoads> loads;
  for (const LoadStep& step : steps) {
    loads.push_back(loads_at(step));
    check_fault_pressure(step, loads.back());
  }
  result_.outcome = Outcome::converged;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (interrupted()) {
      result_.outcome = Outcome::interrupted;
      result_.reason = concat("stopped before load step ", steps[i].step);
      break;
    }
    if (stage_ && steps[i].stage != steps[i - 1].stage) {
      result_.stages.push_back(stage_->finish());
      stage_.reset();
    }
    if (!advance(steps[i], i == 0 ? nullptr : &loads[i - 1], loads[i])) break;
    monitor.progress(static_cast<double>(i + 1) / static_cast<double>(steps.size()),
                     steps[i].stage);
  }
  if (stage_) result_.stages.push_back(stage_->finish());
  result_.whole = whole_.finish();
  result_.episodes = episodes_.finish();
  result_.unexpected = unexpected_reactivation(result_.episodes);
  if (!result_.whole.activated) {
    const std::span<const StepResult> all(result_.steps);
    result_.pressure_margin =
        pressure_margin(all.first(all.size() - (result_.failed_step ? 1 : 0)));
  }
  result_.weakening_resolved = result_.max_nucleation_ratio <= 1.0 / 3.0;
  name_events();
  result_.warnings = case_warnings(scene_, op_, meter_, result_);
  result_.seconds = watch.seconds();
  return std::move(result_);
}

/// The steps before are solved as run() does; their metrics are by the way.
StepStart CaseRun::start_of(int step) {
  const std::vector<LoadStep> steps = load_steps(scene_);
  const auto n_steps = static_cast<int>(steps.size());
  if (step < 0 || step >= n_steps) {
    throw InputError("scene", {{"/stages", 0, concat("the case has no load step ", step),
                                concat("choose one of 0 to ", n_steps - 1)}});
  }
  StepStart start;
  start.laws = laws_;
  start.options = contact_options(scene_.numerics);
  start.before = Eigen::VectorXd::Zero(op_.geometry.n_dofs);
  std::optional<StepLoads> last;
  start.outcome = result_.outcome = Outcome::converged;
  name_result();
  for (const LoadStep& next : steps) {
    if (interrupted()) {
      start.outcome = Outcome::interrupted;
      start.reason = concat("stopped before load step ", next.step);
      return start;
    }
    const StepLoads loads = loads_at(next);
    check_fault_pressure(next, loads);
    start.step = next;
    start.after = loads.locked;
    if (next.step == step) break;
    if (!advance(next, last ? &*last : nullptr, loads)) {
      start.outcome = result_.outcome;
      start.reason = result_.reason;
      return start;
    }
    start.before = loads.locked;
    last = loads;
  }
  start.state = state_;
  return start;
}

}  // namespace

CaseResult run_case(const Scene& scene, const FaultOperator& op, Monitor& monitor,
                    const StepObserver& observer) {
  return CaseRun(scene, op, observer).run(monitor);
}

StepStart start_of_step(const Scene& scene, const FaultOperator& op, int step) {
  return CaseRun(scene, op, {}).start_of(step);
}

}  // namespace faultsim
