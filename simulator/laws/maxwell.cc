#include "simulator/laws/maxwell.h"

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {

MaxwellStep maxwell_step(double shear_modulus, double viscosity, double duration,
                         MaxwellScheme scheme) {
  FAULTSIM_DEMAND(shear_modulus > 0 && viscosity > 0 && duration >= 0, "G ", shear_modulus,
                  " Pa, eta ", viscosity, " Pa s, dt ", duration, " s");
  const double x = duration * shear_modulus / viscosity;
  if (x == 0) return {};
  if (scheme == MaxwellScheme::backward_euler) return {1 / (1 + x), x / (1 + x), 1 / (1 + x)};
  const double relaxed = -std::expm1(-x);
  return {std::exp(-x), relaxed, relaxed / x};
}

}  // namespace faultsim
