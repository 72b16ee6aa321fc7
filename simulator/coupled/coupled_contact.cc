#include "simulator/coupled/coupled_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Components strike and dip of a vector over fault dofs; missing ones are 0.
Eigen::Vector2d shear_of(const std::array<int, 2>& dof, const Eigen::VectorXd& values) {
  return {dof[0] >= 0 ? values[dof[0]] : 0, dof[1] >= 0 ? values[dof[1]] : 0};
}

void set_shear(const std::array<int, 2>& dof, const Eigen::Vector2d& value,
               Eigen::VectorXd& values) {
  for (int c = 0; c < 2; ++c) {
    if (dof[c] >= 0) values[dof[c]] = value[c];
  }
}

/// H_dd/A of the commutator's approximation, (CᵀKC)_dd A/(CᵀC)²: any positive number would do.
/// @param diagonal  of K, own rows from `first` on.
double stiffness_of(const TwoSidedNode& node, int c, const Eigen::VectorXd& diagonal, int first) {
  double stiffness = 0, gram = 0;
  for (const JumpTerm& term : node.terms) {
    const double square = term.factor * term.factor;
    gram += square;
    if (term.dof[c] >= 0) stiffness += square * diagonal[term.dof[c] - first];
  }
  return stiffness / (gram * gram * node.area);
}

int count(const std::vector<FaultState>& states, FaultState state) {
  return static_cast<int>(std::ranges::count(states, state));
}

}  // namespace

/// Where Newton stands within a load step.
struct CoupledContact::Iterate {
  Eigen::VectorXd u, increment, traction;  ///< displacements; Δg, t' over fault dofs.
  std::vector<FaultState> state;           ///< per node that may jump.
  int n_changed = 0;                       ///< states, at the last classify().
  /// t' of the next iterate: `fixed` + D Δg + d t'_N where a node slips, with the multiplier
  /// elsewhere.
  Eigen::VectorXd fixed;
  std::vector<NodeLinearisation> how;  ///< per node of the bulk.
};

CoupledContact::CoupledContact(const TwoSidedBulk& bulk, const ContactLaws& laws,
                               const CoupledContactOptions& options)
    : bulk_(bulk),
      options_(options),
      all_held_(make_saddle_point(bulk)),
      linear_(options.solver, options.stop),
      held_(bulk.ranks()) {
  if (runs_on_ranks(options.solver)) bulk.engine();  // before anything is multiplied
  const Eigen::VectorXd diagonal = bulk.diagonal();
  std::vector<double> inverse_area;
  for (int k = 0; k < static_cast<int>(bulk.fault_nodes().size()); ++k) {
    const TwoSidedNode& two = bulk.fault_nodes()[k];
    if (!two.may_jump(0)) continue;
    Node node{k, n_dofs(), 1, {-1, -1}, two.area, 0, {}};
    for (int c = 0; c < 2; ++c) {
      if (two.may_jump(1 + c)) node.shear[c] = node.first + node.n_dofs++;
    }
    for (int c = 0; c < 3; ++c)
      if (two.may_jump(c)) dof_.push_back(two.jump[c]);
    inverse_area.insert(inverse_area.end(), static_cast<std::size_t>(node.n_dofs), 1 / two.area);
    if (bulk.owns(two)) {
      for (int d = 0; d < node.n_dofs; ++d) own_.push_back(node.first + d);
      for (int c = 0; c < 3; ++c)
        node.stiffness = std::max(node.stiffness, stiffness_of(two, c, diagonal, bulk.first_own()));
    }
    nodes_.push_back(node);
  }
  inverse_area_ = Eigen::Map<const Eigen::VectorXd>(inverse_area.data(), n_dofs());
  FAULTSIM_DEMAND(std::ssize(own_) == all_held_.n_multipliers(), own_.size(), " of ",
                  all_held_.n_multipliers());
  gathered_ = bulk.ranks().gathered(own_);
  Eigen::VectorXd stiffness(std::ssize(nodes_));
  for (std::size_t k = 0; k < nodes_.size(); ++k) stiffness[k] = nodes_[k].stiffness;
  bulk.ranks().sum(stiffness);
  for (std::size_t k = 0; k < nodes_.size(); ++k) nodes_[k].stiffness = stiffness[k];
  FAULTSIM_DEMAND(laws.size() == nodes_.size(), "laws for ", laws.size(), " of ", nodes_.size(),
                  " nodes");
  for (std::size_t k = 0; k < laws.size(); ++k) {
    FAULTSIM_DEMAND(laws[k].cohesion_after_slip, "loss of cohesion by slip at node ", k);
    nodes_[k].law = NodeLaw(laws[k]);
  }
  for (int k = 0; k < bulk.n_loads(); ++k) loads_.push_back(bulk.load(k));
}

