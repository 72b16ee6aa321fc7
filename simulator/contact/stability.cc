#include "simulator/contact/stability.h"

#include <algorithm>
#include <cmath>

namespace faultsim {

void StabilityCheck::collect(const SubStep& sub_step, Where where, StabilityReport& report) {
  movers_.clear();
  for (int k = 0; k < problem_.n_nodes(); ++k) {
    const ContactNode& node = problem_.nodes[k];
    const double damping = node.law->drag(sub_step.per_second);
    if (sub_step.state[k] == FaultState::open) {
      for (int c = 0; c < node.n_dofs; ++c) {
        movers_.push_back({k, c, {0, 0}, 0, 0, c > 0 ? damping : 0});
      }
      continue;
    }
    const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
    if (sub_step.state[k] != FaultState::slip || slip.norm() == 0) continue;
    Mover mover{k, -1, slip / slip.norm(), 0, 0, damping};
    const double normal = sub_step.traction[node.dof[0]];
    const FrictionState before = friction_before(node, sub_step, k);
    const Strength end = node.law->strength(normal, slip, 0, before, slip);
    mover.friction = -end.d_normal;
    if (where == Where::at_the_end) {
      mover.weakening = -end.d_slip.dot(slip) / slip.norm();
    } else if (node.law->weakens()) {
      const double lowest = std::min({0.0, normal, sub_step.start->traction[node.dof[0]]});
      mover.weakening = node.law->fastest_weakening(lowest, slip, before);
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
    const Mover& mover = movers_[i];
    const ContactNode& node = problem_.nodes[mover.node];
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
  for (Eigen::Index j = 0; j < n; ++j) {
    const Mover& column = movers_[j];
    const ContactNode& from = problem_.nodes[column.node];
    const auto column_of = [&](int component) {
      return problem_.compliance.column(from.dof[component]).data();
    };
    const bool open = column.open_component >= 0;
    const double* first = column_of(open ? column.open_component : 1);
    const double* second = !open && from.n_dofs > 2 ? column_of(2) : nullptr;
    // H applied to the column's direction, at one dof.
    const auto response = [&](int dof) {
      if (open) return first[dof];
      double sum = first[dof] * column.direction[0];
      if (second != nullptr) sum += second[dof] * column.direction[1];
      return sum;
    };
    for (Eigen::Index i = 0; i < n; ++i) {
      const Mover& row = movers_[i];
      const ContactNode& to = problem_.nodes[row.node];
      if (row.open_component >= 0) {
        tangent_(i, j) = response(to.dof[row.open_component]);
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
