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

}  // namespace

ContactLaws contact_laws(const Scene& scene, const FaultGeometry& geometry) {
  ContactLaws laws;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    CoulombLaw law = scene.faults[f].friction;
    if (law.slip_weakening_distance == 0)  // it does not weaken
      law.slip_weakening_distance = CoulombLaw().slip_weakening_distance;
    laws.insert(laws.end(), geometry.faults[f].n_nodes, law);
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
