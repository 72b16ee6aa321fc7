#pragma once

#include <Eigen/Core>

/// Closed forms of a Maxwell body, elastic in volume, that `faultsim verify` compares with. They
/// share no code with the simulator. SI, tension positive, changes since the start.
namespace faultsim {

/// s = 2G (e − ε_v), ε̇_v = s/(2η).
struct MaxwellSolid {
  double youngs_modulus;  ///< Pa
  double poisson_ratio;
  double viscosity;  ///< η, Pa s

  double shear_modulus() const;    ///< G, Pa
  double bulk_modulus() const;     ///< K, Pa
  double relaxation_time() const;  ///< τ = η/G, s
};

/// Stress of uniform strain `held` since t = 0 and further strain at a constant `rate`, Pa:
/// σ = K tr(ε) I + 2G dev(held) e^{−t/τ} + 2η dev(rate) (1 − e^{−t/τ}), ε = held + rate t.
/// @param held  symmetric; @param rate  symmetric, 1/s; @param time  s, ≥ 0.
Eigen::Matrix3d maxwell_stress(const MaxwellSolid& solid, const Eigen::Matrix3d& held,
                               const Eigen::Matrix3d& rate, double time);

/// A laterally confined column under a constant vertical stress since t = 0, with
/// k = E/(6η(1−ν)).
struct ConfinedColumn {
  double lateral_stress;   ///< σ_x = T0 [1 − (1−2ν)/(1−ν) e^{−kt}], Pa
  double vertical_strain;  ///< ε_z = T0 (1−2ν)/E [3 − 2(1−2ν)/(1−ν) e^{−kt}]
};
/// @param load  T0 = σ_z, Pa; @param time  s, ≥ 0.
ConfinedColumn confined_column(const MaxwellSolid& solid, double load, double time);

}  // namespace faultsim
