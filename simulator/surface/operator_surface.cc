#include "simulator/surface/operator_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/machine.h"
#include "simulator/condensation/condensation.h"
#include "simulator/condensation/fault_geometry.h"
#include "simulator/surface/adaptive_interpolant.h"

namespace faultsim {
namespace {

const char* const kWhere = "/numerics/surface";

using Kind = SurfaceParameter::Kind;

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

[[noreturn]] void refuse(const std::string& what, const std::string& cure) {
  throw InputError("scene", {{kWhere, 0, what, cure}});
}

bool moves_mesh(const SurfaceRequest& request) {
  return std::any_of(request.over.begin(), request.over.end(), [](const SurfaceParameter& one) {
    return one.kind == Kind::dip || one.kind == Kind::offset;
  });
}

Plan plan_of(const Scene& scene) {
  std::vector<Problem> problems;
  Plan plan = make_plan(scene, problems);
  if (!problems.empty()) throw InputError("scene at a node of its surface", std::move(problems));
  return plan;
}

/// The mesh nodes that stand for the observation points.
std::vector<int> observed_nodes(const BulkProblem& problem) {
  std::vector<int> nodes;
  for (const auto& [name, point] : problem.observation_points)
    nodes.push_back(observed_node(problem.mesh, point));
  return nodes;
}

/// Points of the cube, none of them a node: the same for every surface of as many axes.
std::vector<Eigen::VectorXd> check_points(int n_axes, int n_points) {
  std::mt19937 random(7);
  std::vector<Eigen::VectorXd> points;
  for (int i = 0; i < n_points; ++i) {
    Eigen::VectorXd x(n_axes);
    for (double& one : x) one = -1 + 2 * (static_cast<double>(random()) / 4294967296.0);
    points.push_back(x);
  }
  return points;
}

}  // namespace

std::vector<SurfaceAxis> surface_axes(const SurfaceRequest& request, const Scene& scene) {
  std::vector<SurfaceAxis> axes;
  for (const SurfaceParameter& one : request.over) {
    const auto i = static_cast<std::size_t>(one.index);
    SurfaceAxis axis;
    axis.from = one.from;
    axis.to = one.to;
    switch (one.kind) {
      case Kind::youngs_modulus:
        axis.name = "Young's modulus of " + scene.materials.at(i).name;
        axis.scale = SurfaceAxis::Scale::logarithm;
        break;
      case Kind::poisson_ratio:
        axis.name = "Poisson's ratio of " + scene.materials.at(i).name;
        break;
      case Kind::dip:
        axis.name = "dip of " + scene.faults.at(i).name;
        axis.scale = SurfaceAxis::Scale::tangent;
        break;
      case Kind::offset:
        axis.name = "offset of " + scene.field.blocks.at(i).name;
        break;
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

Eigen::VectorXd surface_coordinates(const std::vector<SurfaceAxis>& axes,
                                    const SurfaceRequest& request, const Scene& scene) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(axes.size()));
  for (std::size_t j = 0; j < axes.size(); ++j) {
    const double at = axes[j].coordinate(value_of(request.over[j], scene));
    x[static_cast<Eigen::Index>(j)] = std::clamp(at, -1.0, 1.0);  // ends are rounded
  }
  return x;
}

/// What does not change from sample to sample unless the mesh moves.
struct OperatorSurface::Frame {
  explicit Frame(BulkProblem bulk)
      : problem(std::move(bulk)),
        dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size())),
        observed(observed_nodes(problem)) {}
  BulkProblem problem;
  DofMap dofs;
  std::vector<int> observed;

  void demand_same_topology(const BulkProblem& other, const Scene& scene) const;
};

void OperatorSurface::Frame::demand_same_topology(const BulkProblem& other,
                                                  const Scene& scene) const {
  const Mesh &a = problem.mesh, &b = other.mesh;
  if (a.nodes.size() != b.nodes.size() || a.cells != b.cells || a.material != b.material ||
      a.region != b.region || a.tied_to != b.tied_to) {
    refuse("the mesh changes its topology over the ranges of the surface",
           "narrow the ranges of dips and offsets, or take exact operators");
  }
  const std::vector<int> nodes = observed_nodes(other);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] == observed[i]) continue;
    refuse("the observation point " + scene.output.observation_points[i].name +
               " is nearest to different nodes of the mesh over the ranges of the surface",
           "leave it out or put it where the mesh does not move, or take exact operators");
  }
}

