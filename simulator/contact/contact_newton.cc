#include "simulator/contact/contact_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

// How far linear equations are solved, as a share of their right side: no further than the set that
// they hold for is worth, and at the end as far as TangentSolver can. No equation is solved beyond
// a tenth of the tolerance.
constexpr double kForcing = 1e-2;
constexpr double kForcingAtTheEnd = 3e-5;
constexpr double kBeyond = 0.1;

/// How long a search has gone on without its residual falling by half.
struct Progress {
  double best = std::numeric_limits<double>::infinity();
  int idle = 0;  ///< iterations.
  /// @returns idle with this residual (Σ of squares) counted in.
  int idle_after(double residual) {
    constexpr double kProgress = 0.5;
    idle = residual < kProgress * best ? 0 : idle + 1;
    best = std::min(best, residual);
    return idle;
  }
};

SearchIteration iteration_of(const SubStep& sub_step, double residual, double length, int n_changed,
                             int krylov) {
  const auto count = [&](FaultState state) {
    return static_cast<int>(std::ranges::count(sub_step.state, state));
  };
  return {residual, length, count(FaultState::slip), count(FaultState::open), n_changed, krylov};
}

}  // namespace

ContactNewton::ContactNewton(ContactProblem& problem, const ContactOptions& options, StopToken stop)
    : problem_(problem), options_(options), stop_(stop), tangent_(problem), watched_(problem) {}

SlipPoint ContactNewton::slip_point(const SubStep& sub_step, const Eigen::VectorXd& traction,
                                    const Eigen::VectorXd& increment, int k) const {
  const ContactNode& node = problem_.nodes[k];
  SlipPoint point;
  point.normal_traction = traction[node.dof[0]];
  point.shear_traction = shear_part(node, traction);
  point.slip_increment = shear_part(node, increment);
  point.before = friction_before(node, sub_step, k);
  // A node at rest needs no r, and its column of H stays unread.
  if (point.slip_increment[0] != 0 || point.slip_increment[1] != 0 ||
      sub_step.state[k] == FaultState::slip) {
    point.stiffness = problem_.stiffness(node, 1);
    if (node.n_dofs > 2) point.stiffness = std::max(point.stiffness, problem_.stiffness(node, 2));
  }
  point.per_second = sub_step.per_second;
  // With damping in r, |y| − τ_L of a node that slips along its traction does not depend on Δt;
  // without, a first guess that slips too far would look like rest, and the set would cycle.
  point.stiffness += node.law->drag(sub_step.per_second);
  return point;
}

/// Sets each node's state from the augmented tractions. Hysteresis: leaving stick needs a violation
/// beyond the tolerance, going back none. @returns how many changed.
int ContactNewton::classify(SubStep& sub_step) {
  int n_changed = 0;
  for (const int k : watched_.nodes()) {
    const ContactNode& node = problem_.nodes[k];
    const double tolerance = sub_step.tolerance[k];
    const double gap = sub_step.start->jump[node.dof[0]] + sub_step.increment[node.dof[0]];
    double normal = sub_step.traction[node.dof[0]];
    if (gap != 0) normal += problem_.stiffness(node, 0) * gap;
    FaultState state = FaultState::stick;
    const bool is_open = sub_step.state[k] == FaultState::open;
    if (normal > (is_open ? 0 : tolerance)) {
      state = FaultState::open;
    } else if (node.n_dofs > 1) {
      const double excess =
          slip_excess(*node.law, slip_point(sub_step, sub_step.traction, sub_step.increment, k));
      const bool slips = sub_step.state[k] == FaultState::slip;
      if (excess > (slips ? 0 : tolerance)) state = FaultState::slip;
    }
    if (state == FaultState::open) was_open_[k] = 1;
    n_changed += state != sub_step.state[k];
    sub_step.state[k] = state;
  }
  return n_changed;
}

