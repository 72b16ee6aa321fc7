#include "simulator/contact/contact_export.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/node_state.h"
#include "simulator/contact/step_report.h"

namespace faultsim {
namespace {

/// A condition that keeps a step from being exported, as one problem of an InputError.
struct Obstacle {
  int count = 0;
  std::size_t first = 0;
  void note(std::size_t node) {
    if (count++ == 0) first = node;
  }
};

int n_shear(const OperatorNode& node) {
  return (node.dof[1] >= 0 ? 1 : 0) + (node.dof[2] >= 0 ? 1 : 0);
}

/// Where the components of the exported problem come from: dof, or −1 for a component that is
/// missing.
std::vector<int> component_dofs(const FaultGeometry& geometry, int dimension) {
  std::vector<int> dofs;
  for (const OperatorNode& node : geometry.nodes) {
    dofs.push_back(node.dof[0]);
    if (dimension == 2) {
      dofs.push_back(node.dof[2] >= 0 ? node.dof[2] : node.dof[1]);
    } else {
      dofs.push_back(node.dof[1]);
      dofs.push_back(node.dof[2]);
    }
  }
  return dofs;
}

double power_of_ten(double value) {
  return value > 0 && std::isfinite(value) ? std::pow(10.0, std::round(std::log10(value))) : 1.0;
}

Eigen::MatrixXd inverse(const FaultOperator& op) {
  const Eigen::LLT<Eigen::MatrixXd> factor(op.h());
  FAULTSIM_DEMAND(factor.info() == Eigen::Success, "H is not positive definite");
  Eigen::MatrixXd w = Eigen::MatrixXd::Identity(op.h().rows(), op.h().cols());
  factor.solveInPlace(w);
  return 0.5 * (w + w.transpose());
}

}  // namespace

ContactLaws frozen_laws(const FaultOperator& op, const ContactLaws& laws, const ContactState& start,
                        Weakening weakening) {
  const ContactProblem problem(op, laws);
  ContactLaws frozen = laws;
  Obstacle cohesion, change;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const NodeLaw& law = *problem.nodes[i].law;
    const FrictionState state = friction_state(op.geometry.nodes[i], start, static_cast<int>(i));
    if (law.cohesion(state.cohesive) > 0) cohesion.note(i);
    frozen[i].cohesion = 0;
    if (!law.weakens()) continue;
    const bool spent =
        laws[i].slip_measure == SlipMeasure::cumulated && law.is_fully_weakened(state);
    if (!spent && weakening == Weakening::refuse) change.note(i);
    const double unit_traction = -1;  // μ = −∂τ_L/∂t'_N is the same at any
    const double friction = -law.strength(unit_traction, {0, 0}, 0, state).d_normal;
    frozen[i].static_friction_angle = frozen[i].dynamic_friction_angle = std::atan(friction);
  }
  std::vector<Problem> problems;
  const auto refuse = [&](const Obstacle& obstacle, const std::string& what,
                          const std::string& cure) {
    if (obstacle.count == 0) return;
    problems.push_back({"", 0,
                        concat(what, " at ", obstacle.count, " of ", laws.size(),
                               " nodes (first: ", place(problem, static_cast<int>(obstacle.first)),
                               "), but a friction cone has no cohesion"),
                        cure});
  };
  refuse(cohesion, "cohesion acts in the step", "set the cohesion to 0");
  refuse(change, "friction may weaken within the step",
         "freeze the strength: every node keeps the friction coefficient that it has at the start "
         "of the step");
  if (!problems.empty()) throw InputError("contact problem", problems);
  return frozen;
}

