#include "simulator/condensation/condensation.h"

#include <Eigen/Geometry>
#include <span>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/stopwatch.h"
#include "simulator/condensation/fault_geometry.h"
#include "simulator/condensation/loose_pieces.h"
#include "simulator/elasticity/element.h"
#include "simulator/elasticity/rigid_modes.h"
#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

/// Remarks when a stress load leaves a net force or moment on a body that is only pinned: the pins
/// would have to carry it.
void check_balance(const BulkProblem& problem, const LoadCase& load, const RunContext& context) {
  constexpr double kBalanced = 1e-6;  // of the sum of the absolute nodal forces
  const Eigen::Matrix3Xd forces =
      nodal_stress_forces(problem.mesh, load.stress_groups, load.stress);
  const Eigen::AlignedBox3d extent = extent_of(problem.mesh, [](int) { return true; });
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    const Eigen::Vector3d arm = problem.mesh.nodes[i] - extent.center();
    force += forces.col(i);
    moment += arm.cross(Eigen::Vector3d(forces.col(i)));
  }
  if (problem.mesh.plane_strain) {  // u_y = 0 carries the rest
    force.y() = 0;
    moment.x() = moment.z() = 0;
  }
  const double total = forces.colwise().norm().sum();
  const double size = extent.diagonal().norm();
  if (force.norm() <= kBalanced * total && moment.norm() <= kBalanced * total * size) return;
  context.note(concat("load ", to_string(load.key), " alone is not in balance (net force ",
                      force.norm(), " N, moment ", moment.norm(),
                      " N m per unit): no displacement is prescribed, so the loads must balance "
                      "together, or three pinned points carry the difference"));
}

void check_problem(const BulkProblem& problem) {
  const Mesh& mesh = problem.mesh;
  FAULTSIM_DEMAND(!mesh.cells.empty(), "empty mesh");
  FAULTSIM_DEMAND(mesh.material.size() == mesh.cells.size() &&
                      mesh.region.size() == mesh.cells.size() &&
                      mesh.region_fraction.size() == mesh.cells.size(),
                  "per-cell data of ", mesh.cells.size(), " cells is incomplete");
  for (const ElasticMaterial& material : problem.materials) {
    const double nu = material.poisson_ratio;
    FAULTSIM_DEMAND(material.youngs_modulus > 0 && nu > -1 && nu < 0.5, "E ",
                    material.youngs_modulus, " Pa, nu ", nu);
  }
}

InfluenceCell influence_cell(const BulkProblem& problem, int cell) {
  const Mesh& mesh = problem.mesh;
  FAULTSIM_DEMAND(cell >= 0 && cell < static_cast<int>(mesh.cells.size()), "cell ", cell, " of ",
                  mesh.cells.size());
  InfluenceCell result;
  result.cell = cell;
  result.material = mesh.material[cell];
  result.region = pressure_region(problem, cell);
  if (result.region >= 0) result.fraction = mesh.region_fraction[cell];
  result.volume = volume_of(mesh, cell) / (mesh.plane_strain ? mesh.thickness : 1);
  const std::span<const int> corners = mesh.cells.corners(cell);
  for (const int node : corners)
    result.centroid += mesh.nodes[node] / static_cast<double>(corners.size());
  return result;
}

}  // namespace

std::vector<InfluenceCell> influence_cells(const BulkProblem& problem,
                                           const std::vector<int>& cells) {
  return mapped(cells, [&](const int& cell) { return influence_cell(problem, cell); });
}

struct CondensedBulk::Impl {
  explicit Impl(std::shared_ptr<const BulkProblem> given)
      : shared(std::move(given)),
        problem(*shared),
        dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size())),
        geometry(fault_geometry(problem.mesh, problem.materials, dofs, problem.half_domain)) {}

  void factorise(const RunContext& context);
  void make_loads(const RunContext& context);
  Eigen::MatrixXd condensed_matrix(int n_threads) const;
  void set_locked(FaultOperator& op, StopToken stop);
  void observe(FaultOperator& op, StopToken stop);
  /// q: u = q·x of a component of the displacement of an observation point (n_unknowns); zero where
  /// it is prescribed or held for good.
  Eigen::VectorXd observation(const Eigen::Vector3d& point, int component) const;

  std::shared_ptr<const BulkProblem> shared;
  const BulkProblem& problem;
  DofMap dofs;
  FaultGeometry geometry;
  Eigen::VectorXd springs;  // D
  std::unique_ptr<TrailingCholesky> factor;
  std::vector<Eigen::VectorXd> loads;
  std::vector<Eigen::VectorXd> forward_loads;  // L⁻¹ P f_k, made when first wanted
  double seconds = 0;
};

