// The judge must pass what is right and measure each wrong solution by its own number.

#include "simulator/contact/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

constexpr int kNodes = 20;
constexpr double kTan = 0.5;
constexpr double kRight = 1e-7, kWrong = 1e-4;

/// A fault in the half-space: step 1 loads it so that some nodes slip along strike and dip, some
/// open and some stick.
class PlantedErrors : public testing::Test {
 protected:
  PlantedErrors() {
    set_h(op_, half_space_matrix(op_, 5e9, 0.1));
    step_.locked_before = Eigen::VectorXd::Zero(op_.geometry.n_dofs);
    step_.locked = step_.locked_before;
    for (int k = 0; k < kNodes; ++k) {
      step_.locked_before[3 * k] = -10e6;
      step_.locked[3 * k] = k == 4 ? 3e6 : -10e6;
      step_.locked[3 * k + 1] = 2e6;
      step_.locked[3 * k + 2] = k > 9 ? 6e6 : 1e6;
    }
    ContactSolver solver(op_, laws_, {});
    ContactState state = initial_state(op_);
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(op_.geometry.n_dofs);
    EXPECT_EQ(solver.solve_step(nothing, step_.locked_before, state).outcome, Outcome::converged);
    step_.before = state;
    const ContactReport report = solver.solve_step(step_.locked_before, step_.locked, state);
    EXPECT_EQ(report.outcome, Outcome::converged);
    EXPECT_EQ(report.counts.sub_steps, 1);
    step_.after = state;
  }

  Verdict verdict() const { return judge_step(op_, laws_, step_); }
  Misses check() const { return verdict().relative; }
  int first(FaultState wanted) const {
    for (int k = 0; k < kNodes; ++k) {
      if (step_.after.state[static_cast<std::size_t>(k)] == wanted) return k;
    }
    ADD_FAILURE() << "no node in state " << static_cast<int>(wanted);
    return 0;
  }

  FaultOperator op_ = make_operator(kNodes, 2, Eigen::VectorXd::Constant(kNodes, 2.5));
  ContactLaws laws_ = same_law(op_, {WeakeningLaw::angle, 0, std::atan(kTan), std::atan(kTan), 1});
  AcceptedStep step_;
};

TEST_F(PlantedErrors, NothingPlantedPasses) {
  const Verdict right = verdict();
  EXPECT_LE(right.relative.largest(), kRight);
  EXPECT_LE(right.largest_energy(), kRight);
  EXPECT_GT(right.relative.largest(), 0) << "nothing was computed";
  first(FaultState::open);
  first(FaultState::stick);
}

TEST_F(PlantedErrors, TractionThatDoesNotBelongToTheSlip) {
  step_.after.traction[3 * first(FaultState::stick)] *= 1 + 1e-3;
  EXPECT_GT(check().equilibrium, kWrong);
  EXPECT_LE(check().over_limit, kRight) << "conditions are checked on recomputed tractions";
}

TEST_F(PlantedErrors, AsymmetricOperatorBreaksTheEnergyIdentity) {
  // From one state of slip to another: without slip before, asymmetry does no work.
  step_.before = step_.after;
  step_.locked_before = step_.locked;
  const int slipping = 3 * first(FaultState::slip) + 2, open = 3 * first(FaultState::open);
  step_.after.jump[slipping] *= 0.5;
  const auto fit = [&] {  // tractions that fit H: equilibrium cannot see what is wrong, work can
    for (ContactState* state : {&step_.before, &step_.after}) {
      state->traction = step_.locked - (op_.h() * state->jump).cwiseQuotient(op_.geometry.dof_area);
    }
  };
  fit();
  EXPECT_LE(verdict().energy, 1e-14);
  Eigen::MatrixXd h = op_.h();
  h(slipping, open) += 0.1 * h(open, open);
  set_h(op_, h);
  fit();
  EXPECT_LE(check().equilibrium, 1e-14);
  EXPECT_GT(verdict().energy, kWrong);
}