/// Values over all fault dofs from the own ones of each rank.
Eigen::VectorXd CoupledContact::of_all(const Eigen::VectorXd& own) const {
  Eigen::VectorXd all(n_dofs());
  all(gathered_) = bulk_.ranks().gathered(own);
  return all;
}

FrictionState CoupledContact::state_of(const Node& node, const ContactState& state, int k) {
  return {shear_of(node.shear, state.jump), state.slip_path[k], state.cohesion_lost[k] == 0};
}

/// The node at the slip that its augmented traction promises; none where that stays below the
/// strength.
SlippingPoint CoupledContact::point_of(const ContactState& before, const Iterate& at, int k) const {
  const Node& node = nodes_[k];
  SlippingPoint point;
  point.normal_traction = std::min(at.traction[node.first], 0.0);
  point.before = state_of(node, before, k);
  const Eigen::Vector2d slip = shear_of(node.shear, at.increment);
  const Eigen::Vector2d y = shear_of(node.shear, at.traction) + node.stiffness * slip;
  const double norm = y.norm();
  if (norm > 0) point.traction_direction = y / norm;
  point.slip_increment = slip;
  const double limit = slip_tangent(node.law, point).traction.norm();
  point.slip_increment = std::max(norm - limit, 0.0) / node.stiffness * point.traction_direction;
  return point;
}

/// Whether a node went back against the direction in which it was set to slip. It may rest; to let
/// it slip the other way at once, as its augmented traction says, may repeat for ever.
bool CoupledContact::turned_back(const Iterate& at, int k) const {
  if (at.state[k] != FaultState::slip || at.how.empty()) return false;
  const Node& node = nodes_[k];
  return shear_of(node.shear, at.increment).dot(at.how[node.fault_node].tangent.traction) < 0;
}

/// States from the augmented tractions. Leaving stick takes more than the tolerance, going back
/// nothing, so that round-off changes no state for ever.
void CoupledContact::classify(const ContactState& before, Iterate& at, double tolerance) const {
  at.n_changed = 0;
  for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
    const Node& node = nodes_[k];
    const double gap = before.jump[node.first] + at.increment[node.first];
    const double normal = at.traction[node.first] + node.stiffness * gap;
    FaultState state = FaultState::stick;
    if (normal > (at.state[k] == FaultState::open ? 0 : tolerance)) {
      state = FaultState::open;
    } else if (node.n_dofs > 1 && !turned_back(at, k)) {
      const double excess = node.stiffness * point_of(before, at, k).slip_increment.norm();
      if (excess > (at.state[k] == FaultState::slip ? 0 : tolerance)) state = FaultState::slip;
    }
    at.n_changed += state != at.state[k];
    at.state[k] = state;
  }
}

void CoupledContact::linearise(const ContactState& before, Iterate& at) const {
  at.fixed.setZero(n_dofs());
  at.how.assign(bulk_.fault_nodes().size(), {});
  for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
    const Node& node = nodes_[k];
    NodeLinearisation& how = at.how[node.fault_node];
    how.state = at.state[k];
    if (how.state != FaultState::slip) continue;
    const SlippingPoint point = point_of(before, at, k);
    how.tangent = slip_tangent(node.law, point);
    if (at.traction[node.first] > 0) how.tangent.d_normal.setZero();
    set_shear(node.shear,
              how.tangent.traction - how.tangent.d_slip * point.slip_increment -
                  how.tangent.d_normal * point.normal_traction,
              at.fixed);
  }
}

