#include "campaign/scheduler/manager.h"

#include <gmock/gmock.h>

#include <numeric>
#include <sstream>

#include "simulator/common/stopwatch.h"
#include "tests/unit/scheduler/manager_world.h"

namespace faultsweep {
namespace {

TEST_F(ManagerTest, RunsEveryCaseOnceAndASecondRunDoesNothing) {
  submit(200, {});
  for (int repeat = 0; repeat < 2; ++repeat) {
    Store store = Store::open_owner(folder_);
    Stage stage(3);
    Manager manager(store, stage, silent_, {});
    EXPECT_TRUE(stage.play(manager));
    EXPECT_EQ(manager.status(), ExitCode::done);
    EXPECT_EQ(store.campaign("").n_converged, 200);
    EXPECT_EQ(FakeRunner::n_runs, 200);
  }
}

/// A worker that is handed work before it has said how many cores it has would build with one.
TEST_F(ManagerTest, HandsOutNothingBeforeAllWorkersHaveSaidWhereTheyAre) {
  submit(1, {});
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  stage.greet(1);
  EXPECT_FALSE(stage.take_turns(manager, 50));
  EXPECT_EQ(FakeRunner::n_runs, 0);
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(FakeRunner::n_runs, 1);
  EXPECT_EQ(FakeRunner::threads, std::vector{4});
}

/// `status` reads it in the store, which hears of it once a second.
TEST_F(ManagerTest, SaysWhatIsBeingBuilt) {
  submit(3, {});
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_, {});
  FakeRunner::builds_until_it_may_end = true;
  const auto is_said = [&] {
    const auto owner = store.owner();
    return owner &&
           owner->progress.find("building: operator 3 of a surface: meshing") != std::string::npos;
  };
  const faultsim::Stopwatch watch;
  while (!is_said() && watch.seconds() < 20) EXPECT_FALSE(stage.play(manager, 10));
  EXPECT_TRUE(is_said());
  FakeRunner::builds_until_it_may_end = false;
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::done);
}

TEST_F(ManagerTest, FailuresAreRowsAndTheCampaignIsIncomplete) {
  submit(30, {3, 17});
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 28);
  EXPECT_EQ(info.n_failed, 2);
  EXPECT_EQ(store.stored_case(info.id, "4").runs.at(0).reason, "killed");
}

/// All cases of a campaign may fail alike.
TEST_F(ManagerTest, ShowsTheFirstFailuresAndWhereTheOthersAre) {
  std::vector<int> all(25);
  std::iota(all.begin(), all.end(), 0);
  submit(25, all);
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  ProgressDisplay lines{ProgressDisplay::Style::lines};
  ::testing::internal::CaptureStderr();
  {
    Manager manager(store, stage, lines, {});
    EXPECT_TRUE(stage.play(manager));
  }
  std::istringstream said(::testing::internal::GetCapturedStderr());
  int n_failures = 0, n_hints = 0;
  for (std::string line; std::getline(said, line);) {
    n_failures += line.ends_with("crashed: killed");
    n_hints += line == "further failures are not shown here: `faultsweep status sweep` has them";
  }
  EXPECT_EQ(n_failures, 10);
  EXPECT_EQ(n_hints, 1);
  EXPECT_EQ(store.campaign("").n_failed, 25);
}

TEST_F(ManagerTest, ADamagedResultIsARowWithItsReason) {
  submit(3, {});
  FakeRunner::damage = true;
  EXPECT_EQ(run(), ExitCode::incomplete);
  FakeRunner::damage = false;
  const Store store = Store::open_reader(folder_);
  const StoredRun one = store.stored_case(store.campaign("").id, "2").runs.at(0);
  EXPECT_EQ(one.status, "garbled");
  EXPECT_THAT(one.reason, ::testing::HasSubstr("its checksum differs"));
}

