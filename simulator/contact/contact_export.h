#pragma once

#include "simulator/contact/contact_state.h"
#include "simulator/model/fault_operator.h"
#include "simulator/model/frictional_contact.h"

namespace faultsim {

/// A load step whose contact problem is to be given away.
struct LoadStepProblem {
  Eigen::VectorXd before, after;  ///< locked effective traction t_L, n_dofs, Pa.
  ContactState start;             ///< at the start of the step.
};

/// What to do with friction that may weaken within the step.
enum class Weakening { refuse, freeze };

/// The laws of a step with *frozen strength*: each node keeps, through the whole step, the friction
/// coefficient that it has at the start, μ_k = tan φ(s_k) with s_k the slip measure there; no
/// cohesion. For laws without cohesion and weakening these are the same laws.
///
/// Throws InputError when the step has no such form: cohesion at work (c > 0 where the node is
/// cohesive at the start); friction that may still change in the step, unless that is to be frozen.
/// Friction that can no longer change is fully weakened by the cumulated slip path.
ContactLaws frozen_laws(const FaultOperator& op, const ContactLaws& laws, const ContactState& start,
                        Weakening weakening);

/// The contact problem of a whole load step ((3)–(5) without sub-steps) as u = W r + q. With the
/// areas A, the traction if nothing moves t = start.traction + after − before and the start's gap
/// g_0,
///
///   r = −A t',    u = Δg + g_0 e_n,    W = H⁻¹,    q = W A t + g_0 e_n.
///
/// d is 2 when every node has at most one shear component (plane strain), else 3. A component that
/// a node lacks gets a row of its own, W_cc = W_nn of the node and q_c = 0: as friction opposes
/// slip, its u_c and r_c are 0 in every solution.
///
/// @param frozen  from frozen_laws().  Cost: inverting H, n_dofs³ flops.
/// Throws InputError when there are no nodes, or too many for FCLib's integers.
FrictionalContactProblem frictional_contact_problem(const FaultOperator& op,
                                                    const ContactLaws& frozen,
                                                    const LoadStepProblem& step);

/// The end state of the step in the variables of its problem.
FrictionalContactSolution frictional_contact_solution(const FaultOperator& op,
                                                      const FrictionalContactProblem& problem,
                                                      const LoadStepProblem& step,
                                                      const ContactState& end);

/// The natural-map error of u and r, in units of the problem: the Euclidean norm over all contacts
/// of
///
///   r − P_K(r − (u + μ|u_T| e_n)),     P_K the orthogonal projection on K_μ;
///
/// 0 iff contact and friction hold. It does not look at u = W r + q: see equilibrium_error.
double natural_map_error(const FrictionalContactProblem& problem,
                         const FrictionalContactSolution& solution);
/// |u − W r − q|, in displacement units.
double equilibrium_error(const FrictionalContactProblem& problem,
                         const FrictionalContactSolution& solution);

/// The nearest point of K_μ = {|x_T| ≤ μ x_N} (normal first; 2 or 3 components).
Eigen::VectorXd project_on_friction_cone(const Eigen::VectorXd& x, double friction);

}  // namespace faultsim
