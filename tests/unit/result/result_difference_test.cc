#include "simulator/result/result_difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace faultsim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

FaultOnset onset_of(int step, double change_west) {
  FaultOnset onset;
  onset.step = step;
  onset.depth = 2000;
  onset.pressures.region_minus = "west", onset.pressures.region_plus = "east";
  onset.pressures.change_minus = change_west, onset.pressures.change_plus = change_west / 2;
  return onset;
}

FaultStageMetrics fault_that(const char* name, double chi_bar) {
  FaultStageMetrics fault;
  fault.fault = name;
  fault.chi_bar = chi_bar;
  return fault;
}
void slide(FaultStageMetrics& fault, const FaultOnset& onset) {
  fault.activated = true;
  fault.activation = onset;
}

/// Steps 1 to 10 of production, 11 to 20 of storage; nothing slides.
CaseResult quiet_case() {
  CaseResult result;
  result.outcome = Outcome::converged;
  result.fault_names = {"F1", "F2"};
  for (int k = 0; k <= 20; ++k) {
    StepResult step;
    step.step = k;
    step.stage = k == 0 ? "initial" : k <= 10 ? "production" : "storage";
    result.steps.push_back(step);
  }
  result.whole.faults = {fault_that("F1", 0.5), fault_that("F2", 0.84)};
  for (const char* name : {"production", "storage"}) {
    StageMetrics stage;
    stage.stage = name;
    stage.first_step = result.stages.empty() ? 1 : 11;
    stage.last_step = result.stages.empty() ? 10 : 20;
    stage.faults = result.whole.faults;
    result.stages.push_back(stage);
  }
  return result;
}
/// F2 slides from a step of production on.
CaseResult sliding_case(int step, double change_west) {
  CaseResult result = quiet_case();
  for (FaultStageMetrics* f : {&result.whole.faults[1], &result.stages[0].faults[1]}) {
    slide(*f, onset_of(step, change_west));
    f->chi_bar = 1;
  }
  return result;
}

TEST(DifferenceSentences, SayWhereNothingChanges) {
  CaseResult before = quiet_case(), after = quiet_case();
  after.whole.faults[0].chi_bar += 0.0009;
  after.whole.faults[0].max_slip = 9e-6;
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("Nothing changes beyond 0.001 in the largest χ̄ and 0.01 mm in the "
                          "largest slip of a fault."));
  before.identity = after.identity = "a";
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("Nothing changes: it is the same case."));
}

TEST(DifferenceSentences, HaveWhatSlidesNowFirstAndFromWhen) {
  const CaseResult quiet = quiet_case(), sliding = sliding_case(8, -1.404e7);
  EXPECT_THAT(difference_sentences(quiet, sliding),
              ElementsAre("F2 slides now, from load step 8 (production, west at Δp -140 bar): "
                          "before the change it did not.",
                          "Largest χ̄: of F2 1 instead of 0.84."));
  EXPECT_THAT(difference_sentences(sliding, quiet),
              ElementsAre("F2 no longer slides: before the change it did, from load step 8 "
                          "(production, west at Δp -140 bar).",
                          "Largest χ̄: of F2 0.84 instead of 1."));
  EXPECT_THAT(difference_sentences(sliding_case(9, -1.52e7), sliding),
              ElementsAre("F2 slides from load step 8 (production, west at Δp -140 bar) instead of "
                          "step 9 (production, west at Δp -152 bar)."));
}

TEST(DifferenceSentences, HaveThePressureInAFaultBesideNoRegion) {
  CaseResult sliding = sliding_case(8, 0);
  SidePressures alone;
  alone.change_in_fault = -3.21e5;
  sliding.whole.faults[1].activation->pressures = alone;
  EXPECT_THAT(difference_sentences(quiet_case(), sliding),
              Contains(HasSubstr("step 8 (production, Δp in the fault -3.21 bar)")));
}

/// A stage in which the case's own onset lies is not said again.
TEST(DifferenceSentences, HaveOtherStagesAfterTheCase) {
  const CaseResult before = sliding_case(9, -1.52e7);
  CaseResult after = sliding_case(8, -1.4e7);
  slide(after.stages[1].faults[1], onset_of(14, -1e7));
  const std::vector<std::string> said = difference_sentences(before, after);
  ASSERT_EQ(said.size(), 2U);
  EXPECT_THAT(said[0], HasSubstr("F2 slides from load step 8"));
  EXPECT_EQ(said[1],
            "F2 slides in storage now, from load step 14 (storage, west at Δp -100 bar): before "
            "the change it did not.");
}

