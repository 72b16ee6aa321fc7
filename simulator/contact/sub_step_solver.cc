#include "simulator/contact/sub_step_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/contact/node_relaxation.h"

namespace faultsim {

SubStepSolver::SubStepSolver(const FaultOperator& op, const ContactLaws& laws,
                             const ContactOptions& options)
    : options_(options),
      problem_(op, laws),
      scalar_(problem_, options_),
      newton_(problem_, options_),
      stability_(problem_) {}

void SubStepSolver::begin(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                          const SubStepRange& range, const ContactState& start) {
  SubStep& s = sub_step_;
  s.start = &start;
  if (range.from == 0 && range.to == 1) {
    s.trial = start.traction + (after - before);
    s.locked = after;
  } else {
    s.trial = start.traction + (range.to - range.from) * (after - before);
    s.locked = before + range.to * (after - before);
  }
  FAULTSIM_DEMAND(s.trial.allFinite(), "locked traction of a load step is not finite");
  s.traction = s.trial;
  s.damping_per_second = range.duration > 0 ? 1 / range.duration : 0;
  const auto n = static_cast<std::size_t>(problem_.n_nodes());
  s.state.assign(n, FaultState::stick);
  s.cohesive.resize(n);
  closed_ = true;
  for (std::size_t i = 0; i < n; ++i) {
    s.cohesive[i] = !start.cohesion_lost[i];
    if (start.jump[problem_.nodes[i].dof[0]] != 0 || start.state[i] == FaultState::open) {
      closed_ = false;
    }
  }
  set_tolerance();
  iterations_ = passes_ = 0;
}

/// Relative to the traction level of the node; but a node that carries little is not asked for more
/// than a thousandth of the highest level, and none for more than rounding leaves of A⁻¹ H g.
void SubStepSolver::set_tolerance() {
  SubStep& s = sub_step_;
  const ContactState& start = *s.start;
  constexpr double kLowest = 1e-3;
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
  const double largest_jump = start.jump.size() > 0 ? start.jump.cwiseAbs().maxCoeff() : 0;
  s.tolerance.resize(problem_.n_nodes());
  double highest = 0;
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[static_cast<std::size_t>(k)];
    double level = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(node.n_dofs); ++c) {
      level = std::max({level, std::abs(s.trial[node.dof[c]]), std::abs(s.locked[node.dof[c]]),
                        std::abs(start.traction[node.dof[c]])});
    }
    s.tolerance[k] = level;
    highest = std::max(highest, level);
  }
  s.tolerance = options_.traction_tolerance * s.tolerance.cwiseMax(kLowest * highest).array();
  if (largest_jump == 0) return;
  if (normal_stiffness_.size() == 0) {  // scattered reads: once per case, and only if it slips
    normal_stiffness_.resize(problem_.n_nodes());
    for (int k = 0; k < problem_.n_nodes(); ++k) {
      const ContactNode& node = problem_.nodes[static_cast<std::size_t>(k)];
      normal_stiffness_[k] = problem_.stiffness(node, 0);
    }
  }
  s.tolerance = s.tolerance.cwiseMax(kRounding * largest_jump * normal_stiffness_);
}

bool SubStepSolver::rest() {
  if (!closed_ || !at_rest()) return false;
  start_from_rest();
  stable_ = {};
  return true;
}

bool SubStepSolver::at_rest() const {
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem_.nodes[i];
    const double normal = sub_step_.trial[node.dof[0]];
    if (normal > sub_step_.tolerance[k]) return false;
    if (node.n_dofs < 2) continue;
    double s = 0;
    if (node.weakens) {
      s = problem_.laws.cumulated[i] ? sub_step_.start->slip_path[k]
                                     : shear_part(node, sub_step_.start->jump).norm();
    }
    const double limit = problem_.strength(k, sub_step_.cohesive[i] != 0, normal, s).value;
    const double shear = node.n_dofs > 2 ? shear_part(node, sub_step_.trial).norm()
                                         : std::abs(sub_step_.trial[node.dof[1]]);
    if (shear - limit > sub_step_.tolerance[k]) return false;
  }
  return true;
}

