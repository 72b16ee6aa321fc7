#pragma once

#include <Eigen/Core>

#include "simulator/laws/friction_law.h"

namespace faultsim {

/// A closed node and its motion, as the slip equation sees them. Missing shear components are 0.
struct SlipPoint {
  double normal_traction = 0;
  Eigen::Vector2d shear_traction{0, 0};
  Eigen::Vector2d slip_increment{0, 0};  ///< Δg_T, m.
  FrictionState before;                  ///< at the start of the sub-step.
  double stiffness = 0;                  ///< r > 0, Pa/m: any value gives the same solutions.
  double per_second = 0;                 ///< 1/Δt; 0 = static.
};

/// The slip equation and its derivatives.
struct SlipResidual {
  Eigen::Vector2d value;     ///< R, Pa.
  Eigen::Vector2d d_normal;  ///< ∂R/∂t'_N.
  Eigen::Matrix2d d_shear;   ///< ∂R/∂t'_T.
  Eigen::Matrix2d d_slip;    ///< ∂R/∂Δg_T at fixed tractions, Pa/m.
  double excess = 0;         ///< |y| − τ_L: slips iff > 0, Pa.
};

/// The slip branch of (5) in the form of Alart and Curnier (1991), with its consistent tangent:
///
///   R = t'_T − τ_L(t'_N, s) y/|y|,   y = t'_T + r Δg_T.
///
/// R = 0 with |y| > τ_L means |t'_T| = τ_L and Δg_T = (|y| − τ_L)/r · t'_T/|t'_T|. While Δg_T = 0
/// the direction is that of the traction. τ_L is all that NodeLaw::strength gives, rate included.
SlipResidual slip_residual(const NodeLaw& law, const SlipPoint& point);

/// |y| − τ_L alone, for the choice between stick and slip.
double slip_excess(const NodeLaw& law, const SlipPoint& point);

}  // namespace faultsim
