#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "simulator/contact/contact_export.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {

/// A problem u = W r + q as a load step of ours from rest: H = W⁻¹, A = 1, and the traction if
/// nothing moves, t = H q. All in the units of the problem.
struct ConeStep {
  FaultOperator op;
  ContactLaws laws;
  LoadStepProblem step;
};

inline ConeStep cone_step(const FrictionalContactProblem& problem) {
  const int n_contacts = problem.n_contacts();
  const auto n = problem.w.rows();
  ConeStep made{
      make_operator(n_contacts, problem.dimension - 1, Eigen::VectorXd::Ones(n_contacts)), {}, {}};
  const Eigen::MatrixXd h = problem.w.llt().solve(Eigen::MatrixXd::Identity(n, n));
  set_h(made.op, 0.5 * (h + h.transpose()));
  for (int k = 0; k < n_contacts; ++k) {
    const double angle = std::atan(problem.friction[k]);
    made.laws.push_back({WeakeningLaw::coefficient, 0, angle, angle, 1});
  }
  made.step.before = Eigen::VectorXd::Zero(n);
  made.step.after = made.op.h() * problem.q;
  made.step.start = initial_state(made.op);
  return made;
}

/// The end state in the variables of the problem: u = g, r = −t'.
inline FrictionalContactSolution cone_solution(const ContactState& end) {
  return {end.jump, -end.traction};
}

}  // namespace faultsim
