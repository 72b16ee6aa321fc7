#include "simulator/contact/scalar_slip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/ranges.h"

namespace faultsim {

ScalarSlip::ScalarSlip(ContactProblem& problem, const ContactOptions& options, StopToken stop)
    : problem_(problem), options_(options), stop_(stop) {
  wanted_.assign(static_cast<std::size_t>(problem.n_nodes()), 0);
  placed_ = wanted_;
}

/// Lets every stick node beyond its limit slip along its traction. @returns whether there was one.
bool ScalarSlip::add_violators(const SubStep& sub_step, bool& opens) {
  constexpr double kNear = 0.7;  // of the limit; only speed depends on it
  bool any = false;
  near_limit_.clear();
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const ContactNode& node = problem_.nodes[i];
    const double tolerance = sub_step.tolerance[i];
    const double normal = sub_step.traction[node.dof[0]];
    opens = opens || normal > tolerance;
    if (wanted_[i] != 0 || node.n_dofs < 2) continue;
    const double shear = sub_step.traction[node.dof[1]];
    const double limit = node.law->static_limit(normal, sub_step.cohesive[i] != 0);
    if (std::abs(shear) - limit > tolerance) {
      wanted_[i] = shear > 0 ? 1 : -1;
      any = true;
    } else if (std::abs(shear) > kNear * limit) {
      near_limit_.push_back(static_cast<int>(i));
    }
  }
  return any;
}

/// The same with the slip just solved for, at the nodes near their limit alone and without the
/// product with H: their rows are read from their own columns, by symmetry. Not where those would
/// have to be solved for.
bool ScalarSlip::add_neighbours(const SubStep& sub_step) {
  if (problem_.compliance.is_solved_for()) return false;
  bool any = false;
  const std::size_t m = order_.size();
  for (const int k : near_limit_) {
    if (wanted_[k] != 0) continue;
    const ContactNode& node = problem_.nodes[k];
    const double* shear_row = problem_.compliance.column(node.dof[1]).data();
    const double* normal_row = problem_.compliance.column(node.dof[0]).data();
    double shear_sum = 0;
    double normal_sum = 0;
    for (std::size_t j = 0; j < m; ++j) {
      shear_sum += shear_row[order_dof_[j]] * slip_[j];
      normal_sum += normal_row[order_dof_[j]] * slip_[j];
    }
    const double shear = sub_step.trial[node.dof[1]] - shear_sum * node.inverse_area[1];
    const double normal = sub_step.trial[node.dof[0]] - normal_sum * node.inverse_area[0];
    const double limit = node.law->static_limit(normal, sub_step.cohesive[k] != 0);
    if (!(std::abs(shear) - limit > sub_step.tolerance[k])) continue;
    wanted_[k] = shear > 0 ? 1 : -1;
    any = true;
  }
  return any;
}

/// Brings the factor to the wanted set: cuts it back to what still holds, appends the rest.
void ScalarSlip::synchronise() {
  std::size_t keep = 0;
  while (keep < order_.size() && wanted_[order_[keep]] == signs_[keep]) {
    ++keep;
  }
  for (std::size_t i = keep; i < order_.size(); ++i) {
    placed_[order_[i]] = 0;
  }
  order_.resize(keep);
  order_dof_.resize(keep);
  signs_.resize(keep);
  lu_.truncate(static_cast<int>(keep));
}

