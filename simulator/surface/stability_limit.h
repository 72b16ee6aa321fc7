#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"

namespace faultsim {

/// The weakening with slip at which each fault becomes unstable where all of it slips, everything
/// else held: the least of
///
///   xᵀ H x / xᵀ A x,   Pa/m,
///
/// over slips x of the fault with closed normal jumps (docs/model.md, 2: with − dτ_L/ds above it
/// the tangent is not positive definite). Nucleation lengths go with its inverse. By inverse
/// iteration to 1e-10 of itself; NaN where H is not positive definite there, or nothing can slip.
/// @param h  H of any operator with these faults, n_dofs x n_dofs.
std::vector<double> stability_limits(const FaultGeometry& faults,
                                     const Eigen::Ref<const Eigen::MatrixXd>& h);

}  // namespace faultsim
