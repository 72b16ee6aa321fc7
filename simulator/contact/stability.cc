#include "simulator/contact/stability.h"

#include <algorithm>
#include <cmath>

namespace faultsim {

/// W ≥ −dτ_L/d|Δg_T| over the straight way from rest to slip: both laws weaken fastest at the
/// smallest s met on the way, and more under more pressure.
double StabilityCheck::fastest_weakening(const SubStep& sub_step, int k,
                                         const Eigen::Vector2d& slip) const {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = problem_.nodes[i];
  const ContactState& start = *sub_step.start;
  const double length = slip.norm();
  const double normal =
      std::min({0.0, sub_step.traction[node.dof[0]], start.traction[node.dof[0]]});
  const bool cohesive = sub_step.cohesive[i] != 0;
  if (problem_.laws.cumulated[i]) {
    return -problem_.strength(k, cohesive, normal, start.slip_path[k]).d_slip;
  }
  const Eigen::Vector2d before = shear_part(node, start.jump);
  const Eigen::Vector2d after = before + slip;
  const double outward = after.dot(slip);
  if (outward <= 0) return 0;  // s shrinks all the way: the node heals
  const double nearest = std::clamp(-before.dot(slip) / (length * length), 0.0, 1.0);
  const double smallest = (before + nearest * slip).norm();
  const double rate = after.norm() > 0 ? outward / (length * after.norm()) : 1;
  return -problem_.strength(k, cohesive, normal, smallest).d_slip * rate;
}

/// −dτ_L/d|Δg_T| where the sub-step ends.
double StabilityCheck::weakening_at_the_end(const SubStep& sub_step, int k,
                                            const Eigen::Vector2d& slip) const {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = problem_.nodes[i];
  const SlipMeasure s = slip_measure(problem_.laws.cumulated[i] != 0, sub_step.start->slip_path[k],
                                     shear_part(node, sub_step.start->jump), slip, slip);
  const double normal = sub_step.traction[node.dof[0]];
  const double rate = s.gradient.dot(slip) / slip.norm();
  return -problem_.strength(k, sub_step.cohesive[i] != 0, normal, s.value).d_slip * rate;
}

void StabilityCheck::collect(const SubStep& sub_step, Where where, StabilityReport& report) {
  movers_.clear();
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ContactNode& node = problem_.nodes[i];
    const double damping = sub_step.damping_per_second * problem_.damping(k);
    if (sub_step.state[i] == FaultState::open) {
      for (int c = 0; c < node.n_dofs; ++c) {
        movers_.push_back({k, c, {0, 0}, 0, 0, c > 0 ? damping : 0});
      }
      continue;
    }
    const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
    if (sub_step.state[i] != FaultState::slip || slip.norm() == 0) continue;
    Mover mover{k, -1, slip / slip.norm(), 0, 0, damping};
    const SlipMeasure s =
        slip_measure(problem_.laws.cumulated[i] != 0, sub_step.start->slip_path[k],
                     shear_part(node, sub_step.start->jump), slip, slip);
    mover.friction =
        -problem_.strength(k, sub_step.cohesive[i] != 0, sub_step.traction[node.dof[0]], s.value)
             .d_normal_traction;
    if (node.weakens) {
      mover.weakening = where == Where::at_the_end ? weakening_at_the_end(sub_step, k, slip)
                                                   : fastest_weakening(sub_step, k, slip);
    }
    ++report.n_slipping;
    if (mover.weakening > 0) {
      report.checked = true;
      const double ratio = mover.weakening / problem_.stiffness(node, 1);
      if (report.node < 0 || ratio > report.ratio) {
        report.node = k;
        report.ratio = ratio;
      }
    }
    movers_.push_back(mover);
  }
}

int StabilityCheck::count_negative_pivots(bool with_weakening, bool damped) {
  lu_.clear();
  int negative = 0;
  const auto n = static_cast<Eigen::Index>(movers_.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      lu_.row()[j] = tangent_(i, j);
      lu_.column()[j] = tangent_(j, i);
    }
    const Mover& mover = movers_[static_cast<std::size_t>(i)];
    const ContactNode& node = problem_.nodes[static_cast<std::size_t>(mover.node)];
    double diagonal = tangent_(i, i);
    if (with_weakening) diagonal -= mover.weakening / node.inverse_area[1];
    if (damped) diagonal += mover.damping / node.inverse_area[1];
    const double pivot = lu_.append(diagonal);
    if (pivot == 0 || !std::isfinite(pivot)) return negative + 1;
    if (pivot < 0) ++negative;
  }
  return negative;
}

/// The elastic and frictional part of the tangent over the movers, times A.
void StabilityCheck::assemble() {
  const auto n = static_cast<Eigen::Index>(movers_.size());
  tangent_.resize(n, n);
  const auto& h = problem_.op.h;
  for (Eigen::Index j = 0; j < n; ++j) {
    const Mover& column = movers_[static_cast<std::size_t>(j)];
    const ContactNode& from = problem_.nodes[static_cast<std::size_t>(column.node)];
    // H applied to the column's direction, at one dof.
    const auto response = [&](int dof) {
      if (column.open_component >= 0) {
        return h(dof, from.dof[static_cast<std::size_t>(column.open_component)]);
      }
      double sum = h(dof, from.dof[1]) * column.direction[0];
      if (from.n_dofs > 2) sum += h(dof, from.dof[2]) * column.direction[1];
      return sum;
    };
    for (Eigen::Index i = 0; i < n; ++i) {
      const Mover& row = movers_[static_cast<std::size_t>(i)];
      const ContactNode& to = problem_.nodes[static_cast<std::size_t>(row.node)];
      if (row.open_component >= 0) {
        tangent_(i, j) = response(to.dof[static_cast<std::size_t>(row.open_component)]);
        continue;
      }
      double sum = row.direction[0] * response(to.dof[1]);
      if (to.n_dofs > 2) sum += row.direction[1] * response(to.dof[2]);
      tangent_(i, j) =
          sum + row.friction * response(to.dof[0]) * to.inverse_area[0] / to.inverse_area[1];
    }
  }
}

StabilityReport StabilityCheck::check(const SubStep& sub_step) {
  StabilityReport report;
  collect(sub_step, Where::fastest_on_the_way, report);
  if (!report.checked) return report;
  assemble();
  const int with = count_negative_pivots(true, true);
  report.stable = with == 0 || with == count_negative_pivots(false, true);
  return report;
}

int StabilityCheck::negative_pivots(const SubStep& sub_step) {
  StabilityReport report;
  collect(sub_step, Where::at_the_end, report);
  if (!report.checked) return 0;
  assemble();
  const int with = count_negative_pivots(true, false);
  return with == 0 ? 0 : std::max(0, with - count_negative_pivots(false, false));
}

}  // namespace faultsim
