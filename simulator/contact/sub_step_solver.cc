#include "simulator/contact/sub_step_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/contact/node_relaxation.h"

namespace faultsim {

SubStepSolver::SubStepSolver(const FaultOperator& op, const ContactLaws& laws,
                             const ContactOptions& options, const ContactWatch& watch)
    : options_(options),
      watch_(watch),
      problem_(op, laws, watch.team),
      scalar_(problem_, options_, watch.stop),
      newton_(problem_, options_, watch.stop),
      stability_(problem_) {}

void SubStepSolver::begin(const LoadPath& path, const SubStepRange& range,
                          const ContactState& start) {
  SubStep& s = sub_step_;
  s.start = &start;
  s.trial = start.traction + path.change(range.from, range.to);
  s.locked = path.at(range.to);
  FAULTSIM_DEMAND(s.trial.allFinite(), "locked traction of a load step is not finite");
  s.traction = s.trial;
  s.per_second = range.duration > 0 ? 1 / range.duration : 0;
  const auto n = static_cast<std::size_t>(problem_.n_nodes());
  s.state.assign(n, FaultState::stick);
  s.cohesive.resize(n);
  closed_ = true;
  rests_ = false;
  for (std::size_t i = 0; i < n; ++i) {
    s.cohesive[i] = !start.cohesion_lost[i];
    if (start.jump[problem_.nodes[i].dof[0]] != 0 || start.state[i] == FaultState::open) {
      closed_ = false;
    }
  }
  set_tolerance();
  trace_.from = range.from;
  trace_.to = range.to;
  trace_.duration = range.duration;
  trace_.n_nodes = problem_.n_nodes();
  trace_.searches.clear();
}

/// Relative to the traction level of the node; but a node that carries little is not asked for more
/// than a thousandth of the highest level, and none for more than rounding leaves of A⁻¹ H g.
void SubStepSolver::set_tolerance() {
  SubStep& s = sub_step_;
  const ContactState& start = *s.start;
  constexpr double kLowest = 1e-3;
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
  const double largest_jump = start.jump.size() > 0 ? start.jump.cwiseAbs().maxCoeff() : 0;
  level_ = s.trial.cwiseAbs().cwiseMax(s.locked.cwiseAbs()).cwiseMax(start.traction.cwiseAbs());
  s.tolerance.resize(problem_.n_nodes());
  double highest = 0;
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    double level = level_[node.dof[0]];
    for (std::size_t c = 1; c < static_cast<std::size_t>(node.n_dofs); ++c)
      level = std::max(level, level_[node.dof[c]]);
    s.tolerance[k] = level;
    highest = std::max(highest, level);
  }
  s.tolerance = options_.traction_tolerance * s.tolerance.cwiseMax(kLowest * highest).array();
  if (largest_jump == 0) return;
  if (normal_stiffness_.size() == 0) {  // scattered reads: once per case, and only if it slips
    normal_stiffness_.resize(problem_.n_nodes());
    for (int k = 0; k < problem_.n_nodes(); ++k) {
      const ContactNode& node = problem_.nodes[k];
      normal_stiffness_[k] = problem_.compliance.diagonal_bound(node.dof[0]) * node.inverse_area[0];
    }
  }
  s.tolerance = s.tolerance.cwiseMax(kRounding * largest_jump * normal_stiffness_);
}

bool SubStepSolver::rest() {
  rests_ = closed_ && at_rest();
  if (!rests_) return false;
  start_from_rest();
  stable_ = {};
  conclude("accepted");
  return true;
}

bool SubStepSolver::at_rest() const {
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    const double normal = sub_step_.trial[node.dof[0]];
    if (normal > sub_step_.tolerance[k]) return false;
    if (node.n_dofs < 2) continue;
    const double limit = node.law->weakens() || !sub_step_.cohesive[k]
                             ? node.law->limit(normal, friction_before(node, sub_step_, k))
                             : node.law->static_limit(normal, true);
    const double shear = node.n_dofs > 2 ? shear_part(node, sub_step_.trial).norm()
                                         : std::abs(sub_step_.trial[node.dof[1]]);
    if (shear - limit > sub_step_.tolerance[k]) return false;
  }
  return true;
}

void SubStepSolver::start_from_rest() {
  sub_step_.increment.setZero(problem_.n_dofs());
  sub_step_.traction = sub_step_.trial;
  std::ranges::fill(sub_step_.state, FaultState::stick);
}

