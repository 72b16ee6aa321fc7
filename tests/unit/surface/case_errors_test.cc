#include "simulator/surface/case_errors.h"

#include <gtest/gtest.h>

#include <limits>

namespace faultsim {
namespace {

/// Two steps of two faults in one stage.
CaseResult result() {
  CaseResult r;
  r.outcome = Outcome::converged;
  r.steps.resize(2);
  for (StepResult& step : r.steps) step.faults.resize(2);
  r.steps[1].faults[0].chi_bar = 0.9;
  r.steps[1].faults[1].max_slip = 0.05;
  r.stages.resize(1);
  r.stages[0].faults.resize(2);
  return r;
}

TEST(CaseErrors, AreThoseOfTheWorstFaultAndStep) {
  CaseResult other = result();
  other.steps[1].faults[0].chi_bar = 0.898;
  other.steps[0].faults[1].chi_bar = 0.001;
  other.steps[0].faults[0].max_slip = 0.001;
  const CaseErrors errors = case_errors(other, result());
  EXPECT_NEAR(errors.chi_bar, 0.002, 1e-15);
  EXPECT_NEAR(errors.largest_slip, 0.001 / 0.05, 1e-15) << "relative to the case, not the fault";
  EXPECT_EQ(errors.flags_that_differ, 0);
  EXPECT_TRUE(errors.within(0.002 + 1e-12));
  EXPECT_FALSE(errors.within(0.0019)) << "of slip";
}

TEST(CaseErrors, HoldSmallSlipsAgainstAMillimetre) {
  CaseResult exact = result(), other = result();
  exact.steps[1].faults[1].max_slip = 1e-6;
  other.steps[1].faults[1].max_slip = 2e-6;
  EXPECT_NEAR(case_errors(other, exact).largest_slip, 1e-3, 1e-15);
}

TEST(CaseErrors, AreInfiniteWhereThereIsNoNumber) {
  CaseResult other = result();
  other.steps[1].faults[0].chi_bar = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(case_errors(other, result()).within(0.1));
  EXPECT_FALSE(case_errors(result(), other).within(0.1));
}

TEST(CaseErrors, CountFlagsThatBothAreSureOf) {
  CaseResult other = result();
  other.stages[0].faults[0].activated = true;
  EXPECT_EQ(case_errors(other, result()).flags_that_differ, 1);
  other.stages[0].faults[0].activation_resolved = false;
  EXPECT_EQ(case_errors(other, result()).flags_that_differ, 0);
  other.outcome = Outcome::failed;
  EXPECT_EQ(case_errors(other, result()).flags_that_differ, 1);
}

/// What a case would have done after its end is not known to be right.
TEST(CaseErrors, AreInfiniteWhereOneCaseGoesOn) {
  CaseResult early = result();
  early.steps[1].faults.clear();  // reached, not in equilibrium
  early.outcome = Outcome::unstable;
  EXPECT_FALSE(case_errors(early, result()).within(1e9));
  EXPECT_FALSE(case_errors(result(), early).within(1e9));
  EXPECT_TRUE(case_errors(early, early).within(0)) << "both end there";
  CaseResult shorter = result();
  shorter.steps.pop_back();
  EXPECT_FALSE(case_errors(shorter, result()).within(1e9)) << "with the same outcome";
  EXPECT_FALSE(case_errors(result(), shorter).within(1e9));
  CaseResult ended = result();
  ended.outcome = Outcome::unconverged;
  EXPECT_FALSE(case_errors(ended, result()).within(1e9)) << "with as many steps";
  CaseResult event = result();
  event.outcome = Outcome::event;
  EXPECT_TRUE(case_errors(event, result()).within(0)) << "in equilibrium, and counted as a flag";
}

TEST(CaseErrors, TakeFaultsThatOpenInBothForAlike) {
  CaseResult exact = result(), other = result();
  for (CaseResult* one : {&exact, &other})
    one->steps[1].faults[0].chi_bar = std::numeric_limits<double>::infinity();
  EXPECT_EQ(case_errors(other, exact).chi_bar, 0);
  other.steps[1].faults[0].chi_bar = 1;
  EXPECT_FALSE(case_errors(other, exact).within(0.1));
}

}  // namespace
}  // namespace faultsim
