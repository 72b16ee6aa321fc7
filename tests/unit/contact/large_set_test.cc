// More sliding nodes than are solved for directly: the same solution as with everything exact, at
// the tolerance, step by step as load grows, turns and comes back.
#include <gtest/gtest.h>

#include "simulator/common/thread_team.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

struct LargeFault {
  explicit LargeFault(int n = 260) : n_nodes(n) {
    set_h(op, 1e8 * half_space_matrix(op, 1, 0.2));
    const int dofs = op.geometry.n_dofs;
    Eigen::VectorXd start(dofs), change(dofs), across = Eigen::VectorXd::Zero(dofs);
    for (int k = 0; k < n_nodes; ++k) {
      const double x = (k - 0.5 * n_nodes) / (0.5 * n_nodes);
      start.segment<3>(3 * k) = Eigen::Vector3d(-1e7, 1e6 * x, 2e6);
      change.segment<3>(3 * k) = Eigen::Vector3d(4e6, 1e6, 6e6 * (1 - x * x));
      across[3 * k + 1] = 2e6 * (1 - x);
    }
    for (const double factor : {0.0, 0.4, 0.7, 1.0, 0.8, -0.6, 1.1}) {
      locked.push_back(start + factor * change + factor * factor * across);
    }
  }
  int n_nodes;
  FaultOperator op = make_operator(n_nodes, 2, Eigen::VectorXd::Ones(n_nodes));
  const ContactLaws laws = same_law(op, {WeakeningLaw::angle, 0, std::atan(0.5), std::atan(0.5)});
  std::vector<Eigen::VectorXd> locked;
};

/// @returns the states after the steps.
std::vector<ContactState> history(const LargeFault& fault, ContactSolver& solver) {
  std::vector<ContactState> states = {initial_state(fault.op)};
  Eigen::VectorXd before = Eigen::VectorXd::Zero(fault.op.geometry.n_dofs);
  for (const Eigen::VectorXd& locked : fault.locked) {
    ContactState state = states.back();
    const ContactReport report = solver.solve_step(before, locked, state);
    EXPECT_EQ(report.outcome, Outcome::converged) << report.reason;
    EXPECT_EQ(report.counts.sub_steps, 1);
    const Misses miss = judged(fault.op, fault.laws, before, locked, states.back(), state).pascal;
    EXPECT_LT(miss.largest(), 0.2) << "Pa: 1e-8 of the tractions, times two";
    EXPECT_LT(miss.equilibrium, 1e-6);
    states.push_back(state);
    before = locked;
  }
  return states;
}

TEST(LargeSet, SlidesAtItsLimitTurnsAndComesBack) {
  const LargeFault fault;
  int iterations = 0, krylov = 0, largest = 0;
  ContactWatch watch;
  watch.tried = [&](const SubStepTrace& trace) {
    for (const SubStepTrace::Search& search : trace.searches) {
      iterations += search.history.iterations;
      for (const SearchIteration& iteration : search.history.last) {
        krylov += std::max(iteration.krylov, 0);
        largest = std::max(largest, iteration.n_slip);
      }
    }
  };
  ContactSolver solver(fault.op, fault.laws, {}, watch);
  history(fault, solver);
  EXPECT_GT(largest, 100);    // beyond what is factorised
  EXPECT_GT(krylov, 10);      // so GMRES was at work,
  EXPECT_LT(krylov, 330);     // with a factor that helps,
  EXPECT_LT(iterations, 45);  // and Newton does not mind
}

TEST(LargeSet, GivesTheSameBitsByAnyNumberOfThreads) {
  const LargeFault fault(420);
  ContactSolver alone(fault.op, fault.laws, {});
  const std::vector<ContactState> expected = history(fault, alone);
  for (const int n_threads : {2, 3}) {
    ThreadTeam team(n_threads);
    ContactWatch watch;
    watch.team = &team;
    ContactSolver shared(fault.op, fault.laws, {}, watch);
    const std::vector<ContactState> states = history(fault, shared);
    EXPECT_GT(team.n_works(), 50);
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_EQ(states[i].jump, expected[i].jump) << i;
      EXPECT_EQ(states[i].traction, expected[i].traction) << i;
    }
  }
}

// What one history leaves in a solver has no say in the next.
TEST(LargeSet, GivesTheSameBitsWhateverRanBefore) {
  const LargeFault fault;
  ContactSolver solver(fault.op, fault.laws, {});
  const std::vector<ContactState> first = history(fault, solver);
  const std::vector<ContactState> again = history(fault, solver);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].jump, again[i].jump) << i;
    EXPECT_EQ(first[i].traction, again[i].traction) << i;
  }
}

}  // namespace
}  // namespace faultsim
