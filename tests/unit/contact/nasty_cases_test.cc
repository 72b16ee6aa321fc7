// The cases known to make contact solvers fail, by name.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/contact/step_cutter.h"
#include "tests/unit/contact/contact_fixture.h"
#include "tests/unit/contact/depleted_fault.h"

namespace faultsim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

CoulombLaw coulomb(double coefficient, double cohesion = 0) {
  return {WeakeningLaw::angle, cohesion, std::atan(coefficient), std::atan(coefficient), 1};
}

/// One node, one load step from zero load; unit area.
struct OneNode {
  OneNode(const Eigen::MatrixXd& h, const CoulombLaw& law)
      : op(make_operator(1, static_cast<int>(h.rows()) - 1, Eigen::VectorXd::Ones(1))),
        laws(same_law(op, law)),
        state(initial_state(op)),
        locked(Eigen::VectorXd::Zero(h.rows())) {
    set_h(op, h);
  }
  ContactReport go_to(const Eigen::VectorXd& after) {
    ContactSolver solver(op, laws, {});
    const ContactState before = state;
    const ContactReport report = solver.solve_step(locked, after, state);
    if (report.outcome != Outcome::converged) return report;
    const bool at_once = report.counts.sub_steps == 1;
    const Verdict verdict = judged(op, laws, locked, after, before, state, at_once);
    EXPECT_LT(verdict.relative.largest(), 1e-7);
    locked = after;
    return report;
  }
  FaultOperator op;
  ContactLaws laws;
  ContactState state;
  Eigen::VectorXd locked;
};

TEST(NastyContact, OpensWithoutCohesionAndCarriesNothing) {
  const Eigen::Matrix3d h = Eigen::Vector3d(4, 2, 2).asDiagonal();
  OneNode node(h, coulomb(0.6));
  ASSERT_EQ(node.go_to(Eigen::Vector3d(1, 0.5, -0.3)).outcome, Outcome::converged);
  EXPECT_EQ(node.state.state[0], FaultState::open);
  EXPECT_LT(node.state.traction.norm(), 1e-15);
  EXPECT_LT((node.state.jump - Eigen::Vector3d(0.25, 0.25, -0.15)).norm(), 1e-15);
  EXPECT_TRUE(node.state.cohesion_lost[0]);
}

TEST(NastyContact, ClosesAgainWithoutItsCohesion) {
  for (const bool keep : {false, true}) {
    OneNode node(Eigen::Vector2d(4, 2).asDiagonal(), coulomb(0.5, 3));
    node.laws[0].cohesion_after_opening = keep;
    ASSERT_EQ(node.go_to(Eigen::Vector2d(-1, 3)).outcome, Outcome::converged);
    EXPECT_EQ(node.state.state[0], FaultState::stick);  // 3 < 3 + 0.5
    ASSERT_EQ(node.go_to(Eigen::Vector2d(1, 0)).outcome, Outcome::converged);
    EXPECT_EQ(node.state.state[0], FaultState::open);
    ASSERT_EQ(node.go_to(Eigen::Vector2d(-1, 3)).outcome, Outcome::converged);
    EXPECT_EQ(node.state.jump[0], 0);  // not 1e-17
    EXPECT_NEAR(node.state.traction[1], keep ? 3 : 0.5, 1e-14);
    EXPECT_EQ(node.state.state[0], keep ? FaultState::stick : FaultState::slip);
  }
}

TEST(NastyContact, SlidesWithoutFriction) {
  OneNode node(Eigen::Vector3d(4, 2, 2).asDiagonal(), coulomb(0));
  ASSERT_EQ(node.go_to(Eigen::Vector3d(-1, 2, 1)).outcome, Outcome::converged);
  EXPECT_LT(node.state.traction.tail<2>().norm(), 1e-15);
  EXPECT_LT((node.state.jump - Eigen::Vector3d(0, 1, 0.5)).norm(), 1e-15);
}

TEST(NastyContact, RestsUnderNoLoadAtAll) {
  OneNode node(Eigen::Vector3d(4, 2, 2).asDiagonal(), coulomb(0));
  ASSERT_EQ(node.go_to(Eigen::Vector3d(0, 0, 0)).outcome, Outcome::converged);
  EXPECT_EQ(node.state.state[0], FaultState::stick);
}

