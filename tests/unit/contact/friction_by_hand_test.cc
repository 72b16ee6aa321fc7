// V7: what a spring-slider of stiffness k under normal traction −N does, by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "simulator/common/units.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

constexpr double kMega = 1e6;

/// k = 10 MPa/m, N = 20 MPa, loaded by a displacement u: locked shear traction k u.
class Slider {
 public:
  Slider(const CoulombLaw& law, int n_shear, bool cumulated = false)
      : op_(spring_slider(10 * kMega, n_shear)), laws_(same_law(op_, law)), n_shear_(n_shear) {
    laws_[0].slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
    solver_ = std::make_unique<ContactSolver>(op_, laws_, ContactOptions{});
    state_ = initial_state(op_);
    locked_ = Eigen::VectorXd::Zero(1 + n_shear);
    const Eigen::VectorXd rest = locked(0, 0);
    EXPECT_EQ(solver_->solve_step(locked_, rest, state_).outcome, Outcome::converged);
    locked_ = rest;
  }
  Eigen::VectorXd locked(double u, double u_strike) const {
    Eigen::VectorXd t = Eigen::VectorXd::Zero(1 + n_shear_);
    t[0] = -20 * kMega;
    t[n_shear_] = 10 * kMega * u;
    if (n_shear_ == 2) t[1] = 10 * kMega * u_strike;
    return t;
  }
  ContactReport go_to(double u, double u_strike = 0) {
    const Eigen::VectorXd after = locked(u, u_strike);
    const ContactReport report = solver_->solve_step(locked_, after, state_);
    if (report.outcome == Outcome::converged) locked_ = after;
    return report;
  }
  double slip() const { return state_.jump[n_shear_]; }
  double shear() const { return state_.traction[n_shear_]; }
  const ContactState& state() const { return state_; }

 private:
  FaultOperator op_;
  ContactLaws laws_;
  int n_shear_;
  std::unique_ptr<ContactSolver> solver_;
  ContactState state_;
  Eigen::VectorXd locked_;
};

CoulombLaw constant(double coefficient) {
  return {WeakeningLaw::angle, 0, std::atan(coefficient), std::atan(coefficient), 1};
}

TEST(SpringSlider, FollowsStableLinearWeakening) {
  for (const int n_shear : {1, 2}) {
    Slider slider(linear_weakening(0.8), n_shear);
    const double u[] = {1.2, 1.3, 1.4, 1.5, 1.6, 1.8};
    const double slip[] = {0, 0.2, 0.4, 0.6, 0.8, 1.0};
    const double shear[] = {12, 11, 10, 9, 8, 8};
    for (int i = 0; i < 6; ++i) {
      const ContactReport report = slider.go_to(u[i]);
      ASSERT_EQ(report.outcome, Outcome::converged) << u[i] << report.reason;
      EXPECT_NEAR(slider.slip(), slip[i], 1e-7);
      EXPECT_NEAR(slider.shear(), shear[i] * kMega, 1);
    }
  }
}

TEST(SpringSlider, FollowsStableWeakeningOfTheAngle) {
  const CoulombLaw law{WeakeningLaw::angle, 0, 30 * kDegree, 10 * kDegree, 1.6};
  Slider slider(law, 1);
  ASSERT_EQ(slider.go_to(1.1547).outcome, Outcome::converged);
  EXPECT_EQ(slider.slip(), 0);
  const double u[] = {1.2, 1.5, 1.7, 1.9, 2.1};
  const double slip[] = {0.1063831, 0.7445245, 1.13232449, 1.50398049, 1.74734604};
  for (int i = 0; i < 5; ++i) {
    const ContactReport report = slider.go_to(u[i]);
    ASSERT_EQ(report.outcome, Outcome::converged) << u[i] << report.reason;
    EXPECT_NEAR(slider.slip(), slip[i], 5e-8);
  }
}

TEST(SpringSlider, NeverPassesSmoothlyOverAnInstability) {
  for (const double u : {1.21, 1.5, 3.0}) {
    Slider slider(linear_weakening(0.2), 1);
    ASSERT_EQ(slider.go_to(1.2).outcome, Outcome::converged);
    EXPECT_EQ(slider.slip(), 0);
    const ContactState before = slider.state();
    const ContactReport report = slider.go_to(u);
    EXPECT_EQ(report.outcome, Outcome::unstable) << u << report.reason;
    EXPECT_NE(report.reason.find("fault 'main' at x = 0 m, y = 0 m, depth = 2000 m"),
              std::string::npos)
        << report.reason;
    EXPECT_NE(report.reason.find("between load factors 0 and 0.015625"), std::string::npos)
        << report.reason;
    EXPECT_EQ(slider.state().jump, before.jump);
    EXPECT_EQ(slider.state().traction, before.traction);
  }
}

