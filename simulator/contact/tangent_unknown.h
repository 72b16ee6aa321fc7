#pragma once

#include <array>

namespace faultsim {

/// A component of the motion that is solved for, and its equation: the row of the tangent
///
///   T_uv = Σ_c weight_c H(dof c of the node, dof of v) + own of v's component if v is of the node.
///
/// Unknowns of a node follow each other.
struct TangentUnknown {
  int node, component, dof;
  std::array<double, 3> weight;  ///< −∂R/∂t' A⁻¹ per dof of the node, 1/m2.
  std::array<double, 2> own;     ///< ∂R/∂Δg_T of the node's own slip, Pa/m.
};

}  // namespace faultsim
