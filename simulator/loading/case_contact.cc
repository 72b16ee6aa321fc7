#include "simulator/loading/case_contact.h"

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// η = G/2c_s = ½ √(ρ G), Pa s/m (Rice 1993). Density enters as a root and only scales the duration
/// of events, so one value stands for all rocks.
double radiation_damping(const OperatorNode& node) {
  constexpr double kDensity = 2500;  // kg/m3
  return 0.5 * std::sqrt(kDensity * node.effective_shear_modulus);
}

CoulombLaw law_of(const Friction& friction) {
  CoulombLaw law = {.weakening = friction.law,
                    .cohesion = friction.cohesion,
                    .static_friction_angle = friction.static_friction_angle,
                    .dynamic_friction_angle = friction.dynamic_friction_angle,
                    .cumulated = friction.slip_measure == SlipMeasure::cumulated,
                    .cohesion_after_opening = friction.cohesion_after_opening,
                    .cohesion_after_slip = friction.cohesion_after_slip};
  if (friction.slip_weakening_distance > 0)
    law.slip_weakening_distance = friction.slip_weakening_distance;
  return law;
}

}  // namespace

ContactLaws contact_laws(const Scene& scene, const FaultGeometry& geometry) {
  ContactLaws laws;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    laws.insert(laws.end(), geometry.faults[f].n_nodes, law_of(scene.faults[f].friction));
  }
  if (!scene.numerics.follow_events) return laws;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    laws[k].damping = radiation_damping(geometry.nodes[k]);
  }
  return laws;
}

ContactOptions contact_options(const Numerics& numerics) {
  return {numerics.traction_tolerance,    numerics.max_newton_iterations,
          numerics.max_active_set_passes, numerics.max_step_cuts,
          numerics.onset_tolerance,       numerics.max_events};
}

}  // namespace faultsim
