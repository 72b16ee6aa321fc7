#include <gtest/gtest.h>

#include <cmath>

#include "simulator/contact/jump_follower.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

constexpr double kMPa = 1e6;

/// Runs load steps and has every accepted one judged.
struct History {
  History(FaultOperator o, ContactLaws l, ContactOptions options = {})
      : op(std::move(o)), laws(std::move(l)), solver(op, laws, options), state(initial_state(op)) {
    last = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  }
  ContactReport step(const Eigen::VectorXd& locked) {
    const ContactState before = state;
    ContactReport report = solver.solve_step(last, locked, state);
    if (report.outcome == Outcome::converged || report.outcome == Outcome::event) {
      const bool at_once = report.counts.sub_steps == 1 && report.jumps.empty();
      const Misses miss = judged(op, laws, last, locked, before, state, at_once).pascal;
      EXPECT_LT(miss.largest(), 10) << "Pa";
      EXPECT_LT(miss.equilibrium, 1);
    }
    last = locked;
    return report;
  }
  FaultOperator op;
  ContactLaws laws;
  ContactSolver solver;
  ContactState state;
  Eigen::VectorXd last;
};

ContactLaws following(const FaultOperator& op, const CoulombLaw& law) {
  ContactLaws laws = same_law(op, law);
  for (CoulombLaw& each : laws) each.damping = 2e6;  // ½ √(ρ G)
  return laws;
}

/// N = 20 MPa, k = 10 MPa/m, u in m.
Eigen::VectorXd pulled(double u, int n_dofs) {
  Eigen::VectorXd locked = Eigen::VectorXd::Zero(n_dofs);
  locked[0] = -20 * kMPa;
  locked[n_dofs - 1] = 10 * kMPa * u;
  return locked;
}

TEST(Jump, UnstableSliderJumpsOnceByTheHandFigure) {
  for (const int n_shear : {1, 2}) {
    ContactOptions options;
    options.onset_tolerance = 1e-9;
    options.traction_tolerance = 1e-12;
    FaultOperator op = spring_slider(10 * kMPa, n_shear);
    const ContactLaws laws = following(op, linear_weakening(0.2));
    History run(std::move(op), laws, options);
    const int n = 1 + n_shear;
    ASSERT_EQ(run.step(pulled(1.1, n)).outcome, Outcome::converged);
    const ContactReport report = run.step(pulled(1.3, n));
    ASSERT_EQ(report.outcome, Outcome::event) << report.reason;
    ASSERT_EQ(report.jumps.size(), 1u);
    const ContactJump& jump = report.jumps[0];
    EXPECT_NEAR(jump.load_before, 0.5, 1e-8);  // u = 1.2
    EXPECT_NEAR(jump.jump_after[n - 1] - jump.jump_before[n - 1], 0.4, 1e-8);
    EXPECT_NEAR(jump.traction_after[n - 1], 8 * kMPa, 1);
    EXPECT_NEAR(run.state.jump[n - 1], 0.5, 1e-8);  // u = 1.3, τ = 8
    EXPECT_GT(jump.negative_pivots, 0);
    const double area = 2.5;
    EXPECT_NEAR(jump.released, 0.5 * (12 + 8) * kMPa * 0.4 * area, 10);
    const double friction = (0.5 * (12 + 8) * 0.2 + 8 * 0.2) * kMPa * area;
    EXPECT_NEAR(jump.dissipated / friction, 1, 1e-3);  // the kink at d_c is passed within a step
    EXPECT_LT(jump.residual_before, 5);
    EXPECT_LT(jump.residual_after, 5);
    EXPECT_EQ(jump.nucleus, std::vector<int>{0});
  }
}

TEST(Jump, StableWeakeningHasNone) {
  FaultOperator op = spring_slider(10 * kMPa, 1);
  const ContactLaws laws = following(op, linear_weakening(0.8));
  History run(std::move(op), laws);
  for (const double u : {1.2, 1.3, 1.4, 1.5, 1.6, 1.8}) {
    const ContactReport report = run.step(pulled(u, 2));
    EXPECT_EQ(report.outcome, Outcome::converged) << u << report.reason;
    EXPECT_NEAR(run.state.jump[1], u < 1.7 ? 2 * (u - 1.2) : 1.0, 1e-7);
  }
}

TEST(Jump, CohesionLostAtFirstSlipIsAnEventOfTheDropInStrength) {
  FaultOperator op = spring_slider(10 * kMPa, 1);
  ContactLaws laws =
      following(op, {WeakeningLaw::angle, 2 * kMPa, std::atan(0.5), std::atan(0.5), 1});
  laws[0].cohesion_after_slip = false;
  ContactOptions options;
  options.onset_tolerance = 1e-9;
  History run(std::move(op), laws, options);
  ASSERT_EQ(run.step(pulled(1.19, 2)).outcome, Outcome::converged);
  EXPECT_EQ(run.state.jump[1], 0);
  const ContactReport report = run.step(pulled(1.3, 2));
  ASSERT_EQ(report.outcome, Outcome::event) << report.reason;
  ASSERT_EQ(report.jumps.size(), 1u);
  EXPECT_EQ(report.jumps[0].n_lost_cohesion, 1);
  EXPECT_EQ(report.jumps[0].nucleus, std::vector<int>{0});
  EXPECT_NEAR(report.jumps[0].jump_after[1], 0.2, 1e-7);  // from 12 to 10 MPa
  EXPECT_NEAR(run.state.jump[1], 0.3, 1e-7);
  EXPECT_NEAR(run.state.traction[1], 10 * kMPa, 1);
  // A second pull is ordinary friction without cohesion.
  EXPECT_EQ(run.step(pulled(1.5, 2)).outcome, Outcome::converged);
  EXPECT_NEAR(run.state.jump[1], 0.5, 1e-7);
}

