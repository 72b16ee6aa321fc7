#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/contact/contact.h"
#include "simulator/contact/judge.h"
#include "simulator/loads/case_loads.h"
#include "simulator/loads/field_history.h"
#include "simulator/loads/history.h"
#include "simulator/model/fault_operator.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Called after each load step in equilibrium.
using StepObserver = std::function<void(const StepResult&, const FaultFields&)>;

/// What callers add to a run: looks at what was tried and accepted, noise, and what they know.
struct CaseProbe {
  /// Relative size of a disturbance of every locked traction at every time, with signs that depend
  /// on nothing but the position of the entry; 0 = none.
  double noise = 0;
  /// Called after each load step in equilibrium, if set, with the number of the step.
  std::function<void(int, const ContactLaws&, const AcceptedStep&)> accepted;
  /// Called after each try at a part of a load step, if set, with the number of the step.
  std::function<void(int, const SubStepTrace&)> tried;
  std::string identity;                 ///< case_identity of the scene; empty = to be found.
  const FieldHistory* field = nullptr;  ///< of a scene with a flow result.
};

/// Who finds the equilibrium of a load step where that is not contact on a condensed operator: the
/// coupled path (coupled_case/), which loading does not know. Remembers the last equilibrium.
class StepSolver {
 public:
  virtual ~StepSolver() = default;
  struct Report {
    ContactReport contact;  ///< load factors of its jumps are of the load step.
    StepCoupled linear;
  };
  /// Advances from the last equilibrium, the unloaded rest at first, to that under `loads`. Unless
  /// in equilibrium, `state` is left as it was. Throws Interrupted when it is told to stop.
  virtual Report advance(const StepLoads& loads, ContactState& state) = 0;
  /// Displacement there of all mesh nodes, 3 x n_nodes, m, and of the operator's observation rows.
  virtual const Eigen::Matrix3Xd& displacement() const = 0;
  virtual Eigen::VectorXd observed() const = 0;
  /// How it solves, with the sizes; sums are 0.
  virtual CaseCoupled description() const = 0;
};

/// Runs one case on its operator: initial state, load steps, contact, metrics. Deterministic: the
/// same scene and operator give the same bits whatever ran before. Never throws for
/// non-convergence, nor where the context stops it: the outcome is then `interrupted`, and the
/// steps are those that were complete.
CaseResult run_case(const Scene& scene, const PreparedOperator& prepared, const RunContext& context,
                    const StepObserver& observer = {}, const CaseProbe& probe = {});
/// The same without creep, whatever the scene says of viscosity.
CaseResult run_case(const Scene& scene, const FaultOperator& op, const RunContext& context,
                    const StepObserver& observer = {});

/// The same by a solver of its own: no creep, no slip events.
/// @param faults  an operator that is not condensed (coupled_case.h): geometry, keys of its loads
/// and observation rows, and nothing of what a load or a jump does.
CaseResult run_case(const Scene& scene, const FaultOperator& faults, StepSolver& solver,
                    const RunContext& context, const StepObserver& observer = {},
                    const CaseProbe& probe = {});

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
