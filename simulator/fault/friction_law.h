#pragma once

namespace faultsim {

enum class WeakeningLaw { angle, coefficient };

/// Constants of Coulomb friction that weakens linearly with slip, at one fault point.
struct CoulombLaw {
  WeakeningLaw weakening = WeakeningLaw::angle;
  double cohesion = 0;                 ///< c ≥ 0, Pa.
  double static_friction_angle = 0;    ///< φ_s in [0, π/2), rad.
  double dynamic_friction_angle = 0;   ///< φ_d in [0, φ_s], rad.
  double slip_weakening_distance = 1;  ///< d_c > 0, m; not used when φ_d = φ_s.
};

/// A limit shear traction and its two partial derivatives.
struct LimitShearTraction {
  double value;              ///< τ_L ≥ 0, Pa.
  double d_normal_traction;  ///< ∂τ_L/∂t'_N = −tan φ ≤ 0, dimensionless.
  double d_slip;  ///< ∂τ_L/∂s ≤ 0, Pa/m; the right-hand derivative at s = d_c (0).
};

/// The largest shear traction that a closed fault point carries (docs/model.md, 4 and 6):
///
///   τ_L(t'_N, s) = c − t'_N tan φ(s),   φ(s) = φ_s + (φ_d − φ_s) min(s/d_c, 1)
///
/// or, for WeakeningLaw::coefficient, tan φ(s) = tan φ_s + (tan φ_d − tan φ_s) min(s/d_c, 1).
///
/// @param normal_traction  t'_N ≤ 0, Pa, effective, tension positive.
/// @param slip             s ≥ 0, m, by the slip measure in force.
/// @pre both signs; otherwise InternalError: whether the point is closed is for the active set.
LimitShearTraction limit_shear_traction(const CoulombLaw& law, double normal_traction, double slip);

/// χ = |t'_T| / max(τ_L, 1 kPa); the floor only here, never in (5).
double critical_index(double shear_traction_norm, double limit_shear_traction);

/// Nucleation length of Uenishi and Rice: h_n = 1.157773883699 G*/W, W = −∂τ_L/∂s at onset, m;
/// infinity without weakening. @param modulus  G* = G/(1−ν) down dip (mode II), G along strike
/// (III).
double nucleation_length(double modulus, double weakening_rate);

}  // namespace faultsim
