#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulator/condensation/creep_ladder.h"
#include "simulator/contact/contact.h"
#include "simulator/loads/case_loads.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// How a load step with creeping salt went.
struct CreepReport {
  ContactReport contact;      ///< load factors of its jumps are of the load step.
  int time_steps = 0;         ///< accepted.
  double time_error = 0;      ///< Pa, largest change of fault traction when a step was halved.
  bool time_resolved = true;  ///< that change is within the tolerance wherever it was measured.
};

/// Walks a case whose salt creeps, load step by load step, on the rungs of its ladder.
///
/// Over a time step Δt the faults carry, if they stay as they are,
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
class CreepMarch {
 public:
  /// @pre all arguments outlive this; laws and the operators of the ladder agree.
  CreepMarch(const Scene& scene, const CaseLoads& loads, CreepLadder& ladder,
             const ContactLaws& laws, const ContactWatch& watch = {});
  ~CreepMarch();

  /// Step 0: the faults have moved from closed to `state` under the loads at t = 0, elastically.
  void begin(const StepLoads& loads, const ContactState& state);
  /// Advances from the end of the last step to time `to`, s. Unless in equilibrium, state and salt
  /// are left as they were. Throws Interrupted when the watch says so.
  CreepReport advance(double to, ContactState& state);

  /// Displacement so far: observation points (ladder order) and all mesh nodes.
  Eigen::VectorXd observed() const;
  const Eigen::Matrix3Xd& displacement() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A⁻¹ H g over the columns with g ≠ 0, n_dofs, Pa.
Eigen::VectorXd elastic_traction_drop(const FaultOperator& op, const Eigen::VectorXd& jump);

}  // namespace faultsim
