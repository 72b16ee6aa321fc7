#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "simulator/contact/contact.h"
#include "simulator/loads/case_loads.h"
#include "simulator/loads/history.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

class CreepLadder;

/// How a load step was solved.
struct SolvedStep {
  ContactReport contact;              ///< load factors of its jumps are of the load step.
  std::optional<StepCreep> creep;     ///< where something creeps; its faults are left empty.
  std::optional<StepCoupled> linear;  ///< where linear systems of the whole bulk were solved.
  /// The elastic operator relates locked traction and jump, from the start of the step to its end.
  bool is_elastic = true;
  /// t'_creep, n_dofs, Pa: what relaxation has added to the elastic traction; empty: nothing can.
  Eigen::VectorXd creep_traction = {};
};

/// Finds the equilibrium of the load steps of one case, one after the other, and remembers the
/// last. One per case.
class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// Advances from the last equilibrium, the unloaded rest at first (step 0), to that under
  /// `loads`, which are linear in between. Unless in equilibrium, `state` is left as it was and so
  /// is what is remembered. Throws Interrupted when the watch says so.
  virtual SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) = 0;
  /// The equilibrium under `after`, from one of the same case under `before`, both of locked
  /// tractions within a load step; nothing is remembered, and unless in equilibrium `state` is left
  /// as it was. None where the rock remembers more than its loads, or there is no such way.
  virtual std::optional<ContactReport> part_of_step(const Eigen::VectorXd& before,
                                                    const Eigen::VectorXd& after,
                                                    ContactState& state) {
    static_cast<void>(before), static_cast<void>(after), static_cast<void>(state);
    return std::nullopt;
  }
  /// The operator's observation rows in the last equilibrium, m (n_rows).
  virtual Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const = 0;
  /// Displacement of all mesh nodes there, 3 x n_nodes, m. @pre the bulk was kept for it.
  virtual Eigen::Matrix3Xd displacement(const StepLoads& loads, const ContactState& state) = 0;
  /// What of its method a result should say from the start: sizes, names.
  virtual void describe(CaseResult&) const {}
};

/// What a solver is given of the case; all of it outlives the solver.
struct StepSetting {
  const Scene& scene;
  const ContactLaws& laws;
  const CaseLoads& loads;
  ContactWatch watch;
};
using MakeStepSolver = std::function<std::unique_ptr<StepSolver>(const StepSetting&)>;

/// Load steps in elastic rock: contact on the condensed operator, and nothing else.
/// @param bulk  whose factor gives displacements; may be null. Both outlive the solvers.
MakeStepSolver elastic_steps(const FaultOperator& op, CreepLadder* bulk);
/// Load steps while salt creeps, on the rungs of its ladder, which outlives the solvers.
MakeStepSolver creep_steps(CreepLadder& ladder);

}  // namespace faultsim
