#include "simulator/solved_compliance/solved_operator.h"

#include <utility>

#include "simulator/condensation/fault_geometry.h"

namespace faultsim {
namespace {

/// q: u = q·x of a component of a node's displacement; zero where it is prescribed.
Eigen::VectorXd row_of(const DofMap& dofs, int node, int component) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(dofs.n_unknowns());
  for (const DofMap::Term& term : dofs.terms(node, component)) q[term.unknown] += term.coefficient;
  return q;
}

/// One adjoint solve per component: V = q_g − K_gr z, U_k = z·f_k,r + the prescribed part, with
/// z = K_rr⁻¹ q_r.
void observe(const StuckBulk& bulk, const std::vector<Eigen::VectorXd>& loads, FaultOperator& op,
             StopToken stop) {
  const BulkProblem& problem = bulk.problem();
  const DofMap& dofs = bulk.dofs();
  const Eigen::Index n_rows = 3 * std::ssize(problem.observation_points);
  op.observed.per_load.setZero(n_rows, std::ssize(loads));
  op.observed.per_jump.setZero(n_rows, dofs.n_jump());
  Eigen::Index row = 0;
  for (const auto& [name, point] : problem.observation_points) {
    const int node = observed_node(problem.mesh, point);
    for (int c = 0; c < 3; ++c, ++row) {
      stop.throw_if_requested("condensing the observation points");
      op.observed.rows.push_back({concat(name, ".", "xyz"[c]), problem.mesh.nodes[node]});
      for (int k = 0; k < static_cast<int>(loads.size()); ++k)
        op.observed.per_load(row, k) = dofs.prescribed(k, node, c);
      const Eigen::VectorXd q = row_of(dofs, node, c);
      if (q.isZero(0)) continue;
      const StuckBulk::Response z = bulk.respond(q);
      op.observed.per_jump.row(row) = z.jumps.transpose();
      for (std::size_t k = 0; k < loads.size(); ++k)
        op.observed.per_load(row, static_cast<Eigen::Index>(k)) +=
            z.r.dot(loads[k].head(dofs.n_bulk()));
    }
  }
}

}  // namespace

FaultOperator solved_operator(const StuckBulk& bulk, std::shared_ptr<const Compliance> compliance,
                              const RunContext& context) {
  const BulkProblem& problem = bulk.problem();
  FaultOperator op;
  op.geometry = fault_geometry(problem.mesh, problem.materials, bulk.dofs(), problem.half_domain);
  op.compliance = std::move(compliance);
  op.n_unknowns = bulk.dofs().n_unknowns();
  op.loads.traction.resize(op.geometry.n_dofs, std::ssize(problem.loads));
  std::vector<Eigen::VectorXd> loads;
  for (int k = 0; k < static_cast<int>(problem.loads.size()); ++k) {
    context.stop.throw_if_requested("condensing the loads");
    loads.push_back(unit_load(problem, bulk.dofs(), k));
    op.loads.keys.push_back(problem.loads[static_cast<std::size_t>(k)].key);
    op.loads.traction.col(k) = bulk.respond(loads.back()).jumps.cwiseQuotient(op.geometry.dof_area);
  }
  observe(bulk, loads, op, context.stop);
  return op;
}

Eigen::Matrix3Xd solved_displacement(const StuckBulk& bulk, const std::vector<double>& load_factors,
                                     const Eigen::VectorXd& jump) {
  const BulkProblem& problem = bulk.problem();
  const DofMap& dofs = bulk.dofs();
  FAULTSIM_DEMAND(load_factors.size() == problem.loads.size(), load_factors.size(), " factors for ",
                  problem.loads.size(), " loads");
  Eigen::VectorXd force = -bulk.jump_forces(jump);
  for (std::size_t k = 0; k < load_factors.size(); ++k) {
    if (load_factors[k] != 0)
      force += load_factors[k] * unit_load(problem, dofs, static_cast<int>(k));
  }
  Eigen::VectorXd x(dofs.n_unknowns());
  x << bulk.respond(force).r, jump;
  return nodal_displacement(problem.mesh, dofs, x, load_factors);
}

}  // namespace faultsim
