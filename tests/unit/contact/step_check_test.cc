// The check from outside must pass what is right and catch each planted error by its own number.

#include "simulator/contact/step_check.h"

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

  StepCheck check() const { return check_step(op_, laws_, step_); }
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
  const StepCheck right = check();
  EXPECT_LE(right.largest_residual(), kRight);
  EXPECT_LE(right.largest_energy(), kRight);
  EXPECT_GT(right.largest_residual(), 0) << "nothing was computed";
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
  EXPECT_LE(check().energy, 1e-14);
  Eigen::MatrixXd h = op_.h();
  h(slipping, open) += 0.1 * h(open, open);
  set_h(op_, h);
  fit();
  EXPECT_LE(check().equilibrium, 1e-14);
  EXPECT_GT(check().energy, kWrong);
}

TEST_F(PlantedErrors, SlipAgainstTheTraction) {
  const int k = first(FaultState::slip);
  for (int d : {3 * k + 1, 3 * k + 2}) {
    step_.after.jump[d] = step_.before.jump[d] - (step_.after.jump[d] - step_.before.jump[d]);
  }
  EXPECT_GT(check().misaligned, kWrong);
  EXPECT_GT(check().negative_dissipation, kWrong);
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
  EXPECT_LE(check().largest_residual(), kRight);
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
  EXPECT_GT(check().negative_energy, kWrong);
}

TEST_F(PlantedErrors, NotANumber) {
  step_.after.jump[3 * first(FaultState::slip) + 1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check().largest_residual(), std::numeric_limits<double>::infinity());
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
  EXPECT_LE(check().largest_residual(), kRight);
  step_.after.traction[3 * first(FaultState::slip) + 1] *= 1.01;
  EXPECT_GT(check().over_limit, kWrong);
}

TEST(StepCheck, TakesTheWorstOfEachNumber) {
  StepCheck a, b;
  a.equilibrium = 3;
  b.equilibrium = 2;
  b.energy = 5;
  a.take_worst(b);
  EXPECT_EQ(a.equilibrium, 3);
  EXPECT_EQ(a.energy, 5);
  EXPECT_EQ(a.largest_residual(), 3);
  EXPECT_EQ(a.largest_energy(), 5);
}

}  // namespace
}  // namespace faultsim
