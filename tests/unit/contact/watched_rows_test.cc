#include "simulator/contact/watched_rows.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

/// Sixty closed nodes at a tenth of their limit, in a sub-step of which nothing moved yet.
struct Quiet {
  Quiet() : start(initial_state(op)) {
    set_h(op, Eigen::MatrixXd::Identity(op.geometry.n_dofs, op.geometry.n_dofs));
    sub_step.start = &start;
    sub_step.trial.setZero(op.geometry.n_dofs);
    for (int k = 0; k < kNodes; ++k) {
      sub_step.trial[normal(k)] = -10e6;
      sub_step.trial[normal(k) + 2] = 0.1 * 6e6;
    }
    sub_step.traction = sub_step.trial;
    sub_step.increment.setZero(op.geometry.n_dofs);
    sub_step.state.assign(kNodes, FaultState::stick);
    sub_step.cohesive.assign(kNodes, 1);
  }
  static int normal(int k) { return 3 * k; }
  std::vector<int> near() {
    const ContactProblem problem(op, laws);
    WatchedRows watched(problem);
    watched.watch_near_limit(sub_step);
    return watched.nodes();
  }

  static constexpr int kNodes = 60;
  FaultOperator op = make_operator(kNodes, 2, Eigen::VectorXd::Ones(kNodes));
  const ContactLaws laws =
      same_law(op, {WeakeningLaw::coefficient, 0, std::atan(0.6), std::atan(0.6), 1});
  ContactState start;
  SubStep sub_step;
};

TEST(WatchedRows, AreAllUntilFewWillDo) {
  Quiet given;
  const ContactProblem problem(given.op, given.laws);
  WatchedRows watched(problem);
  EXPECT_TRUE(watched.all());
  EXPECT_EQ(watched.nodes().size(), 60u);
  ASSERT_EQ(watched.rows().size(), 1u);
  EXPECT_EQ(watched.rows()[0].n, 180);
  watched.watch_near_limit(given.sub_step);
  EXPECT_FALSE(watched.all());
  EXPECT_TRUE(watched.nodes().empty());
  EXPECT_TRUE(watched.rows().empty());
  watched.watch_all();
  EXPECT_EQ(watched.nodes().size(), 60u);
}

TEST(WatchedRows, HoldWhatMovesAndWhatIsNearItsLimitOrItsOpening) {
  Quiet given;
  given.sub_step.state[3] = FaultState::slip;
  given.sub_step.state[50] = FaultState::open;
  given.sub_step.traction[Quiet::normal(7) + 1] = 0.85 * 6e6;  // of strike
  given.sub_step.traction[Quiet::normal(8) + 2] = 0.75 * 6e6;  // too far
  given.sub_step.traction[Quiet::normal(20)] = -1.5e6;         // unloaded by most
  given.sub_step.traction[Quiet::normal(20) + 2] = 0;
  EXPECT_EQ(given.near(), (std::vector<int>{3, 7, 20, 50}));
}

TEST(WatchedRows, AreRangesThatHoldEachRowOfTheirNodesOnce) {
  Quiet given;
  for (const int k : {2, 3, 6, 30, 59}) given.sub_step.state[k] = FaultState::slip;
  const ContactProblem problem(given.op, given.laws);
  WatchedRows watched(problem);
  watched.watch_near_limit(given.sub_step);
  std::vector<int> times(180, 0);
  for (const RowRange& part : watched.rows())
    for (int r = part.first; r < part.first + part.n; ++r) ++times.at(r);
  for (const int k : watched.nodes())
    for (const int dof : given.op.geometry.nodes[k].dof) EXPECT_EQ(times[dof], 1) << k;
  for (const int n : times) EXPECT_LE(n, 1);
  EXPECT_EQ(watched.rows().size(), 3u);  // 2 to 6 in one
  EXPECT_EQ(times[Quiet::normal(30) - 1], 0);
}

}  // namespace
}  // namespace faultsim