/// Σ (F_k / tolerance_k)² of the natural residual F: t'_N − min(0, t'_N + r g_N) and
/// t'_T − projection of t'_T + r Δg_T on the disc of radius τ_L (t'_T itself when open).
ContactNewton::Residual ContactNewton::natural_residual(const SubStep& sub_step,
                                                        const Eigen::VectorXd& traction,
                                                        const Eigen::VectorXd& increment) const {
  Residual residual;
  for (const int k : watched_.nodes()) {
    const ContactNode& node = problem_.nodes[k];
    const double gap = sub_step.start->jump[node.dof[0]] + increment[node.dof[0]];
    const double normal = traction[node.dof[0]];
    const double augmented = gap != 0 ? normal + problem_.stiffness(node, 0) * gap : normal;
    double square = normal - std::min(0.0, augmented);
    square *= square;
    if (augmented > (sub_step.state[k] == FaultState::open ? 0 : sub_step.tolerance[k])) {
      const double drag = node.law->drag(sub_step.per_second);
      square += (shear_part(node, traction) - drag * shear_part(node, increment)).squaredNorm();
    } else if (node.n_dofs > 1) {
      const SlipPoint point = slip_point(sub_step, traction, increment, k);
      const double excess = slip_excess(*node.law, point);
      const Eigen::Vector2d y = point.shear_traction + point.stiffness * point.slip_increment;
      const double norm = y.norm();
      Eigen::Vector2d shear = point.shear_traction - y;
      if (excess > 0) shear += excess / norm * y;
      square += shear.squaredNorm();
    }
    square /= sub_step.tolerance[k] * sub_step.tolerance[k];
    residual.square_sum += square;
    residual.worst = std::max(residual.worst, square);
    if (!std::isfinite(square)) residual.worst = std::numeric_limits<double>::infinity();
  }
  residual.worst = std::sqrt(residual.worst);
  return residual;
}

/// direction_ := what eliminated components must still move: to Δg_T = 0 and g_N = 0.
void ContactNewton::prescribe(const SubStep& sub_step) {
  direction_.setZero(problem_.n_dofs());
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    if (sub_step.state[k] == FaultState::open) continue;
    const int normal = node.dof[0];
    direction_[normal] = -(sub_step.start->jump[normal] + sub_step.increment[normal]);
    if (sub_step.state[k] == FaultState::slip) continue;
    for (std::size_t c = 1; c < static_cast<std::size_t>(node.n_dofs); ++c) {
      direction_[node.dof[c]] = -sub_step.increment[node.dof[c]];
    }
  }
}

void ContactNewton::collect_node(const SubStep& sub_step, int k) {
  const ContactNode& node = problem_.nodes[k];
  const auto n = static_cast<std::size_t>(node.n_dofs);
  std::array<double, 3> response{};
  for (std::size_t c = 0; c < n; ++c) response[c] = response_[node.dof[c]];
  if (sub_step.state[k] == FaultState::open) {
    const double drag = node.law->drag(sub_step.per_second);
    for (std::size_t c = 0; c < n; ++c) {
      TangentUnknown unknown{k, static_cast<int>(c), node.dof[c], {0, 0, 0}, {0, 0}};
      unknown.weight[c] = -node.inverse_area[c];
      const double carried = c > 0 ? drag * sub_step.increment[node.dof[c]] : 0;
      if (c > 0) unknown.own[c - 1] = -drag;
      right_[unknowns_.size()] = carried - sub_step.traction[node.dof[c]] - response[c];
      unknowns_.push_back(unknown);
    }
    return;
  }
  const SlipResidual r =
      slip_residual(*node.law, slip_point(sub_step, sub_step.traction, sub_step.increment, k));
  for (std::size_t c = 1; c < n; ++c) {
    const auto row = static_cast<Eigen::Index>(c - 1);
    const std::array<double, 3> d_traction = {r.d_normal[row], r.d_shear(row, 0),
                                              r.d_shear(row, 1)};
    TangentUnknown unknown{
        k, static_cast<int>(c), node.dof[c], {0, 0, 0}, {r.d_slip(row, 0), r.d_slip(row, 1)}};
    double right = -r.value[row];
    for (std::size_t a = 0; a < n; ++a) {
      unknown.weight[a] = -d_traction[a] * node.inverse_area[a];
      right -= d_traction[a] * response[a];
    }
    right_[unknowns_.size()] = right;
    unknowns_.push_back(unknown);
  }
}

/// Linearises the equations of the moving nodes about the current iterate.
void ContactNewton::linearise(const SubStep& sub_step) {
  prescribe(sub_step);
  response_.setZero(problem_.n_dofs());
  problem_.subtract_product(direction_, watched_.rows(), response_);
  right_.resize(problem_.n_dofs());
  unknowns_.clear();
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    if (sub_step.state[k] != FaultState::stick) collect_node(sub_step, k);
  }
}

