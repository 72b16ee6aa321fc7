#include "simulator/fault/friction_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"

namespace faultsim {

LimitShearTraction limit_shear_traction(const CoulombLaw& law, double normal_traction,
                                        double slip) {
  FAULTSIM_DEMAND(normal_traction <= 0 && slip >= 0, "normal traction ", normal_traction, " slip ",
                  slip);
  const double angle_s = law.static_friction_angle;
  const double angle_d = law.dynamic_friction_angle;
  // Without weakening d_c means nothing and may be anything, zero included.
  if (angle_d == angle_s) {
    const double friction = std::tan(angle_s);
    return {law.cohesion - normal_traction * friction, -friction, 0};
  }
  const double d_c = law.slip_weakening_distance;
  if (slip >= d_c) {
    const double friction = std::tan(angle_d);
    return {law.cohesion - normal_traction * friction, -friction, 0};
  }
  double friction = 0;
  double d_friction = 0;
  switch (law.weakening) {
    case WeakeningLaw::angle: {
      friction = std::tan(angle_s + (angle_d - angle_s) * (slip / d_c));
      d_friction = (1 + friction * friction) * (angle_d - angle_s) / d_c;
      break;
    }
    case WeakeningLaw::coefficient: {
      const double drop = std::tan(angle_d) - std::tan(angle_s);
      friction = std::tan(angle_s) + drop * (slip / d_c);
      d_friction = drop / d_c;
      break;
    }
  }
  return {law.cohesion - normal_traction * friction, -friction, -normal_traction * d_friction};
}

double critical_index(double shear_traction_norm, double limit_shear_traction) {
  constexpr double kFloor = 1e3;  // Pa; keeps χ finite where a fault carries next to nothing
  return shear_traction_norm / std::max(limit_shear_traction, kFloor);
}

double nucleation_length(double modulus, double weakening_rate) {
  constexpr double kUenishiRice = 1.157773883699;  // Uenishi and Rice (2003), 0.579 x 2
  if (!(weakening_rate > 0)) return std::numeric_limits<double>::infinity();
  return kUenishiRice * modulus / weakening_rate;
}

}  // namespace faultsim
