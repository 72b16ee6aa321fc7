#include "simulator/contact/contact_newton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

// Node 0 carries a thousand times what node 1 carries. Solved exactly, it slips by 2 mm: so little
// for its load that it is rounded to rest, which hands node 1 a traction of four of its tolerances.
struct TwoNodes {
  TwoNodes() {
    set_h(op, Eigen::Matrix4d{{4, 0, 0, 0}, {0, 4, 0, 2}, {0, 0, 4, 0}, {0, 2, 0, 4}});
    step.start = &start;
    step.trial = Eigen::Vector4d(-2000, 1000 + 4 * 0.002 + 2 * 1, -2, 1 + 2 * 0.002 + 4 * 1);
    step.traction = step.locked = step.trial;
    step.increment = Eigen::Vector4d::Zero();
    step.state = start.state;
    step.cohesive = {1, 1};
    step.tolerance = Eigen::Vector2d(1, 1e-3);
  }
  FaultOperator op = make_operator(2, 1, Eigen::VectorXd::Ones(2));
  const ContactLaws laws = same_law(op, {WeakeningLaw::angle, 0, std::atan(0.5), std::atan(0.5)});
  const ContactState start = initial_state(op);
  const ContactOptions options;
  SubStep step;
};

// Newton has to go on from there, to the slip of node 1 alone.
TEST(ContactNewton, TakesNothingThatItsOwnRoundingHasPutOutOfBalance) {
  TwoNodes given;
  ContactProblem problem(given.op, given.laws);
  SubStep& step = given.step;
  const SearchHistory report = ContactNewton(problem, given.options).solve(step);
  EXPECT_TRUE(report.converged());
  EXPECT_EQ(report.iterations, 2);
  EXPECT_EQ(step.increment[1], 0);
  EXPECT_NEAR(step.increment[3], 4.004 / 4, 1e-12);
  for (const int k : {0, 1}) EXPECT_LT(check_node(problem, step, k).worst(), step.tolerance[k]);
}

/// What is no number is no equilibrium, wherever it stands.
TEST(NodeViolation, HidesNoNan) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (double NodeViolation::*one :
       {&NodeViolation::tension, &NodeViolation::penetration, &NodeViolation::over_limit,
        &NodeViolation::below_limit, &NodeViolation::misaligned, &NodeViolation::open_traction}) {
    NodeViolation violation{1, 1, 1, 1, 1, 1};
    violation.*one = 2;
    EXPECT_EQ(violation.worst(), 2);
    violation.*one = kNan;
    EXPECT_TRUE(std::isnan(violation.worst()));
    EXPECT_TRUE(std::isnan(violation.over(1)));
  }
  EXPECT_EQ(NodeViolation().over(0), 0) << "a free surface of no strength has no tolerance";
  TwoNodes given;
  const ContactProblem problem(given.op, given.laws);
  for (const FaultState state : {FaultState::slip, FaultState::open}) {
    for (const auto member : {&SubStep::traction, &SubStep::increment}) {
      for (const int dof : {2, 3}) {
        SubStep step = given.step;
        step.state[1] = state;
        (step.*member)[dof] = kNan;
        EXPECT_TRUE(std::isnan(check_node(problem, step, 1).worst())) << dof;
        EXPECT_FALSE(std::isnan(check_node(problem, step, 0).worst()));
      }
    }
  }
}

TEST(ContactNewton, StopsWhenItIsAsked) {
  TwoNodes given;
  ContactProblem problem(given.op, given.laws);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(ContactNewton(problem, given.options, StopToken(stop)).solve(given.step),
               Interrupted);
}

TEST(SearchHistory, KeepsTheLastIterationsAndTheBest) {
  SearchHistory history;
  for (int i = 1; i <= 1000; ++i) history.add({.residual = std::abs(i - 300) + 0.5, .n_slip = i});
  EXPECT_EQ(history.iterations, 1000);
  EXPECT_GE(history.last.size(), SearchHistory::kMost);
  EXPECT_LE(history.last.size(), 2 * SearchHistory::kMost);
  EXPECT_EQ(history.last.back().n_slip, 1000);
  EXPECT_EQ(history.best, 0.5);
  EXPECT_EQ(history.best_at, 300);
}

}  // namespace
}  // namespace faultsim
