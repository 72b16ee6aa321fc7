#pragma once

#include "simulator/common/run_context.h"
#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// Nonlinear block Gauss-Seidel: solves (3)–(5) node by node, in order, sweeps times. Slow but hard
/// to stop, as it needs no good start: what the Newton loop starts from when it failed from rest.
/// Strength weakens with the slip of the last visit. Cost per sweep: 6 n_dofs per moving node.
/// Throws Interrupted when `stop` says so.
/// @returns the largest change of traction in the last sweep, in units of the node's tolerance.
double relax(ContactProblem& problem, SubStep& sub_step, int sweeps, StopToken stop);

}  // namespace faultsim
