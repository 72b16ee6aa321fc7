#include "simulator/plan/boundary_conditions.h"

#include "simulator/scene/mesh_body.h"

namespace faultsim {
namespace {

DisplacementCondition held(BoundaryGroup group, std::array<bool, 3> components) {
  return {group, components, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1};
}

std::array<bool, 3> one_component(std::size_t axis) {
  std::array<bool, 3> components = {false, false, false};
  components[axis] = true;
  return components;
}

std::array<bool, 3> normal_only(Side side) {
  return one_component(static_cast<std::size_t>(side) / 2);
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
    for (const std::string& name : condition.surfaces) {
      const NamedMesh& mesh = *scene.box.mesh->content;
      const BoundaryGroup group(surface_number(mesh, name));
      if (condition.kind == BoundaryKind::roller)
        conditions.push_back(held(group, one_component(*axis_across(mesh, group.index))));
      if (condition.kind == BoundaryKind::fixed)
        conditions.push_back(held(group, {true, true, true}));
      if (condition.kind == BoundaryKind::displacement)
        conditions.push_back({group, condition.components, translation, gradient, load});
    }
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
