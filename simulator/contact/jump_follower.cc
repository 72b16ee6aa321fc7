#include "simulator/contact/jump_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace faultsim {
namespace {

// Accuracy of the way, not of the end: halving the share moves results by less than the share of
// a cell.
constexpr double kLargestShare = 0.25;  // of d_c that a node may slip in one damped step
constexpr double kLargestHop = 0.02;  // −t'_N/c of a node that hops, at the end of a damped step
constexpr double kGrowth = 1.6;  // of Δt after a good damped step; twice would often be too much
constexpr int kMaxDampedSteps = 4000;  // a bound on the work; reached, the jump has not arrived
constexpr int kMaxHalvings = 60;       // of Δt: more change nothing in double precision
constexpr int kStaticInterval = 4;     // damped steps between two tries at the static end

}  // namespace

/// The node whose stiffness outlasts damping the longest, by bounds alone.
int JumpFollower::stiffest_by_bounds() const {
  const ContactProblem& problem = solver_.problem();
  int stiffest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const ContactNode& node = problem.nodes[k];
    if (node.n_dofs < 2) continue;
    const double bound = problem.compliance.diagonal_bound(node.dof[1]) * node.inverse_area[1];
    const double duration = node.law->constants().damping / bound;
    if (duration >= least) continue;
    least = duration;
    stiffest = k;
  }
  return stiffest;
}

/// Δt at which damping outweighs the stiffness of every node, and so any weakening worth the name.
/// Where stiffnesses have to be solved for, one stands for all: Δt is tried and adapted anyway.
double JumpFollower::first_duration() const {
  const ContactProblem& problem = solver_.problem();
  const int only = problem.compliance.is_solved_for() ? stiffest_by_bounds() : -1;
  double duration = std::numeric_limits<double>::infinity();
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const ContactNode& node = problem.nodes[k];
    if (node.n_dofs < 2 || (only >= 0 && k != only)) continue;
    duration = std::min(duration, node.law->constants().damping / problem.stiffness(node, 1));
  }
  return std::isfinite(duration) ? duration : 1;
}

/// Whether the node slips and was not fully weakened before the sub-step.
bool JumpFollower::still_weakens(int k) const {
  const ContactProblem& problem = solver_.problem();
  const SubStep& s = solver_.sub_step();
  const ContactNode& node = problem.nodes[k];
  return node.law->weakens() && s.state[k] == FaultState::slip &&
         !node.law->is_fully_weakened(friction_before(node, s, k));
}

/// Largest slip of the sub-step in units of d_c among nodes that still weaken.
double JumpFollower::weakening_share() const {
  const ContactProblem& problem = solver_.problem();
  double share = 0;
  for (int k = 0; k < problem.n_nodes(); ++k) {
    if (!still_weakens(k)) continue;
    const double slip = shear_part(problem.nodes[k], solver_.sub_step().increment).norm();
    share = std::max(share, slip / problem.nodes[k].law->constants().slip_weakening_distance);
  }
  return share;
}

/// Largest −t'_N/c among nodes that slide without the cohesion they keep (ContactNewton). Hopping
/// ends where tension does; a long damped step would slide on, down to the strength without
/// cohesion.
double JumpFollower::hop_share() const {
  const ContactProblem& problem = solver_.problem();
  const SubStep& s = solver_.sub_step();
  double share = 0;
  for (std::size_t i = 0; i < problem.nodes.size(); ++i) {
    const CoulombLaw& law = problem.nodes[i].law->constants();
    const bool hops = law.cohesion_after_opening && !s.cohesive[i] && !s.start->cohesion_lost[i];
    if (!hops || s.state[i] != FaultState::slip) continue;
    share = std::max(share, -s.traction[problem.nodes[i].dof[0]] / law.cohesion);
  }
  return share;
}

void JumpFollower::note_stability() {
  negative_now_ = solver_.negative_pivots();
  if (negative_now_ > 0 && evidence_.negative_pivots == 0) {
    evidence_.nucleus.clear();
    for (int k = 0; k < solver_.problem().n_nodes(); ++k) {
      if (still_weakens(k)) evidence_.nucleus.push_back(k);
    }
  }
  evidence_.negative_pivots = std::max(evidence_.negative_pivots, negative_now_);
}

