#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/contact/contact_state.h"
#include "simulator/contact/search_record.h"
#include "simulator/fault/friction_law.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

struct ContactOptions {
  double traction_tolerance = 1e-8;  ///< relative to the local traction level; too tight: cycling.
  int max_newton_iterations = 30;    ///< per active-set pass.
  int max_active_set_passes = 100;
  int max_step_cuts = 6;                ///< halvings of a load step before giving up.
  double onset_tolerance = 1.0 / 4096;  ///< of a load step, to which an instability is located.
  int max_jumps = 256;                  ///< per load step.
  /// Newton iterations per load step after which no jump is followed further: a bound on the work.
  int max_iterations = 10'000'000;
};

/// Rest under no load.
ContactState initial_state(const FaultOperator& op);
/// What the friction of a node remembers at the end of a step. @param node  number k of the
/// operator.
FrictionState friction_state(const OperatorNode& node, const ContactState& state, int k);

/// Equilibrium jumped: between two load factors there is no stable equilibrium next to the last
/// one. The jump was followed at fixed load to the next one (jump_follower.h).
struct ContactJump {
  double load_before = 0;  ///< load factor of the step with the last equilibrium before.
  double load_after = 0;   ///< and the one at which the jump was followed.
  Eigen::VectorXd jump_before, traction_before;  ///< g and t' at load_before.
  Eigen::VectorXd jump_after, traction_after;    ///< g and t' at load_after.
  std::vector<int> nucleus;  ///< nodes that slip and weaken, or lose their cohesion, when stability
                             ///< is first lost.
  int n_lost_cohesion = 0;   ///< nodes whose cohesion was lost by slip.
  int negative_pivots = 0;   ///< of the undamped tangent, most seen; 0 before and after.
  double residual_before = 0;  ///< largest violation of (3)–(5) in units of the tolerance.
  double residual_after = 0;
  double released = 0;    ///< energy released by bulk and loads, ½ Σ A (t'_0 + t'_1)·Δg, J.
  double dissipated = 0;  ///< by friction, Σ A τ_L |Δg_T|, J; the rest is radiated.
  double duration = 0;    ///< s, of the damped motion.
  int damped_steps = 0;
  /// Makes one jump of this and the next one, which starts where this one ended.
  void append(const ContactJump& next);
};

struct ContactReport {
  Outcome outcome = Outcome::failed;
  std::string reason;  ///< why, with counts per reason and the worst node; empty if converged.
  SolveCounts counts;
  std::vector<ContactJump> jumps;  ///< in order of load.
};

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