TEST_F(ManagerTest, SlipEventsAreFullResultsAndEarlyEndsAreNot) {
  using faultsim::Outcome;
  submit(4, {});
  const std::pair<Outcome, ExitCode> expected[] = {{Outcome::unstable, ExitCode::incomplete},
                                                   {Outcome::unresolved_event, ExitCode::done},
                                                   {Outcome::event, ExitCode::done}};
  for (const auto& [outcome, status] : expected) {
    FakeRunner::outcome = outcome;
    Store store = Store::open_owner(folder_);
    for (int repeat = 0; repeat < 2; ++repeat) {  // as it comes, and as the store counts it
      Stage stage(1);
      Manager manager(store, stage, silent_, {});
      EXPECT_TRUE(stage.play(manager));
      EXPECT_EQ(manager.status(), status) << faultsim::to_string(outcome) << repeat;
    }
    // The next outcome takes its place.
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_write);
    connection.execute("UPDATE cases SET state = 'waiting'");
  }
}

TEST_F(ManagerTest, RetriesAsTheSpecSays) {
  Policy policy;
  policy.on_failure = FailureAction::retry;
  policy.retries = 2;
  submit(10, {5}, policy);
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(store.stored_case(store.campaign("").id, "6").runs.size(), 3u);
}

TEST_F(ManagerTest, AbortLeavesTheRestWaiting) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(300, {0}, policy);
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  EXPECT_EQ(store.campaign("").n_failed, 1);
  EXPECT_GT(store.campaign("").n_waiting, 200);
}

TEST_F(ManagerTest, InterruptedCampaignsResumeWhereTheyStopped) {
  submit(100, {});
  {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {});
    EXPECT_FALSE(stage.play(manager, 20));
    manager.interrupt();
    EXPECT_TRUE(stage.play(manager));
    EXPECT_TRUE(manager.workers_are_drained());
    EXPECT_EQ(manager.status(), ExitCode::interrupted);
    EXPECT_GT(store.campaign("").n_done, 0);
    EXPECT_EQ(store.campaign("").n_done, FakeRunner::n_runs);
  }
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 100);
}

/// As an open transaction of another program does. Cases go on, and nothing is lost.
TEST_F(ManagerTest, ResultsWaitWhileAnotherProcessHasLockedTheStore) {
  submit(30, {7});
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  Connection other(folder_ / "campaign.sqlite", Connection::Mode::read_write);
  other.execute("BEGIN IMMEDIATE");
  EXPECT_FALSE(stage.play(manager, 40));
  EXPECT_EQ(FakeRunner::n_runs, 29);
  EXPECT_EQ(store.campaign("").n_waiting, 30) << "nothing could be stored";
  EXPECT_FALSE(manager.commit());
  manager.interrupt();
  EXPECT_FALSE(stage.play(manager, 5)) << "not without the results";
  EXPECT_TRUE(manager.workers_are_drained()) << "which was done meanwhile";
  other.execute("COMMIT");
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 29);
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_THAT(events(), ::testing::HasSubstr("case failed: case 8 crashed: killed"));
}

TEST_F(ManagerTest, BeginsWhenTheStoreIsFree) {
  submit(3, {});
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Connection other(folder_ / "campaign.sqlite", Connection::Mode::read_write);
  other.execute("BEGIN IMMEDIATE");
  int n_asked = 0;
  Manager::Options options;
  options.is_stopped = [&] { return ++n_asked == 3; };
  EXPECT_THROW(Manager(store, stage, silent_, options), faultsim::StorageError);
  options.is_stopped = [&] {
    if (++n_asked == 6) other.execute("COMMIT");
    return false;
  };
  Manager manager(store, stage, silent_, options);
  EXPECT_EQ(n_asked, 6);
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::done);
}

/// `retry` of one campaign puts back a case that another one has too.
TEST_F(ManagerTest, TakesCasesThatWerePutBackMeanwhile) {
  submit(12, {5});
  EXPECT_EQ(run(), ExitCode::incomplete);
  submit(30, {5}, {}, "larger");
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_FALSE(stage.play(manager, 3));
  EXPECT_EQ(Store::open_writer(folder_).retry(store.campaign("sweep").id, false, {}), 1);
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(store.campaign("larger").n_waiting, 0);
  EXPECT_EQ(store.stored_case(store.campaign("larger").id, "6").runs.size(), 2u);
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  EXPECT_THAT(events(), ::testing::HasSubstr("requeued: 1 case waits again"));
}

