#include "simulator/contact/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {

ContactProblem::ContactProblem(const FaultOperator& fault_operator, const ContactLaws& contact_laws,
                               ThreadTeam* shared_by)
    : op(fault_operator),
      team(shared_by),
      compliance(*fault_operator.compliance),
      laws(contact_laws) {
  const auto& geometry = op.geometry;
  const std::size_t n = geometry.nodes.size();
  FAULTSIM_DEMAND(contact_laws.size() == n, "laws for ", contact_laws.size(), " of ", n, " nodes");
  FAULTSIM_DEMAND(
      geometry.dof_area.size() == geometry.n_dofs && compliance.size() == geometry.n_dofs,
      "n_dofs ", geometry.n_dofs, " areas ", geometry.dof_area.size(), " H ", compliance.size());
  FAULTSIM_DEMAND(n == 0 || geometry.dof_area.minCoeff() > 0, "smallest area ",
                  geometry.dof_area.minCoeff());
  inverse_area = geometry.dof_area.cwiseInverse();
  columns_.reserve(static_cast<std::size_t>(geometry.n_dofs));
  nodes.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    ContactNode& node = nodes[k];
    FAULTSIM_DEMAND(geometry.nodes[k].dof[0] >= 0, "node ", k, " has no normal dof");
    for (const int dof : geometry.nodes[k].dof) {
      if (dof < 0) continue;
      FAULTSIM_DEMAND(dof < geometry.n_dofs, "dof ", dof, " of ", geometry.n_dofs);
      const auto c = static_cast<std::size_t>(node.n_dofs++);
      node.dof[c] = dof;
      node.inverse_area[c] = inverse_area[dof];
    }
    node.law = &laws[k];
    const bool weakens = node.law->weakens();
    may_jump = may_jump || weakens || !contact_laws[k].cohesion_after_slip;
    if (weakens || node.n_dofs > 2) scalar = false;
  }
}

double ContactProblem::stiffness(const ContactNode& node, int component) const {
  return compliance.diagonal(node.dof[component]) * node.inverse_area[component];
}

void ContactProblem::subtract_product(const Eigen::VectorXd& jump, std::span<const RowRange> rows,
                                      Eigen::VectorXd& traction) {
  columns_.clear();
  for (int j = 0; j < n_dofs(); ++j) {
    if (jump[j] != 0) columns_.push_back(j);
  }
  compliance.subtract_product(columns_, jump, inverse_area, rows, traction, team);
}

bool loses_cohesion(const ContactProblem& problem, const SubStep& sub_step, int k) {
  return sub_step.state[k] == FaultState::slip &&
         problem.nodes[k].law->loses_cohesion_slipping(sub_step.cohesive[k] != 0);
}

double NodeViolation::worst() const {
  double worst = 0;
  for (const double one :
       {tension, penetration, over_limit, below_limit, misaligned, open_traction})
    worst = worse(worst, one);
  return worst;
}

NodeViolation check_node(const ContactProblem& problem, const SubStep& sub_step, int k) {
  const ContactNode& node = problem.nodes[k];
  const ContactState& start = *sub_step.start;
  const double normal = sub_step.traction[node.dof[0]];
  const Eigen::Vector2d shear = shear_part(node, sub_step.traction);
  const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
  const double gap = start.jump[node.dof[0]] + sub_step.increment[node.dof[0]];
  const double drag = node.law->drag(sub_step.per_second);
  NodeViolation violation;
  if (!(gap >= 0)) violation.penetration = -gap * problem.stiffness(node, 0);
  if (gap > 0 || sub_step.state[k] == FaultState::open) {
    violation.open_traction = worse(std::abs(normal), (shear - drag * slip).norm());
    return violation;
  }
  violation.tension = std::max(normal, 0.0);
  if (node.n_dofs == 1) return violation;
  const double shear_norm = shear.norm();
  const double slip_norm = slip.norm();
  const double limit = strength_after(node, sub_step, k).value;
  violation.over_limit = std::max(shear_norm - limit, 0.0);
  if (slip_norm != 0) {
    violation.below_limit = std::max(limit - shear_norm, 0.0);
    const double across = (shear_norm * slip - shear * slip_norm).norm();
    if (across != 0) {
      // A slip so small that it hardly matters has a direction of round-off; it counts in
      // proportion.
      double stiffness = problem.stiffness(node, 1);
      if (node.n_dofs > 2) stiffness = std::max(stiffness, problem.stiffness(node, 2));
      violation.misaligned = across / std::max(slip_norm, 1e-6 * shear_norm / (stiffness + drag));
    }
  }
  return violation;
}

}  // namespace faultsim
