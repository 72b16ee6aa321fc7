#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/stress/random_scene.h"

namespace faultsim {

/// How load steps ended and what was met on the way, over many scenes.
struct StressTally {
  int n_scenes = 0, n_steps = 0;
  std::array<int, 4> scenes_ended{};  ///< converged, event, unstable, unconverged: the last step.
  int n_unsolved_followed = 0;        ///< ended unstable or unconverged although damping was on.
  int n_edge_of_opening = 0;  ///< ended unconverged without it, where cohesion outlives opening.
  int n_open = 0, n_slip = 0, n_stick = 0, n_closed_again = 0;
  int n_cut = 0, n_jumps = 0, n_lost_cohesion = 0;
  int most_iterations = 0;  ///< of a load step, wasted ones included.
  long iterations = 0;
};

struct SceneReport {
  std::vector<std::string> violations;  ///< of what must hold; empty if all is well.
  std::string unsolved;                 ///< reason of an unstable or unconverged end.
  Outcome outcome = Outcome::failed;    ///< of the last step.
  bool excused = false;                 ///< unsolved in a way that is not a fault: see check_scene.
};

/// Runs a scene load step by load step, twice, and checks after each step, from definitions and not
/// from the solver's residual: (3)–(5), finite numbers, friction that never gives energy, the
/// evidence of jumps, a bound on the work, states left alone by steps that failed, and equal bits
/// of both runs (one scene in four).
///
/// An unsolved end is excused only where jumps are not followed: `unstable` where strength falls,
/// and `unconverged` where cohesion outlives opening, for then a static step may have no solution
/// (see NastyContact in contact_test).
SceneReport check_scene(const RandomScene& scene, StressTally& tally);

}  // namespace faultsim
