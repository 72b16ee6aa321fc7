#pragma once

#include <memory>

#include "simulator/condensation/creep_ladder.h"
#include "simulator/loading/step_solver.h"

namespace faultsim {

/// Walks a case whose salt creeps, load step by load step, on the rungs of its ladder.
///
/// Step 0 is elastic. Over a time step Δt the faults carry, if they stay as they are,
///
///   t'_n + (history of the salt) + Σ Δc_k L_k(Δt) + α_f δp_f n,
///
/// from which contact is solved with H_Δt. Time steps are fixed (`creep_time_step`) or controlled:
/// a step is taken once whole and once in halves; where the tractions differ by more than
/// `creep_tolerance` the halves are halved, as far as the ladder goes; the finer answer is kept.
///
/// Slip that the relaxing bulk cannot hold (outcome unstable on a rung) makes the step shorter. On
/// the shortest the load is applied at once, elastically, where a jump is followed as in an elastic
/// case, and the salt then creeps under constant load. A jump that is followed in that creep, with
/// the relaxed stiffness, is marked: the ladder is too coarse for it.
class CreepMarch final : public StepSolver {
 public:
  /// @pre all arguments outlive this; laws and the operators of the ladder agree.
  CreepMarch(CreepLadder& ladder, const StepSetting& setting);
  ~CreepMarch() override;

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override;
  Eigen::Matrix3Xd displacement(const StepLoads& loads, const ContactState& state) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
