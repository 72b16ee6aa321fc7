#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/fault/friction_law.h"
#include "simulator/output/fault_operator.h"
#include "simulator/output/result.h"

namespace faultsim {

/// What the contact solve needs besides the operator; per case, constant over its steps.
struct ContactLaws {
  std::vector<CoulombLaw> node;     ///< one per operator node.
  std::vector<char> cumulated;      ///< per node: slip measure is the cumulated path.
  std::vector<char> keep_cohesion;  ///< per node: cohesion survives opening.
};

struct ContactOptions {
  double traction_tolerance = 1e-8;  ///< relative to the local traction level; too tight: cycling.
  int max_newton_iterations = 30;    ///< per active-set pass.
  int max_active_set_passes = 100;
  int max_step_cuts = 6;  ///< halvings of a load step before giving up.
};

/// The state that a load step starts from and ends in.
struct ContactState {
  Eigen::VectorXd jump;           ///< g, n_dofs, m.
  Eigen::VectorXd traction;       ///< t', n_dofs, Pa.
  std::vector<FaultState> state;  ///< per node.
  Eigen::VectorXd slip_path;      ///< Σ|Δg_T| per node, m.
  std::vector<char> opened;       ///< per node: was open once (cohesion lost).
};
ContactState initial_state(const FaultOperator& op);

struct ContactReport {
  Outcome outcome = Outcome::failed;
  std::string reason;  ///< why, with counts per reason and the worst node; empty if converged.
  SolveCounts counts;
};

/// Solves the frictional contact problem on the faults, load step by load step (D2, D3, D4):
/// given the locked effective traction t_L (n_dofs), find g with
///
///   t' = t_L − A⁻¹ H g,   t'_N ≤ 0, g_N ≥ 0, t'_N g_N = 0,
///   |t'_T| ≤ τ_L(t'_N, s),   Δg_T = α t'_T/|t'_T|, α ≥ 0, α(|t'_T| − τ_L) = 0,   Δg_T over the
///   step.
///
/// Load step → sub-step (t_L linear in between) → active set → Newton; every loop is bounded. Only
/// active nodes are unknowns and only their columns of H are touched; scratch memory is kept
/// between calls. The result does not depend on earlier cases (scratch never carries values).
/// When a step is cut, D3 holds over each sub-step, not over the step as a whole.
///
/// A step with weakening is accepted only when every state on the way was shown stable
/// (stability.h); what cannot be shown at the smallest sub-step is `unstable`.
class ContactSolver {
 public:
  /// @pre op and laws outlive the solver; sizes agree (InternalError).
  ContactSolver(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& options);
  ~ContactSolver();

  /// Advances state to the end of a load step whose locked traction goes linearly from `before`
  /// (of the last step) to `after`. On any outcome but converged, state is left as it was.
  ContactReport solve_step(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                           ContactState& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Largest violation of D2–D3 by a state, in Pa and m, measured independently of the solver.
/// Misalignment of slips below 1e-6 |t'_T| A/H_TT counts in proportion: their direction is
/// round-off. A step that was cut (sub_steps > 1) need not pass the last two of slip: see
/// ContactSolver.
struct ContactViolation {
  double tension = 0;           ///< max t'_N over closed nodes, Pa.
  double penetration = 0;       ///< max −g_N, m.
  double over_limit = 0;        ///< max |t'_T| − τ_L over closed nodes, Pa.
  double slip_below_limit = 0;  ///< max τ_L − |t'_T| over nodes that slipped in the step, Pa.
  double misaligned = 0;        ///< max | |t'_T| Δg_T − t'_T |Δg_T| | / |Δg_T|, Pa.
  double open_traction = 0;     ///< max |t'| over open nodes, Pa.
  double equilibrium = 0;       ///< max |t' − (t_L − A⁻¹ H g)|, Pa.
};
ContactViolation contact_violation(const FaultOperator& op, const ContactLaws& laws,
                                   const Eigen::VectorXd& locked, const ContactState& before,
                                   const ContactState& after);

}  // namespace faultsim
