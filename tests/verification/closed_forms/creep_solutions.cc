#include "tests/verification/closed_forms/creep_solutions.h"

#include <cmath>

namespace faultsim {
namespace {

Eigen::Matrix3d deviator(const Eigen::Matrix3d& strain) {
  return strain - strain.trace() / 3 * Eigen::Matrix3d::Identity();
}

}  // namespace

double MaxwellSolid::shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }

double MaxwellSolid::bulk_modulus() const { return youngs_modulus / (3 * (1 - 2 * poisson_ratio)); }

double MaxwellSolid::relaxation_time() const { return viscosity / shear_modulus(); }

Eigen::Matrix3d maxwell_stress(const MaxwellSolid& solid, const Eigen::Matrix3d& held,
                               const Eigen::Matrix3d& rate, double time) {
  const double x = time / solid.relaxation_time();
  const double volume = (held + rate * time).trace();
  return solid.bulk_modulus() * volume * Eigen::Matrix3d::Identity() +
         2 * solid.shear_modulus() * std::exp(-x) * deviator(held) -
         2 * solid.viscosity * std::expm1(-x) * deviator(rate);
}

ConfinedColumn confined_column(const MaxwellSolid& solid, double load, double time) {
  const double nu = solid.poisson_ratio, E = solid.youngs_modulus;
  const double decay = std::exp(-E / (6 * solid.viscosity * (1 - nu)) * time);
  const double ratio = (1 - 2 * nu) / (1 - nu);
  return {load * (1 - ratio * decay), load * (1 - 2 * nu) / E * (3 - 2 * ratio * decay)};
}

}  // namespace faultsim
