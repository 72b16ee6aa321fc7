#include "simulator/loads/initial_traction.h"

#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/loads/history.h"

namespace faultsim {

InitialTraction initial_traction(const Scene& scene, const FaultGeometry& geometry,
                                 const std::vector<int>& region_of_load) {
  const auto n_nodes = static_cast<Eigen::Index>(geometry.nodes.size());
  InitialTraction initial{Eigen::VectorXd::Zero(geometry.n_dofs), Eigen::VectorXd::Zero(n_nodes)};
  const Eigen::VectorXd excess = initial_pressure_excess(scene, geometry, region_of_load);
  const InitialColumn column(scene);
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const OperatorFault& fault = geometry.faults[f];
    const double fault_biot = scene.faults[f].fault_biot;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      StressAtDepth at = column.at(node.position.z());
      at.pressure += excess[k];
      const Eigen::Matrix3d sigma =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at.sigma.data());
      const Eigen::Vector3d total = sigma * node.normal;
      const std::array<double, 3> local = {total.dot(node.normal) + fault_biot * at.pressure,
                                           total.dot(node.strike), total.dot(node.dip)};
      for (std::size_t c = 0; c < 3; ++c) {
        if (node.dof[c] >= 0) {
          initial.traction[node.dof[c]] = local[c];
        } else if (std::abs(local[c]) > 1e-9 * (total.norm() + 1.0)) {
          throw InputError(
              "scene",
              {{"/initial_state", 0,
                concat("the initial traction on fault ", scene.faults[f].name, " has a component (",
                       local[c] / 1e6, " MPa) that symmetry or plane strain removes"),
                "align the initial stress with the axes or switch the reduction off "
                "(/numerics/half_domain, /numerics/plane_strain)"}});
        }
      }
      initial.pressure[k] = at.pressure;
    }
  }
  return initial;
}

}  // namespace faultsim
