#include "simulator/contact/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {

ContactProblem::ContactProblem(const FaultOperator& fault_operator, const ContactLaws& contact_laws)
    : op(fault_operator), laws(contact_laws) {
  const auto& geometry = op.geometry;
  const std::size_t n = geometry.nodes.size();
  FAULTSIM_DEMAND(
      laws.node.size() == n && laws.cumulated.size() == n && laws.keep_cohesion.size() == n,
      "laws for ", laws.node.size(), " of ", n, " nodes");
  FAULTSIM_DEMAND(op.dof_area.size() == geometry.n_dofs && op.h.rows() == geometry.n_dofs &&
                      op.h.cols() == geometry.n_dofs,
                  "n_dofs ", geometry.n_dofs, " areas ", op.dof_area.size(), " H ", op.h.rows());
  FAULTSIM_DEMAND(n == 0 || op.dof_area.minCoeff() > 0, "smallest area ", op.dof_area.minCoeff());
  inverse_area = op.dof_area.cwiseInverse();
  product_.resize(geometry.n_dofs);
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
    const CoulombLaw& law = laws.node[k];
    node.friction = std::tan(law.static_friction_angle);
    node.weakens = law.dynamic_friction_angle != law.static_friction_angle;
    any_weakening = any_weakening || node.weakens;
    if (node.weakens || node.n_dofs > 2) scalar = false;
  }
  may_jump = any_weakening ||
             std::any_of(laws.lose_cohesion_slipping.begin(), laws.lose_cohesion_slipping.end(),
                         [](char loses) { return loses != 0; });
}

LimitShearTraction ContactProblem::strength(int k, bool cohesive, double normal_traction,
                                            double slip) const {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = nodes[i];
  const double normal = std::min(normal_traction, 0.0);
  LimitShearTraction limit;
  if (node.weakens) {
    limit = limit_shear_traction(laws.node[i], normal, slip);
  } else {
    limit = {laws.node[i].cohesion - normal * node.friction, -node.friction, 0};
  }
  if (!cohesive) limit.value -= laws.node[i].cohesion;
  if (normal_traction > 0) limit.d_normal_traction = 0;
  return limit;
}

double ContactProblem::stiffness(const ContactNode& node, int component) const {
  const auto c = static_cast<std::size_t>(component);
  return op.h(node.dof[c], node.dof[c]) * node.inverse_area[c];
}

void ContactProblem::subtract_product(const Eigen::VectorXd& jump, Eigen::VectorXd& traction) {
  columns_.clear();
  for (int j = 0; j < n_dofs(); ++j) {
    if (jump[j] != 0) columns_.push_back(j);
  }
  product_.setZero();
  // Four columns at a time: the sum is bound by loads and stores of the product.
  std::size_t i = 0;
  for (; i + 4 <= columns_.size(); i += 4) {
    const int a = columns_[i], b = columns_[i + 1], c = columns_[i + 2], d = columns_[i + 3];
    product_.noalias() += op.h.col(a) * jump[a] + op.h.col(b) * jump[b] + op.h.col(c) * jump[c] +
                          op.h.col(d) * jump[d];
  }
  for (; i < columns_.size(); ++i) product_.noalias() += op.h.col(columns_[i]) * jump[columns_[i]];
  traction.array() -= product_.array() * inverse_area.array();
}

SlipMeasure slip_measure(bool cumulated, double path_before, const Eigen::Vector2d& slip_before,
                         const Eigen::Vector2d& slip_increment, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d slip = cumulated ? slip_increment : slip_before + slip_increment;
  const double norm = slip.norm();
  const Eigen::Vector2d gradient = norm > 0 ? Eigen::Vector2d(slip / norm) : direction;
  return {cumulated ? path_before + norm : norm, gradient};
}

bool loses_cohesion(const ContactProblem& problem, const SubStep& sub_step, int k) {
  const auto i = static_cast<std::size_t>(k);
  const ContactLaws& laws = problem.laws;
  return !laws.lose_cohesion_slipping.empty() && laws.lose_cohesion_slipping[i] != 0 &&
         sub_step.state[i] == FaultState::slip && sub_step.cohesive[i] != 0 &&
         laws.node[i].cohesion > 0;
}

double NodeViolation::worst() const {
  return std::max({tension, penetration, over_limit, below_limit, misaligned, open_traction});
}

NodeViolation check_node(const ContactProblem& problem, const SubStep& sub_step, int k) {
  const auto i = static_cast<std::size_t>(k);
  const ContactNode& node = problem.nodes[i];
  const ContactState& start = *sub_step.start;
  const double normal = sub_step.traction[node.dof[0]];
  const Eigen::Vector2d shear = shear_part(node, sub_step.traction);
  const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
  const double gap = start.jump[node.dof[0]] + sub_step.increment[node.dof[0]];
  const double damping = sub_step.damping_per_second * problem.damping(k);
  NodeViolation violation;
  if (gap < 0) violation.penetration = -gap * problem.stiffness(node, 0);
  if (gap > 0 || sub_step.state[i] == FaultState::open) {
    violation.open_traction = std::max(std::abs(normal), (shear - damping * slip).norm());
    return violation;
  }
  violation.tension = std::max(normal, 0.0);
  if (node.n_dofs == 1) return violation;
  const double shear_norm = shear.norm();
  const double slip_norm = slip.norm();
  double s = 0;
  if (node.weakens) {
    s = slip_measure(problem.laws.cumulated[i] != 0, start.slip_path[k],
                     shear_part(node, start.jump), slip, slip)
            .value;
  }
  const double limit =
      problem.strength(k, sub_step.cohesive[i] != 0, normal, s).value + damping * slip_norm;
  violation.over_limit = std::max(shear_norm - limit, 0.0);
  if (slip_norm > 0) {
    violation.below_limit = std::max(limit - shear_norm, 0.0);
    const double across = (shear_norm * slip - shear * slip_norm).norm();
    if (across > 0) {
      // A slip so small that it hardly matters has a direction of round-off; it counts in
      // proportion.
      double stiffness = problem.stiffness(node, 1);
      if (node.n_dofs > 2) stiffness = std::max(stiffness, problem.stiffness(node, 2));
      violation.misaligned =
          across / std::max(slip_norm, 1e-6 * shear_norm / (stiffness + damping));
    }
  }
  return violation;
}

}  // namespace faultsim
