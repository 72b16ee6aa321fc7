#include "simulator/plan/boundary_conditions.h"

namespace faultsim {
namespace {

MeshSide mesh_side(Side side) { return static_cast<MeshSide>(static_cast<int>(side)); }

DisplacementCondition held(MeshSide side, std::array<bool, 3> components) {
  return {side, components, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1};
}

std::array<bool, 3> normal_only(MeshSide side) {
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
    for (const MeshSide side :
         {MeshSide::x_min, MeshSide::x_max, MeshSide::y_min, MeshSide::y_max, MeshSide::z_min}) {
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
      const MeshSide s = mesh_side(side);
      if (condition.kind == BoundaryKind::roller) conditions.push_back(held(s, normal_only(s)));
      if (condition.kind == BoundaryKind::fixed) conditions.push_back(held(s, {true, true, true}));
      if (condition.kind == BoundaryKind::displacement) {
        conditions.push_back({s, condition.components, translation, gradient, load});
      }
    }
    if (is_load(condition.kind)) ++load;
  }
  return conditions;
}

}  // namespace faultsim