OperatorSurface::OperatorSurface(const Scene& scene, const CachePolicy& cache,
                                 const RunContext& context)
    : centre_(scene),
      request_(scene.numerics.surface),
      axes_(surface_axes(request_, scene)),
      grid_(static_cast<int>(axes_.size())) {
  centre_.numerics.surface = {};
  const int n_axes = static_cast<int>(axes_.size());
  centre_ = scene_at(Eigen::VectorXd::Zero(n_axes));
  frame_ = std::make_unique<Frame>(bulk_problem(centre_, plan_of(centre_)));
  centre_operator_ = exact_at(Eigen::VectorXd::Zero(n_axes), cache, context).op;
  if (Eigen::LLT<Eigen::MatrixXd>(centre_operator_->h()).info() != Eigen::Success) {
    refuse("a piece that faults cut loose moves freely, so that H is not positive definite",
           "take exact operators");
  }
  values_ = std::make_unique<OperatorValues>(*centre_operator_);
  const double bytes = 8.0 * static_cast<double>(values_->size());
  int n_read = 0;
  const auto value_at = [&](const Eigen::VectorXd& x) {
    context.progress(0, concat("operator ", ++n_read, " of a surface"));
    // Its own, that of the check points and the columns that are left of them.
    if (const auto free = available_memory(); free && 3 * bytes > *free) {
      throw ResourceError(concat("the ", n_read,
                                 " operators of the surface do not fit into memory (",
                                 brief(bytes / 1e9), " GB each); narrow its ranges"));
    }
    return values_->pack(*exact_at(x, cache, context).op);
  };
  AdaptiveInterpolant interpolant(
      n_axes, value_at, [&](const Eigen::VectorXd& one) { return values_->largest_block(one); });
  const auto points = check_points(n_axes, n_surface_checks(request_));
  std::vector<std::shared_ptr<const FaultOperator>> exact;
  for (double surplus = request_.tolerance;; surplus /= 4) {
    interpolant.grow(surplus, request_.most_operators);
    for (std::size_t i = exact.size(); i < points.size(); ++i) {
      context.progress(0, concat("check point ", i + 1, " of a surface"));
      exact.push_back(exact_at(points[i], cache, context).op);
    }
    grid_ = interpolant.grid();
    compress(interpolant.values(), surplus);
    measure(points, exact);
    const double error = std::max(std::max(accuracy_.stiffness, accuracy_.traction),
                                  std::max(accuracy_.observation, accuracy_.slip));
    if (error <= request_.tolerance) return;
    constexpr double kRounding = 1e-13;  // nothing is gained below it
    if (grid_.n_nodes() >= request_.most_operators || surplus < kRounding) {
      refuse(concat("the surface does not reach its tolerance: with ", grid_.n_nodes(),
                    " operators H is off by ", brief(accuracy_.stiffness), ", locked tractions by ",
                    brief(accuracy_.traction), ", observations by ", brief(accuracy_.observation),
                    ", slip without friction by ", brief(accuracy_.slip), "; ",
                    brief(request_.tolerance), " is asked for"),
             "narrow its ranges, raise tolerance or most_operators, or take exact operators");
    }
  }
}

OperatorSurface::~OperatorSurface() = default;

Scene OperatorSurface::scene_at(const Eigen::VectorXd& x) const {
  Scene scene = centre_;
  for (std::size_t j = 0; j < axes_.size(); ++j)
    set_value(request_.over[j], axes_[j].value(x[static_cast<Eigen::Index>(j)]), scene);
  return scene;
}

PreparedOperator OperatorSurface::exact_at(const Eigen::VectorXd& x, const CachePolicy& cache,
                                           const RunContext& context) const {
  const Scene scene = scene_at(x);
  const Plan plan = plan_of(scene);
  if (moves_mesh(request_)) frame_->demand_same_topology(bulk_problem(scene, plan), scene);
  return prepare_operator(scene, plan, cache, false, context);
}

