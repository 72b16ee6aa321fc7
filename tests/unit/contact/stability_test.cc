#include "simulator/contact/stability.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/unit/contact/contact_fixture.h"
#include "tests/unit/contact/depleted_fault.h"

namespace faultsim {
namespace {

/// A patch of n nodes with A = 2 that slips by 1 mm everywhere under t'_N = −1e7 Pa.
struct Patch {
  Patch(int n, int n_shear, double d_c)
      : op(make_operator(n, n_shear, Eigen::VectorXd::Constant(n, 2))) {
    set_h(op, half_space_matrix(op, 1e8, 0));
    laws = same_law(op, {WeakeningLaw::coefficient, 0, std::atan(0.6), std::atan(0.4), d_c});
    start = initial_state(op);
    for (const OperatorNode& node : op.geometry.nodes) start.traction[node.dof[0]] = -1e7;
    step.start = &start;
    step.traction = start.traction;
    step.increment = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    for (const OperatorNode& node : op.geometry.nodes) step.increment[node.dof[2]] = 1e-3;
    step.state.assign(static_cast<std::size_t>(n), FaultState::slip);
    step.cohesive.assign(static_cast<std::size_t>(n), 1);
  }
  FaultOperator op;
  ContactLaws laws;
  ContactState start;
  SubStep step;
};

TEST(StabilityCheck, FindsTheSmallestEigenvalueOfThePatchAtZero) {
  for (const int n_shear : {1, 2}) {
    for (const int n : {1, 2, 15}) {
      const Patch any(n, n_shear, 1);
      Eigen::MatrixXd shear(n, n);
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          shear(i, j) = any.op.h()(any.op.geometry.nodes[static_cast<std::size_t>(i)].dof[2],
                                   any.op.geometry.nodes[static_cast<std::size_t>(j)].dof[2]) /
                        2;
        }
      }
      const double smallest =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(shear).eigenvalues()[0];
      const double critical = 1e7 * 0.2 / smallest;  // d_c with W = smallest eigenvalue
      for (const double factor : {0.999, 1.001}) {
        const Patch patch(n, n_shear, factor * critical);
        const ContactProblem problem(patch.op, patch.laws);
        const StabilityReport report = StabilityCheck(problem).check(patch.step);
        EXPECT_TRUE(report.checked);
        EXPECT_EQ(report.n_slipping, n);
        EXPECT_EQ(report.stable, factor > 1) << n;
      }
    }
  }
}

TEST(StabilityCheck, HasNothingToSayOnceFullyWeakenedOrHealing) {
  Patch patch(5, 1, 0.01);
  for (const OperatorNode& node : patch.op.geometry.nodes) patch.start.jump[node.dof[2]] = 0.02;
  const ContactProblem problem(patch.op, patch.laws);
  EXPECT_FALSE(StabilityCheck(problem).check(patch.step).checked);
  for (const OperatorNode& node : patch.op.geometry.nodes) patch.start.jump[node.dof[2]] = -0.005;
  EXPECT_FALSE(StabilityCheck(problem).check(patch.step).checked);  // s goes from 5 to 4 mm
  for (const OperatorNode& node : patch.op.geometry.nodes) patch.start.jump[node.dof[2]] = -0.0005;
  EXPECT_TRUE(StabilityCheck(problem).check(patch.step).checked);  // through 0 and out again
}

TEST(WeakeningStep, IsCutWhereOnlySmallerStepsShowThatItIsStable) {
  // Each node alone is stable (10 > 8), both weakening at once are not (6 < 8). The first is
  // through before the second starts.
  FaultOperator op = make_operator(2, 1, Eigen::VectorXd::Ones(2));
  Eigen::Matrix4d h = Eigen::Vector4d(20, 10, 20, 10).asDiagonal();
  h(1, 3) = h(3, 1) = -4;
  set_h(op, h);
  const ContactLaws laws =
      same_law(op, {WeakeningLaw::coefficient, 0, std::atan(0.6), std::atan(0.4), 0.25});
  const auto locked = [](double factor) {
    return Eigen::Vector4d(-10, 12 * factor, -10, 5.2 * factor);
  };
  ContactSolver solver(op, laws, {});
  ContactState at_once = initial_state(op);
  const Eigen::Vector4d zero = Eigen::Vector4d::Zero();
  ASSERT_EQ(solver.solve_step(zero, locked(0), at_once).outcome, Outcome::converged);
  ContactState in_steps = at_once;
  const ContactReport report = solver.solve_step(locked(0), locked(1), at_once);
  ASSERT_EQ(report.outcome, Outcome::converged) << report.reason;
  EXPECT_GT(report.counts.sub_steps, 1);
  EXPECT_GT(report.counts.wasted_newton_iterations, 0);
  constexpr int kSteps = 128;
  for (int i = 0; i < kSteps; ++i) {
    ASSERT_EQ(solver.solve_step(locked(i / 128.0), locked((i + 1) / 128.0), in_steps).outcome,
              Outcome::converged);
  }
  EXPECT_GT(at_once.jump[3], 0.02);  // the second node has started
  EXPECT_LT((at_once.jump - in_steps.jump).norm(), 1e-6);
  EXPECT_LT((at_once.traction - in_steps.traction).norm(), 1e-6);
}

TEST(WeakeningStep, EndsOnTheSameBranchWhateverTheStepSize) {
  // From stable to unstable weakening: where a big step converges, small steps arrive at the same.
  int n_converged = 0;
  int n_unstable = 0;
  for (const double d_c : {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 2.0}) {
    DepletedFault fault = depleted_fault(80, 1, true);
    for (CoulombLaw& law : fault.laws) {
      law.slip_weakening_distance = d_c;
      law.dynamic_friction_angle = std::atan(0.45);
    }
    const auto run = [&](int n_steps, ContactState& state) {
      ContactSolver solver(fault.op, fault.laws, {});
      Eigen::VectorXd before = fault.locked[0];
      Outcome outcome =
          solver.solve_step(Eigen::VectorXd::Zero(fault.op.geometry.n_dofs), before, state).outcome;
      for (int i = 1; i <= n_steps && outcome == Outcome::converged; ++i) {
        const Eigen::VectorXd after =
            fault.locked[0] + (fault.locked[10] - fault.locked[0]) * i / n_steps;
        outcome = solver.solve_step(before, after, state).outcome;
        before = after;
      }
      return outcome;
    };
    ContactState coarse = initial_state(fault.op);
    ContactState fine = coarse;
    const Outcome big = run(3, coarse);
    const Outcome small = run(300, fine);
    if (big == Outcome::converged) {
      ++n_converged;
      EXPECT_EQ(small, Outcome::converged) << d_c;
      EXPECT_LT((coarse.jump - fine.jump).norm(), 1e-3 * fine.jump.norm()) << d_c;
    } else {
      EXPECT_EQ(big, Outcome::unstable) << d_c;
      ++n_unstable;
    }
  }
  EXPECT_GE(n_converged, 2);
  EXPECT_GE(n_unstable, 2);
}

}  // namespace
}  // namespace faultsim
