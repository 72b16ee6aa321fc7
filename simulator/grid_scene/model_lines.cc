#include "simulator/grid_scene/model_lines.h"

#include <algorithm>

namespace faultsim::grid_scene {

using Eigen::Vector2d;

Polyline ModelFault::at(double z, double reference_z) const {
  const double down = reference_z - std::clamp(z, bottom, top);
  std::vector<Vector2d> across;  // of pieces, to the right
  for (std::size_t k = 0; k + 1 < trace.size(); ++k) {
    const Vector2d along = (trace[k + 1] - trace[k]).normalized();
    across.emplace_back(along.y(), -along.x());
  }
  Polyline line;
  for (std::size_t k = 0; k < trace.size(); ++k) {
    const Vector2d &before = across[k == 0 ? 0 : k - 1],
                   &after = across[std::min(k, across.size() - 1)];
    const Vector2d mean = (before + after).normalized();
    line.emplace_back(trace[k] + lean_at(k) * down / mean.dot(after) * mean);
  }
  return line;
}

}  // namespace faultsim::grid_scene
