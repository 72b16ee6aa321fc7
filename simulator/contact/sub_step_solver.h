#pragma once

#include "simulator/contact/contact_newton.h"
#include "simulator/contact/contact_options.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/load_path.h"
#include "simulator/contact/scalar_slip.h"
#include "simulator/contact/stability.h"

namespace faultsim {

/// How a try at a sub-step ended.
enum class Attempt {
  converged,
  failed,            ///< no equilibrium found.
  not_shown_stable,  ///< found, but the way there may pass an instability.
  lost_cohesion,     ///< found, but a node slipped whose cohesion does not outlive slip.
};

/// Part of a load step, by load factors, and how its motion is damped.
struct SubStepRange {
  double from = 0, to = 1;
  double duration = 0;  ///< s, Δt of a damped sub-step; 0 = static equilibrium.
};

/// Solves one sub-step: rest if it will do, the fast path of plane strain, Newton from rest, Newton
/// after relaxation. Every solution is checked against (3)–(5) node by node. A damped sub-step lets
/// the limit shear traction grow with the slip rate, |t'_T| = τ_L + η |Δg_T|/Δt: for small Δt it
/// always has a solution.
class SubStepSolver {
 public:
  SubStepSolver(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& options,
                const ContactWatch& watch);

  /// Sets up a sub-step of a load step. @param start  kept by reference until commit().
  void begin(const LoadPath& path, const SubStepRange& range, const ContactState& start);
  /// Whether nothing needs to move; then the sub-step is solved.
  bool rest();
  /// @param last  no smaller sub-step will follow, so the fallbacks are tried too.
  Attempt attempt(bool last);
  /// Moves state, the `start` of begin() or a copy of it, to the end of the sub-step.
  void commit(ContactState& state) const;

  /// Pivots of the undamped tangent of what slips, with the weakening at the end of the sub-step.
  int negative_pivots() { return stability_.negative_pivots(sub_step_); }
  /// Largest violation of (3)–(5) in units of the node's tolerance.
  double residual() const;
  /// The same of the start of the sub-step, as if nothing moved.
  double residual_at_rest() {
    start_from_rest();
    return residual();
  }
  int iterations() const;  ///< of the last attempt.
  int passes() const;
  /// What was tried since begin().
  const SubStepTrace& trace() const { return trace_; }
  const StabilityReport& stability_report() const { return stable_; }
  const SubStep& sub_step() const { return sub_step_; }
  const ContactProblem& problem() const { return problem_; }

 private:
  void set_tolerance();
  bool at_rest() const;
  void start_from_rest();
  bool rests_in_plane(int k, double margin) const;
  bool verified() const;
  bool solved_by(const char* way, SearchHistory history);
  void conclude(const char* verdict);
  bool solve_motion(bool last);
  bool loses_cohesion() const;

  ContactOptions options_;
  ContactWatch watch_;
  ContactProblem problem_;
  ScalarSlip scalar_;
  ContactNewton newton_;
  StabilityCheck stability_;
  SubStep sub_step_;
  bool closed_ = true;  ///< no gap at the start of the sub-step.
  bool rests_ = false;  ///< nothing moves in the sub-step.
  StabilityReport stable_;
  Eigen::VectorXd level_;             ///< largest |traction| per dof, Pa.
  Eigen::VectorXd normal_stiffness_;  ///< ≥ H_NN/A per node, Pa/m; empty until something slipped.
  SubStepTrace trace_;
};

}  // namespace faultsim