TEST_F(PlantedErrors, SlipAgainstTheTraction) {
  const int k = first(FaultState::slip);
  for (int d : {3 * k + 1, 3 * k + 2}) {
    step_.after.jump[d] = step_.before.jump[d] - (step_.after.jump[d] - step_.before.jump[d]);
  }
  EXPECT_GT(check().misaligned, kWrong);
  EXPECT_GT(verdict().negative_dissipation, kWrong);
}

TEST_F(PlantedErrors, SlipAcrossTheTraction) {
  const int k = first(FaultState::slip);
  std::swap(step_.after.jump[3 * k + 1], step_.after.jump[3 * k + 2]);
  EXPECT_GT(check().misaligned, kWrong);
}

TEST_F(PlantedErrors, SlipBelowTheLimit) {
  for (CoulombLaw& law : laws_) {
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(kTan * 1.01);
  }
  EXPECT_GT(check().below_limit, kWrong);
  EXPECT_LE(check().over_limit, kRight);
}

TEST_F(PlantedErrors, ShearOverTheLimit) {
  for (CoulombLaw& law : laws_) {
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(kTan * 0.99);
  }
  EXPECT_GT(check().over_limit, kWrong);
}

TEST_F(PlantedErrors, CohesionThatIsLostIsNotCounted) {
  for (CoulombLaw& law : laws_) law.cohesion = 1e6;
  EXPECT_GT(check().below_limit, kWrong) << "with cohesion it would not slip yet";
  step_.after.cohesion_lost.assign(kNodes, 1);
  EXPECT_LE(check().largest(), kRight);
}

TEST_F(PlantedErrors, OpenNodeThatIsPressedTogether) {
  const int k = first(FaultState::open);
  step_.after.jump[3 * k] *= 0.99;
  EXPECT_GT(check().open_traction, kWrong);
  step_.after.jump[3 * k] = -1e-6;
  EXPECT_GT(check().penetration, kWrong);
}

TEST_F(PlantedErrors, TensionOfAClosedNode) {
  const int k = first(FaultState::open);
  step_.after.state[static_cast<std::size_t>(k)] = FaultState::stick;
  step_.after.jump[3 * k] = 0;
  EXPECT_GT(check().tension, kWrong);
}

TEST_F(PlantedErrors, OperatorThatGivesEnergyAway) {
  set_h(op_, -op_.h());
  EXPECT_GT(verdict().negative_energy, kWrong);
}

TEST_F(PlantedErrors, NotANumber) {
  step_.after.jump[3 * first(FaultState::slip) + 1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check().largest(), std::numeric_limits<double>::infinity());
}

/// What a cut step does not promise is not asked of it; what its last state shows is.
TEST_F(PlantedErrors, StepThatWasCutIsAskedForItsLastStateOnly) {
  const int k = first(FaultState::slip);
  step_.before.jump[3 * k + 1] += 1;  // the slip of the step points backwards
  step_.at_once = false;
  EXPECT_EQ(check().misaligned, 0);
  EXPECT_LE(check().over_limit, kRight);
}

/// Where salt creeps, the tractions given are what conditions are checked on.
TEST_F(PlantedErrors, CreepingStepIsCheckedOnItsTractions) {
  step_.elastic = false;
  step_.locked.setConstant(std::numeric_limits<double>::max());  // must not take part
  EXPECT_EQ(check().equilibrium, 0);
  step_.locked.setZero();
  EXPECT_LE(check().largest(), kRight);
  step_.after.traction[3 * first(FaultState::slip) + 1] *= 1.01;
  EXPECT_GT(check().over_limit, kWrong);
}

