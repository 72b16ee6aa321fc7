#pragma once

namespace faultsim {

enum class WeakeningLaw {
  angle,        ///< φ(s) = φ_s + (φ_d − φ_s) min(s/d_c, 1) (docs/model.md, 6).
  coefficient,  ///< tan φ weakens linearly instead.
};

/// How far a point has slipped, as the weakening counts it.
enum class SlipMeasure {
  current,    ///< |g_T|.
  cumulated,  ///< the length of its path.
};

/// Constants of the friction of one fault point: Coulomb, weakening linearly with slip.
struct CoulombLaw {
  WeakeningLaw weakening = WeakeningLaw::angle;
  double cohesion = 0;                 ///< c ≥ 0, Pa.
  double static_friction_angle = 0;    ///< φ_s in [0, π/2), rad.
  double dynamic_friction_angle = 0;   ///< φ_d in [0, φ_s], rad.
  double slip_weakening_distance = 1;  ///< d_c > 0, m; not used when φ_d = φ_s.
  SlipMeasure slip_measure = SlipMeasure::current;
  bool cohesion_after_opening = false;  ///< cohesion survives opening.
  bool cohesion_after_slip = true;      ///< false: the first slip ends it.
  double damping = 0;                   ///< η = G/2c_s ≥ 0 of motion at a rate, Pa s/m.

  bool operator==(const CoulombLaw&) const = default;
};

}  // namespace faultsim
