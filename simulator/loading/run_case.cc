#include "simulator/loading/run_case.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/ranges.h"
#include "simulator/common/stopwatch.h"
#include "simulator/loading/case_contact.h"
#include "simulator/loading/node_fields.h"
#include "simulator/loading/onset_search.h"
#include "simulator/loading/warnings.h"
#include "simulator/measures/episodes.h"
#include "simulator/measures/fault_neighbours.h"
#include "simulator/measures/metrics.h"
#include "simulator/measures/slip_events.h"
#include "simulator/measures/stage_summary.h"
#include "simulator/scene/identity.h"

namespace faultsim {
namespace {

std::vector<std::string> fault_names(const Scene& scene) {
  return mapped(scene.faults, &Fault::name);
}

/// One case on its way through the load steps.
class CaseRun {
 public:
  CaseRun(const Scene& scene, const FaultOperator& op, const LoadSources& further,
          const MakeStepSolver& solver, const RunContext& context, const CaseProbe& probe)
      : scene_(scene),
        op_(op),
        context_(context),
        probe_(probe),
        laws_(contact_laws(scene, op.geometry)),
        node_laws_(laws_),
        loads_(scene, op, further, probe.noise),
        meter_(op, laws_, scene.numerics.slip_tolerance, scene.numerics.activation_length),
        solver_(solver({scene, laws_, loads_, watch()})),
        state_(initial_state(op)),
        neighbours_(scene, op),
        episodes_(meter_, neighbours_, fault_names(scene), op.geometry.plane_strain),
        whole_("", 0, {}, true, op.geometry.plane_strain) {}

  CaseResult run();
  StepStart start_of(int step);

 private:
  ContactWatch watch() const;
  void name_result();
  void walk(const std::vector<LoadStep>& steps);
  bool advance(const LoadStep& step, const StepLoads* before, const StepLoads& loads);
  void show(const StepLoads* before, const StepLoads& loads, const SolvedStep& solved,
            const StepResult& result, AcceptedStep& step) const;
  void record_events(const LoadStep& step, const StepLoads* before, const StepLoads& loads,
                     const std::vector<ContactJump>& jumps);
  void record(const LoadStep& step, const StepLoads& loads, const Eigen::VectorXd& jump_before,
              StepResult& result);
  void narrow_onsets(const OnsetSearch::Step& step);
  FaultFields fields(const StepLoads& loads) const;
  void name_events();
  void note_weakening(const Eigen::VectorXd& traction, bool trial);

