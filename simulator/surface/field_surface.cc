#include "simulator/surface/field_surface.h"

#include <algorithm>

#include "simulator/common/ranges.h"
#include "simulator/operators/influence.h"
#include "simulator/surface/surface_builder.h"

namespace faultsim {
namespace {

/// 1 Pa of stress per pascal, or kelvin, in the rock of one material, and none in the others.
Scene with_unit_strength(Scene scene, std::size_t material, bool is_thermal) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    Material& one = scene.materials[m];
    one.biot = m == material && !is_thermal ? 1 : 0;
    one.thermal_expansion = 0;
    if (m != material || !is_thermal) continue;
    one.thermal_expansion = 1;
    one.thermal_expansion = 1 / thermal_stress(one);
  }
  return scene;
}

}  // namespace

FieldSurface::FieldSurface(const OperatorSurface& surface, const Scene& scene,
                           const CachePolicy& cache, const RunContext& context)
    : surface_(surface) {
  const Scene centre = surface.node_scene(0);
  const InfluenceBlock cells =
      cells_of_compartments(scene, *surface.problem_of(centre, exact_plan(centre)));
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const bool is_in_cells = contains(cells.cells, static_cast<int>(m), &InfluenceCell::material);
    if (is_in_cells && scene.pressure_field.is_given()) strengths_.push_back({m, false});
    if (is_in_cells && scene.temperature_field.is_given()) strengths_.push_back({m, true});
  }
  const auto with_field = [&](Scene at) {
    at.pressure_field = scene.pressure_field;
    at.temperature_field = scene.temperature_field;
    return at;
  };
  const int n_nodes = surface.n_nodes();
  const std::vector<Scene> checks = surface.check_scenes();
  const double n_asked = n_nodes + static_cast<double>(checks.size());
  for (int k = 0; k < n_nodes; ++k) {
    context.progress(k / n_asked, concat("flow result at node ", k + 1, " of the surface"));
    nodes_.push_back(exact_at(with_field(surface.node_scene(k)), cache, context));
    if (k == 0) continue;
    nodes_.back().locked -= nodes_.front().locked;
    nodes_.back().observed -= nodes_.front().observed;
  }
  for (std::size_t i = 0; i < checks.size(); ++i) {
    context.progress((n_nodes + static_cast<double>(i)) / n_asked,
                     concat("flow result at check point ", i + 1));
    const Columns exact = exact_at(with_field(checks[i]), cache, context);
    const Columns found = interpolated(surface.weights(checks[i]));
    traction_error_ = std::max(traction_error_, worst_column(found.locked, exact.locked));
    observation_error_ = std::max(observation_error_, worst_column(found.observed, exact.observed));
  }
}

FieldSurface::Columns FieldSurface::exact_at(const Scene& scene, const CachePolicy& cache,
                                             const RunContext& context) const {
  context.stop.throw_if_requested("mapping a flow result onto a surface of operators");
  const Plan plan = exact_plan(scene);
  const SceneBulk bulk(scene, plan);
  const PreparedInfluence made = prepare_influence(bulk, {}, cache, context);
  Columns columns;
  for (std::size_t k = 0; k < strengths_.size(); ++k) {
    const Scene unit = with_unit_strength(scene, strengths_[k].material, strengths_[k].is_thermal);
    const auto history =
        field_loads(unit, {*made.op, bulk.problem()->mesh, *made.block}, context.n_threads).history;
    const Eigen::Index n = history->locked.cols(), first = static_cast<Eigen::Index>(k) * n;
    const auto n_all = static_cast<Eigen::Index>(strengths_.size()) * n;
    columns.locked.conservativeResize(history->locked.rows(), n_all);
    columns.observed.conservativeResize(history->observed.rows(), n_all);
    columns.locked.middleCols(first, n) = history->locked;
    columns.observed.middleCols(first, n) = history->observed;
  }
  return columns;
}

FieldSurface::Columns FieldSurface::interpolated(const Eigen::VectorXd& weights) const {
  Columns sum = nodes_.front();
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    sum.locked += weights[i] * nodes_[i].locked;
    sum.observed += weights[i] * nodes_[i].observed;
  }
  return sum;
}

FieldLoads FieldSurface::at(const Scene& scene, const Plan& plan, const FaultOperator& op,
                            CreepLadder* bulk) const {
  const std::shared_ptr<const BulkProblem> problem = surface_.problem_of(scene, plan);
  const InfluenceBlock cells = cells_of_compartments(scene, *problem);
  FieldLoads loads = field_loads(scene, {op, problem->mesh, cells, bulk});
  FieldHistory history = *loads.history;
  const Columns columns = interpolated(surface_.weights(scene));
  const Eigen::Index n = std::ssize(history.time);
  history.locked = Eigen::MatrixXd::Zero(columns.locked.rows(), n);
  history.observed = Eigen::MatrixXd::Zero(columns.observed.rows(), n);
  for (std::size_t k = 0; k < strengths_.size(); ++k) {
    const Material& material = scene.materials[strengths_[k].material];
    const double strength = strengths_[k].is_thermal ? thermal_stress(material) : material.biot;
    const Eigen::Index first = static_cast<Eigen::Index>(k) * n;
    history.locked += strength * columns.locked.middleCols(first, n);
    history.observed += strength * columns.observed.middleCols(first, n);
  }
  loads.history = std::make_shared<const FieldHistory>(std::move(history));
  return loads;
}

}  // namespace faultsim
