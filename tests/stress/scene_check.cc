#include "tests/stress/scene_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "simulator/contact/judge.h"
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
    check_conditions();
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
  void set_tolerances();
  void check_counts();
  void check_failure();
  void check_conditions();
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

void StepJudge::check_conditions() {
  const Verdict verdict = judge_step(
      op_, laws_, {step_.locked_before, step_.locked, step_.before, step_.after, at_once()});
  const Misses& miss = verdict.pascal;
  require_at_most(miss.tension, traction_, "tension over closed nodes, Pa:");
  require_at_most(miss.over_limit, traction_, "shear over the limit, Pa:");
  require_at_most(miss.open_traction, traction_, "traction over open nodes, Pa:");
  require_at_most(miss.penetration, traction_, "penetration, Pa:");
  require_at_most(miss.equilibrium, equilibrium_, "t' - (t_L - H g/A), Pa:");
  require_at_most(miss.below_limit, traction_, "slip below the limit, Pa:");
  require_at_most(miss.misaligned, traction_, "slip not along its traction, Pa:");
  require_at_most(miss.memory, equilibrium_, "memory of slip or cohesion, Pa:");
  require_at_most(verdict.largest_energy(), 1e-6, "energies, relative:");
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
