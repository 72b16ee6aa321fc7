#include <algorithm>

#include "simulator/mesh/mesh.h"

namespace faultsim {

int observed_node(const Mesh& mesh, const Eigen::Vector3d& point) {
  const auto distance = [&](const Eigen::Vector3d& node) { return (node - point).squaredNorm(); };
  return static_cast<int>(std::ranges::min_element(mesh.nodes, {}, distance) - mesh.nodes.begin());
}

}  // namespace faultsim
