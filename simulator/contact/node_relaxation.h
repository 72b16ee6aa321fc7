#pragma once

#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// The contact problem of one node with all others fixed.
struct LocalSolution {
  FaultState state = FaultState::stick;
  Eigen::Vector3d increment = Eigen::Vector3d::Zero();  ///< Δg (n, shear, shear), m.
};

/// Nonlinear block Gauss-Seidel: solves (3)–(5) node by node, in order, sweeps times. Slow but hard
/// to stop, as it needs no good start: what the Newton loop starts from when it failed from rest.
/// Strength weakens with the slip of the last visit. Cost per sweep: 6 n_dofs per moving node.
/// @returns the largest change of traction in the last sweep, in units of the node's tolerance.
double relax(ContactProblem& problem, SubStep& sub_step, int sweeps);

/// @param traction   t' of the node if it does not move in the sub-step (b), Pa.
/// @param stiffness  D = A⁻¹H of the node, 3 x 3; unit rows for missing components.
/// @param gap_before  g_N at the start, m.
LocalSolution solve_node(const ContactProblem& problem, int node, bool cohesive, double slip,
                         const Eigen::Vector3d& traction, const Eigen::Matrix3d& stiffness,
                         double gap_before);

}  // namespace faultsim
