#include <limits>

#include "simulator/mesh/mesh.h"

namespace faultsim {

int observed_node(const Mesh& mesh, const Eigen::Vector3d& point) {
  int best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double distance = (mesh.nodes[i] - point).squaredNorm();
    if (distance < best_distance) {
      best = static_cast<int>(i);
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace faultsim
