#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/elasticity/bulk_problem.h"
#include "simulator/linalg/cholesky.h"
#include "simulator/model/fault_operator.h"
#include "simulator/model/influence.h"

namespace faultsim {

/// Cells of a mesh as an influence block lists them. @pre they are cells of the problem's mesh.
std::vector<InfluenceCell> influence_cells(const BulkProblem& problem,
                                           const std::vector<int>& cells);

/// The factorised bulk of one family: kept while displacement fields, or the creep of salt, still
/// need it.
class CondensedBulk {
 public:
  /// Orders jump unknowns last, factorises K (blocks that faults cut loose get D > 0 on their
  /// jumps, taken off H again), checks H. Throws InputError naming a floating block that nothing
  /// holds, Interrupted when the context says so; so do the other two that take one.
  CondensedBulk(std::shared_ptr<const BulkProblem> problem, const RunContext& context);
  CondensedBulk(BulkProblem problem, const RunContext& context)
      : CondensedBulk(std::make_shared<const BulkProblem>(std::move(problem)), context) {}
  ~CondensedBulk();
  /// H = K_gg − K_gr K_rr⁻¹ K_rg, L_k = A⁻¹(f_g − K_gr K_rr⁻¹ f_r), observation rows; fingerprint
  /// left empty. One right-hand side at a time, so that the bits do not depend on what else is
  /// asked.
  FaultOperator condense(const RunContext& context = {});
  /// The influence of cells of the mesh, names left empty: f_c = Pᵀ ∫_c div v, one forward
  /// substitution per cell, P_c = A⁻¹ (f_g − K_gr K_rr⁻¹ f_r); one back-solve per observation row,
  /// K_rr z = q_r, O_c = z·f_c. The bits of a cell do not depend on the others.
  InfluenceBlock influence(const std::vector<int>& cells, const RunContext& context);
  /// f_c of cells, N: (unknown, force) each.
  std::vector<SparseLoad> dilatations(const std::vector<int>& cells) const;
  /// Displacement of all mesh nodes for given load factors and jumps: 3 x n_nodes, m.
  Eigen::Matrix3Xd displacement(const std::vector<double>& load_factors,
                                const Eigen::VectorXd& jump);

  /// Half of a back-solve for nodal forces that are not a load of the family (n_unknowns, N), and
  /// its two uses.
  Eigen::VectorXd forward(const Eigen::VectorXd& force);
  /// The locked traction A⁻¹ (f_g − K_gr K_rr⁻¹ f_r) of that force, n_dofs, Pa.
  Eigen::VectorXd locked_traction(const Eigen::VectorXd& forward) const;
  /// Displacement of all mesh nodes for that force, load factors and jumps, m. @pre condense() was
  /// called.
  Eigen::Matrix3Xd displacement(Eigen::VectorXd forward, const std::vector<double>& load_factors,
                                const Eigen::VectorXd& jump);
  const BulkProblem& problem() const;
  const DofMap& dofs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