void CondensedBulk::Impl::factorise(const RunContext& context) {
  springs = loose_piece_springs(problem, dofs, geometry);
  context.progress(0.02, concat("assembling ", dofs.n_unknowns(), " unknowns"));
  SparseMatrix k =
      assemble_stiffness(problem.mesh, problem.materials, dofs, problem.mean_dilatation);
  for (int g = 0; g < dofs.n_jump(); ++g) {
    k.valuePtr()[k.outerIndexPtr()[dofs.n_bulk() + g]] += springs[g];  // the diagonal comes first
  }
  context.stop.throw_if_requested("condensing the bulk");
  constexpr double kBegin = 0.1, kEnd = 0.9;
  const std::string what = concat("factorising ", dofs.n_unknowns(), " unknowns");
  context.progress(kBegin, what);
  const FactorRun run = {
      .n_threads = context.n_threads,
      .progress = [&](double done) { context.progress(kBegin + (kEnd - kBegin) * done, what); },
      .stop = [&] { return context.stop.requested(); },
      .analysis = context.analysis};
  factor = std::make_unique<TrailingCholesky>(k, dofs.n_jump(), dofs.bulk_groups(), run);
  if (factor->failed_column() >= 0) throw_not_held(problem, dofs, factor->failed_column());
  context.stop.throw_if_requested("condensing the bulk");
}

void CondensedBulk::Impl::make_loads(const RunContext& context) {
  for (std::size_t k = 0; k < problem.loads.size(); ++k) {
    loads.push_back(unit_load(problem, dofs, static_cast<int>(k)));
    if (dofs.pinned() && !problem.loads[k].stress_groups.empty()) {
      check_balance(problem, problem.loads[k], context);
    }
  }
}

Eigen::MatrixXd CondensedBulk::Impl::condensed_matrix(int n_threads) const {
  Eigen::MatrixXd h = lower_times_transpose(factor->trailing_factor(), n_threads);
  h.diagonal() -= springs;
  for (Eigen::Index i = 0; i < h.cols(); ++i) {
    // Zero up to rounding only where a block that nothing else holds moves as a whole.
    const double least = springs[i] > 0 ? -1e-9 * springs[i] : 0;
    FAULTSIM_DEMAND(h(i, i) > least && h.col(i).allFinite(), "column ", i, " of H, diagonal ",
                    h(i, i));
  }
  return h;
}

void CondensedBulk::Impl::set_locked(FaultOperator& op, StopToken stop) {
  op.loads.traction.resize(geometry.n_dofs, static_cast<Eigen::Index>(loads.size()));
  for (std::size_t k = 0; k < loads.size(); ++k) {
    stop.throw_if_requested("condensing the loads");
    if (forward_loads.size() == k) forward_loads.push_back(factor->forward(loads[k]));
    op.loads.keys.push_back(problem.loads[k].key);
    op.loads.traction.col(static_cast<Eigen::Index>(k)) =
        factor->condensed(forward_loads[k]).cwiseQuotient(geometry.dof_area);
  }
  FAULTSIM_DEMAND(op.loads.traction.allFinite(), "locked tractions are not finite");
}

/// One adjoint back-solve per component: with q the row of P, u = q·x gives V = q_g − K_gr K_rr⁻¹
/// q_r and U_k = q_r·K_rr⁻¹ f_k,r + the prescribed part.
void CondensedBulk::Impl::observe(FaultOperator& op, StopToken stop) {
  const Eigen::Index n_rows = 3 * static_cast<Eigen::Index>(problem.observation_points.size());
  op.observed.per_load.setZero(n_rows, static_cast<Eigen::Index>(loads.size()));
  op.observed.per_jump.setZero(n_rows, geometry.n_dofs);
  Eigen::Index row = 0;
  for (const auto& [name, point] : problem.observation_points) {
    const int node = observed_node(problem.mesh, point);
    for (int c = 0; c < 3; ++c, ++row) {
      stop.throw_if_requested("condensing the observation points");
      op.observed.rows.push_back({concat(name, ".", "xyz"[c]), problem.mesh.nodes[node]});
      for (std::size_t k = 0; k < loads.size(); ++k) {
        op.observed.per_load(row, static_cast<Eigen::Index>(k)) =
            dofs.prescribed(static_cast<int>(k), node, c);
      }
      const Eigen::VectorXd q = observation(point, c);
      if (q.isZero(0)) continue;
      const Eigen::VectorXd y = factor->forward(q);
      op.observed.per_jump.row(row) = factor->condensed(y).transpose();
      for (std::size_t k = 0; k < loads.size(); ++k) {
        op.observed.per_load(row, static_cast<Eigen::Index>(k)) +=
            y.head(dofs.n_bulk()).dot(forward_loads[k].head(dofs.n_bulk()));
      }
    }
  }
}

Eigen::VectorXd CondensedBulk::Impl::observation(const Eigen::Vector3d& point,
                                                 int component) const {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(dofs.n_unknowns());
  for (const DofMap::Term& term : dofs.terms(observed_node(problem.mesh, point), component)) {
    q[term.unknown] += term.coefficient;
  }
  return q;
}