TEST(NastyContact, ResolvesTheCycleOfACohesiveNodeThatOpensAndCloses) {
  // Closed, cohesion holds the shear but t'_N > 0; open, the release of the shear closes it. Having
  // failed in tension, it slips without cohesion: t'_T = 5 − 2s, t'_N = 0.1 − s.
  const Eigen::Matrix2d h{{2, 1}, {1, 2}};
  OneNode node(h, coulomb(0.6, 10));
  ASSERT_EQ(node.go_to(Eigen::Vector2d(0.1, 5)).outcome, Outcome::converged);
  const double slip = (5 + 0.1 * 0.6) / (2 + 0.6);
  EXPECT_NEAR(node.state.jump[1], slip, 1e-12);
  EXPECT_EQ(node.state.jump[0], 0);
  EXPECT_TRUE(node.state.cohesion_lost[0]);
}

TEST(NastyContact, SaysWhyThereIsNoSolutionAndKeepsTheState) {
  const Eigen::Matrix2d h{{2, 1}, {1, 2}};
  OneNode node(h, coulomb(0.6, 10));
  node.laws[0].cohesion_after_opening = 1;  // so that the cycle above has no way out
  ASSERT_EQ(node.go_to(Eigen::Vector2d(-1, 1)).outcome, Outcome::converged);
  const ContactState before = node.state;
  const ContactReport report = node.go_to(Eigen::Vector2d(0.1, 5));
  EXPECT_EQ(report.outcome, Outcome::unconverged);
  EXPECT_NE(report.reason.find("nodes open in stick"), std::string::npos) << report.reason;
  EXPECT_NE(report.reason.find("worst: fault 'main' at x = 0 m, y = 0 m, depth = 2000 m"),
            std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find("; last search: "), std::string::npos) << report.reason;
  EXPECT_NE(report.reason.find("residual "), std::string::npos) << report.reason;
  EXPECT_EQ(node.state.jump, before.jump);
  EXPECT_EQ(node.state.traction, before.traction);
  EXPECT_EQ(node.state.cohesion_lost, before.cohesion_lost);
}

TEST(NastyContact, AcceptsNodesWithoutSomeShearDofs) {
  FaultOperator op = make_operator(3, 1, Eigen::VectorXd::Ones(3));
  op.geometry.nodes[1].dof = {2, -1, -1};  // only the normal: a corner held by two rollers
  op.geometry.nodes[2].dof = {3, 4, -1};   // strike instead of dip
  op.geometry.n_dofs = 5;
  op.geometry.dof_area = Eigen::VectorXd::Ones(5);
  set_h(op, Eigen::MatrixXd::Identity(5, 5) + 0.1 * Eigen::MatrixXd::Ones(5, 5));
  const ContactLaws laws = same_law(op, coulomb(0.5));
  ContactSolver solver(op, laws, {});
  for (const double normal_of_second : {-1.0, 1.0}) {
    ContactState state = initial_state(op);
    Eigen::VectorXd locked(5);
    locked << -1, 2, normal_of_second, -1, -2;
    const ContactState start = state;
    ASSERT_EQ(solver.solve_step(Eigen::VectorXd::Zero(5), locked, state).outcome,
              Outcome::converged);
    EXPECT_LT(judged(op, laws, Eigen::VectorXd::Zero(5), locked, start, state).pascal.largest(),
              1e-7);
    EXPECT_GT(state.jump[1], 0.1);
    EXPECT_LT(state.jump[4], -0.1);
    EXPECT_EQ(state.state[1], normal_of_second > 0 ? FaultState::open : FaultState::stick);
  }
}

