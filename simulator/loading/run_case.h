#pragma once

#include <functional>
#include <string>

#include "simulator/common/run_context.h"
#include "simulator/contact/judge.h"
#include "simulator/loading/run_watch.h"
#include "simulator/loading/step_solver.h"
#include "simulator/model/fault_operator.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// What callers add to a run: looks at what was tried and accepted, noise, and what they know.
struct CaseProbe : RunWatch {
  /// Relative size of a disturbance of every locked traction at every time, with signs that depend
  /// on nothing but the position of the entry; 0 = none.
  double noise = 0;
  /// Called after each load step in equilibrium, if set, with the number of the step.
  std::function<void(int, const ContactLaws&, const AcceptedStep&)> accepted = nullptr;
  std::string identity = {};  ///< case_identity of the scene; empty = to be found.
};

/// Runs one case on its operator: initial state, load steps, contact, metrics. Deterministic: the
/// same scene and operator give the same bits whatever ran before. Never throws for
/// non-convergence, nor where the context stops it: the outcome is then `interrupted`, and the
/// steps are those that were complete.
CaseResult run_case(const Scene& scene, const PreparedOperator& prepared, const RunContext& context,
                    const CaseProbe& probe = {});
/// The same by a solver of its own, which has no operator.
/// @param faults  geometry, keys of its loads and observation rows; nothing of what a load or a
/// jump does.
CaseResult run_case(const Scene& scene, const FaultOperator& faults, const MakeStepSolver& solver,
                    const RunContext& context, const CaseProbe& probe = {});

/// One load step of a case before it is solved: what a contact solver would be given.
struct StepStart {
  LoadStep step;
  ContactLaws laws;
  ContactOptions options;
  Eigen::VectorXd before, after;      ///< locked effective traction t_L at its start and end, Pa.
  ContactState state;                 ///< at the start.
  Outcome outcome = Outcome::failed;  ///< of the steps before; the rest holds iff converged.
  std::string reason;                 ///< why they ended early.
};

/// Runs a case up to the end of load step − 1 (0: the unloaded start, whose step equilibrates the
/// initial state). Throws InputError when the case has no such step,
/// Interrupted when the context says so.
StepStart start_of_step(const Scene& scene, const PreparedOperator& prepared, int step,
                        const RunContext& context = {});

}  // namespace faultsim