/// The second cycle is compared with the second one.
TEST(DifferenceSentences, TellStagesOfOneNameApart) {
  CaseResult before = quiet_case();
  for (StageMetrics& stage : before.stages) stage.stage = "cycle";
  slide(before.stages[1].faults[1], onset_of(14, -1e7));
  CaseResult after = before;
  EXPECT_THAT(difference_sentences(before, after), ElementsAre(HasSubstr("Nothing changes")));
  slide(after.stages[0].faults[1], onset_of(9, -1e7));
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("F2 slides in cycle now, from load step 9 (production, west at Δp "
                          "-100 bar): before the change it did not."));
}

TEST(DifferenceSentences, SayWhatCellsLeaveOpen) {
  const CaseResult quiet = quiet_case(), sliding = sliding_case(8, -1.4e7);
  CaseResult open = sliding;
  open.whole.faults[1].activation_resolved = false;
  EXPECT_THAT(difference_sentences(sliding, open),
              ElementsAre("Whether F2 slides cannot be decided on these cells: before the change "
                          "it did, from load step 8 (production, west at Δp -140 bar)."));
  EXPECT_THAT(difference_sentences(open, sliding),
              ElementsAre("F2 slides now, from load step 8 (production, west at Δp -140 bar): "
                          "before the change its cells could not tell."));
  EXPECT_THAT(difference_sentences(open, quiet),
              Contains("F2 does not slide now: before the change its cells could not tell."));
  CaseResult still = open;
  still.whole.faults[0].chi_bar = 0.61;
  EXPECT_THAT(difference_sentences(open, still),
              ElementsAre("Largest χ̄: of F1 0.61 instead of 0.5.",
                          "Whether F2 slides cannot be decided on these cells, as before the "
                          "change."));
}

/// What a history does not reach is not said to be no more.
TEST(DifferenceSentences, DoNotTakeAnEarlyEndForSafety) {
  const CaseResult sliding = sliding_case(8, -1.4e7);
  CaseResult cut = quiet_case();
  cut.outcome = Outcome::unstable, cut.failed_step = 6, cut.reason = "no equilibrium";
  EXPECT_THAT(difference_sentences(sliding, cut),
              ElementsAre("The history ends early now, at load step 6 (unstable: no equilibrium): "
                          "before the change it came to its end.",
                          "F2 does not slide before the history ends: before the change it did, "
                          "from load step 8 (production, west at Δp -140 bar), which is not "
                          "reached now.",
                          "Largest χ̄: of F2 0.84 instead of 1."));
  CaseResult later = cut;
  later.failed_step = 12;
  EXPECT_EQ(difference_sentences(sliding, later)[1],
            "F2 does not slide before the history ends: before the change it did, from load step 8 "
            "(production, west at Δp -140 bar).");
  const std::vector<std::string> back = difference_sentences(cut, sliding);
  EXPECT_THAT(back[0], HasSubstr("comes to its end now: before the change it ended early, at load "
                                 "step 6 (unstable: no equilibrium)."));
  EXPECT_THAT(back[1], HasSubstr("before the change it did not come so far."));
  CaseResult sooner = cut;
  sooner.failed_step = 4;
  EXPECT_THAT(difference_sentences(cut, sooner),
              ElementsAre("The history ends early, at load step 4 (unstable: no equilibrium) "
                          "instead of at load step 6 (unstable: no equilibrium)."));
}

TEST(DifferenceSentences, HaveEventsWithTheLargestAndWhetherItIsResolved) {
  const CaseResult before = quiet_case();
  CaseResult after = quiet_case();
  SlipEvent small, large;
  small.step = 3, small.fault = "F1", small.moment = 1e12, small.magnitude = 1.933;
  large.step = 7, large.fault = "F2", large.moment = 4e12, large.magnitude = 2.331;
  large.resolved = false;
  after.events = {large, small};
  const std::string largest =
      "Mw 2.33 on F2 in load step 7 (unresolved: its size depends on the mesh)";
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("2 slip events now, the largest " + largest +
                          ": before the change there was "
                          "none."));
  EXPECT_THAT(difference_sentences(after, before),
              ElementsAre("No slip event now: before the change 2 slip events, the largest " +
                          largest + "."));
  CaseResult flat = before;
  flat.plane_strain = true;
  small.magnitude.reset();
  flat.events = {small};
  EXPECT_THAT(difference_sentences(after, flat),
              Contains("1 slip event instead of 2, the largest M0 1e+12 N m per m of strike on F1 "
                       "in load step 3 instead of " +
                       largest + "."));
  EXPECT_THAT(difference_sentences(after, flat),
              Contains("It is in plane strain now, and was in three dimensions."));
}