/// The columns of B beyond which nothing is above a hundredth of `tolerance` in any node.
void OperatorSurface::compress(const std::vector<Eigen::VectorXd>& values, double tolerance) {
  mean_ = values.front();
  const auto n = static_cast<Eigen::Index>(values.size()) - 1;
  Eigen::MatrixXd moved(mean_.size(), n);
  for (Eigen::Index i = 0; i < n; ++i)
    moved.col(i) = values[static_cast<std::size_t>(i) + 1] - mean_;
  const Eigen::MatrixXd gram = moved.transpose() * moved;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);  // ascending
  const double least = std::pow(tolerance / 100, 2);
  Eigen::Index n_left_out = 0;
  double left_out = 0;  // sum of squares over all nodes
  while (n_left_out < n && left_out + std::max(0.0, solver.eigenvalues()[n_left_out]) <= least)
    left_out += std::max(0.0, solver.eigenvalues()[n_left_out++]);
  const Eigen::MatrixXd directions = solver.eigenvectors().rightCols(n - n_left_out);
  basis_ = moved * directions;
  weights_ = directions.transpose();
}

FaultOperator OperatorSurface::interpolated(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd of_nodes = grid_.weights(x);
  const Eigen::VectorXd factors = weights_ * of_nodes.tail(of_nodes.size() - 1);
  Eigen::VectorXd values = mean_;
  for (Eigen::Index k = 0; k < basis_.cols(); ++k) values += factors[k] * basis_.col(k);
  FaultOperator op;
  op.observed.rows = centre_operator_->observed.rows;
  op.n_unknowns = centre_operator_->n_unknowns;
  op.blas = centre_operator_->blas;
  values_->unpack(values, op);
  return op;
}

void OperatorSurface::measure(const std::vector<Eigen::VectorXd>& points,
                              const std::vector<std::shared_ptr<const FaultOperator>>& exact) {
  accuracy_ = {.n_operators = grid_.n_nodes(),
               .n_basis = static_cast<int>(basis_.cols()),
               .n_checks = static_cast<int>(points.size()),
               .tolerance = request_.tolerance};
  for (std::size_t i = 0; i < points.size(); ++i) {
    FaultOperator op = interpolated(points[i]);
    op.geometry = exact[i]->geometry;
    const CaseSurface errors = OperatorValues::errors(op, *exact[i]);
    accuracy_.stiffness = std::max(accuracy_.stiffness, errors.stiffness);
    accuracy_.traction = std::max(accuracy_.traction, errors.traction);
    accuracy_.observation = std::max(accuracy_.observation, errors.observation);
    accuracy_.slip = std::max(accuracy_.slip, errors.slip);
  }
}

FaultGeometry OperatorSurface::geometry_of(const Scene& scene, const Plan& plan) const {
  std::vector<ElasticMaterial> materials;
  for (const Material& m : scene.materials)
    materials.push_back({m.youngs_modulus, m.poisson_ratio});
  if (!moves_mesh(request_))
    return fault_geometry(frame_->problem.mesh, materials, frame_->dofs, plan.half_domain);
  const BulkProblem problem = bulk_problem(scene, plan);
  frame_->demand_same_topology(problem, scene);
  const DofMap dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size()));
  return fault_geometry(problem.mesh, materials, dofs, plan.half_domain);
}

PreparedOperator OperatorSurface::at(const Scene& scene, const Plan& plan) const {
  const Eigen::VectorXd x = surface_coordinates(axes_, request_, scene);
  auto op = std::make_shared<FaultOperator>(interpolated(x));
  op->geometry = geometry_of(scene, plan);
  FAULTSIM_DEMAND(op->geometry.faults.size() == scene.faults.size(), op->geometry.faults.size());
  for (std::size_t f = 0; f < scene.faults.size(); ++f)
    op->geometry.faults[f].name = scene.faults[f].name;
  const Eigen::LLT<Eigen::MatrixXd> factor(op->h());
  if (factor.info() != Eigen::Success) {
    refuse("the interpolated H is not positive definite at this case's parameters",
           "take a smaller tolerance, or exact operators");
  }
  std::string key = operator_fingerprint(scene, plan, centre_operator_->blas);
  for (const double one : x) key += concat(" ", one);
  op->fingerprint = fingerprint(key);
  PreparedOperator prepared;
  prepared.op = op;
  prepared.surface = accuracy_;
  return prepared;
}

}  // namespace faultsim
