#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/laws/coulomb_law.h"
#include "simulator/result/result.h"

namespace faultsim {

/// What the contact solve needs besides the operator: the law of each operator node, constant over
/// the steps of a case. Jumps are followed where the laws have damping.
using ContactLaws = std::vector<CoulombLaw>;

/// The state that a load step starts from and ends in.
struct ContactState {
  Eigen::VectorXd jump;             ///< g, n_dofs, m.
  Eigen::VectorXd traction;         ///< t', n_dofs, Pa.
  std::vector<FaultState> state;    ///< per node.
  Eigen::VectorXd slip_path;        ///< Σ|Δg_T| per node, m.
  std::vector<char> cohesion_lost;  ///< per node: by opening or, where the law says so, by slip.
};

}  // namespace faultsim