/// Appends a node's row and column, both read from its own columns of H by symmetry.
bool ScalarSlip::append(int k) {
  const ContactNode& node = problem_.nodes[k];
  const double* shear = problem_.compliance.column(node.dof[1]).data();
  const double* normal = problem_.compliance.column(node.dof[0]).data();
  const auto coupling = [](const ContactNode& at, int sign) {
    return sign * at.law->static_friction() * at.inverse_area[0] / at.inverse_area[1];
  };
  const double own = coupling(node, wanted_[k]);
  double* row = lu_.row();
  double* column = lu_.column();
  for (std::size_t j = 0; j < order_.size(); ++j) {
    const ContactNode& other = problem_.nodes[order_[j]];
    const double tangential = shear[other.dof[1]];
    row[j] = tangential + own * normal[other.dof[1]];
    column[j] = tangential + coupling(other, signs_[j]) * shear[other.dof[0]];
  }
  // Pivots far below the diagonal would be a loss of digits, so they end the fast path.
  const double diagonal = shear[node.dof[1]] + own * normal[node.dof[1]];
  constexpr double kSmallestPivot = 1e-8;
  if (!(lu_.append(diagonal) > kSmallestPivot * shear[node.dof[1]])) return false;
  order_.push_back(k);
  order_dof_.push_back(node.dof[1]);
  signs_.push_back(wanted_[k]);
  placed_[k] = 1;
  return true;
}

bool ScalarSlip::solve_set(const SubStep& sub_step) {
  synchronise();
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    if (wanted_[i] != 0 && !placed_[i] && !append(static_cast<int>(i))) return false;
  }
  slip_.resize(order_.size());
  for (std::size_t j = 0; j < order_.size(); ++j) {
    const auto i = static_cast<std::size_t>(order_[j]);
    const ContactNode& node = problem_.nodes[i];
    const double excess = signs_[j] * sub_step.trial[node.dof[1]] -
                          node.law->cohesion(sub_step.cohesive[i] != 0) +
                          node.law->static_friction() * sub_step.trial[node.dof[0]];
    slip_[j] = signs_[j] * excess / node.inverse_area[1];
  }
  lu_.solve(slip_.data());
  return true;
}

bool ScalarSlip::release_wrong_way() {
  bool any = false;
  for (std::size_t j = 0; j < order_.size(); ++j) {
    if (signs_[j] * slip_[j] > 0) continue;
    wanted_[order_[j]] = 0;
    any = true;
  }
  return any;
}

/// Sets are solved exactly, so no residual is formed.
void ScalarSlip::note(SearchHistory& history) {
  int n_changed = 0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    n_changed += (wanted_[i] != 0) != (placed_[i] != 0);
  }
  history.add({.residual = std::numeric_limits<double>::quiet_NaN(),
               .n_slip = static_cast<int>(order_.size()),
               .n_changed = n_changed});
}

SearchHistory ScalarSlip::solve(SubStep& sub_step) {
  SearchHistory history;
  history.end = SearchEnd::too_many_sets;
  seen_.clear();
  std::ranges::fill(wanted_, 0);
  // A history starts with no jump: nothing of an earlier one, not even the order of nodes, stays.
  if (sub_step.start->jump.isZero(0)) synchronise();
  bool opens = false;
  bool changed = add_violators(sub_step, opens);
  while (!opens && history.passes < options_.max_active_set_passes) {
    if (!changed) {
      history.end = SearchEnd::balanced;
      break;
    }
    if (seen_.has_seen(wanted_)) {
      history.end = SearchEnd::set_comes_back;
      break;
    }
    stop_.throw_if_requested("solving a load step");
    ++history.passes;
    if (!solve_set(sub_step)) {
      history.end = SearchEnd::singular_tangent;  // what was appended so far is a valid factor
      break;
    }
    // A set that already fails in its own rows is revised before all rows are looked at.
    if (release_wrong_way() || add_neighbours(sub_step)) {
      note(history);
      continue;
    }
    sub_step.increment.setZero();
    for (std::size_t j = 0; j < order_.size(); ++j) {
      const auto i = static_cast<std::size_t>(order_[j]);
      sub_step.increment[problem_.nodes[i].dof[1]] = slip_[j];
    }
    sub_step.traction = sub_step.trial;
    problem_.subtract_product(sub_step.increment, sub_step.traction);
    changed = add_violators(sub_step, opens);
    note(history);
  }
  if (opens) history.end = SearchEnd::opens;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    sub_step.state[i] = wanted_[i] != 0 ? FaultState::slip : FaultState::stick;
  }
  return history;
}

}  // namespace faultsim
