#include "simulator/surface/operator_surface.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "simulator/cache/operator_cache.h"
#include "simulator/common/ranges.h"
#include "simulator/condensation/condensation.h"
#include "simulator/condensation/fault_geometry.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/linalg/dense_cholesky.h"
#include "simulator/operators/influence.h"
#include "simulator/surface/surface_builder.h"

namespace faultsim {
namespace {

using Kind = SurfaceParameter::Kind;

bool moves_mesh(const SurfaceRequest& request) {
  return std::ranges::any_of(request.over, [](const SurfaceParameter& one) {
    return one.kind == Kind::dip || one.kind == Kind::offset;
  });
}

/// The mesh nodes that stand for the observation points.
std::vector<int> observed_nodes(const BulkProblem& problem) {
  return mapped(problem.observation_points,
                [&](const auto& point) { return observed_node(problem.mesh, point.second); });
}

[[noreturn]] void refuse_topology() {
  refuse_surface("the mesh changes its topology over the ranges of the surface",
                 "narrow the ranges of dips and offsets, or use exact operators");
}

SparseGrid grid_of(const std::vector<SparseGrid::Index>& nodes) {
  SparseGrid grid(static_cast<int>(nodes.front().size()));
  for (std::size_t k = 1; k < nodes.size(); ++k) grid.add(nodes[k]);
  return grid;
}

SurfaceAxis::Scale scale_of(Kind kind) {
  if (kind == Kind::youngs_modulus) return SurfaceAxis::Scale::logarithm;
  return kind == Kind::dip ? SurfaceAxis::Scale::tangent : SurfaceAxis::Scale::linear;
}

std::vector<SurfaceAxis> axes_of(const SurfaceRequest& request) {
  std::vector<SurfaceAxis> axes;
  for (const SurfaceParameter& one : request.over)
    axes.push_back({one.from, one.to, scale_of(one.kind)});
  return axes;
}

}  // namespace

Scene without_surface(Scene scene) {
  scene.numerics.surface = {};
  return scene;
}

/// What does not change from sample to sample unless the mesh moves.
struct OperatorSurface::Frame {
  explicit Frame(BulkProblem bulk)
      : problem(std::move(bulk)),
        dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size())),
        observed(observed_nodes(problem)) {}
  BulkProblem problem;
  DofMap dofs;
  std::vector<int> observed;  ///< go with the mesh where it moves.

  void require_same_topology(const Mesh& other) const;
};

void OperatorSurface::Frame::require_same_topology(const Mesh& other) const {
  const Mesh& mesh = problem.mesh;
  if (mesh.nodes.size() != other.nodes.size() || mesh.cells != other.cells ||
      mesh.material != other.material || mesh.region != other.region ||
      mesh.tied_to != other.tied_to) {
    refuse_topology();
  }
}

OperatorSurface::OperatorSurface(const Scene& scene, const Plan& plan, const ProbingScenes& cases,
                                 const CachePolicy& cache, const RunContext& context)
    : centre_(without_surface(scene)),
      request_(scene.numerics.surface),
      axes_(axes_of(request_)),
      grid_(static_cast<int>(axes_.size())) {
  take_blas_buffer();
  set_blas_threads(1);
  centre_ = scene_at(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes_.size())));
  frame_ = std::make_shared<const Frame>(bulk_problem(centre_, exact_plan(centre_)));
  if (moves_mesh(request_)) move_points(frame_->problem.mesh, centre_);
  const std::string name = operator_fingerprint(scene, plan, blas_description());
  std::optional<StoredSurface> found;
  if (!cache.folder.empty()) found = read_surface_file(cache.folder, name, &remark_);
  from_cache_ = found.has_value();
  if (found) {
    surface_ = std::move(*found);
  } else {
    build(name, cases, cache, context);
  }
  grid_ = grid_of(surface_.basis->nodes);
}

OperatorSurface::~OperatorSurface() = default;

/// What was written is read back, so that processes share it.
void OperatorSurface::build(const std::string& name, const ProbingScenes& cases,
                            const CachePolicy& cache, const RunContext& context) {
  const auto exact = [&](const Eigen::VectorXd& x, const RunContext& part) {
    return exact_at(x, cache, part);
  };
  CaseRunner runner(
      cases, [&](const Eigen::VectorXd& x) { return scene_at(x); }, cache, context.stop);
  ProbingCases probing;
  if (request_.probes) {
    probing = {
        cases.n, request_.probes->tolerance,
        [&](int i, const Eigen::VectorXd& x, const std::shared_ptr<const FaultOperator>& op) {
          return runner.run(i, x, op);
        }};
  }
  FactorAnalysis analysis;  // one for all nodes
  RunContext with_analysis = context;
  with_analysis.analysis = &analysis;
  surface_ = build_surface(request_, name, exact, probing, with_analysis);
  if (cache.folder.empty()) return;
  const auto write = [&] {
    write_surface(surface_, cache.folder);
    if (auto kept = read_surface_file(cache.folder, name)) surface_ = std::move(*kept);
  };
  keep(cache, name, "the surface of operators", write, remark_);
}

