#include "simulator/coupled/linear_steps.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;

TEST(ForcingTerm, FallsWithTheSquareOfWhatNewtonGains) {
  ForcingTerm forcing(1e-2, 1e-14);
  EXPECT_EQ(forcing.next(1), 1e-2) << "nothing is known at first";
  EXPECT_DOUBLE_EQ(forcing.next(1e-2), 0.9e-4);
  EXPECT_DOUBLE_EQ(forcing.next(1e-5), 0.9e-6);
  EXPECT_EQ(forcing.next(1e-3), 1e-2) << "a set that changed is a new beginning";
}

TEST(ForcingTerm, AsksForNoMoreThanTheLoadStep) {
  ForcingTerm forcing(1e-2, 1e-10);
  forcing.next(5);
  EXPECT_DOUBLE_EQ(forcing.next(5e-7), 1e-3) << "then the residual is 1e-10 of the first";
  EXPECT_DOUBLE_EQ(forcing.next(5e-9), 0.1);
  EXPECT_DOUBLE_EQ(forcing.next(5e-11), 0.1) << "which confirms that it is there";
}

TEST(ForcingTerm, KnowsWhatTheStepAskedForWhereNewtonStartsNearby) {
  ForcingTerm forcing(1e-2, 1e-10, 1e4);
  EXPECT_EQ(forcing.next(1), 1e-2);
  EXPECT_DOUBLE_EQ(forcing.next(1e-3), 1e-3) << "to 1e-6, a ten thousand-millionth of the load";
}

constexpr SolverChoice kKept{LeadingKind::amg_by_component, SchurKind::rac};

/// A Newton step with these states at the nodes, and what is left of its residual.
struct Step {
  LinearSteps::Solved solved;
  double left;
};

Step solve(LinearSteps& steps, const CoupledExample& example,
           const std::vector<NodeLinearisation>& nodes) {
  const SaddlePoint j = make_saddle_point(example.bulk, nodes);
  const Eigen::VectorXd f = example.bulk.load(0);
  const Eigen::VectorXd g = 1e-3 * j.gram().cwiseSqrt();
  Eigen::VectorXd u, lambda;
  Step step{steps.solve(
                j, f, g, [](double) { return 1e-9; }, u, lambda),
            0};
  const double scale = CoupledSolver(j, kKept).multiplier_scale();
  const Eigen::VectorXd r_u = f - j.leading() * u - j.coupling * lambda;
  const Eigen::VectorXd r_l = scale * (g - j.constraint.transpose() * u);
  step.left = std::hypot(r_u.norm(), r_l.norm()) / std::hypot(f.norm(), scale * g.norm());
  return step;
}

TEST(LinearSteps, KeepThePreconditionerWhereTheSetStays) {
  const CoupledExample example;
  LinearSteps steps(kKept);
  const Step first = solve(steps, example, {}), second = solve(steps, example, {});
  EXPECT_GT(first.solved.setup_seconds, 0);
  EXPECT_EQ(second.solved.setup_seconds, 0);
  EXPECT_EQ(first.solved.report.residuals, second.solved.report.residuals);
}

TEST(LinearSteps, FollowASetThatChangesUntilThatCostsMoreThanANewOne) {
  const CoupledExample example;
  LinearSteps steps(kKept);
  solve(steps, example, {});
  const Step moved = solve(steps, example, example.some_move());
  EXPECT_EQ(moved.solved.setup_seconds, 0);
  EXPECT_LT(moved.left, 1e-6);
  std::vector<NodeLinearisation> open(example.bulk.fault_nodes().size());
  for (NodeLinearisation& node : open) node.state = FaultState::open;
  int n_set_up = 0;
  for (int k = 0; k < 12; ++k) {
    const Step step = solve(steps, example, k % 2 == 0 ? open : example.some_move());
    EXPECT_TRUE(step.solved.report.converged);
    EXPECT_LT(step.left, 1e-6) << k;  // recurrences lose some
    n_set_up += step.solved.setup_seconds > 0;
  }
  EXPECT_GE(n_set_up, 1);
  EXPECT_LT(n_set_up, 12);
}

TEST(LinearSteps, EndWhenTheyAreAskedTo) {
  const CoupledExample example;
  std::atomic<bool> flag = false;
  LinearSteps steps(kKept, StopToken(flag));
  EXPECT_TRUE(solve(steps, example, {}).solved.report.converged);
  flag = true;
  EXPECT_THROW(solve(steps, example, {}), Interrupted);
}

TEST(LinearSteps, SetUpAnewWhatIsNotOnTheSharedMatrix) {
  const CoupledExample example;
  LinearSteps steps({LeadingKind::incomplete_cholesky, SchurKind::lsc});
  for (int k = 0; k < 2; ++k)
    EXPECT_GT(solve(steps, example, example.some_move()).solved.setup_seconds, 0);
}

}  // namespace
}  // namespace faultsim