/// One linear step, as a correction. @returns the largest change of a traction, or of r times a
/// jump, Pa; infinite where the system is not solved, which report.reason then says.
double CoupledContact::improve(const Eigen::VectorXd& force, const ContactState& before,
                               ForcingTerm& forcing, Iterate& at, CoupledStepReport& report) const {
  linearise(before, at);
  SaddlePoint j = make_saddle_point(bulk_, at.how);
  // The traction that this linearisation gives the iterate: what is held keeps its own.
  Eigen::VectorXd traction = at.traction, wanted = before.jump;
  for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
    const Node& node = nodes_[k];
    wanted[node.first] = 0;
    if (at.state[k] == FaultState::open) traction.segment(node.first, node.n_dofs).setZero();
    if (at.state[k] != FaultState::slip) continue;
    const SlipTangent& tangent = at.how[node.fault_node].tangent;
    set_shear(node.shear,
              shear_of(node.shear, at.fixed) + tangent.d_slip * shear_of(node.shear, at.increment) +
                  tangent.d_normal * at.traction[node.first],
              traction);
  }
  const SparseMatrix& c = all_held_.constraint;
  const Eigen::VectorXd r_u = force - bulk_.times_stiffness(at.u) - c * traction(own_);
  const Eigen::VectorXd jump = inverse_area_.cwiseProduct(of_all(c.transpose() * at.u));
  Eigen::VectorXd r_l(j.n_multipliers()), du, lambda;
  const std::vector<int> begin = j.node_begin;
  const auto for_each_held = [&](const auto& visit) {  // (node, its first own multiplier, how many)
    for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
      if (!owns(nodes_[k]) || at.state[k] == FaultState::open) continue;
      visit(nodes_[k], begin[nodes_[k].fault_node],
            at.state[k] == FaultState::stick ? nodes_[k].n_dofs : 1);
    }
  };
  for_each_held([&](const Node& node, int first, int n) {
    r_l.segment(first, n) = node.area * (wanted - jump).segment(node.first, n);
  });
  const LinearSteps::Solved solved = linear_.solve(
      std::move(j), r_u, r_l, [&forcing](double norm) { return forcing.next(norm); }, du, lambda);
  report.linear.krylov_iterations.push_back(static_cast<int>(solved.report.residuals.size()) - 1);
  report.linear.setup_seconds += solved.setup_seconds;
  report.linear.solve_seconds += solved.report.seconds;
  at.u += du;
  const Eigen::VectorXd next =
      inverse_area_.cwiseProduct(of_all(c.transpose() * at.u)) - before.jump;
  for_each_held([&](const Node& node, int first, int n) {
    traction.segment(node.first, n) += lambda.segment(first, n);
  });
  traction = of_all(traction(own_));
  double change = 0;
  for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
    const Node& node = nodes_[k];
    if (at.state[k] == FaultState::slip) {
      const SlipTangent& tangent = at.how[node.fault_node].tangent;
      set_shear(node.shear,
                shear_of(node.shear, at.fixed) + tangent.d_slip * shear_of(node.shear, next) +
                    tangent.d_normal * traction[node.first],
                traction);
    }
    for (int d = node.first; d < node.first + node.n_dofs; ++d) {
      change = std::max({change, std::abs(traction[d] - at.traction[d]),
                         node.stiffness * std::abs(next[d] - at.increment[d])});
    }
  }
  at.traction = traction;
  at.increment = next;
  if (solved.report.converged) return change;
  report.reason = concat("GMRES (", to_string(options_.solver.leading), ", ",
                         to_string(options_.solver.schur), ") does not reach ", solved.tolerance,
                         " within ", options_.solver.max_iterations, " iterations");
  return std::numeric_limits<double>::infinity();
}

