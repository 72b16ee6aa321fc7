#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// A dof vector as components (n, strike, dip) of nodes; removed components are 0.
Eigen::Matrix3Xd per_node(const FaultGeometry& geometry, const Eigen::VectorXd& values);
/// Of each fault. @param traction  t'_creep, n_dofs, Pa.
std::vector<FaultCreep> creep_of_faults(const FaultGeometry& geometry,
                                        const Eigen::VectorXd& traction);

}  // namespace faultsim