/// The most frequent case of check_node: two dofs, no weakening, closed and at rest.
bool SubStepSolver::rests_in_plane(int k, double margin) const {
  const ContactNode& node = problem_.nodes[k];
  if (node.n_dofs != 2 || node.law->weakens() || sub_step_.state[k] != FaultState::stick)
    return false;
  const double normal = sub_step_.traction[node.dof[0]];
  return sub_step_.increment[node.dof[0]] == 0 && sub_step_.increment[node.dof[1]] == 0 &&
         sub_step_.start->jump[node.dof[0]] == 0 && normal <= margin &&
         std::abs(sub_step_.traction[node.dof[1]]) <=
             node.law->static_limit(normal, sub_step_.cohesive[k] != 0) + margin;
}

/// (3)–(5) at each node: what decides whether a step is accepted.
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
    worst = worse(worst, check_node(problem_, sub_step_, k).over(sub_step_.tolerance[k]));
  }
  return worst;
}

bool SubStepSolver::solved_by(const char* way, SearchHistory history) {
  trace_.searches.push_back({way, std::move(history)});
  return trace_.searches.back().history.converged() && verified();
}

int SubStepSolver::iterations() const {
  int sum = 0;
  for (const SubStepTrace::Search& search : trace_.searches) sum += search.history.iterations;
  return sum;
}

int SubStepSolver::passes() const {
  int sum = 0;
  for (const SubStepTrace::Search& search : trace_.searches) sum += search.history.passes;
  return sum;
}

void SubStepSolver::conclude(const char* verdict) {
  trace_.verdict = verdict;
  if (watch_.tried) watch_.tried(trace_);
}

/// With weakening, failure often means that there is nothing near to be found, so smaller
/// sub-steps and damping come before relaxation.
bool SubStepSolver::solve_motion(bool last) {
  const bool damped = sub_step_.per_second > 0;
  if (problem_.scalar && closed_ && !damped) {
    start_from_rest();
    if (solved_by("plane strain", scalar_.solve(sub_step_))) return true;
  }
  start_from_rest();
  constexpr int kPatience =
      8;  // iterations without half the residual: a smaller sub-step is cheaper
  const bool smaller_follow = damped || (problem_.may_jump && !last);
  if (solved_by("newton", newton_.solve(sub_step_, smaller_follow ? kPatience : 0))) return true;
  if (smaller_follow) return false;
  constexpr int kSweeps = 200;  // a short try first: most need no more
  for (const int sweeps : {kSweeps, 5 * kSweeps}) {
    start_from_rest();
    relax(problem_, sub_step_, sweeps, watch_.stop);
    if (solved_by("relaxed", newton_.solve(sub_step_))) return true;
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
  if (problem_.laws.any_weakens()) stable_ = stability_.check(sub_step_);
  const bool damped = sub_step_.per_second > 0;
  const auto ends_as = [&](Attempt attempt, const char* verdict) {
    conclude(verdict);
    return attempt;
  };
  if (!solved) return ends_as(Attempt::failed, "failed");
  if (!stable_.stable) return ends_as(Attempt::not_shown_stable, "not shown stable");
  if (!damped && loses_cohesion()) return ends_as(Attempt::lost_cohesion, "loses cohesion by slip");
  return ends_as(Attempt::converged, "accepted");
}

void SubStepSolver::commit(ContactState& state) const {
  state.traction = sub_step_.traction;
  if (rests_) {  // closed as before, and nothing to remember
    state.state = sub_step_.state;
    state.jump += sub_step_.increment;
    return;
  }
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    state.state[k] = sub_step_.state[k];
    // Not cohesive although it was: opened and closed again within the sub-step.
    const bool opened = sub_step_.state[k] == FaultState::open || !sub_step_.cohesive[k];
    const Eigen::Vector2d slip = shear_part(node, sub_step_.increment);
    if (!opened && slip[0] == 0 && slip[1] == 0) continue;  // most nodes, and nothing to remember
    const FrictionState before = {shear_part(node, state.jump), state.slip_path[k],
                                  state.cohesion_lost[k] == 0};
    const FrictionState after = node.law->after(before, slip, opened);
    state.slip_path[k] = after.path;
    state.cohesion_lost[k] = !after.cohesive;
  }
  state.jump += sub_step_.increment;
}

}  // namespace faultsim
