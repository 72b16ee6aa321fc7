#include "simulator/contact/contact.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/contact/contact_newton.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/node_relaxation.h"
#include "simulator/contact/scalar_slip.h"
#include "simulator/contact/stability.h"
#include "simulator/contact/step_report.h"

namespace faultsim {

ContactState initial_state(const FaultOperator& op) {
  const std::size_t n = op.geometry.nodes.size();
  ContactState state;
  state.jump = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  state.traction = state.jump;
  state.state.assign(n, FaultState::stick);
  state.slip_path = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  state.opened.assign(n, 0);
  return state;
}

namespace {

enum class Attempt { converged, failed, not_shown_stable };

}  // namespace

struct ContactSolver::Impl {
  Impl(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& given)
      : options(given),
        problem(op, laws),
        scalar(problem, options),
        newton(problem, options),
        stability(problem) {}

  bool begin(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double from, double to,
             const ContactState& start);
  bool at_rest() const;
  void start_from_rest();
  bool rests_in_plane(int node, double margin) const;
  bool verified() const;
  bool count(const NewtonReport& report);
  bool solve_motion(bool may_cut);
  Attempt attempt(bool may_cut);
  void commit(ContactState& state) const;
  ContactReport cut(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                    ContactState& state);

  ContactOptions options;
  ContactProblem problem;
  ScalarSlip scalar;
  ContactNewton newton;
  StabilityCheck stability;
  SubStep sub_step;
  bool closed = true;  ///< no gap at the start of the sub-step.
  StabilityReport stable;
  SolveCounts counts;    ///< of the step.
  int iterations = 0;    ///< of the attempt.
  ContactState rolling;  ///< the state between sub-steps.
};

ContactSolver::ContactSolver(const FaultOperator& op, const ContactLaws& laws,
                             const ContactOptions& options)
    : impl_(std::make_unique<Impl>(op, laws, options)) {}
ContactSolver::~ContactSolver() = default;

/// Sets up the sub-step over load factors [from, to] of the step. @returns whether rest is a
/// solution.
bool ContactSolver::Impl::begin(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                double from, double to, const ContactState& start) {
  SubStep& s = sub_step;
  s.start = &start;
  if (from == 0 && to == 1) {
    s.trial = start.traction + (after - before);
    s.locked = after;
  } else {
    s.trial = start.traction + (to - from) * (after - before);
    s.locked = before + to * (after - before);
  }
  FAULTSIM_DEMAND(s.trial.allFinite(), "locked traction of a load step is not finite");
  s.traction = s.trial;
  const int n = problem.n_nodes();
  s.state.resize(static_cast<std::size_t>(n));
  s.cohesive.resize(static_cast<std::size_t>(n));
  s.tolerance.resize(n);
  closed = true;
  double highest = 0;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem.nodes[i];
    double level = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(node.n_dofs); ++c) {
      level = std::max({level, std::abs(s.trial[node.dof[c]]), std::abs(s.locked[node.dof[c]]),
                        std::abs(start.traction[node.dof[c]])});
    }
    s.tolerance[k] = level;
    highest = std::max(highest, level);
    s.cohesive[i] = !start.opened[i] || problem.laws.keep_cohesion[i];
    s.state[i] = FaultState::stick;
    if (start.jump[node.dof[0]] != 0 || start.state[i] == FaultState::open) closed = false;
  }
  // A node that carries little is not asked for more than a thousandth of the highest level.
  constexpr double kLowest = 1e-3;
  s.tolerance = options.traction_tolerance * s.tolerance.cwiseMax(kLowest * highest).array();
  return closed && at_rest();
}

