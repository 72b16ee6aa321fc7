#include "simulator/plan/boundary_conditions.h"

namespace faultsim {
namespace {

DisplacementCondition held(Side side, std::array<bool, 3> components) {
  return {side, components, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1};
}

std::array<bool, 3> normal_only(Side side) {
  std::array<bool, 3> components = {false, false, false};
  components[static_cast<std::size_t>(side) / 2] = true;
  return components;
}

}  // namespace

bool is_load(BoundaryKind kind) {
  return kind == BoundaryKind::displacement || kind == BoundaryKind::stress;
}

std::vector<DisplacementCondition> displacement_conditions(const Scene& scene, int first_load) {
  std::vector<DisplacementCondition> conditions;
  if (scene.geometry_kind == GeometryKind::field) {
    // Plane strain and the half domain need nothing more: y_min and y_max are rollers anyway.
    for (const Side side : {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min}) {
      conditions.push_back(held(side, normal_only(side)));
    }
    return conditions;
  }
  int load = first_load;
  for (const BoundaryCondition& condition : scene.box.boundary) {
    const Eigen::Matrix3d gradient =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(condition.gradient.data());
    const Eigen::Vector3d translation(condition.translation.data());
    for (const Side side : condition.sides) {
      if (condition.kind == BoundaryKind::roller)
        conditions.push_back(held(side, normal_only(side)));
      if (condition.kind == BoundaryKind::fixed)
        conditions.push_back(held(side, {true, true, true}));
      if (condition.kind == BoundaryKind::displacement) {
        conditions.push_back({side, condition.components, translation, gradient, load});
      }
    }
    if (is_load(condition.kind)) ++load;
  }
  return conditions;
}

}  // namespace faultsim
