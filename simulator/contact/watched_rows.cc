#include "simulator/contact/watched_rows.h"

#include <algorithm>
#include <numeric>

namespace faultsim {

WatchedRows::WatchedRows(const ContactProblem& problem)
    : problem_(problem), every_node_(static_cast<std::size_t>(problem.n_nodes())) {
  std::iota(every_node_.begin(), every_node_.end(), 0);
  watch_all();
}

void WatchedRows::watch_all() {
  all_ = true;
  rows_.assign(1, {0, problem_.n_dofs()});
}

/// Moving, or within a share of the limit, or of opening.
bool WatchedRows::is_near(const SubStep& sub_step, int k) const {
  constexpr double kMargin = 0.2;
  if (sub_step.state[k] != FaultState::stick) return true;
  const ContactNode& node = problem_.nodes[k];
  const double normal = sub_step.traction[node.dof[0]];
  if (normal > kMargin * sub_step.trial[node.dof[0]]) return true;
  if (node.n_dofs == 1) return false;
  const double limit = node.law->static_limit(normal, sub_step.cohesive[k] != 0);
  return shear_part(node, sub_step.traction).norm() > (1 - kMargin) * limit;
}

void WatchedRows::watch_near_limit(const SubStep& sub_step) {
  constexpr int kGap = 16;  // rows that cost less to compute than to pass over
  all_ = false;
  near_.clear();
  std::vector<int> dofs;
  for (const int k : every_node_) {
    if (!is_near(sub_step, k)) continue;
    near_.push_back(k);
    const ContactNode& node = problem_.nodes[k];
    dofs.insert(dofs.end(), node.dof.begin(), node.dof.begin() + node.n_dofs);
  }
  std::ranges::sort(dofs);
  rows_.clear();
  for (const int dof : dofs) {
    if (rows_.empty() || dof > rows_.back().first + rows_.back().n + kGap)
      rows_.push_back({dof, 0});
    rows_.back().n = dof + 1 - rows_.back().first;
  }
}

}  // namespace faultsim
