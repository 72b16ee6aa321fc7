#pragma once

#include <Eigen/Core>

#include "simulator/laws/friction_law.h"

namespace faultsim {

/// A slipping node and its motion in the load step.
struct SlippingPoint {
  double normal_traction = 0;                ///< t'_N, Pa.
  Eigen::Vector2d slip_increment{0, 0};      ///< Δg_T (strike, dip), m.
  FrictionState before;                      ///< at the start of the step.
  Eigen::Vector2d traction_direction{0, 0};  ///< of t'_T: the direction while Δg_T = 0.
};

/// The shear traction of a slipping node as a function of its slip and normal traction,
///
///   t*_T = τ_L(t'_N, s) m,   m = Δg_T/|Δg_T|,
///
/// and its derivatives (model section 11).
struct SlipTangent {
  Eigen::Vector2d traction{0, 0};                    ///< t*_T, Pa.
  Eigen::Matrix2d d_slip = Eigen::Matrix2d::Zero();  ///< ∂t*_T/∂Δg_T, Pa/m.
  Eigen::Vector2d d_normal{0, 0};                    ///< ∂t*_T/∂t'_N, –.
};

/// A node just set to slip (Δg_T = 0) takes the direction of its traction, and none of the part of
/// the derivative that turns it: that part grows without bound as Δg_T → 0.
SlipTangent slip_tangent(const NodeLaw& law, const SlippingPoint& point);

}  // namespace faultsim
