#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/result/result.h"

namespace faultsim {

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

/// Adds the work of a part of a step, or of a step of a case.
SolveCounts& operator+=(SolveCounts& sum, const SolveCounts& part);

struct ContactReport {
  Outcome outcome = Outcome::failed;
  std::string reason;  ///< why, with counts per reason and the worst node; empty if converged.
  SolveCounts counts;
  std::vector<ContactJump> jumps;  ///< in order of load.
};

}  // namespace faultsim