void SubStepSolver::start_from_rest() {
  sub_step_.increment.setZero(problem_.n_dofs());
  sub_step_.traction = sub_step_.trial;
  std::fill(sub_step_.state.begin(), sub_step_.state.end(), FaultState::stick);
}

/// The most frequent case of check_node: two dofs, no weakening, closed and at rest.
bool SubStepSolver::rests_in_plane(int k, double margin) const {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = problem_.nodes[i];
  if (node.n_dofs != 2 || node.weakens || sub_step_.state[i] != FaultState::stick) return false;
  const double normal = sub_step_.traction[node.dof[0]];
  const double cohesion = sub_step_.cohesive[i] ? problem_.laws.node[i].cohesion : 0;
  return sub_step_.increment[node.dof[0]] == 0 && sub_step_.increment[node.dof[1]] == 0 &&
         sub_step_.start->jump[node.dof[0]] == 0 && normal <= margin &&
         std::abs(sub_step_.traction[node.dof[1]]) <=
             cohesion - std::min(normal, 0.0) * node.friction + margin;
}

/// (3)–(5) straight from their definition at each node: what decides whether a step is accepted.
bool SubStepSolver::verified() const {
  constexpr double kMargin = 4;  // the solvers stop at 1 to 1.5
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const double margin = kMargin * sub_step_.tolerance[k];
    if (!rests_in_plane(k, margin) && !(check_node(problem_, sub_step_, k).worst() <= margin)) {
      return false;
    }
  }
  return true;
}

double SubStepSolver::residual() const {
  double worst = 0;
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    worst = std::max(worst, check_node(problem_, sub_step_, k).worst() / sub_step_.tolerance[k]);
  }
  return worst;
}

bool SubStepSolver::count(const NewtonReport& report) {
  iterations_ += report.iterations;
  passes_ += report.passes;
  return report.converged && verified();
}

/// With weakening, failure often means that there is nothing near to be found, so smaller
/// sub-steps and damping come before relaxation.
bool SubStepSolver::solve_motion(bool last) {
  const bool damped = sub_step_.damping_per_second > 0;
  if (problem_.scalar && closed_ && !damped) {
    start_from_rest();
    if (count(scalar_.solve(sub_step_))) return true;
  }
  start_from_rest();
  constexpr int kPatience = 8;
  const bool smaller_follow = damped || (problem_.may_jump && !last);
  if (count(newton_.solve(sub_step_, smaller_follow ? kPatience : 0))) return true;
  if (smaller_follow) return false;
  constexpr int kSweeps = 200;
  for (const int sweeps : {kSweeps, 5 * kSweeps}) {
    start_from_rest();
    relax(problem_, sub_step_, sweeps);
    if (count(newton_.solve(sub_step_))) return true;
    if (problem_.may_jump) break;
  }
  return false;
}

bool SubStepSolver::loses_cohesion() const {
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    if (faultsim::loses_cohesion(problem_, sub_step_, k)) return true;
  }
  return false;
}

Attempt SubStepSolver::attempt(bool last) {
  stable_ = {};
  const bool solved = solve_motion(last);
  if (problem_.any_weakening) stable_ = stability_.check(sub_step_);
  if (!solved) return Attempt::failed;
  if (!stable_.stable) return Attempt::not_shown_stable;
  const bool damped = sub_step_.damping_per_second > 0;
  return !damped && loses_cohesion() ? Attempt::lost_cohesion : Attempt::converged;
}

void SubStepSolver::commit(ContactState& state) const {
  const ContactLaws& laws = problem_.laws;
  state.traction = sub_step_.traction;
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem_.nodes[i];
    state.state[i] = sub_step_.state[i];
    // Not cohesive although it was: opened and closed again within the sub-step.
    const bool opened = sub_step_.state[i] == FaultState::open || !sub_step_.cohesive[i];
    if (opened && !laws.keep_cohesion[i]) state.cohesion_lost[i] = 1;
    const Eigen::Vector2d slip = shear_part(node, sub_step_.increment);
    if (slip[0] == 0 && slip[1] == 0) continue;
    state.slip_path[k] += slip.norm();
    if (!laws.lose_cohesion_slipping.empty() && laws.lose_cohesion_slipping[i] != 0) {
      state.cohesion_lost[i] = 1;
    }
  }
  state.jump += sub_step_.increment;
}

}  // namespace faultsim
