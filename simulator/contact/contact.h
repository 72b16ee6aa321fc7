#pragma once

#include <Eigen/Core>
#include <memory>

#include "simulator/contact/contact_options.h"
#include "simulator/contact/contact_report.h"
#include "simulator/contact/node_state.h"
#include "simulator/contact/search_record.h"

namespace faultsim {

/// Solves the frictional contact problem on the faults, load step by load step (docs/model.md, 3 to
/// 6): given the locked effective traction t_L (n_dofs), find g with
///
///   t' = t_L − A⁻¹ H g,   t'_N ≤ 0, g_N ≥ 0, t'_N g_N = 0,
///   |t'_T| ≤ τ_L(t'_N, s),   Δg_T = α t'_T/|t'_T|, α ≥ 0, α(|t'_T| − τ_L) = 0,   Δg_T over the
///   step.
///
/// Load step → sub-step (t_L linear in between) → active set → Newton; every loop is bounded. Only
/// active nodes are unknowns and only their columns of H are touched; scratch memory is kept
/// between calls. The result does not depend on earlier cases (scratch never carries values).
/// When a step is cut, (5) holds over each sub-step, not over the step as a whole.
///
/// A step with weakening is accepted only when every state on the way was shown stable
/// (stability.h). Where that fails at the smallest sub-step, the jump is followed to the next
/// stable equilibrium (jump_follower.h) and reported; without damping in the laws the outcome is
/// `unstable`.
class ContactSolver {
 public:
  /// @pre op and laws outlive the solver; sizes agree (InternalError).
  ContactSolver(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& options,
                const ContactWatch& watch = {});
  ~ContactSolver();

  /// Advances state to the end of a load step whose locked traction goes linearly from `before`
  /// (of the last step) to `after`. On any outcome but converged and event, state is left as it
  /// was. Throws Interrupted when the watch says so; state is then as it was.
  ContactReport solve_step(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                           ContactState& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