TEST(DifferenceSentences, HaveSlipInMillimetresAndTheFaultsThatChangeMostFirst) {
  CaseResult before = quiet_case(), after = quiet_case();
  before.whole.faults[0].max_slip = 0.0081, after.whole.faults[0].max_slip = 0.01612;
  after.whole.faults[1].max_slip = 1.2;
  before.pressure_margin = 5.2e6, after.pressure_margin = 3.5e6;
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("Largest slip: of F2 1.2 m instead of 0 mm, of F1 16.1 mm instead of "
                          "8.1 mm.",
                          "Extrapolated, χ̄ would be 1 after 35 bar more depletion instead of "
                          "52 bar."));
}

TEST(DifferenceSentences, AreOfFaultsByTheirNamesAndSayWhichAreNotInBoth) {
  const CaseResult before = quiet_case();
  CaseResult after = quiet_case();
  after.fault_names = {"F2", "F4"};
  after.whole.faults = {fault_that("F2", 0.84), fault_that("F4", 0.2)};
  const std::vector<std::string> said = difference_sentences(before, after);
  EXPECT_THAT(said, ElementsAre(HasSubstr("Nothing changes beyond"),
                                "Fault F4 was not there before the change.",
                                "Fault F1 was there before the change and is not now."));
}

/// What a surface is off by is not a change.
TEST(DifferenceSentences, CountASurfacesErrorsAndSayThatOneIsExact) {
  const CaseResult before = quiet_case();
  CaseResult after = quiet_case();
  after.surface = CaseSurface{.n_operators = 75};
  after.surface->chi_bar = 0.01;
  after.whole.faults[1].chi_bar = 0.849;
  EXPECT_THAT(
      difference_sentences(before, after),
      ElementsAre(HasSubstr("Nothing changes beyond 0.01 in the largest χ̄"),
                  "The operator is interpolated between 75 exact ones (χ̄ off by up to 0.01) "
                  "now, and was exact."));
  after.whole.faults[1].chi_bar = 0.851;
  EXPECT_THAT(difference_sentences(before, after), Not(Contains(HasSubstr("Nothing changes"))));
}

TEST(DifferenceSentences, SayUnexpectedReactivationsAndOpening) {
  const CaseResult before = quiet_case();
  CaseResult after = quiet_case();
  Episode episode;
  episode.fault = "F2";
  after.episodes = {episode, episode};
  after.unexpected = Reactivation{2, 1};
  for (FaultStageMetrics* f : {&after.whole.faults[0], &after.stages[0].faults[0]}) {
    f->opens = true;
    f->opening = onset_of(5, 1e6);
  }
  EXPECT_THAT(difference_sentences(before, after),
              ElementsAre("F1 opens now, from load step 5 (production, west at Δp 10 bar): before "
                          "the change it did not.",
                          "Unexpected reactivation of F2 now: before the change there was none."));
}

TEST(DifferenceSentences, AreFewWhereManyFaultsChange) {
  CaseResult before = quiet_case(), after = quiet_case();
  for (int k = 3; k <= 12; ++k) {
    const std::string name = "F" + std::to_string(k);
    before.whole.faults.push_back(fault_that(name.c_str(), 0.9));
    after.whole.faults.push_back(fault_that(name.c_str(), 1));
    slide(after.whole.faults.back(), onset_of(8, -1e7));
  }
  const std::vector<std::string> said = difference_sentences(before, after);
  ASSERT_EQ(said.size(), 7U);
  EXPECT_EQ(said[5], "5 more differences of what slides are not listed.");
  EXPECT_THAT(said[6], HasSubstr("; 7 others change by no more."));
}

}  // namespace
}  // namespace faultsim