TEST(NastyContact, NeverReadsTheColumnsOfNodesAtRest) {
  DepletedFault fault = depleted_fault(60, 1, false);
  std::vector<ContactState> states[2];
  for (const bool poisoned : {false, true}) {
    ContactSolver solver(fault.op, fault.laws, {});
    ContactState state = initial_state(fault.op);
    Eigen::VectorXd before = Eigen::VectorXd::Zero(fault.op.geometry.n_dofs);
    for (const Eigen::VectorXd& locked : fault.locked) {
      ASSERT_EQ(solver.solve_step(before, locked, state).outcome, Outcome::converged);
      before = locked;
      states[poisoned].push_back(state);
    }
    if (poisoned) break;
    Eigen::MatrixXd h = fault.op.h();
    int n_poisoned = 0;
    for (const OperatorNode& node : fault.op.geometry.nodes) {
      if (state.jump[node.dof[2]] != 0) continue;
      h.col(node.dof[0]).setConstant(kNaN);
      h.col(node.dof[2]).setConstant(kNaN);
      ++n_poisoned;
    }
    ASSERT_GT(n_poisoned, 5);
    set_h(fault.op, h);
  }
  for (std::size_t step = 0; step < states[0].size(); ++step) {
    // Not the same bits: which nodes were foreseen to join decides the order of the factor.
    EXPECT_LT((states[0][step].jump - states[1][step].jump).norm(),
              1e-12 * (1e-3 + states[0][step].jump.norm()));
  }
}

TEST(NastyContact, RefusesLoadsThatAreNotNumbers) {
  OneNode node(Eigen::Vector2d(4, 2).asDiagonal(), coulomb(0.6));
  EXPECT_THROW(node.go_to(Eigen::Vector2d(-1, kNaN)), InternalError);
  EXPECT_THROW(node.go_to(Eigen::Vector3d(-1, 0, 0)), InternalError);
}

std::vector<ContactState> run_history(const DepletedFault& fault, ContactSolver& solver) {
  std::vector<ContactState> states;
  ContactState state = initial_state(fault.op);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(fault.op.geometry.n_dofs);
  for (const Eigen::VectorXd& locked : fault.locked) {
    const ContactState start = state;
    const ContactReport report = solver.solve_step(before, locked, state);
    EXPECT_EQ(report.outcome, Outcome::converged) << report.reason;
    const Misses miss =
        judged(fault.op, fault.laws, before, locked, start, state, report.counts.sub_steps == 1)
            .pascal;
    EXPECT_LT(miss.largest(), 2) << "Pa, of 2e7";
    EXPECT_LT(miss.equilibrium, 1e-12 * 1e8);
    before = locked;
    states.push_back(state);
  }
  return states;
}

TEST(NastyContact, GivesTheSameBitsEachTime) {
  for (const int n_shear : {1, 2}) {
    for (const bool weakening : {false, true}) {
      const DepletedFault fault = depleted_fault(60, n_shear, weakening);
      ContactSolver solver(fault.op, fault.laws, {});
      const auto first = run_history(fault, solver);
      const auto again = run_history(fault, solver);  // the solver has a past
      ContactSolver fresh(fault.op, fault.laws, {});
      const auto other = run_history(fault, fresh);
      for (std::size_t i = 0; i < first.size(); ++i) {
        ASSERT_EQ(first[i].jump, again[i].jump) << i;
        ASSERT_EQ(first[i].traction, again[i].traction) << i;
        ASSERT_EQ(first[i].jump, other[i].jump) << i;
      }
    }
  }
}

TEST(NastyContact, FastRoadAgreesWithNewton) {
  DepletedFault fault = depleted_fault(80, 1, false);
  ContactSolver fast(fault.op, fault.laws, {});
  const auto scalar = run_history(fault, fast);
  // A weakening so slight that it changes nothing keeps the solver off the fast path.
  for (CoulombLaw& law : fault.laws) {
    law.dynamic_friction_angle = law.static_friction_angle * (1 - 1e-15);
    law.slip_weakening_distance = 1e3;
  }
  ASSERT_NE(fault.laws[0].dynamic_friction_angle, fault.laws[0].static_friction_angle);
  ContactSolver slow(fault.op, fault.laws, {});
  const auto general = run_history(fault, slow);
  int n_slip = 0;
  for (std::size_t i = 0; i < scalar.size(); ++i) {
    EXPECT_LT((scalar[i].jump - general[i].jump).norm(), 1e-10 * (1e-2 + scalar[i].jump.norm()));
    EXPECT_EQ(scalar[i].state, general[i].state) << i;
    for (const FaultState s : scalar[i].state) n_slip += s == FaultState::slip;
  }
  EXPECT_GT(n_slip, 100);
}

