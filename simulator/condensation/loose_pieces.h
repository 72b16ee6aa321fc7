#pragma once

#include <Eigen/Core>

#include "simulator/condensation/condensation.h"

namespace faultsim {

/// What must be added to the diagonal of K_gg so that pieces of rock that nothing but faults holds
/// do not make K singular: D = A G_eff / h on the jumps of their faults, N/m (n_jump, zero
/// elsewhere). It is taken off H again, so it has no effect but rounding.
///
/// Throws InputError when pieces that faults hold together can move as one: nothing holds them.
Eigen::VectorXd loose_piece_springs(const BulkProblem& problem, const DofMap& dofs,
                                    const FaultGeometry& geometry);

/// The error for a matrix that is singular all the same, at a bulk or jump unknown.
[[noreturn]] void throw_not_held(const BulkProblem& problem, const DofMap& dofs, int unknown);

}  // namespace faultsim
