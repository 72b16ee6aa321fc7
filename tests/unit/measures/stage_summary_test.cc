// What a stage keeps per fault: words (docs/words.md), places and pressures.
#include "simulator/measures/stage_summary.h"

#include <gtest/gtest.h>

#include "tests/unit/measures/faults_between_regions.h"

namespace faultsim {
namespace {

class StageSummaryTest : public ::testing::Test {
 protected:
  void step(StageSummary& summary, double west, double east,
            const std::vector<SlipEvent>& events = {}) {
    StepResult step;
    step.step = ++number_;
    step.pressure_change = {west * 1e5, east * 1e5};
    NodalState nodal;
    meter_.evaluate(faults_.state, nodal);
    step.faults = meter_.measure(nodal, faults_.state, before_);
    summary.add(step, meter_, neighbours_, nodal, faults_.state,
                {step.pressure_change, in_fault_, beside_}, {"F1", "F2"}, events);
    before_ = faults_.state.jump;
  }
  FaultsBetweenRegions faults_;
  FaultMeter meter_ = faults_.meter();
  FaultNeighbours neighbours_ = faults_.neighbours();
  Eigen::VectorXd before_ = faults_.state.jump;
  Eigen::VectorXd in_fault_ = Eigen::VectorXd::LinSpaced(18, 0, 17);  // Pa: the number of the node
  Eigen::MatrixX2d beside_;                                           // none
  int number_ = 0;
};

/// With a field the pressures are those of the cells beside the node that slides, or, where no
/// compartment is, beside the nearest node that has one.
TEST_F(StageSummaryTest, PressuresOfAFieldAreThoseBesideThePlace) {
  beside_.resize(18, 2);
  for (int k = 0; k < 18; ++k) beside_.row(k) << 1e3 * k, -1e4 * k;
  StageSummary summary("production", 1, {}, false, false);
  faults_.slip(1, 5e-3);  // most at the node 13, at 2050 m
  step(summary, -100, -40);
  const int widest = FaultsBetweenRegions::kNodes + 7;  // at 2080 m, beside no region
  faults_.state.state[widest] = FaultState::open;
  faults_.state.jump[2 * widest] = 2e-3;
  step(summary, -120, -50);
  const StageMetrics m = summary.finish();
  const SidePressures slide = first_activation(m)->pressures, open = first_opening(m)->pressures;
  EXPECT_EQ(slide.change_minus, -100e5 + 13e3);
  EXPECT_EQ(slide.change_plus, -40e5 - 13e4);
  EXPECT_EQ(slide.absolute_plus, 2050e4 - 40e5 - 13e4);
  EXPECT_EQ(open.change_minus, -120e5 + 15e3) << "at 2070 m";
  EXPECT_EQ(open.change_in_fault, 16);
}

TEST_F(StageSummaryTest, SlipsSlidesAndOpensPerFaultWithPlaceAndPressures) {
  StageSummary summary("production", 1, {}, false, false);
  step(summary, -50, -20);
  faults_.slip(0, 1e-3, 4, 5);  // one or two cells: slips, does not slide
  step(summary, -80, -30);
  faults_.slip(1, 5e-3);
  step(summary, -100, -40);
  const int widest = FaultsBetweenRegions::kNodes + 7;  // of F2, at 2080 m
  for (const int node : {widest - 1, widest}) {
    faults_.state.state[node] = FaultState::open;
    faults_.state.jump[2 * node] = node == widest ? 2e-3 : 1e-3;
  }
  step(summary, -120, -50);
  const StageMetrics m = summary.finish();
  ASSERT_EQ(m.faults.size(), 2u);
  const FaultStageMetrics &f1 = m.faults[0], &f2 = m.faults[1];
  EXPECT_TRUE(f1.slips);
  EXPECT_FALSE(f1.activated);
  EXPECT_FALSE(f1.opens);
  EXPECT_FALSE(f1.activation || f1.opening);
  EXPECT_NEAR(f1.max_slip, 0.75e-3, 1e-12);
  EXPECT_TRUE(f2.slips && f2.activated && f2.opens);
  EXPECT_EQ(m.activated_fault, "F2");
  EXPECT_EQ(m.activation_step, 3);
  EXPECT_EQ(m.opened_fault, "F2");
  EXPECT_EQ(m.opening_step, 4);
  const FaultOnset* slide = first_activation(m);
  ASSERT_NE(slide, nullptr);
  EXPECT_EQ(slide->step, 3);
  EXPECT_EQ(slide->depth, 2050);
  EXPECT_EQ(slide->pressures,
            (SidePressures{"west", "east", -100e5, -40e5, 2050e4 - 100e5, 2050e4 - 40e5, 13}));
  const FaultOnset* open = first_opening(m);
  ASSERT_NE(open, nullptr);
  EXPECT_EQ(open->depth, 2080) << "where the gap is widest";
  EXPECT_EQ(open->pressures.region_plus, "east") << "the nearest, 10 m above";
  EXPECT_EQ(open->pressures.change_plus, -50e5);
  EXPECT_EQ(*open->pressures.absolute_plus, 2080e4 - 50e5) << "at the depth of the place";
  EXPECT_DOUBLE_EQ(f2.open_area, 20);
  EXPECT_DOUBLE_EQ(m.open_area, 20);
  EXPECT_DOUBLE_EQ(m.moment, f1.moment + f2.moment);
}

TEST_F(StageSummaryTest, SaysWhatHangsOnTheCellsPerFaultAndOfAll) {
  StageSummary summary("production", 1, {}, false, false);
  step(summary, -50, -20);
  EXPECT_TRUE(summary.finish().activation_resolved);
  faults_.slip(0, 1e-3, 3, 5);  // 37 m, with ends that may be half a cell further out
  step(summary, -80, -30);
  StageMetrics m = summary.finish();
  EXPECT_FALSE(m.activated);
  EXPECT_FALSE(m.activation_resolved);
  EXPECT_FALSE(m.faults[0].activation_resolved);
  EXPECT_TRUE(m.faults[1].activation_resolved);
  faults_.slip(1, 5e-3);
  step(summary, -100, -40);
  m = summary.finish();
  EXPECT_TRUE(m.activated);
  EXPECT_TRUE(m.activation_resolved) << "one fault slides for certain";
  EXPECT_FALSE(m.faults[0].activation_resolved);
  EXPECT_TRUE(m.faults[1].activation_resolved);
}

TEST_F(StageSummaryTest, AWhollyOpenFaultOpensAndDoesNotSlide) {
  StageSummary summary("injection", 1, {}, false, false);
  for (int k = 0; k < FaultsBetweenRegions::kNodes; ++k) {
    faults_.state.state[k] = FaultState::open;
    faults_.state.jump[2 * k] = 1e-3 * (k + 1);
  }
  step(summary, 200, 0);
  const StageMetrics m = summary.finish();
  EXPECT_FALSE(m.activated);
  EXPECT_TRUE(m.activation_resolved);
  EXPECT_TRUE(m.opens);
  EXPECT_EQ(m.opened_fault, "F1");
  EXPECT_EQ(first_activation(m), nullptr);
  ASSERT_NE(first_opening(m), nullptr);
  EXPECT_EQ(first_opening(m)->pressures.region_minus, "") << "no region on that side of F1";
  EXPECT_FALSE(first_opening(m)->pressures.change_minus);
  EXPECT_EQ(leading_change(first_opening(m)->pressures), 200e5);
  EXPECT_EQ(leading_absolute(first_opening(m)->pressures), 2090e4 + 200e5);
}

TEST_F(StageSummaryTest, AStageCountsItsOwnSlipAndItsOwnEvents) {
  faults_.slip(1, 5e-3);
  const Eigen::VectorXd start = faults_.state.jump;
  StageSummary summary("storage", 1, start, false, false);
  SlipEvent small, large;
  small.fault = large.fault = "F2";
  small.moment = 1e10;
  large.moment = 3e10;
  large.magnitude = 0.9;
  small.stress_drop = 9e6;
  large.stress_drop = 2.5e6;
  before_ = start;
  step(summary, -60, -60, {small, large});
  const StageMetrics m = summary.finish();
  EXPECT_FALSE(m.slips || m.activated) << "all of it slipped before";
  EXPECT_EQ(m.faults[1].moment, 0);
  EXPECT_EQ(m.faults[1].n_events, 2);
  EXPECT_EQ(m.faults[1].event_moment, 3e10);
  EXPECT_EQ(m.faults[1].event_magnitude, 0.9);
  EXPECT_EQ(m.event_stress_drop, 2.5e6) << "of the largest, not the largest";
  EXPECT_EQ(m.faults[1].event_stress_drop, 2.5e6);
  EXPECT_FALSE(m.faults[0].event_stress_drop);
  EXPECT_EQ(m.faults[0].n_events, 0);
  EXPECT_FALSE(m.magnitude_if_at_once);
}

TEST(LeadingSide, IsTheOneThatChangedMore) {
  EXPECT_FALSE(leading_change({}));
  EXPECT_EQ(leading_change({"a", "b", -1, -3, 10, 20, 0}), -3);
  EXPECT_EQ(leading_absolute({"a", "b", -1, -3, 10, 20, 0}), 20);
  EXPECT_EQ(leading_change({"a", "b", -3, 3, 10, 20, 0}), -3);
  EXPECT_EQ(leading_absolute({"", "b", {}, 0, {}, 20, 0}), 20);
}

}  // namespace
}  // namespace faultsim
