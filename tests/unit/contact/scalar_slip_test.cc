#include "simulator/contact/scalar_slip.h"

#include <gtest/gtest.h>

#include "tests/unit/contact/depleted_fault.h"

namespace faultsim {
namespace {

/// One sub-step set up by hand as ContactSolver does it.
SubStep sub_step_of(const DepletedFault& fault, const ContactState& start,
                    const Eigen::VectorXd& locked) {
  const int n = static_cast<int>(fault.op.geometry.nodes.size());
  SubStep step;
  step.start = &start;
  step.locked = locked;
  step.trial = locked - (fault.op.h() * start.jump).cwiseQuotient(fault.op.geometry.dof_area);
  step.traction = step.trial;
  step.increment = Eigen::VectorXd::Zero(locked.size());
  step.state.assign(static_cast<std::size_t>(n), FaultState::stick);
  step.cohesive.assign(static_cast<std::size_t>(n), 1);
  step.tolerance = Eigen::VectorXd::Constant(n, 0.1);
  return step;
}

// ContactSolver would hide a fault of the fast path, as it checks it and falls back on Newton; so
// here it must stand alone, with strong coupling of slip to normal traction and nodes to release.
TEST(ScalarSlip, SolvesAWholeHistoryByItself) {
  DepletedFault fault = depleted_fault(120, 1, false);
  set_h(fault.op, half_space_matrix(fault.op, 6e9, 0.4));
  ContactProblem problem(fault.op, fault.laws);
  const ContactOptions options;
  ScalarSlip scalar(problem, options);
  ContactState state = initial_state(fault.op);
  int n_slip = 0;
  int passes = 0;
  for (std::size_t i = 1; i < fault.locked.size(); ++i) {
    SubStep step = sub_step_of(fault, state, fault.locked[i]);
    const SearchHistory report = scalar.solve(step);
    ASSERT_TRUE(report.converged()) << i;
    for (int k = 0; k < problem.n_nodes(); ++k) {
      ASSERT_LT(check_node(problem, step, k).worst(), 0.2) << i << ' ' << k;
    }
    passes += report.passes;
    state.jump += step.increment;
    for (const FaultState s : step.state) n_slip += s == FaultState::slip;
  }
  EXPECT_GT(n_slip, 200);
  EXPECT_LT(passes, 100);
}

TEST(ScalarSlip, LeavesOpeningToNewton) {
  const DepletedFault fault = depleted_fault(20, 1, false);
  ContactProblem problem(fault.op, fault.laws);
  const ContactOptions options;
  ScalarSlip scalar(problem, options);
  const ContactState state = initial_state(fault.op);
  Eigen::VectorXd locked = fault.locked[0];
  locked[0] = 1e6;
  SubStep step = sub_step_of(fault, state, locked);
  EXPECT_FALSE(scalar.solve(step).converged());
}

}  // namespace
}  // namespace faultsim
