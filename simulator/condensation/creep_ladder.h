#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "simulator/condensation/condensation.h"
#include "simulator/elasticity/creep.h"

namespace faultsim {

/// What the bulk remembers of a case: the creeping cells' stress and the displacement so far.
struct BulkState {
  CreepStress stress;
  Eigen::Matrix3Xd displacement;  ///< of all mesh nodes since the start, 3 x n_nodes, m.
};

/// The linear bulk of a family kept factorised: elastic, and where salt creeps once per time step
/// length Δt. Rung 0 is elastic (Δt = 0: step 0, instantaneous loads, slip events); rungs 1, 2,
/// ... have the durations asked for. Over a step of a rung, with the history s of the salt,
///
///   A (t_{n+1} − t_n) = f_g − K_gr K_rr⁻¹ f_r − H_Δt (g_{n+1} − g_n),
///   f = Σ_k Δc_k f_k + Pᵀ ∫ ε(v):(1 − decay) s_n                         (docs/model.md, 14)
///
/// costs one forward substitution for the history, before contact is solved, and one backward
/// substitution for the displacement, after: together one back-solve, and never a factorisation.
class CreepLadder {
 public:
  /// Factorises the elastic bulk and one per duration (s, > 0), which may be none. @pre
  /// shared->viscosity is set.
  CreepLadder(const std::shared_ptr<const BulkProblem>& shared,
              const std::vector<double>& durations, MaxwellScheme scheme,
              const RunContext& context);

  int n_rungs() const { return static_cast<int>(rungs_.size()); }  ///< with the elastic one.
  double duration(int rung) const { return rungs_.at(rung).duration; }
  const FaultOperator& op(int rung) const { return rungs_.at(rung).op; }
  CondensedBulk& bulk(int rung) { return *rungs_.at(rung).bulk; }
  BulkState at_rest() const;

  /// What the history, and forces that are no load of the family, add to a step of the rung.
  struct History {
    Eigen::VectorXd traction;  ///< locked traction, n_dofs, Pa.
    Eigen::VectorXd forward;   ///< half of the back-solve, for advance().
  };
  /// @param added  force of the step itself, n_unknowns, N; empty = none.
  History history(int rung, const BulkState& state, const Eigen::VectorXd& added = {});

  /// Moves the bulk over a step of the rung, given the increments of the load factors and jumps.
  void advance(int rung, History history, const std::vector<double>& load_increments,
               const Eigen::VectorXd& jump_increment, BulkState& state);

  /// Displacement components of the observation points, in the order of
  /// FaultOperator::observed.
  Eigen::VectorXd observed(const BulkState& state) const;

 private:
  struct Rung {
    double duration;
    std::vector<MaxwellStep> step;  ///< per viscous material of the cells.
    std::unique_ptr<CondensedBulk> bulk;
    FaultOperator op;
  };
  std::vector<Rung> rungs_;
  std::unique_ptr<CreepCells> cells_;  ///< refers to the mesh and dofs of rung 0.
  std::vector<int> observed_nodes_;
};

}  // namespace faultsim
