#include "tests/stress/scene_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "simulator/fault/friction_law.h"
#include "tests/stress/stress_operators.h"

namespace faultsim {
namespace {

/// One load step of a scene: what went in and what came out.
struct StepRecord {
  Eigen::VectorXd locked_before, locked;
  ContactState before, after;
  ContactReport report;
};

std::vector<StepRecord> run(const RandomScene& scene, const FaultOperator& op,
                            const ContactLaws& laws) {
  ContactSolver solver(op, laws, options_of(scene));
  ContactState state = initial_state(op);
  Eigen::VectorXd last = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  std::vector<StepRecord> records;
  for (const Eigen::VectorXd& locked : locked_tractions(scene, op)) {
    StepRecord record;
    record.locked_before = last;
    record.locked = locked;
    record.before = state;
    record.report = solver.solve_step(last, locked, state);
    record.after = state;
    records.push_back(std::move(record));
    if (!in_equilibrium(records.back().report.outcome)) break;
    last = locked;
  }
  return records;
}

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

bool same_bits(const ContactState& a, const ContactState& b) {
  return same_bits(a.jump, b.jump) && same_bits(a.traction, b.traction) && a.state == b.state &&
         same_bits(a.slip_path, b.slip_path) && a.cohesion_lost == b.cohesion_lost;
}

/// Checks one step; what is wrong goes into `violations`.
class StepJudge {
 public:
  StepJudge(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& options,
            const StepRecord& record, std::string where, std::vector<std::string>& violations)
      : op_(op),
        laws_(laws),
        options_(options),
        step_(record),
        where_(std::move(where)),
        violations_(violations) {
    set_tolerances();
  }

  void run() {
    check_counts();
    if (!in_equilibrium(step_.report.outcome)) {
      check_failure();
      return;
    }
    const ContactState& after = step_.after;
    demand(after.jump.allFinite() && after.traction.allFinite() && after.slip_path.allFinite(),
           "numbers that are not finite");
    check_equilibrium();
    check_history();
    check_energy();
    check_jumps();
  }

 private:
  void demand(bool holds, const std::string& what) {
    if (!holds) violations_.push_back(where_ + what);
  }
  /// value <= limit, and not NaN.
  void require_at_most(double value, double limit, const char* what) {
    if (value <= limit) return;
    std::ostringstream text;
    text << where_ << what << " " << value << ", at most " << limit;
    violations_.push_back(text.str());
  }
  bool at_once() const { return step_.report.counts.sub_steps == 1 && step_.report.jumps.empty(); }
  Eigen::Vector2d shear(const Eigen::VectorXd& values, std::size_t k) const {
    const auto& dof = op_.geometry.nodes[k].dof;
    return {dof[1] >= 0 ? values[dof[1]] : 0, dof[2] >= 0 ? values[dof[2]] : 0};
  }
  void set_tolerances();
  void check_counts();
  void check_failure();
  void check_equilibrium();
  void check_history();
  void check_energy();
  void check_jumps();

