// Episodes of constructed histories, and which of them are unexpected reactivations: every part of
// the definition (docs/words.md) by a history in which only that part decides.
#include "simulator/measures/episodes.h"

#include <gtest/gtest.h>

#include "tests/unit/measures/faults_between_regions.h"

namespace faultsim {
namespace {

Episode episode(const char* fault, bool after_recovery) {
  Episode one;
  one.fault = fault;
  one.after_recovery = after_recovery;
  return one;
}

std::optional<Reactivation> judged(const std::vector<Episode>& episodes) {
  return unexpected_reactivation(episodes);
}

constexpr bool kRecovered = true, kOnTheWayDown = false;

TEST(UnexpectedReactivation, FollowsOneOfTheSameFaultFromBeforeTheRecovery) {
  EXPECT_EQ(judged({episode("F1", kOnTheWayDown), episode("F1", kRecovered)}),
            (Reactivation{2, 1}));
}
TEST(UnexpectedReactivation, IsNoFirstEpisodeHoweverLate) {
  EXPECT_FALSE(judged({}));
  EXPECT_FALSE(judged({episode("F1", kRecovered)}));
  EXPECT_FALSE(judged({episode("F1", kRecovered), episode("F1", kRecovered)}));
}
TEST(UnexpectedReactivation, NeedsARecovery) {
  EXPECT_FALSE(judged({episode("F1", kOnTheWayDown), episode("F1", kOnTheWayDown)}));
}
TEST(UnexpectedReactivation, IsOfTheSameFault) {
  EXPECT_FALSE(judged({episode("F1", kOnTheWayDown), episode("F2", kRecovered)}));
  EXPECT_EQ(
      judged({episode("F1", kOnTheWayDown), episode("F2", kOnTheWayDown), episode("F3", kRecovered),
              episode("F2", kRecovered), episode("F1", kRecovered)}),
      (Reactivation{4, 2}));
}
TEST(UnexpectedReactivation, NamesTheLastEpisodeBeforeTheRecovery) {
  EXPECT_EQ(
      judged({episode("F1", kOnTheWayDown), episode("F1", kOnTheWayDown),
              episode("F2", kOnTheWayDown), episode("F1", kRecovered), episode("F1", kRecovered)}),
      (Reactivation{4, 2}));
}
TEST(UnexpectedReactivation, MustComeAfterTheOther) {
  EXPECT_FALSE(judged({episode("F1", kRecovered), episode("F1", kOnTheWayDown)}));
}

/// Walks the two faults through load steps.
class EpisodesTest : public ::testing::Test {
 protected:
  /// @param slip  of F1 and F2 in this step, m.
  void step(const char* stage, double west, double east, double slip_1, double slip_2) {
    const Eigen::VectorXd before = faults_.state.jump;
    StepResult step;
    step.step = ++number_;
    step.stage = stage;
    step.pressure_change = {west * 1e5, east * 1e5};
    step.faults.resize(2);
    int fault = 0;
    for (const double slip : {slip_1, slip_2}) {
      faults_.slip(fault, slip);
      step.faults[fault].slipping_area = slip != 0 ? 70 : 0;
      step.faults[fault].moment_step = std::abs(slip) * 1e12;
      ++fault;
    }
    NodalState nodal;
    meter_.evaluate(faults_.state, nodal);
    tracker_.add(step, nodal, faults_.state, before,
                 {step.pressure_change, Eigen::VectorXd::Constant(18, west * 1e5 + number_)});
  }
  std::vector<Episode> episodes() { return tracker_.finish(); }

  FaultsBetweenRegions faults_;
  FaultMeter meter_ = faults_.meter();
  FaultNeighbours neighbours_ = faults_.neighbours();
  EpisodeTracker tracker_{meter_, neighbours_, {"F1", "F2"}, true};
  int number_ = 0;
};

TEST_F(EpisodesTest, AStorageHistoryReactivatesAfterRecovery) {
  step("production", -50, -50, 0, 0);
  step("production", -100, -100, 0, 2e-3);
  step("production", -200, -200, 0, 4e-3);
  step("cushion", -130, -130, 0, 0);
  step("cushion", -60, -60, 0, -3e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].first_step, 2);
  EXPECT_EQ(all[0].last_step, 3);
  EXPECT_FALSE(all[0].after_recovery);
  EXPECT_NEAR(all[0].max_slip, 6e-3, 1e-12);
  EXPECT_EQ(all[0].depth, 2050) << "where the tent is highest";
  EXPECT_EQ(all[0].pressures.region_minus, "west");
  EXPECT_EQ(all[0].pressures.change_plus, -100e5) << "of the first step, not of the last";
  EXPECT_NEAR(*all[0].pressures.absolute_plus, 2050e4 - 100e5, 1e-6);
  EXPECT_EQ(all[0].pressures.change_in_fault, -100e5 + 2);
  EXPECT_TRUE(all[1].after_recovery);
  EXPECT_EQ(all[1].pressures.change_minus, -60e5);
  EXPECT_EQ(unexpected_reactivation(all), (Reactivation{2, 1}));
}

TEST_F(EpisodesTest, DeeperDepletionIsNoRecovery) {
  step("production", -100, -100, 0, 2e-3);
  step("pause", -100, -100, 0, 0);
  step("blowdown", -150, -150, 0, 2e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_FALSE(all[1].after_recovery);
  EXPECT_FALSE(unexpected_reactivation(all));
}

/// The pressures are those of the fault: F1 has only west beside it, which still falls while east,
/// the most depleted region of the scene, recovers.
TEST_F(EpisodesTest, TheRecoveryOfARegionElsewhereDoesNotCount) {
  step("production", -100, -180, 2e-3, 2e-3);
  step("pause", -100, -180, 0, 0);
  step("uneven", -120, -60, 2e-3, 2e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[2].fault, "F1");
  EXPECT_FALSE(all[2].after_recovery);
  EXPECT_EQ(all[3].fault, "F2");
  EXPECT_TRUE(all[3].after_recovery) << "-180 bar was its lowest, -120 bar is its lowest now";
  EXPECT_EQ(unexpected_reactivation(all), (Reactivation{4, 2}));
}

TEST_F(EpisodesTest, EndWherePressureTurnsAlsoWithinAStage) {
  step("all", -100, -100, 0, 2e-3);
  step("all", -200, -200, 0, 2e-3);
  step("all", -150, -150, 0, -2e-3);
  step("all", -60, -60, 0, -2e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].last_step, 2);
  EXPECT_EQ(all[1].first_step, 3);
  EXPECT_EQ(unexpected_reactivation(all), (Reactivation{2, 1}));
}

TEST_F(EpisodesTest, PressureAboveTheInitialOneHasNotRecovered) {
  step("injection", 50, 50, 0, 2e-3);
  step("pause", 50, 50, 0, 0);
  step("injection 2", 60, 60, 0, 2e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_FALSE(all[0].after_recovery);
  EXPECT_FALSE(all[1].after_recovery);
}

TEST_F(EpisodesTest, CountOnlyWhereTheFaultSlidesAndAreInOrder) {
  step("production", -50, -50, 2e-3, 5e-5);  // F2 slips, below the slip tolerance
  step("production", -100, -100, 2e-3, 0);
  step("storage", -60, -60, 1e-3, -2e-3);
  const std::vector<Episode> all = episodes();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].fault + all[1].fault + all[2].fault, "F1F1F2");
  EXPECT_EQ(unexpected_reactivation(all), (Reactivation{2, 1})) << "F2 never slid before";
  EXPECT_FALSE(all[0].magnitude_if_at_once) << "plane strain";
}

}  // namespace
}  // namespace faultsim