/// Such a case, of which only the fields were missing, is then run as a whole: its fields alone
/// would leave it waiting for ever.
TEST_F(ManagerTest, TakesCasesThatWerePutBackWhileOnlyTheirFieldsWereMissing) {
  FakeRunner::outcome = faultsim::Outcome::unstable;
  submit(12, {});
  EXPECT_EQ(run(), ExitCode::incomplete);
  submit(30, {}, {}, "larger", KeepFields::stages);
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_FALSE(stage.play(manager, 3));
  EXPECT_EQ(Store::open_writer(folder_).retry(store.campaign("sweep").id, true, {}), 12);
  constexpr int kEnough = 10000;
  EXPECT_TRUE(stage.play(manager, kEnough));
  EXPECT_EQ(store.campaign("larger").n_waiting, 0);
}

/// Forgets manager and workers after each number of turns, as kill -9 of all of them would.
TEST_F(ManagerTest, KilledAtAnyTurnTheNextManagerCompletesTheCampaign) {
  submit(25, {7});
  for (int turns = 0; turns < 60; turns += 3) {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {});
    stage.play(manager, turns);
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 24);
  EXPECT_EQ(info.n_failed, 1);
  for (int position = 1; position <= 25; ++position) {
    EXPECT_EQ(store.stored_case(info.id, std::to_string(position)).runs.size(), 1u);
  }
}

TEST_F(ManagerTest, GoesOnRoundByRoundUntilThereIsNoFurtherOne) {
  submit(3, {});
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_,
                  {.campaign = "", .next_round = [&](Store& s, const std::string& name) {
                     return next_round_of_three(s, name, asked_with);
                   }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  EXPECT_THAT(asked_with, ::testing::ElementsAre(0, 1, 1)) << "a failed case is told";
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_cases, 9);
  EXPECT_EQ(info.n_done, 8);
  EXPECT_EQ(info.conclusion, "enough");
  const auto rounds = store.rounds(info.id);
  ASSERT_EQ(rounds.size(), 3u);
  EXPECT_EQ(rounds[2].first_position, 7);
  EXPECT_EQ(rounds[2].n_cases, 3) << "a case of an earlier round is not a case of a later one";
  EXPECT_EQ(rounds[2].reason, "more");
  EXPECT_TRUE(store.integrity_problems().empty());
  EXPECT_TRUE(store
                  .submit([] {
                    Submission s;
                    s.name = "sweep";
                    s.parameters = {};
                    s.scenes = {{"scene.json", "{\"title\": \"base\"}"}};
                    s.families = {{"a", 1, 1, 2, 1}};
                    for (int k = 0; k < 3; ++k)
                      s.cases.push_back({"case-" + std::to_string(k), 0, 0, "{}", {}});
                    return s;
                  }())
                  .existed)
      << "it is known by its first round";
}

/// As above, killed after each number of turns: each round is proposed once, each case run once.
TEST_F(ManagerTest, KilledAtAnyTurnRoundsGoOnWhereTheyWere) {
  submit(3, {});
  std::vector<long> asked_with;
  const auto next_round = [&](Store& s, const std::string& name) {
    return next_round_of_three(s, name, asked_with);
  };
  for (int turns = 0; turns < 40; ++turns) {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {.campaign = "", .next_round = next_round});
    stage.play(manager, turns);
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_cases, 9);
  EXPECT_EQ(info.n_done, 8);
  EXPECT_EQ(store.rounds(info.id).size(), 3u);
  for (int position = 1; position <= 9; ++position) {
    EXPECT_EQ(store.stored_case(info.id, std::to_string(position)).runs.size(), 1u);
  }
}

TEST_F(ManagerTest, AStoppedCampaignIsNotAskedForItsNextRound) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(3, {1}, policy);
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_,
                  {.campaign = "", .next_round = [&](Store& s, const std::string& name) {
                     return next_round_of_three(s, name, asked_with);
                   }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_THAT(asked_with, ::testing::IsEmpty());
}

}  // namespace
}  // namespace faultsweep