  const FaultOperator& op_;
  const ContactLaws& laws_;
  const ContactOptions& options_;
  const StepRecord& step_;
  std::string where_;
  std::vector<std::string>& violations_;
  double traction_ = 0;     ///< Pa.
  double equilibrium_ = 0;  ///< Pa, rounding of t' = t_L − A⁻¹ H g.
};

/// The solver promises ContactOptions::traction_tolerance of each node's level up to a factor of 4;
/// here of the highest level on the faults.
void StepJudge::set_tolerances() {
  const double level = std::max(
      {step_.locked.lpNorm<Eigen::Infinity>(), step_.locked_before.lpNorm<Eigen::Infinity>(),
       step_.before.traction.lpNorm<Eigen::Infinity>(),
       step_.after.traction.lpNorm<Eigen::Infinity>(),
       (step_.before.traction + step_.locked - step_.locked_before).lpNorm<Eigen::Infinity>()});
  const double sum = (op_.h().cwiseAbs() * step_.after.jump.cwiseAbs())
                         .cwiseQuotient(op_.geometry.dof_area)
                         .lpNorm<Eigen::Infinity>();
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double sub_steps = std::max(step_.report.counts.sub_steps, 1);
  equilibrium_ = 1e-3 + 64 * kEpsilon * (level + sum) * std::sqrt(sub_steps);
  traction_ = 5 * options_.traction_tolerance * level + equilibrium_;
}

/// Iterations of a step, thrown-away ones included: max_iterations, which ends the following of
/// jumps; what one more damped step and a static try may take; and the tries without damping, one
/// per part of a step and width, with at most three searches each.
void StepJudge::check_counts() {
  const SolveCounts& counts = step_.report.counts;
  const int cuts = std::max(options_.max_step_cuts,
                            static_cast<int>(std::ceil(std::log2(1 / options_.onset_tolerance))));
  const int units = 1 << cuts;
  const int search = options_.max_active_set_passes + options_.max_newton_iterations;
  constexpr int kHalvings = 60;  // of a damped step
  const double bound = options_.max_iterations +
                       static_cast<double>(search) * (3 * units * (cuts + 1) + kHalvings + 3);
  require_at_most(counts.newton_iterations + counts.wasted_newton_iterations, bound, "iterations:");
  demand(counts.sub_steps <= units, "more sub-steps than the step has");
  demand(counts.newton_iterations >= 0 && counts.wasted_newton_iterations >= 0 &&
             counts.active_set_passes >= 0,
         "negative counts");
}

void StepJudge::check_failure() {
  const ContactReport& report = step_.report;
  demand(report.outcome == Outcome::unstable || report.outcome == Outcome::unconverged,
         std::string("outcome ") + to_string(report.outcome));
  demand(same_bits(step_.before, step_.after), "a failed step changed the state");
  demand(report.reason.find("fault '") != std::string::npos,
         "the reason names no node: " + report.reason);
}

void StepJudge::check_equilibrium() {
  // Over a step that was cut only its end is compared: (5) in its rate form held per sub-step.
  const ContactViolation v = contact_violation(op_, laws_, step_.locked,
                                               at_once() ? step_.before : step_.after, step_.after);
  double softest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < op_.geometry.dof_area.size(); ++i) {
    softest = std::min(softest, op_.h()(i, i) / op_.geometry.dof_area[i]);
  }
  require_at_most(v.tension, traction_, "tension over closed nodes, Pa:");
  require_at_most(v.over_limit, traction_, "shear over the limit, Pa:");
  require_at_most(v.open_traction, traction_, "traction over open nodes, Pa:");
  require_at_most(v.penetration, traction_ / softest, "penetration, m:");
  require_at_most(v.equilibrium, equilibrium_, "t' - (t_L - H g/A), Pa:");
  require_at_most(v.slip_below_limit, traction_, "slip below the limit, Pa:");
  require_at_most(v.misaligned, traction_, "slip not along its traction, Pa:");
  // Who slips at the end of the step is at the limit there, whatever the way.
  for (std::size_t k = 0; k < step_.after.state.size(); ++k) {
    if (step_.after.state[k] != FaultState::slip) continue;
    const OperatorNode& node = op_.geometry.nodes[k];
    const double limit = NodeLaw(laws_[k]).limit(
        step_.after.traction[node.dof[0]], friction_state(node, step_.after, static_cast<int>(k)));
    require_at_most(std::abs(shear(step_.after.traction, k).norm() - limit), traction_,
                    "a slipping node off its limit, Pa:");
  }
}

void StepJudge::check_history() {
  const Eigen::VectorXd moved = step_.after.jump - step_.before.jump;
  for (std::size_t k = 0; k < step_.after.state.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double path = step_.after.slip_path[i] - step_.before.slip_path[i];
    const double slip = shear(moved, k).norm();
    demand(path >= 0, "a slip path that shrinks");
    require_at_most(slip, path + 1e-12 * (1 + step_.after.slip_path[i]),
                    "slip beyond its path, m:");
    demand(step_.after.cohesion_lost[k] || !step_.before.cohesion_lost[k], "cohesion came back");
    demand(step_.after.state[k] != FaultState::open || step_.after.cohesion_lost[k] ||
               laws_[k].cohesion_after_opening,
           "an open node kept its cohesion");
    demand(path == 0 || step_.after.cohesion_lost[k] || laws_[k].cohesion_after_slip,
           "a node that slipped kept its cohesion");
  }
}

/// Friction dissipates at every node, A t'_T · Δg_T >= 0, where the step was made at once.
void StepJudge::check_energy() {
  if (!at_once()) return;
  const Eigen::VectorXd moved = step_.after.jump - step_.before.jump;
  for (std::size_t k = 0; k < step_.after.state.size(); ++k) {
    const Eigen::Vector2d slip = shear(moved, k);
    const double work = shear(step_.after.traction, k).dot(slip);
    require_at_most(-work, traction_ * slip.norm(), "friction gives energy, J/m2:");
  }
}

void StepJudge::check_jumps() {
  const ContactReport& report = step_.report;
  demand(report.reason.empty(), "a reason although in equilibrium");
  demand((report.outcome == Outcome::event) == !report.jumps.empty(), "event without jump");
  double last = 0;
  for (const ContactJump& jump : report.jumps) {
    demand(jump.load_before >= last && jump.load_after > jump.load_before && jump.load_after <= 1,
           "jumps out of order");
    last = jump.load_before;
    demand(jump.negative_pivots > 0 || jump.n_lost_cohesion > 0, "a jump without evidence");
    require_at_most(-jump.dissipated, 0, "a jump's friction gives energy, J:");
    const double rounding = 1e-9 * std::abs(jump.released);
    require_at_most(jump.dissipated - jump.released, rounding,
                    "a jump dissipates more than was released, J:");
    require_at_most(jump.residual_before, 5, "a jump does not start from equilibrium:");
    require_at_most(jump.residual_after, 5, "a jump does not end in equilibrium:");
    demand(jump.jump_after.allFinite() && jump.traction_after.allFinite() && jump.duration > 0 &&
               std::isfinite(jump.duration),
           "a jump that is not finite");
  }
}

void count(const std::vector<StepRecord>& records, bool follows, StressTally& tally) {
  ++tally.n_scenes;
  for (const StepRecord& record : records) {
    const ContactReport& report = record.report;
    const int iterations = report.counts.newton_iterations + report.counts.wasted_newton_iterations;
    ++tally.n_steps;
    tally.iterations += iterations;
    tally.most_iterations = std::max(tally.most_iterations, iterations);
    tally.n_cut += report.counts.sub_steps > 1;
    tally.n_jumps += static_cast<int>(report.jumps.size());
    for (const ContactJump& jump : report.jumps) tally.n_lost_cohesion += jump.n_lost_cohesion;
    for (std::size_t k = 0; k < record.after.state.size(); ++k) {
      const FaultState now = record.after.state[k];
      tally.n_open += now == FaultState::open;
      tally.n_slip += now == FaultState::slip;
      tally.n_stick += now == FaultState::stick;
      tally.n_closed_again += now != FaultState::open && record.before.state[k] == FaultState::open;
    }
  }
  const Outcome outcome = records.back().report.outcome;
  bool jumped = false;
  for (const StepRecord& record : records) jumped = jumped || !record.report.jumps.empty();
  if (outcome == Outcome::unconverged) {
    ++tally.scenes_ended[3];
  } else if (outcome == Outcome::unstable) {
    ++tally.scenes_ended[2];
  } else {
    ++tally.scenes_ended[jumped ? 1 : 0];
  }
  tally.n_unsolved_followed += follows && !in_equilibrium(outcome);
}

/// Whether some node has cohesion that outlives opening.
bool keeps_cohesion(const ContactLaws& laws) {
  return std::any_of(laws.begin(), laws.end(), [](const CoulombLaw& law) {
    return law.cohesion_after_opening && law.cohesion > 0;
  });
}

/// A second run gives the same bits, whatever the solver did before.
bool repeats(const std::vector<StepRecord>& records, const std::vector<StepRecord>& again) {
  if (again.size() != records.size()) return false;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const SolveCounts& a = records[i].report.counts;
    const SolveCounts& b = again[i].report.counts;
    if (!same_bits(records[i].after, again[i].after) ||
        a.newton_iterations != b.newton_iterations || a.sub_steps != b.sub_steps) {
      return false;
    }
  }
  return true;
}

}  // namespace

SceneReport check_scene(const RandomScene& scene, StressTally& tally) {
  const FaultOperator& op = *stress_operators()[static_cast<std::size_t>(scene.op)].op;
  const ContactLaws laws = laws_of(scene, op);
  const ContactOptions options = options_of(scene);
  const std::vector<StepRecord> records = run(scene, op, laws);
  count(records, scene.follows, tally);
  SceneReport report;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::string where = "step " + std::to_string(i) + ": ";
    StepJudge(op, laws, options, records[i], where, report.violations).run();
  }
  report.outcome = records.back().report.outcome;
  report.unsolved = records.back().report.reason;
  const bool edge =
      report.outcome == Outcome::unconverged && !scene.follows && keeps_cohesion(laws);
  tally.n_edge_of_opening += edge;
  report.excused = edge || (report.outcome == Outcome::unstable && !scene.follows);
  constexpr int kRepeated = 8;  // one in so many, to save time
  if (tally.n_scenes % kRepeated == 0 && !repeats(records, run(scene, op, laws))) {
    report.violations.push_back("a second run differs");
  }
  return report;
}

}  // namespace faultsim
