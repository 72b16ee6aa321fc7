#include "simulator/loading/case_contact.h"

#include <cmath>

namespace faultsim {
namespace {

/// η = G/2c_s = ½ √(ρ G) per node, Pa s/m (Rice 1993). Density enters as a root and only scales the
/// duration of events, so one value stands for all rocks.
Eigen::VectorXd radiation_damping(const FaultGeometry& geometry) {
  constexpr double kDensity = 2500;  // kg/m3
  Eigen::VectorXd damping(static_cast<Eigen::Index>(geometry.nodes.size()));
  for (Eigen::Index k = 0; k < damping.size(); ++k) {
    const OperatorNode& node = geometry.nodes[static_cast<std::size_t>(k)];
    damping[k] = 0.5 * std::sqrt(kDensity * node.effective_shear_modulus);
  }
  return damping;
}

}  // namespace

ContactLaws contact_laws(const Scene& scene, const FaultGeometry& geometry) {
  ContactLaws laws;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const Friction& friction = scene.faults[f].friction;
    CoulombLaw law;
    law.weakening =
        friction.law == FrictionLaw::angle ? WeakeningLaw::angle : WeakeningLaw::coefficient;
    law.cohesion = friction.cohesion;
    law.static_friction_angle = friction.static_friction_angle;
    law.dynamic_friction_angle = friction.dynamic_friction_angle;
    if (friction.slip_weakening_distance > 0)
      law.slip_weakening_distance = friction.slip_weakening_distance;
    const auto n = static_cast<std::size_t>(geometry.faults[f].n_nodes);
    laws.node.insert(laws.node.end(), n, law);
    laws.cumulated.insert(laws.cumulated.end(), n, friction.slip_measure == SlipMeasure::cumulated);
    laws.keep_cohesion.insert(laws.keep_cohesion.end(), n, friction.cohesion_after_opening);
    laws.lose_cohesion_slipping.insert(laws.lose_cohesion_slipping.end(), n,
                                       !friction.cohesion_after_slip);
  }
  if (scene.numerics.follow_events) laws.damping = radiation_damping(geometry);
  return laws;
}

ContactOptions contact_options(const Numerics& numerics) {
  return {numerics.traction_tolerance,    numerics.max_newton_iterations,
          numerics.max_active_set_passes, numerics.max_step_cuts,
          numerics.onset_tolerance,       numerics.max_events};
}

}  // namespace faultsim