TEST(SpringSlider, LocatesTheInstabilityInsideAStep) {
  Slider slider(linear_weakening(0.2), 1);
  ASSERT_EQ(slider.go_to(1.0).outcome, Outcome::converged);
  const ContactReport report = slider.go_to(2.0);  // reaches 1.2 at load factor 0.2 = 12.8/64
  EXPECT_EQ(report.outcome, Outcome::unstable);
  EXPECT_NE(report.reason.find("between load factors 0.1875 and 0.203125"), std::string::npos)
      << report.reason;
}

TEST(SpringSlider, WeakensStablyOnlyAboveTheCriticalDistance) {
  // Angle law: critical d_c = N sec²φ_s Δφ / k = 0.93084227 m.
  for (const double d_c : {0.92, 0.94}) {
    Slider slider({WeakeningLaw::angle, 0, 30 * kDegree, 10 * kDegree, d_c}, 1);
    const ContactReport report = slider.go_to(1.16);
    EXPECT_EQ(report.outcome, d_c > 0.930843 ? Outcome::converged : Outcome::unstable) << d_c;
  }
}

TEST(SpringSlider, DissipatesTheAreaOfItsLoop) {
  for (const int n_shear : {1, 2}) {
    Slider slider(constant(0.6), n_shear);
    double work = 0;
    double slip = 0;
    const auto move = [&](double from, double to) {
      const int n = 40;
      for (int i = 1; i <= n; ++i) {
        const ContactReport report = slider.go_to(from + (to - from) * i / n);
        ASSERT_EQ(report.outcome, Outcome::converged) << report.reason;
        work += slider.shear() * (slider.slip() - slip);
        slip = slider.slip();
      }
    };
    move(0, 1.2);
    EXPECT_NEAR(slider.slip(), 0, 1e-12);
    move(1.2, 2);
    EXPECT_NEAR(slider.slip(), 0.8, 1e-12);
    move(2, -0.4);
    EXPECT_NEAR(slider.slip(), 0.8, 1e-12);
    move(-0.4, -2);
    EXPECT_NEAR(slider.slip(), -0.8, 1e-12);
    work = 0;
    move(-2, 2);
    move(2, -2);
    EXPECT_NEAR(work, 38.4 * kMega, 1);
    EXPECT_NEAR(slider.state().slip_path[0], 0.8 + 3 * 1.6, 1e-9);
  }
}

TEST(SpringSlider, SlipsAlongTheLoadInTheFaultPlane) {
  Slider slider(constant(0.6), 2);
  const double angle = 25 * kDegree;
  const double u = 2;
  ASSERT_EQ(slider.go_to(u * std::cos(angle), u * std::sin(angle)).outcome, Outcome::converged);
  EXPECT_NEAR(slider.state().jump[2], 0.8 * std::cos(angle), 1e-9);
  EXPECT_NEAR(slider.state().jump[1], 0.8 * std::sin(angle), 1e-9);
}

TEST(SpringSlider, WeakensByTheCumulatedPathWhereAskedTo) {
  // Forth 0.4 m and back: the path is what weakens, so the strength at u = −0.4 is the weakened
  // one.
  for (const bool cumulated : {false, true}) {
    Slider slider(linear_weakening(0.8), 1, cumulated);
    ASSERT_EQ(slider.go_to(1.4).outcome, Outcome::converged);
    EXPECT_NEAR(slider.slip(), 0.4, 1e-7);
    ASSERT_EQ(slider.go_to(-0.65).outcome, Outcome::converged);
    // Locked traction −6.5 − 10·0.4 = −10.5 MPa against 10 MPa: reverse slip a with
    // |−6.5 − 10 (0.4 − a)| = τ: 10.5 − 10 a = 10 − 5 a (path) or 10 + 5 a (norm heals).
    EXPECT_NEAR(slider.slip(), 0.4 - (cumulated ? 0.1 : 0.5 / 15), 1e-7);
  }
}

TEST(SpringSlider, SolvesAStartBeyondCoulombInStepZero) {
  const FaultOperator op = spring_slider(10 * kMega, 1);
  const ContactLaws laws = same_law(op, constant(0.6));
  ContactSolver solver(op, laws, {});
  ContactState state = initial_state(op);
  const Eigen::Vector2d start(-20 * kMega, 15 * kMega);
  const ContactReport report = solver.solve_step(Eigen::Vector2d(0, 0), start, state);
  EXPECT_EQ(report.outcome, Outcome::converged);
  EXPECT_EQ(report.counts.sub_steps, 1);
  EXPECT_NEAR(state.traction[1], 12 * kMega, 1e-6);
  EXPECT_NEAR(state.jump[1], 0.3, 1e-12);
}

}  // namespace
}  // namespace faultsim
