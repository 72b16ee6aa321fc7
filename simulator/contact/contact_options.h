#pragma once

namespace faultsim {

/// Tolerances and bounds of a load step.
struct ContactOptions {
  double traction_tolerance = 1e-8;  ///< relative to the local traction level; too tight: cycling.
  int max_newton_iterations = 30;    ///< per active-set pass.
  int max_active_set_passes = 100;
  int max_step_cuts = 6;            ///< halvings of a load step before giving up.
  double onset_tolerance = 2.5e-4;  ///< of a load step, to which an instability is located.
  int max_jumps = 256;              ///< per load step.
  /// Newton iterations per load step after which no jump is followed further: a bound on the work.
  int max_iterations = 10'000'000;
};

}  // namespace faultsim
