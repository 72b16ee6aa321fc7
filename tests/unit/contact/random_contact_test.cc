// Random problems with dense H: all of stick, slip and open must come out in equilibrium.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include <random>

#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

struct RandomProblem {
  FaultOperator op;
  ContactLaws laws;
  std::vector<Eigen::VectorXd> locked;
};

/// Tractions of order 1e7 Pa, stiffness 1e8 Pa/m. Odd seeds: smooth kernel; even: random dense H.
RandomProblem random_problem(unsigned seed, int n_shear) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int n = 2 + static_cast<int>(engine() % 59);
  Eigen::VectorXd area(n);
  for (double& a : area) a = 1.5 + uniform(engine);
  RandomProblem problem{make_operator(n, n_shear, area), {}, {}};
  const int dofs = problem.op.geometry.n_dofs;
  Eigen::MatrixXd h(dofs, dofs);
  if (seed % 2 == 0) {
    Eigen::MatrixXd b(dofs, dofs);
    for (double& v : b.reshaped()) v = uniform(engine);
    h = b * b.transpose() / dofs + 0.3 * Eigen::MatrixXd::Identity(dofs, dofs);
  } else {
    h = half_space_matrix(problem.op, 1, 0.2);
    for (int i = 0; i < dofs; ++i) h(i, i) *= 1.05 + 0.1 * uniform(engine);
  }
  set_h(problem.op, 1e8 * h);
  problem.laws = same_law(problem.op, {});
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
    CoulombLaw& law = problem.laws[k];
    law.static_friction_angle = law.dynamic_friction_angle =
        engine() % 8 == 0 ? 0 : 0.4 + 0.25 * uniform(engine);
    law.cohesion = engine() % 3 == 0 ? 1e6 * (1 + uniform(engine)) : 0;
  }
  Eigen::VectorXd start(dofs), change(dofs);
  const double tension = seed % 3 == 0 ? 1.6 : 0.7;
  const int stride = 1 + n_shear;
  for (int i = 0; i < dofs; ++i) {
    start[i] = i % stride == 0 ? -1e7 : 2e6 * uniform(engine);
    change[i] = (i % stride == 0 ? tension : 1.0) * 1e7 * uniform(engine);
  }
  for (const double factor : {0.0, 0.3, 0.7, 1.0, 1.3, 0.6, -0.2, -0.8, 0.0, 1.0}) {
    Eigen::VectorXd locked = start + factor * change;
    // Turn the load a little, so that slip directions change from step to step.
    for (int i = 0; i < dofs; ++i) {
      if (i % stride != 0) locked[i] += 1e6 * factor * factor * uniform(engine);
    }
    problem.locked.push_back(locked);
  }
  return problem;
}

struct Totals {
  int n_open = 0, n_slip = 0, n_stick = 0, n_cut = 0, n_failed = 0, iterations = 0,
      n_closed_again = 0;
};

void run(const RandomProblem& problem, Totals& totals, unsigned seed) {
  ContactSolver solver(problem.op, problem.laws, {});
  ContactState state = initial_state(problem.op);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(problem.op.geometry.n_dofs);
  for (std::size_t step = 0; step < problem.locked.size(); ++step) {
    const ContactState start = state;
    const ContactReport report = solver.solve_step(before, problem.locked[step], state);
    if (report.outcome != Outcome::converged) {
      ++totals.n_failed;
      ADD_FAILURE() << "seed " << seed << " step " << step << ": " << report.reason;
      return;
    }
    const bool at_once = report.counts.sub_steps == 1;
    const Verdict verdict =
        judged(problem.op, problem.laws, before, problem.locked[step], start, state, at_once);
    EXPECT_LT(verdict.pascal.largest(), 2) << "Pa, of 1e7; " << seed << ' ' << step;
    EXPECT_LT(verdict.pascal.equilibrium, 1e-4) << seed << ' ' << step;
    EXPECT_LT(verdict.largest_energy(), 1e-7) << seed << ' ' << step;
    for (std::size_t k = 0; k < state.state.size(); ++k) {
      totals.n_open += state.state[k] == FaultState::open;
      totals.n_slip += state.state[k] == FaultState::slip;
      totals.n_stick += state.state[k] == FaultState::stick;
      totals.n_closed_again +=
          state.state[k] != FaultState::open && start.state[k] == FaultState::open;
    }
    totals.n_cut += report.counts.sub_steps > 1;
    totals.iterations += report.counts.newton_iterations;
    before = problem.locked[step];
  }
}

/// @param most_iterations  a few percent above what is needed: a wrong tangent costs more.
void run_all(int n_shear, int most_iterations) {
  Totals totals;
  constexpr unsigned kSeeds = 300;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) run(random_problem(seed, n_shear), totals, seed);
  EXPECT_EQ(totals.n_failed, 0);
  EXPECT_EQ(totals.n_cut, 0);
  EXPECT_GT(totals.n_open, 1000);
  EXPECT_GT(totals.n_slip, 10000);
  EXPECT_GT(totals.n_stick, 1000);
  EXPECT_GT(totals.n_closed_again, 100);
  EXPECT_LT(totals.iterations, most_iterations);
}

TEST(RandomContact, ConvergesInThreeDimensions) { run_all(2, 10700); }
TEST(RandomContact, ConvergesInPlaneStrain) { run_all(1, 7500); }

// With weakening there need not be a solution nearby; then the answer is `unstable`, with the state
// kept, and never anything else.
TEST(RandomContact, ConvergesOrIsUnstableWithWeakening) {
  int n_converged = 0, n_unstable = 0, n_cut = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomProblem problem = random_problem(seed, 1 + seed / 2 % 2);
    for (std::size_t k = 0; k < problem.laws.size(); ++k) {
      CoulombLaw& law = problem.laws[k];
      law.dynamic_friction_angle = 0.7 * law.static_friction_angle;
      law.slip_weakening_distance = seed % 5 == 0 ? 0.05 : 0.4;
      law.slip_measure = seed % 3 == 1 ? SlipMeasure::cumulated : SlipMeasure::current;
    }
    ContactSolver solver(problem.op, problem.laws, {});
    ContactState state = initial_state(problem.op);
    Eigen::VectorXd before = Eigen::VectorXd::Zero(problem.op.geometry.n_dofs);
    for (const Eigen::VectorXd& locked : problem.locked) {
      const ContactState start = state;
      const ContactReport report = solver.solve_step(before, locked, state);
      if (report.outcome != Outcome::converged) {
        n_unstable += report.outcome == Outcome::unstable;
        EXPECT_EQ(report.outcome, Outcome::unstable) << seed << report.reason;
        EXPECT_EQ(state.jump, start.jump);
        break;
      }
      ++n_converged;
      n_cut += report.counts.sub_steps > 1;
      const Misses miss = judged(problem.op, problem.laws, before, locked, start, state,
                                 report.counts.sub_steps == 1)
                              .pascal;
      EXPECT_LT(miss.largest(), 4) << seed;
      EXPECT_LT(miss.equilibrium, 1e-4) << seed;
      before = locked;
    }
  }
  EXPECT_GT(n_converged, 300);
  EXPECT_GT(n_unstable, 3);
  EXPECT_GT(n_cut, 0);
}

}  // namespace
}  // namespace faultsim