  const Scene& scene_;
  const FaultOperator& op_;
  const RunContext& context_;
  const CaseProbe& probe_;
  ContactLaws laws_;
  NodeLaws node_laws_;
  CaseLoads loads_;
  FaultMeter meter_;
  std::unique_ptr<StepSolver> solver_;
  ContactState state_;
  NodalState nodal_;
  CaseResult result_;
  FaultNeighbours neighbours_;
  EpisodeTracker episodes_;
  StageSummary whole_;
  std::optional<StageSummary> stage_;
  Eigen::VectorXd creep_traction_;  ///< t'_creep of the last step, n_dofs, Pa; empty without creep.
  double last_time_ = 0;            ///< s, of the last step.
  const LoadStep* at_ = nullptr;    ///< the step being solved.
  bool searches_ = false;           ///< parts of it are, again.
  bool narrows_ = true;  ///< onsets are searched within steps where the scene asks for it.
};

ContactWatch CaseRun::watch() const {
  ContactWatch watch{.stop = context_.stop, .team = context_.team};
  if (probe_.tried)
    watch.tried = [this](const SubStepTrace& part) {
      if (!searches_) probe_.tried(at_->step, part);
    };
  return watch;
}

FaultFields CaseRun::fields(const StepLoads& loads) const {
  const auto n = static_cast<Eigen::Index>(op_.geometry.nodes.size());
  FaultFields f;
  f.traction = per_node(op_.geometry, state_.traction);
  f.jump = per_node(op_.geometry, state_.jump);
  f.state.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    f.state[k] = static_cast<int>(state_.state[k]);
  }
  f.critical_index = nodal_.critical_index;
  f.static_critical_index = nodal_.static_critical_index;
  f.fault_pressure_change = loads.fault_pressure_change;
  if (creep_traction_.size() > 0) f.creep_traction = per_node(op_.geometry, creep_traction_);
  return f;
}

/// Cell edges against the nucleation length (docs/model.md, section 8) where it slips; with a trial
/// traction, where that would make it slip.
void CaseRun::note_weakening(const Eigen::VectorXd& traction, bool trial) {
  if (!node_laws_.any_weakens()) return;
  for (std::size_t k = 0; k < op_.geometry.nodes.size(); ++k) {
    const NodeLaw& law = node_laws_[k];
    if (!law.weakens()) continue;
    const OperatorNode& node = op_.geometry.nodes[k];
    const double normal = traction[node.dof[0]];
    bool slips = state_.state[k] == FaultState::slip;
    if (trial && !slips) {
      const double shear = std::hypot(node.dof[1] >= 0 ? traction[node.dof[1]] : 0.0,
                                      node.dof[2] >= 0 ? traction[node.dof[2]] : 0.0);
      slips = shear > law.limit(normal, {});
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
  if (!op_.observed.rows.empty()) {
    const Eigen::VectorXd u = solver_->observed(loads, state_);
    result.observed.assign(u.begin(), u.end());
  }
  if (result.creep) result.creep->faults = creep_of_faults(op_.geometry, creep_traction_);
  if (result.n_slip > 0) note_weakening(state_.traction, false);
  const auto first = std::ranges::find(result_.events, step.step, &SlipEvent::step);
  const std::span<const SlipEvent> events(first, result_.events.end());
  whole_.add(result, meter_, neighbours_, nodal_, state_, loads, result_.fault_names, events);
  if (step.step > 0) {
    episodes_.add(result, nodal_, state_, jump_before, loads);
    if (!stage_) {
      stage_.emplace(step.stage, step.step, jump_before.isZero(0) ? Eigen::VectorXd() : jump_before,
                     false, op_.geometry.plane_strain);
    }
    stage_->add(result, meter_, neighbours_, nodal_, state_, loads, result_.fault_names, events);
  }
  if (probe_.step) probe_.step(result, fields(loads));
}

/// Loads are linear within a step, so onset lies where its load factor says.
void CaseRun::record_events(const LoadStep& step, const StepLoads* before, const StepLoads& loads,
                            const std::vector<ContactJump>& jumps) {
  for (const ContactJump& jump : jumps) {
    SlipEvent event = measure_event(op_, laws_, jump);
    event.step = step.step;
    event.stage = step.stage;
    const double share = jump.load_before;
    event.time = last_time_ + share * (step.time - last_time_);
    const PressureChanges& start = before != nullptr ? *before : loads;
    if (const int node = nucleus_node(op_.geometry, jump); node >= 0)
      event.pressures = neighbours_.at(node, event.depth, between(start, loads, share));
    result_.events.push_back(std::move(event));
  }
}

/// Where in the step the faults begin to slide that it is the first of.
void CaseRun::narrow_onsets(const OnsetSearch::Step& step) {
  const OnsetSearch search(scene_.numerics.activation_tolerance, meter_, neighbours_, *solver_);
  searches_ = true;
  search.narrow(step, whole_, *stage_);
  searches_ = false;
}

/// Gives the probe what was accepted. @param step  with the state before.
void CaseRun::show(const StepLoads* before, const StepLoads& loads, const SolvedStep& solved,
                   const StepResult& result, AcceptedStep& step) const {
  step.locked = loads.locked;
  step.locked_before =
      before != nullptr ? before->locked : Eigen::VectorXd::Zero(op_.geometry.n_dofs);
  step.after = state_;
  step.elastic = solved.is_elastic;
  const bool one_time_step = !result.creep || result.creep->time_steps <= 1;
  step.at_once =
      one_time_step && solved.contact.counts.sub_steps == 1 && solved.contact.jumps.empty();
  probe_.accepted(result.step, laws_, step);
}

bool CaseRun::advance(const LoadStep& step, const StepLoads* before, const StepLoads& loads) {
  const Stopwatch stopwatch;
  at_ = &step;
  StepResult result;
  result.step = step.step;
  result.stage = step.stage;
  result.time = step.time;
  result.pressure_change = loads.pressure_change;
  result.temperature_change = loads.temperature_change;
  const Eigen::VectorXd jump_before = state_.jump;
  AcceptedStep accepted;
  const bool searches = narrows_ && scene_.numerics.activation_tolerance > 0 && before != nullptr;
  if (probe_.accepted || searches) accepted.before = state_;
  SolvedStep solved = solver_->advance(step, loads, state_);
  const ContactReport& report = solved.contact;
  result.creep = std::move(solved.creep);
  creep_traction_ = std::move(solved.creep_traction);
  if (solved.linear) result_.coupled->add(*solved.linear);
  result.coupled = std::move(solved.linear);
  result.outcome = report.outcome;
  result.reason = report.reason;
  result.counts = report.counts;
  result_.counts += report.counts;
  const bool good = in_equilibrium(report.outcome);
  record_events(step, before, loads, report.jumps);
  result.seconds = stopwatch.seconds();
  if (good) {
    record(step, loads, jump_before, result);
    if (probe_.accepted) show(before, loads, solved, result, accepted);
  } else {
    result_.outcome = report.outcome;
    result_.reason = concat("load step ", step.step, " (", step.stage, "): ", report.reason);
    result_.failed_step = step.step;
    // What slips in a step that has no end: judged by the traction of faults held as they were.
    Eigen::VectorXd trial = state_.traction + loads.locked;
    if (before != nullptr) trial -= before->locked;
    note_weakening(trial, true);
  }
  last_time_ = step.time;
  result_.steps.push_back(std::move(result));
  if (good && searches) narrow_onsets({*before, loads, accepted.before});
  return good;
}

/// A case with events is never called converged; with cells too coarse for its weakening, or with
/// an event whose evidence does not hold, it is marked.
void CaseRun::name_events() {
  const bool evident = std::ranges::all_of(result_.events, &SlipEvent::evidence_holds);
  if (result_.events.empty() || result_.outcome != Outcome::converged) return;
  result_.outcome =
      result_.weakening_resolved && evident ? Outcome::event : Outcome::unresolved_event;
}

/// Identity and names, which the metrics of a step refer to.
void CaseRun::name_result() {
  result_.title = scene_.title;
  result_.identity = probe_.identity.empty() ? case_identity(scene_) : probe_.identity;
  result_.operator_fingerprint = op_.fingerprint;
  result_.numerics_version = kNumericsVersion;
  result_.plane_strain = op_.geometry.plane_strain;
  for (const PressureHistory& history : scene_.pressure)
    result_.region_names.push_back(history.region);
  result_.fault_names = fault_names(scene_);
  for (const ObservationRow& row : op_.observed.rows) result_.observation_names.push_back(row.name);
  solver_->describe(result_);
}

/// Goes through the load steps to their end, or as far as there is equilibrium.
void CaseRun::walk(const std::vector<LoadStep>& steps) {
  std::vector<StepLoads> loads;
  for (const LoadStep& step : steps) {
    loads.push_back(loads_.at(step.time));
    loads_.check_fault_pressure(step, loads.back());
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    at_ = &steps[i];
    context_.stop.throw_if_requested("starting a load step");
    if (stage_ && steps[i].stage != steps[i - 1].stage) {
      result_.stages.push_back(stage_->finish());
      stage_.reset();
    }
    if (!advance(steps[i], i == 0 ? nullptr : &loads[i - 1], loads[i])) break;
    if (probe_.displaced && is_stage_end(steps, i))
      probe_.displaced(result_.steps.back(), solver_->displacement(loads[i], state_));
    context_.progress(static_cast<double>(i + 1) / static_cast<double>(steps.size()),
                      steps[i].stage);
  }
}

CaseResult CaseRun::run() {
  const Stopwatch stopwatch;
  name_result();
  result_.outcome = Outcome::converged;
  const std::vector<LoadStep> steps = load_steps(scene_);
  try {
    walk(steps);
  } catch (const Interrupted&) {  // the step at hand is given up, those before it stand
    result_.outcome = Outcome::interrupted;
    result_.reason = concat("stopped in load step ", at_->step);
  }
  if (stage_) result_.stages.push_back(stage_->finish());
  result_.whole = whole_.finish();
  result_.episodes = episodes_.finish();
  result_.unexpected = unexpected_reactivation(result_.episodes);
  if (!result_.whole.activated && !result_.whole.opens) {
    const std::span<const StepResult> all(result_.steps);
    result_.pressure_margin =
        pressure_margin(all.first(all.size() - (result_.failed_step ? 1 : 0)));
  }
  result_.weakening_resolved = result_.max_nucleation_ratio <= 1.0 / 3.0;
  name_events();
  result_.warnings = case_warnings(scene_, op_, meter_, result_);
  result_.seconds = stopwatch.seconds();
  return std::move(result_);
}

/// The steps before are solved as run() does; their metrics are by the way.
StepStart CaseRun::start_of(int step) {
  narrows_ = false;
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
    const StepLoads loads = loads_.at(next.time);
    loads_.check_fault_pressure(next, loads);
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

/// What solves the steps of cases on an operator.
MakeStepSolver steps_on(const PreparedOperator& prepared) {
  CreepLadder* bulk = prepared.bulk.get();
  return bulk != nullptr && bulk->n_rungs() > 1 ? creep_steps(*bulk)
                                                : elastic_steps(*prepared.op, bulk);
}

}  // namespace

CaseResult run_case(const Scene& scene, const PreparedOperator& prepared, const RunContext& context,
                    const CaseProbe& probe) {
  CaseResult result =
      CaseRun(scene, *prepared.op, prepared.loads, steps_on(prepared), context, probe).run();
  result.field_coverage = prepared.field_coverage;
  result.field_assumed = prepared.field_assumed;
  result.warnings.insert(result.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
  result.surface = prepared.surface;
  if (result.surface) result.warnings.push_back(surface_warning(*result.surface));
  return result;
}

CaseResult run_case(const Scene& scene, const FaultOperator& faults, const MakeStepSolver& solver,
                    const RunContext& context, const CaseProbe& probe) {
  return CaseRun(scene, faults, {}, solver, context, probe).run();
}

StepStart start_of_step(const Scene& scene, const PreparedOperator& prepared, int step,
                        const RunContext& context) {
  const CaseProbe no_probe;
  return CaseRun(scene, *prepared.op, prepared.loads, elastic_steps(*prepared.op, nullptr), context,
                 no_probe)
      .start_of(step);
}

}  // namespace faultsim
