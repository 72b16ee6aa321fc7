#include "simulator/loads/fault_pressure_table.h"

#include <cmath>

namespace faultsim {
TablePlace place_in_table(const Scene& scene, std::size_t fault, const OperatorNode& node) {
  const bool by_depth =
      scene.faults[fault].pressure.profile.place == FaultPressureTable::Place::depth;
  TablePlace place{-node.position.z(), node.position.y()};
  if (scene.geometry_kind == GeometryKind::field) return place;
  const PatchGeometry& patch = scene.box.patches[fault];
  const double s = std::sin(patch.strike), c = std::cos(patch.strike);
  const double dip = patch.dip_from_vertical;
  const Eigen::Vector3d down(c * std::sin(dip), -s * std::sin(dip), -std::cos(dip));
  const Eigen::Vector3d from =
      node.position - Eigen::Vector3d(patch.center[0], patch.center[1], patch.center[2]);
  place.strike = from.dot(Eigen::Vector3d(s, c, 0));
  if (!by_depth) place.dip = from.dot(down);
  return place;
}

}  // namespace faultsim