/// How far the linear equations are to be solved, Pa. Where strength falls with slip the next set
/// to be tried decides where a search ends, and a jump may follow: to round-off.
double ContactNewton::wanted_residual(const SubStep& sub_step) const {
  if (problem_.may_jump) return 0;
  double tolerance = std::numeric_limits<double>::infinity();
  for (const TangentUnknown& unknown : unknowns_) {
    tolerance = std::min(tolerance, sub_step.tolerance[unknown.node]);
  }
  const double norm = right_.head(static_cast<Eigen::Index>(unknowns_.size())).norm();
  return std::max((set_stands_ ? kForcingAtTheEnd : kForcing) * norm, kBeyond * tolerance);
}

/// Solves the tangent over the unknowns and adds their part to direction_.
bool ContactNewton::solve_linear(const SubStep& sub_step) {
  krylov_ = -1;
  if (unknowns_.empty()) return true;
  const auto n = static_cast<Eigen::Index>(unknowns_.size());
  Eigen::VectorXd solution;
  const TangentReport report =
      tangent_.solve(unknowns_, right_.head(n), wanted_residual(sub_step), solution);
  krylov_ = report.krylov;
  if (!report.solved) return false;
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    direction_[unknowns_[u].dof] = solution[u];
  }
  return true;
}

/// Whether few rows will do for the next step: not for a line search, whose merit is that of all,
/// nor where the next set decides how a step ends, nor where there is little to be saved.
bool ContactNewton::may_watch(bool line_search) const {
  constexpr std::size_t kFew = 100;
  return !set_stands_ && !line_search && !problem_.may_jump && unknowns_.size() > kFew;
}

/// Tractions of all nodes, afresh.
void ContactNewton::look_at_all(SubStep& sub_step) {
  sub_step.traction = sub_step.trial;
  problem_.subtract_product(sub_step.increment, sub_step.traction);
  watched_.watch_all();
  fresh_ = true;
}

/// Goes along direction_. While the set stands, and may be what is accepted, tractions are computed
/// afresh: no round-off of earlier iterations is left in them. Else tractions are linear in the
/// step length, so trying lengths is cheap.
/// @returns the length.
double ContactNewton::advance(SubStep& sub_step, bool line_search) {
  if (set_stands_ && !line_search) {
    sub_step.increment += direction_;
    look_at_all(sub_step);
    return 1;
  }
  const bool few = may_watch(line_search);
  if (few && watched_.all()) watched_.watch_near_limit(sub_step);
  if (!few && !watched_.all()) look_at_all(sub_step);
  fresh_ = false;
  double length = 1;
  response_.setZero(problem_.n_dofs());
  problem_.subtract_product(direction_, watched_.rows(), response_);
  if (line_search) {
    double best = std::numeric_limits<double>::infinity();
    for (const double candidate : {1.0, 0.5, 0.25, 0.125, 0.0625}) {
      trial_increment_ = sub_step.increment + candidate * direction_;
      trial_traction_ = sub_step.traction + candidate * response_;
      const double merit = natural_residual(sub_step, trial_traction_, trial_increment_).square_sum;
      if (merit < best) {
        best = merit;
        length = candidate;
      }
    }
  }
  sub_step.increment += length * direction_;
  sub_step.traction += length * response_;
  return length;
}

/// Rounds noise to rest, corrects the tractions for it and checks the residual again.
bool ContactNewton::finish(SubStep& sub_step) {
  constexpr double kNoise = 0.01;  // of the slip that moves the traction by the tolerance
  direction_.setZero(problem_.n_dofs());
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    if (sub_step.state[k] == FaultState::open) continue;
    const double closed = -sub_step.start->jump[node.dof[0]];
    direction_[node.dof[0]] = closed - sub_step.increment[node.dof[0]];
    sub_step.increment[node.dof[0]] = closed;
    const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
    if (slip[0] == 0 && slip[1] == 0) {
      sub_step.state[k] = FaultState::stick;
      continue;
    }
    const double drag = node.law->drag(sub_step.per_second);
    const double noise = kNoise * sub_step.tolerance[k] / (problem_.stiffness(node, 1) + drag);
    if (sub_step.state[k] == FaultState::stick || slip.norm() < noise) {
      for (std::size_t c = 1; c < static_cast<std::size_t>(node.n_dofs); ++c) {
        direction_[node.dof[c]] = -sub_step.increment[node.dof[c]];
        sub_step.increment[node.dof[c]] = 0;
      }
      sub_step.state[k] = FaultState::stick;
    }
  }
  if (fresh_) {
    problem_.subtract_product(direction_, sub_step.traction);
  } else {
    sub_step.traction = sub_step.trial;
    problem_.subtract_product(sub_step.increment, sub_step.traction);
    fresh_ = true;
  }
  constexpr double kAccepted = 1.5;  // the tolerance with a margin for what was rounded to rest
  return natural_residual(sub_step).worst <= kAccepted;
}

