#include <cmath>
#include <limits>
#include <set>

#include "simulator/operators/prepare_operator.h"
#include "simulator/plan/boundary_conditions.h"
#include "simulator/scene/mesh_body.h"

namespace faultsim {
namespace {

/// Splits the mesh's pressure regions by material, because Biot coefficients belong to materials:
/// afterwards Mesh::region indexes the pressure loads, which are appended in (region, material)
/// order.
void add_pressure_loads(Mesh& mesh, std::vector<LoadCase>& loads) {
  std::set<std::pair<int, int>> present;
  for (std::size_t c = 0; c < mesh.region.size(); ++c) {
    if (mesh.region[c] >= 0) present.insert({mesh.region[c], mesh.material[c]});
  }
  std::vector<std::pair<int, int>> order(present.begin(), present.end());
  for (std::size_t k = 0; k < order.size(); ++k) {
    LoadCase load;
    load.key = {LoadKey::Kind::pressure, order[k].first, order[k].second};
    load.region = static_cast<int>(k);
    loads.push_back(load);
  }
  for (std::size_t c = 0; c < mesh.region.size(); ++c) {
    if (mesh.region[c] < 0) continue;
    const auto found = present.find({mesh.region[c], mesh.material[c]});
    mesh.region[c] = static_cast<int>(std::distance(present.begin(), found));
  }
}

/// The loads of a box's boundary, numbered as displacement_conditions() numbers them.
void add_boundary_loads(const Scene& scene, std::vector<LoadCase>& loads) {
  for (std::size_t i = 0; i < scene.box.boundary.size(); ++i) {
    const BoundaryCondition& condition = scene.box.boundary[i];
    if (!is_load(condition.kind)) continue;
    LoadCase load;
    load.key = {.kind = LoadKey::Kind::boundary, .index = static_cast<int>(i)};
    load.displacement = condition.kind == BoundaryKind::displacement;
    if (!load.displacement) {
      load.stress_groups.assign(condition.sides.begin(), condition.sides.end());
      for (const std::string& name : condition.surfaces)
        load.stress_groups.emplace_back(surface_number(*scene.box.mesh->content, name));
      load.stress =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(condition.stress.data());
    }
    loads.push_back(load);
  }
}

}  // namespace

BulkProblem bulk_problem(const Scene& scene, const Plan& plan) {
  return bulk_problem(scene, plan, scene_mesh(scene, plan));
}

const std::shared_ptr<const BulkProblem>& SceneBulk::problem() const {
  if (!problem_) {
    problem_ = std::make_shared<const BulkProblem>(mesh_ ? bulk_problem(scene_, plan_, *mesh_)
                                                         : bulk_problem(scene_, plan_));
  }
  return problem_;
}

BulkProblem bulk_problem(const Scene& scene, const Plan& plan, Mesh mesh) {
  BulkProblem problem;
  problem.mesh = std::move(mesh);
  for (const Material& m : scene.materials) {
    problem.materials.push_back({m.youngs_modulus, m.poisson_ratio});
    const bool creeps = plan.creep.active && m.viscosity;
    problem.viscosity.push_back(creeps ? *m.viscosity : std::numeric_limits<double>::infinity());
  }
  add_pressure_loads(problem.mesh, problem.loads);
  problem.conditions = displacement_conditions(scene, static_cast<int>(problem.loads.size()));
  if (scene.geometry_kind == GeometryKind::box) add_boundary_loads(scene, problem.loads);
  for (const ObservationPoint& point : scene.output.observation_points) {
    // By symmetry; prepare_operator turns u_y round again.
    const double y = plan.half_domain ? std::abs(point.position[1]) : point.position[1];
    problem.observation_points.emplace_back(
        point.name, Eigen::Vector3d(point.position[0], y, point.position[2]));
  }
  problem.mean_dilatation = scene.numerics.b_bar;
  problem.half_domain = plan.half_domain;
  return problem;
}

std::optional<Mesh> moved_faults(const Scene& scene, const Plan& plan, const Mesh& like) {
  std::optional<Mesh> mesh = make_faults(field_mesh_spec(scene, plan), like);
  if (!mesh) return mesh;
  std::vector<LoadCase> loads;
  add_pressure_loads(*mesh, loads);
  if (mesh->region != like.region) mesh.reset();
  return mesh;
}

std::vector<int> mirrored_rows(const Scene& scene, bool half_domain) {
  std::vector<int> rows;
  const auto& points = scene.output.observation_points;
  for (int i = 0; half_domain && i < static_cast<int>(points.size()); ++i) {
    if (points[i].position[1] < 0) rows.push_back(3 * i + 1);
  }
  return rows;
}

}  // namespace faultsim
