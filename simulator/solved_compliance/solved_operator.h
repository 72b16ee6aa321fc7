#pragma once

#include "simulator/model/fault_operator.h"
#include "simulator/solved_compliance/stuck_bulk.h"

namespace faultsim {

/// The operator of a bulk without its H: geometry of the faults, locked loads L (one solve each),
/// observation rows U and V (one solve per component), all as CondensedBulk::condense() has them,
/// to the accuracy of StuckBulk; names of faults and fingerprint left empty. Its compliance is the
/// one given.
/// @param half_domain is the problem's.
FaultOperator solved_operator(const StuckBulk& bulk, std::shared_ptr<const Compliance> compliance,
                              const RunContext& context = {});

/// Displacement of all mesh nodes for given load factors and jumps by one solve: 3 x n_nodes, m.
Eigen::Matrix3Xd solved_displacement(const StuckBulk& bulk, const std::vector<double>& load_factors,
                                     const Eigen::VectorXd& jump);

}  // namespace faultsim
