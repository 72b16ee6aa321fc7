#include <cmath>
#include <limits>
#include <set>

#include "simulator/loading/history.h"
#include "simulator/loading/run_case.h"

namespace faultsim {
namespace {

MeshSide mesh_side(Side side) { return static_cast<MeshSide>(static_cast<int>(side)); }

/// Splits the mesh's pressure regions by material, because Biot coefficients belong to materials:
/// afterwards Mesh::region indexes the pressure loads, which are appended in (region, material)
/// order.
void add_pressure_loads(Mesh& mesh, std::vector<LoadCase>& loads) {
  std::set<std::pair<int, int>> present;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.region[c] >= 0) present.insert({mesh.region[c], mesh.material[c]});
  }
  std::vector<std::pair<int, int>> order(present.begin(), present.end());
  for (std::size_t k = 0; k < order.size(); ++k) {
    LoadCase load;
    load.name = load_name({order[k].first, order[k].second});
    load.region = static_cast<int>(k);
    loads.push_back(load);
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.region[c] < 0) continue;
    const auto found = present.find({mesh.region[c], mesh.material[c]});
    mesh.region[c] = static_cast<int>(std::distance(present.begin(), found));
  }
}

DisplacementCondition held(MeshSide side, std::array<bool, 3> components) {
  return {side, components, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1};
}

std::array<bool, 3> normal_only(MeshSide side) {
  std::array<bool, 3> components = {false, false, false};
  components[static_cast<std::size_t>(side) / 2] = true;
  return components;
}

/// Rollers on sides and base, free top; plane strain and half domain need nothing more, because
/// y_min and y_max are rollers anyway.
void add_field_conditions(BulkProblem& problem) {
  for (const MeshSide side :
       {MeshSide::x_min, MeshSide::x_max, MeshSide::y_min, MeshSide::y_max, MeshSide::z_min}) {
    problem.conditions.push_back(held(side, normal_only(side)));
  }
}

void add_box_conditions(const Scene& scene, BulkProblem& problem) {
  for (std::size_t i = 0; i < scene.box.boundary.size(); ++i) {
    const BoundaryCondition& condition = scene.box.boundary[i];
    const Eigen::Matrix3d stress =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(condition.stress.data());
    const Eigen::Matrix3d gradient =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(condition.gradient.data());
    const Eigen::Vector3d translation(condition.translation.data());
    LoadCase load;
    load.name = boundary_load_name(static_cast<int>(i));
    switch (condition.kind) {
      case BoundaryKind::free:
      case BoundaryKind::tied:
        break;  // ties are in the mesh
      case BoundaryKind::roller:
      case BoundaryKind::fixed:
        for (const Side side : condition.sides) {
          const MeshSide s = mesh_side(side);
          problem.conditions.push_back(held(s, condition.kind == BoundaryKind::fixed
                                                   ? std::array<bool, 3>{true, true, true}
                                                   : normal_only(s)));
        }
        break;
      case BoundaryKind::displacement:
        for (const Side side : condition.sides) {
          problem.conditions.push_back({mesh_side(side), condition.components, translation,
                                        gradient, static_cast<int>(problem.loads.size())});
        }
        load.displacement = true;
        problem.loads.push_back(load);
        break;
      case BoundaryKind::stress:
        for (const Side side : condition.sides) load.stress_sides.push_back(mesh_side(side));
        load.stress = stress;
        problem.loads.push_back(load);
        break;
    }
  }
}

}  // namespace

BulkProblem bulk_problem(const Scene& scene, const Plan& plan) {
  BulkProblem problem;
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  problem.mesh =
      is_field ? make_mesh(field_mesh_spec(scene, plan)) : make_mesh(box_mesh_spec(scene, plan));
  for (const Material& m : scene.materials) {
    problem.materials.push_back({m.youngs_modulus, m.poisson_ratio});
    const bool creeps = plan.creep.active && m.viscosity;
    problem.viscosity.push_back(creeps ? *m.viscosity : std::numeric_limits<double>::infinity());
  }
  add_pressure_loads(problem.mesh, problem.loads);
  if (is_field) {
    add_field_conditions(problem);
  } else {
    add_box_conditions(scene, problem);
  }
  for (const ObservationPoint& point : scene.output.observation_points) {
    // By symmetry; prepare_operator turns u_y round again.
    const double y = plan.half_domain ? std::abs(point.position[1]) : point.position[1];
    problem.observation_points.emplace_back(
        point.name, Eigen::Vector3d(point.position[0], y, point.position[2]));
  }
  problem.b_bar = scene.numerics.b_bar;
  problem.half_domain = plan.half_domain;
  return problem;
}

}  // namespace faultsim
