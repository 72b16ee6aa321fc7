#include "simulator/loading/node_fields.h"

#include <algorithm>

namespace faultsim {

Eigen::Matrix3Xd per_node(const FaultGeometry& geometry, const Eigen::VectorXd& values) {
  Eigen::Matrix3Xd result =
      Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(geometry.nodes.size()));
  for (Eigen::Index k = 0; k < result.cols(); ++k) {
    const auto& dof = geometry.nodes[k].dof;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const int d = dof[c];
      if (d >= 0) result(c, k) = values[d];
    }
  }
  return result;
}

std::vector<FaultCreep> creep_of_faults(const FaultGeometry& geometry,
                                        const Eigen::VectorXd& traction) {
  const Eigen::Matrix3Xd nodes = per_node(geometry, traction);
  std::vector<FaultCreep> faults;
  for (const OperatorFault& fault : geometry.faults) {
    FaultCreep sum;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      sum.normal_min = std::min(sum.normal_min, nodes(0, k));
      sum.normal_max = std::max(sum.normal_max, nodes(0, k));
      sum.shear_max = std::max(sum.shear_max, nodes.col(k).tail<2>().norm());
    }
    faults.push_back(sum);
  }
  return faults;
}

}  // namespace faultsim
