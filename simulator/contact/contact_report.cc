#include "simulator/contact/contact_report.h"

#include <algorithm>

namespace faultsim {

void ContactJump::append(const ContactJump& next) {
  load_after = next.load_after;
  jump_after = next.jump_after;
  traction_after = next.traction_after;
  n_lost_cohesion += next.n_lost_cohesion;
  negative_pivots = std::max(negative_pivots, next.negative_pivots);
  residual_after = next.residual_after;
  released += next.released;
  dissipated += next.dissipated;
  duration += next.duration;
  damped_steps += next.damped_steps;
}

SolveCounts& operator+=(SolveCounts& sum, const SolveCounts& part) {
  sum.newton_iterations += part.newton_iterations;
  sum.active_set_passes += part.active_set_passes;
  sum.sub_steps += part.sub_steps;
  sum.wasted_newton_iterations += part.wasted_newton_iterations;
  return sum;
}

}  // namespace faultsim