/// Newton with the active set, until neither states nor values change.
/// @param level     the largest traction that the load brings, Pa: where faults open, theirs
///                  vanish.
/// @param residual  N, that the load step asks to be balanced.
void CoupledContact::iterate(const Eigen::VectorXd& force, double level, double residual,
                             const ContactState& before, Iterate& at,
                             CoupledStepReport& report) const {
  ForcingTerm forcing(options_.krylov_tolerance, 0.1 * options_.traction_tolerance, residual);
  while (!report.converged) {
    if (report.newton_iterations() == options_.max_newton_iterations) {
      report.reason = concat("Newton's method keeps changing after ", report.newton_iterations(),
                             " iterations, ", at.n_changed, " states in the last");
      return;
    }
    const double change = improve(force, before, forcing, at, report);
    const double tolerance =
        options_.traction_tolerance * std::max(level, at.traction.lpNorm<Eigen::Infinity>());
    classify(before, at, tolerance);
    report.newton.add({.residual = change / tolerance,
                       .length = 1,
                       .n_slip = count(at.state, FaultState::slip),
                       .n_open = count(at.state, FaultState::open),
                       .n_changed = at.n_changed,
                       .krylov = report.linear.krylov_iterations.back()});
    report.newton.passes += at.n_changed > 0 || report.newton.passes == 0;
    if (std::isinf(change)) {
      report.newton.end = SearchEnd::no_progress;
      return;
    }
    report.converged = at.n_changed == 0 && change <= tolerance;
  }
  report.newton.end = SearchEnd::balanced;
}

/// The end of a load step: what is held rests, and what slips has slipped.
void CoupledContact::settle(double tolerance, const ContactState& before, Iterate& at,
                            ContactState& state) const {
  for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) {
    const Node& node = nodes_[k];  // what is held moves by what the last linear step left over
    if (at.state[k] != FaultState::open) at.increment[node.first] = -before.jump[node.first];
    // A node that slips by less than is told apart was set to slip on the way only.
    if (at.state[k] == FaultState::slip &&
        node.stiffness * shear_of(node.shear, at.increment).norm() <= tolerance)
      at.state[k] = FaultState::stick;
    if (at.state[k] == FaultState::stick) set_shear(node.shear, {0, 0}, at.increment);
    const FrictionState after =
        node.law.after(state_of(node, before, k), shear_of(node.shear, at.increment),
                       at.state[k] == FaultState::open);
    state.slip_path[k] = after.path;
    state.cohesion_lost[k] = !after.cohesive;
  }
  state.jump(dof_) += at.increment;
  state.traction(dof_) = at.traction;
  state.state = at.state;
}

CoupledStepReport CoupledContact::advance(const CoupledLoad& load, ContactState& state,
                                          Eigen::VectorXd& u) const {
  FAULTSIM_DEMAND(load.factors.size() == loads_.size() && load.background.size() == n_dofs() &&
                      state.jump.size() == n_dofs() && u.size() == bulk_.n_own(),
                  load.factors.size(), " factors, ", load.background.size(), " tractions");
  ContactState before = state;
  before.jump = state.jump(dof_);
  before.traction = state.traction(dof_);
  const Eigen::VectorXd background = load.background(dof_);
  Eigen::VectorXd force = all_held_.constraint * background(own_);
  for (int k = 0; k < static_cast<int>(loads_.size()); ++k) force += load.factors[k] * loads_[k];
  CoupledStepReport report;
  Iterate at;
  at.u = u;
  at.increment = Eigen::VectorXd::Zero(n_dofs());
  at.traction = before.traction;
  for (const FaultState s : state.state) {
    at.state.push_back(s == FaultState::open ? s : FaultState::stick);
  }
  HeldResponses::Response held;
  held.load =
      force - bulk_.times_stiffness(u) - all_held_.constraint * before.traction(own_).eval();
  held_.add_nearest(held.load, at.u, at.traction);
  const double level = std::max(
      {load.background.lpNorm<Eigen::Infinity>(), state.traction.lpNorm<Eigen::Infinity>(), 1.0});
  const double residual = std::sqrt(bulk_.ranks().sum(held.load.squaredNorm()));
  iterate(force, level, residual, before, at, report);
  if (!report.converged) return report;
  if (count(before.state, FaultState::open) == 0 &&
      count(at.state, FaultState::stick) == static_cast<int>(nodes_.size())) {
    held.u = at.u - u;
    held.traction = at.traction - before.traction;
    held_.keep(std::move(held));
  }
  settle(options_.traction_tolerance * std::max(level, at.traction.lpNorm<Eigen::Infinity>()),
         before, at, state);
  u = at.u;
  return report;
}

}  // namespace faultsim
