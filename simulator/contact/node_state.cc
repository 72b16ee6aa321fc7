#include "simulator/contact/node_state.h"

namespace faultsim {

ContactState initial_state(const FaultOperator& op) {
  const std::size_t n = op.geometry.nodes.size();
  ContactState state;
  state.jump = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  state.traction = state.jump;
  state.state.assign(n, FaultState::stick);
  state.slip_path = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  state.cohesion_lost.assign(n, 0);
  return state;
}

FrictionState friction_state(const OperatorNode& node, const ContactState& state, int k) {
  const auto [normal, strike, dip] = node.dof;
  return {{strike >= 0 ? state.jump[strike] : 0, dip >= 0 ? state.jump[dip] : 0},
          state.slip_path[k],
          state.cohesion_lost[k] == 0};
}

}  // namespace faultsim