FrictionalContactProblem frictional_contact_problem(const FaultOperator& op,
                                                    const ContactLaws& frozen,
                                                    const LoadStepProblem& step) {
  const ContactProblem contact(op, frozen);
  FAULTSIM_DEMAND(!contact.laws.any_weakens(), "the strength is not frozen");
  FrictionalContactProblem problem;
  problem.dimension = 2;
  for (const OperatorNode& node : op.geometry.nodes) {
    if (n_shear(node) > 1) problem.dimension = 3;
  }
  const int n = problem.dimension * contact.n_nodes();
  constexpr int kMostRows = 46340;  // its square still is an int of FCLib
  if (n == 0 || n > kMostRows) {
    throw InputError("contact problem", concat("W would have ", n, " rows"),
                     concat("1 to ", kMostRows, " rows can be written; change the mesh"));
  }
  const Eigen::MatrixXd w = inverse(op);
  const Eigen::VectorXd trial = step.start.traction + (step.after - step.before);
  const Eigen::VectorXd free_motion = w * trial.cwiseProduct(op.geometry.dof_area);
  const std::vector<int> dofs = component_dofs(op.geometry, problem.dimension);
  problem.w.setZero(n, n);
  problem.q.setZero(n);
  problem.friction.resize(contact.n_nodes());
  for (int b = 0; b < n; ++b) {
    const int node = b / problem.dimension;
    const int column = dofs[b];
    if (column < 0) {
      const int normal = op.geometry.nodes[node].dof[0];
      problem.w(b, b) = w(normal, normal);
      continue;
    }
    for (int a = 0; a < n; ++a) {
      const int row = dofs[a];
      if (row >= 0) problem.w(a, b) = w(row, column);
    }
    problem.q[b] = free_motion[column];
    if (b % problem.dimension == 0) {
      problem.q[b] += step.start.jump[column];
      problem.friction[node] = contact.nodes[node].law->static_friction();
    }
  }
  problem.displacement_unit = power_of_ten(problem.q.lpNorm<Eigen::Infinity>());
  const double flexibility = problem.w.diagonal().mean();  // m/N
  problem.force_unit = problem.displacement_unit / power_of_ten(flexibility);
  problem.w *= problem.force_unit / problem.displacement_unit;
  problem.q /= problem.displacement_unit;
  return problem;
}

FrictionalContactSolution frictional_contact_solution(const FaultOperator& op,
                                                      const FrictionalContactProblem& problem,
                                                      const LoadStepProblem& step,
                                                      const ContactState& end) {
  const std::vector<int> dofs = component_dofs(op.geometry, problem.dimension);
  const auto n = static_cast<Eigen::Index>(dofs.size());
  FrictionalContactSolution solution{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const int dof = dofs[a];
    if (dof < 0) continue;
    const bool normal = a % problem.dimension == 0;
    const double motion = normal ? end.jump[dof] : end.jump[dof] - step.start.jump[dof];
    solution.u[a] = motion / problem.displacement_unit;
    solution.r[a] = -op.geometry.dof_area[dof] * end.traction[dof] / problem.force_unit;
  }
  return solution;
}

Eigen::VectorXd project_on_friction_cone(const Eigen::VectorXd& x, double friction) {
  const double normal = x[0];
  const double shear = x.tail(x.size() - 1).norm();
  if (shear <= friction * normal) return x;
  Eigen::VectorXd nearest = Eigen::VectorXd::Zero(x.size());
  if (friction * shear <= -normal) return nearest;  // the polar cone
  nearest[0] = (normal + friction * shear) / (1 + friction * friction);
  nearest.tail(x.size() - 1) = friction * nearest[0] / shear * x.tail(x.size() - 1);
  return nearest;
}

double natural_map_error(const FrictionalContactProblem& problem,
                         const FrictionalContactSolution& solution) {
  const Eigen::Index d = problem.dimension;
  double square = 0;
  for (int k = 0; k < problem.n_contacts(); ++k) {
    const double friction = problem.friction[k];
    const Eigen::VectorXd r = solution.r.segment(k * d, d);
    Eigen::VectorXd u = solution.u.segment(k * d, d);
    u[0] += friction * u.tail(d - 1).norm();
    square += (r - project_on_friction_cone(r - u, friction)).squaredNorm();
  }
  return std::sqrt(square);
}

double equilibrium_error(const FrictionalContactProblem& problem,
                         const FrictionalContactSolution& solution) {
  return (solution.u - problem.w * solution.r - problem.q).norm();
}

}  // namespace faultsim