CondensedBulk::CondensedBulk(std::shared_ptr<const BulkProblem> problem,
                             const RunContext& context) {
  check_problem(*problem);
  Stopwatch stopwatch;
  set_blas_threads(1);
  impl_ = std::make_unique<Impl>(std::move(problem));
  impl_->factorise(context);
  impl_->make_loads(context);
  impl_->seconds = stopwatch.seconds();
  context.progress(0.9, "factorised");
}

CondensedBulk::~CondensedBulk() = default;

FaultOperator CondensedBulk::condense(const RunContext& context) {
  Impl& self = *impl_;
  Stopwatch stopwatch;
  FaultOperator op;
  op.geometry = self.geometry;
  op.compliance = std::make_shared<DenseCompliance>(self.condensed_matrix(context.n_threads));
  self.set_locked(op, context.stop);
  self.observe(op, context.stop);
  op.n_unknowns = self.dofs.n_unknowns();
  op.factor_bytes = self.factor->statistics().bytes;
  op.blas = blas_description();
  op.build_seconds = self.seconds + stopwatch.seconds();
  return op;
}

InfluenceBlock CondensedBulk::influence(const std::vector<int>& cells, const RunContext& context) {
  Impl& self = *impl_;
  Stopwatch stopwatch;
  InfluenceBlock block;
  block.cells = influence_cells(self.problem, cells);
  const std::vector<SparseLoad> loads = dilatations(cells);
  Eigen::MatrixXd traction = self.factor->condense(loads, [&](double share) {
    context.progress(share, concat("influence of ", cells.size(), " cells"));
    context.stop.throw_if_requested("condensing the influence of cells");
  });
  traction.array().colwise() /= self.geometry.dof_area.array();
  FAULTSIM_DEMAND(traction.allFinite(), "influences are not finite");
  block.traction = StoredMatrix(std::move(traction));
  block.observed.resize(3 * self.problem.observation_points.size(), cells.size());
  const Eigen::VectorXd locked = Eigen::VectorXd::Zero(self.geometry.n_dofs);
  Eigen::Index row = 0;
  for (const auto& [name, point] : self.problem.observation_points) {
    for (int c = 0; c < 3; ++c, ++row) {
      const Eigen::VectorXd z = self.factor->expand(self.observation(point, c), locked);
      for (std::size_t k = 0; k < cells.size(); ++k) {
        double sum = 0;
        for (const auto& [unknown, force] : loads[k]) sum += z[unknown] * force;
        block.observed(row, k) = sum;
      }
    }
  }
  block.build_seconds = stopwatch.seconds();
  return block;
}

std::vector<SparseLoad> CondensedBulk::dilatations(const std::vector<int>& cells) const {
  return mapped(cells, [&](const int& cell) {
    return dilatation_load(impl_->problem.mesh, impl_->dofs, cell);
  });
}

Eigen::Matrix3Xd CondensedBulk::displacement(const std::vector<double>& load_factors,
                                             const Eigen::VectorXd& jump) {
  Impl& self = *impl_;
  FAULTSIM_DEMAND(load_factors.size() == self.loads.size(), load_factors.size(), " factors for ",
                  self.loads.size(), " loads");
  Eigen::VectorXd f = Eigen::VectorXd::Zero(self.dofs.n_unknowns());
  for (std::size_t k = 0; k < self.loads.size(); ++k) f += load_factors[k] * self.loads[k];
  return nodal_displacement(self.problem.mesh, self.dofs, self.factor->expand(f, jump),
                            load_factors);
}

Eigen::VectorXd CondensedBulk::forward(const Eigen::VectorXd& force) {
  return impl_->factor->forward(force);
}

Eigen::VectorXd CondensedBulk::locked_traction(const Eigen::VectorXd& forward) const {
  return impl_->factor->condensed(forward).cwiseQuotient(impl_->geometry.dof_area);
}

Eigen::Matrix3Xd CondensedBulk::displacement(Eigen::VectorXd forward,
                                             const std::vector<double>& load_factors,
                                             const Eigen::VectorXd& jump) {
  Impl& self = *impl_;
  FAULTSIM_DEMAND(load_factors.size() == self.forward_loads.size(), load_factors.size(),
                  " factors for ", self.forward_loads.size(), " loads");
  for (std::size_t k = 0; k < load_factors.size(); ++k) {
    if (load_factors[k] != 0) forward += load_factors[k] * self.forward_loads[k];
  }
  return nodal_displacement(self.problem.mesh, self.dofs,
                            self.factor->expand_forward(std::move(forward), jump), load_factors);
}

const BulkProblem& CondensedBulk::problem() const { return impl_->problem; }

const DofMap& CondensedBulk::dofs() const { return impl_->dofs; }

}  // namespace faultsim