/// One node, H/A = diag(4, 2, 2) on a unit area, c = 1, tan φ = 0.5; solutions by hand, in balance.
class ByHand : public testing::Test {
 protected:
  ByHand() {
    set_h(op_, Eigen::Vector3d(4, 2, 2).asDiagonal());
    step_.locked_before = Eigen::Vector3d(-1, 0, 0);
    step_.before = initial_state(op_);
    step_.before.traction = step_.locked_before;
    law().cohesion_after_opening = true;
    end_with({0, 0, 0}, {-1, 0, 0}, FaultState::stick);
  }
  CoulombLaw& law() { return laws_[0]; }
  /// The end of the step, with the memory that its slip leaves.
  void end_with(const Eigen::Vector3d& jump, const Eigen::Vector3d& traction, FaultState state) {
    step_.after = step_.before;
    step_.after.jump = jump;
    step_.after.traction = traction;
    step_.after.state[0] = state;
    step_.after.slip_path[0] =
        step_.before.slip_path[0] + (jump - step_.before.jump).tail<2>().norm();
    step_.locked = traction + Eigen::Vector3d(4, 2, 2).cwiseProduct(jump);
  }
  /// That this condition alone is missed, by so much.
  void expect_miss(double Misses::*condition, double pascal) {
    const Verdict verdict = judge_step(op_, laws_, step_);
    EXPECT_NEAR(verdict.pascal.*condition, pascal, 1e-14);
    EXPECT_EQ(verdict.node, pascal > 0 ? 0 : verdict.node);
    Misses others = verdict.pascal;
    others.*condition = 0;
    EXPECT_LT(others.largest(), 1e-14) << "another condition is missed";
  }
  void expect_right() { expect_miss(&Misses::equilibrium, 0); }

  FaultOperator op_ = make_operator(1, 2, Eigen::VectorXd::Ones(1));
  ContactLaws laws_ = same_law(op_, {WeakeningLaw::angle, 1, std::atan(0.5), std::atan(0.5), 1});
  AcceptedStep step_;
};

TEST_F(ByHand, RestSlipAndOpeningAreRight) {
  expect_right();
  end_with({0, 0.3, 0.4}, {-1, 0.9, 1.2}, FaultState::slip);  // |t'_T| = 1.5
  expect_right();
  end_with({0.2, 0, 0.1}, {0, 0, 0}, FaultState::open);
  expect_right();
}

TEST_F(ByHand, TractionThatIsNotThatOfTheJump) {
  step_.after.traction[2] = 0.125;
  expect_miss(&Misses::equilibrium, 0.125);
}

TEST_F(ByHand, Tension) {
  end_with({0, 0, 0}, {0.25, 0, 0}, FaultState::stick);
  expect_miss(&Misses::tension, 0.25);
}

TEST_F(ByHand, TensionLendsNoFriction) {
  end_with({0, 0, 0}, {0.25, 1.1, 0}, FaultState::stick);
  const Misses miss = judge_step(op_, laws_, step_).pascal;
  EXPECT_NEAR(miss.tension, 0.25, 1e-14);
  EXPECT_NEAR(miss.over_limit, 1.1 - 1, 1e-14);
}

TEST_F(ByHand, Penetration) {
  end_with({-0.25, 0, 0}, {-1, 0, 0}, FaultState::stick);
  expect_miss(&Misses::penetration, 4 * 0.25);
}

TEST_F(ByHand, ShearOverTheLimit) {
  end_with({0, 0, 0}, {-1, 1.2, 1.6}, FaultState::stick);
  expect_miss(&Misses::over_limit, 2 - 1.5);
}

TEST_F(ByHand, SlipBelowTheLimit) {
  end_with({0, 0.5, 0}, {-1, 1.25, 0}, FaultState::slip);
  expect_miss(&Misses::below_limit, 0.25);
  end_with({0, 0.5, 0}, {-1, 1.25, 0}, FaultState::stick);  // called stick, it has slipped
  expect_miss(&Misses::below_limit, 0.25);
}

TEST_F(ByHand, NodeThatIsSaidToSlipBelowTheLimit) {
  step_.at_once = false;
  end_with({0, 0, 0}, {-1, 1.25, 0}, FaultState::slip);
  expect_miss(&Misses::below_limit, 0.25);
}

TEST_F(ByHand, SlipAcrossAndAgainstItsTraction) {
  end_with({0, 0.5, 0}, {-1, 0, 1.5}, FaultState::slip);
  expect_miss(&Misses::misaligned, std::sqrt(2) * 1.5);
  end_with({0, -0.5, 0}, {-1, 1.5, 0}, FaultState::slip);
  expect_miss(&Misses::misaligned, 2 * 1.5);
  EXPECT_NEAR(judge_step(op_, laws_, step_).negative_dissipation, 1.5 / 1.5, 1e-15);
}