bool ContactSolver::Impl::at_rest() const {
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem.nodes[i];
    const double normal = sub_step.trial[node.dof[0]];
    if (normal > sub_step.tolerance[k]) return false;
    if (node.n_dofs < 2) continue;
    double s = 0;
    if (node.weakens) {
      s = problem.laws.cumulated[i] ? sub_step.start->slip_path[k]
                                    : shear_part(node, sub_step.start->jump).norm();
    }
    const double limit = problem.strength(k, sub_step.cohesive[i] != 0, normal, s).value;
    const double shear = node.n_dofs > 2 ? shear_part(node, sub_step.trial).norm()
                                         : std::abs(sub_step.trial[node.dof[1]]);
    if (shear - limit > sub_step.tolerance[k]) return false;
  }
  return true;
}

void ContactSolver::Impl::start_from_rest() {
  sub_step.increment.setZero(problem.n_dofs());
  sub_step.traction = sub_step.trial;
  std::fill(sub_step.state.begin(), sub_step.state.end(), FaultState::stick);
}

/// The most frequent case of check_node: two dofs, no weakening, closed and at rest.
bool ContactSolver::Impl::rests_in_plane(int k, double margin) const {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = problem.nodes[i];
  if (node.n_dofs != 2 || node.weakens || sub_step.state[i] != FaultState::stick) return false;
  const double normal = sub_step.traction[node.dof[0]];
  const double cohesion = sub_step.cohesive[i] ? problem.laws.node[i].cohesion : 0;
  return sub_step.increment[node.dof[0]] == 0 && sub_step.increment[node.dof[1]] == 0 &&
         sub_step.start->jump[node.dof[0]] == 0 && normal <= margin &&
         std::abs(sub_step.traction[node.dof[1]]) <=
             cohesion - std::min(normal, 0.0) * node.friction + margin;
}

/// D2-D3 straight from their definition at each node: what decides whether a step is accepted.
bool ContactSolver::Impl::verified() const {
  constexpr double kMargin = 4;  // the solvers stop at 1 to 1.5
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const double margin = kMargin * sub_step.tolerance[k];
    if (!rests_in_plane(k, margin) && !(check_node(problem, sub_step, k).worst() <= margin)) {
      return false;
    }
  }
  return true;
}

bool ContactSolver::Impl::count(const NewtonReport& report) {
  iterations += report.iterations;
  counts.active_set_passes += report.passes;
  return report.converged && verified();
}

/// From rest by the fast road, by Newton, and by Newton after relaxation. With weakening, failure
/// often means that there is nothing near to be found, so cutting comes before relaxing.
bool ContactSolver::Impl::solve_motion(bool may_cut) {
  if (problem.scalar && closed) {
    start_from_rest();
    if (count(scalar.solve(sub_step))) return true;
  }
  start_from_rest();
  if (count(newton.solve(sub_step))) return true;
  if (problem.any_weakening && may_cut) return false;
  constexpr int kSweeps = 200;
  for (const int sweeps : {kSweeps, 5 * kSweeps}) {
    start_from_rest();
    relax(problem, sub_step, sweeps);
    if (count(newton.solve(sub_step))) return true;
    if (problem.any_weakening) break;
  }
  return false;
}

Attempt ContactSolver::Impl::attempt(bool may_cut) {
  stable = {};
  const bool solved = solve_motion(may_cut);
  if (problem.any_weakening) stable = stability.check(sub_step);
  if (!solved) return Attempt::failed;
  return stable.stable ? Attempt::converged : Attempt::not_shown_stable;
}

void ContactSolver::Impl::commit(ContactState& state) const {
  state.traction = sub_step.traction;
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem.nodes[i];
    state.state[i] = sub_step.state[i];
    if (sub_step.state[i] == FaultState::open) state.opened[i] = 1;
    // Opened and closed again within the sub-step: its cohesion is gone all the same.
    if (!sub_step.cohesive[i] && !problem.laws.keep_cohesion[i]) state.opened[i] = 1;
    const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
    if (slip[0] != 0 || slip[1] != 0) state.slip_path[k] += slip.norm();
  }
  state.jump += sub_step.increment;
}