Scene OperatorSurface::scene_at(const Eigen::VectorXd& x) const {
  Scene scene = centre_;
  for (std::size_t j = 0; j < axes_.size(); ++j)
    set_value(request_.over[j], axes_[j].value(x[j]), scene);
  const bool has_points = !scene.output.observation_points.empty();
  if (frame_ && moves_mesh(request_) && has_points)
    move_points(moved_mesh(scene, exact_plan(scene)), scene);
  return scene;
}

/// Where the nodes that were chosen at the centre are now; of a half domain, the mirror images of
/// those that are there for points at y < 0.
void OperatorSurface::move_points(const Mesh& mesh, Scene& scene) const {
  for (std::size_t i = 0; i < frame_->observed.size(); ++i) {
    Eigen::Map<Eigen::Vector3d> point(scene.output.observation_points[i].position.data());
    const bool mirrored = frame_->problem.half_domain && point.y() < 0;
    point = mesh.nodes[static_cast<std::size_t>(frame_->observed[i])];
    if (mirrored) point.y() *= -1;
  }
}

Mesh OperatorSurface::moved_mesh(const Scene& scene, const Plan& plan) const {
  std::optional<Mesh> moved = moved_faults(scene, plan, frame_->problem.mesh);
  if (!moved) refuse_topology();
  return std::move(*moved);
}

std::shared_ptr<const FaultOperator> OperatorSurface::exact_at(const Eigen::VectorXd& x,
                                                               const CachePolicy& cache,
                                                               const RunContext& context) const {
  const Scene scene = scene_at(x);
  const Plan plan = exact_plan(scene);
  const SceneBulk bulk(scene, plan);
  if (moves_mesh(request_)) frame_->require_same_topology(bulk.problem()->mesh);
  if (centre_.has_field() && !cache.folder.empty())  // its factor is wanted for cells as well
    prepare_influence(bulk, {}, cache, context);
  const PreparedOperator prepared = prepare_operator(bulk, cache, false, context);
  if (prepared.from_cache || cache.folder.empty()) return prepared.op;
  // From its file, whose pages the system may take back; kept in memory where there is none.
  if (auto mapped = read_operator(cache.folder, prepared.op->fingerprint))
    return std::make_shared<const FaultOperator>(std::move(*mapped));
  return prepared.op;
}

/// Positions, frames, areas and pressure shares, which are those of the scene's own mesh.
void OperatorSurface::put_geometry(Scene scene, const Plan& plan, FaultOperator& op) const {
  std::vector materials = mapped(scene.materials, [&](const Material& m) {
    return ElasticMaterial{m.youngs_modulus, m.poisson_ratio};
  });
  if (!moves_mesh(request_)) {
    op.geometry = fault_geometry(frame_->problem.mesh, materials, frame_->dofs, plan.half_domain);
    return;
  }
  const Mesh mesh = moved_mesh(scene, plan);
  op.geometry = fault_geometry(mesh, materials, frame_->dofs, plan.half_domain);
  move_points(mesh, scene);
  for (std::size_t row = 0; row < op.observed.rows.size(); ++row) {
    const auto& point = scene.output.observation_points[row / 3].position;
    op.observed.rows[row].position = {point[0], point[1], point[2]};
  }
}

std::vector<Scene> OperatorSurface::check_scenes() const {
  return mapped(check_points(grid_.n_axes(), n_surface_checks(request_)),
                [&](const Eigen::VectorXd& x) { return scene_at(x); });
}

Eigen::VectorXd OperatorSurface::weights(const Scene& scene) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(axes_.size()));
  for (std::size_t j = 0; j < axes_.size(); ++j) {
    const double at = axes_[j].coordinate(value_of(request_.over[j], scene));
    x[j] = std::clamp(at, -1.0, 1.0);  // ends are rounded
  }
  return grid_.weights(x);
}

std::shared_ptr<const BulkProblem> OperatorSurface::problem_of(const Scene& scene,
                                                               const Plan& plan) const {
  if (!moves_mesh(request_)) return {frame_, &frame_->problem};
  return std::make_shared<const BulkProblem>(bulk_problem(without_surface(scene), plan));
}

PreparedOperator OperatorSurface::at(const Scene& scene, const Plan& plan) const {
  const Eigen::VectorXd weights = this->weights(scene);
  auto op = std::make_shared<FaultOperator>();
  OperatorBasis::put(surface_.basis, weights.tail(weights.size() - 1), *op);
  put_geometry(scene, plan, *op);
  take_fault_names(scene, *op);
  op->fingerprint = surface_.basis->fingerprint;
  PreparedOperator prepared;
  prepared.op = op;
  prepared.surface = surface_.accuracy;
  return prepared;
}

void require_definite(const FaultOperator& op, const std::vector<int>& dofs) {
  const auto n = static_cast<Eigen::Index>(dofs.size());
  Eigen::MatrixXd block(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column = op.compliance->column(dofs[j]);
    for (Eigen::Index i = j; i < n; ++i) block(i, j) = column[dofs[i]];
  }
  if (DenseCholesky().factor(std::move(block))) return;
  refuse_surface("the interpolated H is not positive definite at this case's parameters",
                 "use a smaller tolerance, or exact operators");
}

}  // namespace faultsim