TEST_F(ByHand, TractionOfAnOpenNode) {
  end_with({0.25, 0, 0}, {0, 0.3, 0.4}, FaultState::open);
  expect_miss(&Misses::open_traction, 0.5);
  end_with({0.25, 0, 0}, {-0.75, 0, 0}, FaultState::stick);  // whatever it is called
  expect_miss(&Misses::open_traction, 0.75);
}

TEST_F(ByHand, WeakeningByAngleAndByCoefficient) {
  law().static_friction_angle = std::atan(0.8);
  law().dynamic_friction_angle = std::atan(0.2);
  law().slip_weakening_distance = 2;
  const double by_angle = std::tan(0.75 * std::atan(0.8) + 0.25 * std::atan(0.2));
  end_with({0, 0.5, 0}, {-1, 1 + by_angle, 0}, FaultState::slip);
  expect_right();
  law().weakening = WeakeningLaw::coefficient;
  expect_miss(&Misses::below_limit, 0.65 - by_angle);
  end_with({0, 3, 0}, {-1, 1.5, 0}, FaultState::slip);  // beyond d_c
  expect_miss(&Misses::over_limit, 0.3);
}

TEST_F(ByHand, SlipThatTurnedBackWeakensByItsPathWhereTheLawSaysSo) {
  law() = {WeakeningLaw::coefficient, 0, std::atan(0.8), std::atan(0.2), 2, SlipMeasure::cumulated};
  step_.before.jump = Eigen::Vector3d(0, 0.75, 0);
  step_.before.slip_path[0] = 0.75;
  end_with({0, 0.5, 0}, {-1, -0.5, 0}, FaultState::slip);  // s = 1: half of the way
  expect_right();
  law().slip_measure = SlipMeasure::current;  // s = 0.5
  expect_miss(&Misses::below_limit, 0.65 - 0.5);
}

TEST_F(ByHand, PathThatIsNotThatOfTheSlip) {
  end_with({0, 0.3, 0.4}, {-1, 0.9, 1.2}, FaultState::slip);
  step_.after.slip_path[0] = 0.75;
  expect_miss(&Misses::memory, 2 * 0.25);
  step_.at_once = false;  // it may have gone back and forth,
  expect_right();
  step_.after.slip_path[0] = 0.25;  // but on no shorter way
  expect_miss(&Misses::memory, 2 * 0.25);
}

TEST_F(ByHand, CohesionThatOpeningShouldHaveEnded) {
  end_with({0.25, 0, 0}, {0, 0, 0}, FaultState::open);
  law().cohesion_after_opening = false;
  expect_miss(&Misses::memory, 1);
  step_.after.cohesion_lost[0] = 1;
  expect_right();
}

TEST_F(ByHand, CohesionThatSlipShouldHaveEnded) {
  law().cohesion_after_slip = false;
  end_with({0, 0.5, 0}, {-1, 1.5, 0}, FaultState::slip);
  expect_miss(&Misses::memory, 1);
  end_with({0, 0.5, 0}, {-1, 0.5, 0}, FaultState::slip);
  step_.after.cohesion_lost[0] = 1;
  expect_right();
}

TEST_F(ByHand, CohesionThatComesBackOrEndsWithoutAReason) {
  step_.after.cohesion_lost[0] = 1;
  expect_miss(&Misses::memory, 1);
  std::swap(step_.before, step_.after);
  expect_miss(&Misses::memory, 1);
}

TEST(Verdict, TakesTheWorstOfEachNumber) {
  Verdict a, b;
  a.relative.equilibrium = 3;
  b.relative.equilibrium = 2;
  b.node = 7;
  b.energy = 5;
  a.take_worst(b);
  EXPECT_EQ(a.relative.equilibrium, 3);
  EXPECT_EQ(a.node, -1);
  EXPECT_EQ(a.energy, 5);
  EXPECT_EQ(a.relative.largest(), 3);
  EXPECT_EQ(a.largest_energy(), 5);
  b.relative.tension = 4;
  a.take_worst(b);
  EXPECT_EQ(a.node, 7);
}

}  // namespace
}  // namespace faultsim
