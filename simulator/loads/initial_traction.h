#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The n, strike and dip components of the traction of a stress on a fault, Pa.
inline Eigen::Vector3d local_traction(const Eigen::Matrix3d& stress, const OperatorNode& node) {
  const Eigen::Vector3d total = stress * node.normal;
  return {total.dot(node.normal), total.dot(node.strike), total.dot(node.dip)};
}

/// Initial effective traction on the faults and the initial pressure there.
struct InitialTraction {
  Eigen::VectorXd traction;  ///< t'_0 = σ0 n + α_f p0 n, n_dofs, Pa.
  Eigen::VectorXd pressure;  ///< p0 of the fault: the column's and what blocks of their own
                             ///< overpressure add, n_nodes, Pa.
};

/// Throws InputError when a removed traction component (half domain, plane strain, rollers) is not
/// zero: the reduction would then hide a load.
/// @param region_of_load  LoadFactors::region_of_load().
InitialTraction initial_traction(const Scene& scene, const FaultGeometry& geometry,
                                 const std::vector<int>& region_of_load);

}  // namespace faultsim