void JumpFollower::note_lost_cohesion() {
  std::vector<int> losing;
  for (int k = 0; k < solver_.problem().n_nodes(); ++k) {
    if (loses_cohesion(solver_.problem(), solver_.sub_step(), k)) losing.push_back(k);
  }
  evidence_.n_lost_cohesion += static_cast<int>(losing.size());
  if (evidence_.nucleus.empty()) evidence_.nucleus = std::move(losing);
}

void JumpFollower::add_energy() {
  const ContactProblem& problem = solver_.problem();
  const SubStep& s = solver_.sub_step();
  evidence_.released +=
      0.5 * s.increment.cwiseQuotient(problem.inverse_area).dot(s.trial + s.traction);
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const ContactNode& node = problem.nodes[k];
    if (s.state[k] != FaultState::slip || node.n_dofs < 2) continue;
    const Eigen::Vector2d slip = shear_part(node, s.increment);
    const double length = slip.norm();
    if (length == 0) continue;
    // Trapezoidal rule: exact while strength falls linearly with slip.
    const FrictionState before = friction_before(node, s, k);
    const double friction =
        0.5 * (node.law->limit(s.start->traction[node.dof[0]], before) +
               node.law->strength(s.traction[node.dof[0]], slip, 0, before).value);
    evidence_.dissipated += friction * length / node.inverse_area[1];
  }
}

bool JumpFollower::damped_step(const LoadPath& path, double from, ContactState& state) {
  for (int halving = 0; halving < kMaxHalvings; ++halving) {
    solver_.begin(path, {from, load_, duration_}, state);
    if (solver_.rest()) break;
    const Attempt attempt = solver_.attempt(false);
    report_.counts.active_set_passes += solver_.passes();
    if (attempt == Attempt::converged && weakening_share() <= kLargestShare &&
        hop_share() <= kLargestHop) {
      report_.counts.newton_iterations += solver_.iterations();
      break;
    }
    report_.counts.wasted_newton_iterations += solver_.iterations();
    if (halving + 1 == kMaxHalvings) return false;
    duration_ *= 0.5;
  }
  note_stability();
  add_energy();
  note_lost_cohesion();
  solver_.commit(state);
  evidence_.duration += duration_;
  ++evidence_.damped_steps;
  duration_ *= kGrowth;
  return true;
}

bool JumpFollower::try_static(const LoadPath& path, ContactState& state) {
  solver_.begin(path, {load_, load_, 0}, state);
  if (!solver_.rest()) {
    const Attempt attempt = solver_.attempt(false);
    report_.counts.active_set_passes += solver_.passes();
    if (attempt != Attempt::converged) {
      report_.counts.wasted_newton_iterations += solver_.iterations();
      return false;
    }
    report_.counts.newton_iterations += solver_.iterations();
    add_energy();
  }
  evidence_.residual_after = solver_.residual();
  solver_.commit(state);
  return true;
}

JumpFollower::Report JumpFollower::follow(const LoadPath& path, double from, double to, int budget,
                                          ContactState& state) {
  report_ = {};
  evidence_ = {};
  evidence_.load_before = from;
  evidence_.load_after = load_ = to;
  evidence_.jump_before = state.jump;
  evidence_.traction_before = state.traction;
  solver_.begin(path, {from, from, 0}, state);
  evidence_.residual_before = solver_.residual_at_rest();
  duration_ = first_duration();
  int until_static = kStaticInterval;
  const SolveCounts& counts = report_.counts;
  while (evidence_.damped_steps < kMaxDampedSteps &&
         counts.newton_iterations + counts.wasted_newton_iterations < budget) {
    if (!damped_step(path, evidence_.damped_steps == 0 ? from : load_, state)) break;
    if (--until_static > 0 || negative_now_ > 0) continue;
    if (try_static(path, state)) {
      report_.arrived = true;
      break;
    }
    until_static = kStaticInterval;
  }
  evidence_.jump_after = state.jump;
  evidence_.traction_after = state.traction;
  if (evidence_.negative_pivots > 0 || evidence_.n_lost_cohesion > 0) report_.jump = evidence_;
  return report_;
}

}  // namespace faultsim