/// A bump of shear load, symmetric about the middle, that grows.
Eigen::VectorXd bump(const FaultOperator& op, double load) {
  const auto n = static_cast<double>(op.geometry.nodes.size());
  Eigen::VectorXd locked = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  for (std::size_t k = 0; k < op.geometry.nodes.size(); ++k) {
    const double y = (static_cast<double>(k) - 0.5 * (n - 1)) / n;
    locked[op.geometry.nodes[k].dof[0]] = -20 * kMPa;
    locked[op.geometry.nodes[k].dof[2]] = load * kMPa * std::exp(-20 * y * y);
  }
  return locked;
}

FaultOperator bump_operator(int n_nodes) {
  FaultOperator op = make_operator(n_nodes, 1, Eigen::VectorXd::Constant(n_nodes, 10));
  set_h(op, half_space_matrix(op, 6e9, 0.0));
  // Without the image the matrix is symmetric about the middle.
  Eigen::MatrixXd h = op.h();
  const int n = op.geometry.n_dofs;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i % 2 == j % 2)
        h(i, j) = 6e9 / 5.026548 / (0.25 - 0.25 * (i - j) * (i - j));
      else
        h(i, j) = 0;
    }
  }
  set_h(op, h);
  return op;
}

TEST(Jump, RuptureOfAResolvedPatchStaysSymmetricAndDoesNotDependOnTheLoadStep) {
  double onset[2], moment[2];
  for (const int halved : {0, 1}) {
    FaultOperator op = bump_operator(160);
    const ContactLaws laws = following(op, linear_weakening(0.06));
    History run(std::move(op), laws);
    double load = 0;
    onset[halved] = moment[halved] = 0;
    const double step = halved ? 0.5 : 1;
    while (load < 16) {
      const ContactReport report = run.step(bump(run.op, load + step));
      ASSERT_TRUE(in_equilibrium(report.outcome)) << load << " " << report.reason;
      if (onset[halved] == 0 && !report.jumps.empty()) {
        const ContactJump& jump = report.jumps[0];
        onset[halved] = load + step * jump.load_before;
        moment[halved] = (jump.jump_after - jump.jump_before).sum();
        EXPECT_GE(jump.released, jump.dissipated);
        EXPECT_GT(jump.dissipated, 0);
        EXPECT_GT(jump.nucleus.size(), 3u);
      }
      load += step;
    }
    for (int k = 0; k < 80; ++k) {
      const double a = run.state.jump[2 * k + 1], b = run.state.jump[2 * (159 - k) + 1];
      EXPECT_NEAR(a, b, 1e-6 * run.state.jump.maxCoeff());
    }
  }
  EXPECT_GT(onset[0], 12);
  EXPECT_NEAR(onset[0] / onset[1], 1, 1e-3);
  EXPECT_NEAR(moment[0] / moment[1], 1, 1e-2);
}

TEST(Jump, IsNotFollowedWithoutDamping) {
  FaultOperator op = spring_slider(10 * kMPa, 1);
  const ContactLaws laws = same_law(op, linear_weakening(0.2));
  History run(std::move(op), laws);
  EXPECT_EQ(run.step(pulled(1.1, 2)).outcome, Outcome::converged);
  EXPECT_EQ(run.step(pulled(1.3, 2)).outcome, Outcome::unstable);
  EXPECT_EQ(run.state.jump[1], 0);
}

TEST(Jump, LostCohesionWithoutDampingIsAnInstabilityToo) {
  FaultOperator op = spring_slider(10 * kMPa, 1);
  ContactLaws laws = same_law(op, {WeakeningLaw::angle, 2 * kMPa, 0.4, 0.4, 1});
  laws[0].cohesion_after_slip = false;
  History run(std::move(op), laws);
  ASSERT_EQ(run.step(pulled(1.0, 2)).outcome, Outcome::converged);
  const ContactReport report = run.step(pulled(1.3, 2));
  EXPECT_EQ(report.outcome, Outcome::unstable);
  EXPECT_NE(report.reason.find("slip ends the cohesion of 1 nodes"), std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find("fault 'main'"), std::string::npos) << report.reason;
}

// Open, the release of the shear closes the node; closed, cohesion holds shear that opens it. It
// hops until t'_N = 0.1 − 10 s is no tension any more. NastyContact has the same without damping.
TEST(Jump, ANodeThatKeepsItsCohesionHopsUntilItIsClosed) {
  FaultOperator op = spring_slider(1, 1, 1);
  set_h(op, 10 * kMPa * Eigen::Matrix2d{{2, 1}, {1, 2}});
  ContactLaws laws = following(op, {WeakeningLaw::angle, 10 * kMPa, 0.6, 0.6, 1});
  laws[0].cohesion_after_opening = true;
  History run(std::move(op), laws);
  ASSERT_EQ(run.step(Eigen::Vector2d(-1, 1) * kMPa).outcome, Outcome::converged);
  const ContactReport report = run.step(Eigen::Vector2d(0.1, 5) * kMPa);
  ASSERT_EQ(report.outcome, Outcome::converged) << report.reason;
  EXPECT_EQ(run.state.jump[0], 0);
  EXPECT_NEAR(run.state.jump[1], 0.01, 0.02);  // by the share allowed in one step
  EXPECT_LT(run.state.traction[0], 1);
  EXPECT_FALSE(run.state.cohesion_lost[0]);
  // It slides on the average; without that each hop is halved away, at four times the work.
  EXPECT_LT(report.counts.wasted_newton_iterations, 5000);
}

}  // namespace
}  // namespace faultsim
