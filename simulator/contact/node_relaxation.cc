#include "simulator/contact/node_relaxation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

/// τ_L of the node by its normal traction, with the slip of the last visit.
struct StrengthAt {
  const NodeLaw& law;
  Eigen::Vector2d slip;
  FrictionState before;
  double operator()(double normal_traction) const {
    return law.strength(normal_traction, slip, 0, before).value;
  }
};

struct SlipTrial {
  Eigen::Vector2d slip;
  double excess;  ///< |t'_T| − τ_L
};

/// Slip with t'_T = κ Δg_T: (D_TT + κ) Δg_T = b_T.
SlipTrial slip_trial(const StrengthAt& strength, const Eigen::Vector3d& b, const Eigen::Matrix3d& d,
                     double kappa) {
  Eigen::Matrix2d matrix = d.bottomRightCorner<2, 2>();
  matrix.diagonal().array() += kappa;
  const Eigen::Vector2d increment = matrix.inverse() * b.tail<2>();
  const double normal = b[0] - d(0, 1) * increment[0] - d(0, 2) * increment[1];
  return {increment, kappa * increment.norm() - strength(normal)};
}

/// The slip with |t'_T| = τ_L, by bisection on κ = r z/(1 − z): |t'_T| grows with κ.
Eigen::Vector2d slip_at_limit(const StrengthAt& strength, const Eigen::Vector3d& b,
                              const Eigen::Matrix3d& d) {
  const double scale = d(1, 1) + d(2, 2);
  double low = 0;
  double high = 1;
  constexpr int kHalvings = 60;
  Eigen::Vector2d increment(0, 0);
  for (int i = 0; i < kHalvings; ++i) {
    const double z = 0.5 * (low + high);
    const SlipTrial trial = slip_trial(strength, b, d, scale * z / (1 - z));
    (trial.excess > 0 ? high : low) = z;
    increment = trial.slip;
    if (high - low < 1e-14 * high) break;
  }
  return increment;
}

/// The contact problem of one node with all others fixed.
struct LocalSolution {
  FaultState state = FaultState::stick;
  Eigen::Vector3d increment = Eigen::Vector3d::Zero();  ///< Δg (n, shear, shear), m.
};

/// @param traction   t' of the node if it does not move in the sub-step (b), Pa.
/// @param stiffness  D = A⁻¹H of the node, 3 x 3; unit rows for missing components.
/// @param gap_before  g_N at the start, m.
LocalSolution solve_node(const StrengthAt& strength, const Eigen::Vector3d& traction,
                         const Eigen::Matrix3d& stiffness, double gap_before) {
  LocalSolution solution;
  const Eigen::Vector3d closed = traction + stiffness.col(0) * gap_before;
  solution.increment[0] = -gap_before;
  if (closed[0] <= 0 && closed.tail<2>().norm() <= strength(closed[0])) return solution;
  const Eigen::Vector3d open = stiffness.inverse() * traction;
  if (closed[0] > 0 && gap_before + open[0] >= 0) return {FaultState::open, open};
  const Eigen::Vector2d slipped = slip_at_limit(strength, closed, stiffness);
  const double normal = closed[0] - stiffness(0, 1) * slipped[0] - stiffness(0, 2) * slipped[1];
  if (normal > 0 && gap_before + open[0] >= 0) return {FaultState::open, open};
  solution.state = FaultState::slip;
  solution.increment.tail<2>() = slipped;
  return solution;
}

}  // namespace

double relax(ContactProblem& problem, SubStep& sub_step, int sweeps, StopToken stop) {
  sub_step.traction = sub_step.trial;
  problem.subtract_product(sub_step.increment, sub_step.traction);
  double worst = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    worst = 0;
    for (int k = 0; k < problem.n_nodes(); ++k) {
      stop.throw_if_requested("solving a load step");
      const ContactNode& node = problem.nodes[k];
      const auto n = static_cast<std::size_t>(node.n_dofs);
      const double gap_before = sub_step.start->jump[node.dof[0]];
      Eigen::Vector3d traction(0, 0, 0);
      Eigen::Vector3d increment(0, 0, 0);
      for (std::size_t c = 0; c < n; ++c) {
        traction[c] = sub_step.traction[node.dof[c]];
        increment[c] = sub_step.increment[node.dof[c]];
      }
      const StrengthAt strength = {*node.law, increment.tail<2>(),
                                   friction_before(node, sub_step, k)};
      if (increment.isZero(0) && gap_before == 0 && traction[0] <= 0 &&
          traction.tail<2>().norm() <= strength(traction[0])) {
        sub_step.state[k] = FaultState::stick;
        continue;
      }
      Eigen::Matrix3d stiffness = Eigen::Matrix3d::Identity();
      for (int c = 0; c < node.n_dofs; ++c) {
        const auto column = problem.compliance.column(node.dof[c]);
        for (int r = 0; r < node.n_dofs; ++r) {
          stiffness(r, c) = column[node.dof[r]] * node.inverse_area[r];
        }
      }
      const LocalSolution solution =
          solve_node(strength, traction + stiffness * increment, stiffness, gap_before);
      sub_step.state[k] = solution.state;
      for (std::size_t c = 0; c < n; ++c) {
        const auto row = static_cast<Eigen::Index>(c);
        const double change = solution.increment[row] - increment[row];
        if (change == 0) continue;
        sub_step.increment[node.dof[c]] = solution.increment[row];
        sub_step.traction.array() -=
            change * problem.compliance.column(node.dof[c]).array() * problem.inverse_area.array();
        worst = std::max(worst, std::abs(change) * stiffness(row, row) / sub_step.tolerance[k]);
      }
    }
    if (worst < 1) break;
  }
  return worst;
}

}  // namespace faultsim