ContactReport ContactSolver::solve_step(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                        ContactState& state) {
  Impl& impl = *impl_;
  const auto n = impl.problem.n_dofs();
  FAULTSIM_DEMAND(before.size() == n && after.size() == n && state.jump.size() == n, "n_dofs ", n,
                  " before ", before.size(), " after ", after.size());
  impl.counts = {};
  ContactReport report;
  if (impl.begin(before, after, 0, 1, state)) {
    state.traction = impl.sub_step.trial;
    std::fill(state.state.begin(), state.state.end(), FaultState::stick);
    report.outcome = Outcome::converged;
    report.counts.sub_steps = 1;
    return report;
  }
  impl.iterations = 0;
  if (impl.attempt(impl.options.max_step_cuts > 0) == Attempt::converged) {
    impl.commit(state);
    impl.counts.newton_iterations = impl.iterations;
    impl.counts.sub_steps = 1;
    report.outcome = Outcome::converged;
    report.counts = impl.counts;
    return report;
  }
  return impl.cut(before, after, state);
}

/// Halves the step where it fails and doubles again where it works: sub-steps [p, p +
/// 2^(max−level)] in units of 2^−max.
ContactReport ContactSolver::Impl::cut(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                       ContactState& state) {
  ContactReport report;
  rolling = state;
  counts.wasted_newton_iterations = iterations;
  const int most = options.max_step_cuts;
  const int units = 1 << most;
  int position = 0;
  int level = 1;
  Attempt last = Attempt::failed;
  while (position < units && level <= most) {
    const int width = units >> level;
    const double from = static_cast<double>(position) / units;
    const double to = static_cast<double>(position + width) / units;
    iterations = 0;
    const bool rest = begin(before, after, from, to, rolling);
    last = Attempt::converged;
    if (rest) {
      sub_step.increment.setZero(problem.n_dofs());
    } else {
      last = attempt(level < most);
    }
    if (last != Attempt::converged) {
      counts.wasted_newton_iterations += iterations;
      ++level;
      continue;
    }
    commit(rolling);
    counts.newton_iterations += iterations;
    ++counts.sub_steps;
    position += width;
    // One doubling per success, and only onto the grid of the doubled width.
    if (position % (2 * width) == 0 && position + 2 * width <= units) --level;
  }
  report.counts = counts;
  if (position == units) {
    std::swap(state, rolling);
    report.outcome = Outcome::converged;
    return report;
  }
  const double from = static_cast<double>(position) / units;
  const double to = static_cast<double>(position + 1) / units;
  const bool weakens = stable.checked;
  report.outcome = weakens ? Outcome::unstable : Outcome::unconverged;
  report.reason = weakens ? instability_text(problem, sub_step, stable, from, to)
                          : failure_text(problem, sub_step, counts, from, to);
  return report;
}

ContactViolation contact_violation(const FaultOperator& op, const ContactLaws& laws,
                                   const Eigen::VectorXd& locked, const ContactState& before,
                                   const ContactState& after) {
  const ContactProblem problem(op, laws);
  SubStep s;
  s.start = &before;
  s.locked = locked;
  s.increment = after.jump - before.jump;
  s.traction = after.traction;
  s.state = after.state;
  s.cohesive.resize(laws.node.size());
  ContactViolation violation;
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem.nodes[i];
    s.cohesive[i] = !after.opened[i] || laws.keep_cohesion[i];
    const NodeViolation at = check_node(problem, s, k);
    violation.tension = std::max(violation.tension, at.tension);
    violation.over_limit = std::max(violation.over_limit, at.over_limit);
    violation.slip_below_limit = std::max(violation.slip_below_limit, at.below_limit);
    violation.misaligned = std::max(violation.misaligned, at.misaligned);
    violation.open_traction = std::max(violation.open_traction, at.open_traction);
    violation.penetration = std::max(violation.penetration, -after.jump[node.dof[0]]);
  }
  const Eigen::VectorXd product = (op.h * after.jump).cwiseQuotient(op.dof_area);
  violation.equilibrium = (after.traction - locked + product).lpNorm<Eigen::Infinity>();
  return violation;
}

}  // namespace faultsim