TEST(NastyContact, GivesSymmetricAnswersToSymmetricProblems) {
  constexpr int n = 41;
  FaultOperator op = make_operator(n, 1, Eigen::VectorXd::Ones(n));
  Eigen::MatrixXd h = half_space_matrix(op, 1, 0);
  Eigen::MatrixXd mirrored(2 * n, 2 * n);
  const auto mirror = [](int i) { return 2 * (n - 1 - i / 2) + i % 2; };
  for (int i = 0; i < 2 * n; ++i) {
    for (int j = 0; j < 2 * n; ++j) mirrored(i, j) = 0.5 * (h(i, j) + h(mirror(i), mirror(j)));
  }
  set_h(op, mirrored);
  const ContactLaws laws = same_law(op, coulomb(0.6));
  ContactSolver solver(op, laws, {});
  ContactState state = initial_state(op);
  Eigen::VectorXd locked(2 * n);
  for (int k = 0; k < n; ++k) {
    locked[2 * k] = -10;
    locked[2 * k + 1] = 8 * std::exp(-0.01 * (k - 20) * (k - 20));
  }
  ASSERT_EQ(solver.solve_step(Eigen::VectorXd::Zero(2 * n), locked, state).outcome,
            Outcome::converged);
  EXPECT_GT(state.jump.maxCoeff(), 0.1);
  for (int i = 0; i < 2 * n; ++i) EXPECT_NEAR(state.jump[i], state.jump[mirror(i)], 1e-13);
}

// V7, tiny contact problems u = W r + q with r in the friction cone: here u = g and r = −t', so
// that H/A = W⁻¹ and t_L = W⁻¹ q.
TEST(NastyContact, SolvesTheTinyProblemsOfContactLibraries) {
  const Eigen::Matrix3d w{{15, -1, -2}, {-1, 14, 1}, {-2, 1, 16}};
  const Eigen::Vector3d q(-1, 2, 3);
  OneNode node(w.inverse(), coulomb(0.1));
  ASSERT_EQ(node.go_to(-(w.inverse() * -q)).outcome, Outcome::converged);
  EXPECT_EQ(node.state.state[0], FaultState::slip);
  EXPECT_NEAR(node.state.traction.norm(), 0.0660233441967, 1e-9);
  EXPECT_NEAR(-node.state.traction[0], 0.0656956828977, 1e-9);
  EXPECT_NEAR(node.state.jump.norm(), 3.35274260167, 1e-8);

  FaultOperator op = make_operator(3, 2, Eigen::VectorXd::Ones(3));
  set_h(op, Eigen::MatrixXd::Identity(9, 9));
  const ContactLaws laws = same_law(op, coulomb(0.1));
  ContactSolver solver(op, laws, {});
  ContactState state = initial_state(op);
  const Eigen::VectorXd load = Eigen::Vector3d(-1, 1, 3).replicate(3, 1);
  ASSERT_EQ(solver.solve_step(Eigen::VectorXd::Zero(9), load, state).outcome, Outcome::converged);
  EXPECT_NEAR(state.jump.norm(), 5.30402049429, 1e-9);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(state.traction[3 * k], -1, 1e-12);
}

/// Parts of a step in which one of the smallest is hard: whatever is larger and holds it fails.
constexpr int n_parts(int most_cuts, int hard) {
  int n = 0;
  const auto advance = [&](int from, int width) {
    if (width > 1 && from <= hard && hard < from + width) return false;
    ++n;
    return true;
  };
  return walk_in_parts(most_cuts, advance, [](int) { return false; }) ? n : -1;
}

/// 2^30 of the smallest parts are a step at the least onset_tolerance. By the compiler, to whom an
/// integer that overflows is an error.
TEST(NastyContact, TheFinestPartsOfAStepDoNotOverflow) {
  static_assert(n_parts(30, -1) == 2);
  static_assert(n_parts(30, 0) == 31);
  static_assert(n_parts(30, (1 << 30) - 1) == 31);
  static_assert(n_parts(3, 0) == 4 && n_parts(3, 5) == 4 && n_parts(0, 0) == 1);
}

}  // namespace
}  // namespace faultsim