/// Whether slip follows traction. The natural residual weighs a wrong direction by the size of the
/// slip, so where a node has moved little it is satisfied long before (5) is.
bool ContactNewton::aligned(const SubStep& sub_step) const {
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    if (sub_step.state[k] != FaultState::slip || problem_.nodes[k].n_dofs < 3) continue;
    if (check_node(problem_, sub_step, k).misaligned > sub_step.tolerance[k]) return false;
  }
  return true;
}

/// A node that keeps opening and closing has failed in tension: it closes again without cohesion.
/// Where cohesion outlives opening, open, it would close, and closed, its shear, held by cohesion,
/// would open it: in a damped sub-step it hops, and slides on the average without cohesion. A
/// static sub-step does not allow hopping and then has no solution.
/// @returns whether some node lost it just now.
bool ContactNewton::lose_cohesion(SubStep& sub_step) {
  const bool hops = sub_step.per_second > 0;
  bool any = false;
  for (std::size_t i = 0; i < was_open_.size(); ++i) {
    const CoulombLaw& law = problem_.nodes[i].law->constants();
    if (!was_open_[i] || !sub_step.cohesive[i] || law.cohesion == 0) continue;
    if (law.cohesion_after_opening && !hops) continue;
    sub_step.cohesive[i] = 0;
    any = true;
  }
  return any;
}

void ContactNewton::begin(const SubStep& sub_step) {
  seen_.clear();
  // A history starts with no jump: no factor of an earlier one has a say in its digits.
  if (sub_step.start->jump.isZero(0)) tangent_.clear();
  was_open_.assign(static_cast<std::size_t>(problem_.n_nodes()), 0);
  watched_.watch_all();
  set_stands_ = false;
}

SearchHistory ContactNewton::solve(SubStep& sub_step, int patience) {
  SearchHistory history;
  history.passes = 1;
  const auto stop = [&](SearchEnd end) {
    history.end = end;
    if (!watched_.all()) look_at_all(sub_step);
    return std::move(history);
  };
  bool line_search = false;
  int on_this_set = 0;  // iterations
  Progress progress;
  begin(sub_step);
  classify(sub_step);
  seen_.has_seen(sub_step.state);
  const int bound = options_.max_active_set_passes + options_.max_newton_iterations;
  while (history.iterations < bound) {
    stop_.throw_if_requested("solving a load step");
    linearise(sub_step);
    if (!solve_linear(sub_step)) return stop(SearchEnd::singular_tangent);
    const double length = advance(sub_step, line_search);
    int n_changed = classify(sub_step);
    Residual residual = natural_residual(sub_step);
    if (!watched_.all() && n_changed == 0 && residual.within_tolerance()) {  // before it counts
      look_at_all(sub_step);
      n_changed = classify(sub_step);
      residual = natural_residual(sub_step);
    }
    history.add(iteration_of(sub_step, residual.worst, length, n_changed, krylov_));
    on_this_set = n_changed > 0 ? 0 : on_this_set + 1;
    set_stands_ = n_changed == 0;
    if (patience > 0 && progress.idle_after(residual.square_sum) >= patience) {
      return stop(SearchEnd::no_progress);
    }
    if (n_changed > 0) {
      if (++history.passes > options_.max_active_set_passes) return stop(SearchEnd::too_many_sets);
      const bool comes_back = seen_.has_seen(sub_step.state);
      if (!comes_back) continue;
      // Sets that repeat may differ by nodes whose slip is round-off: both are solutions then.
      line_search = true;
      if (!watched_.all()) look_at_all(sub_step);
      if (lose_cohesion(sub_step)) progress = {};
      residual = natural_residual(sub_step);
    }
    if (residual.within_tolerance() && finish(sub_step) && aligned(sub_step)) {
      return stop(SearchEnd::balanced);
    }
    if (on_this_set > options_.max_newton_iterations) return stop(SearchEnd::set_does_not_settle);
  }
  return stop(SearchEnd::too_many_iterations);
}

}  // namespace faultsim
