// Fault fields of cases, wanted from the beginning, added later, or of those shown first.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/scheduler/manager_world.h"

namespace faultsweep {
namespace {

TEST_F(ManagerTest, TellsWhereTheFieldsOfEachCaseGo) {
  submit(3, {}, {}, "sweep", KeepFields::all);
  EXPECT_EQ(run(), ExitCode::done);
  const std::string folder = folder_ / "fields" / "sweep";
  EXPECT_EQ(FakeRunner::fields_folders,
            (std::set<std::string>{folder + "/1", folder + "/2", folder + "/3"}));
}

TEST_F(ManagerTest, AddsFieldsToStoredResults) {
  submit_for_fields();
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 24);
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("fields");
  EXPECT_EQ(info.n_done, 12);
  for (int position = 1; position <= 12; ++position) {
    const StoredCase stored = store.stored_case(info.id, std::to_string(position));
    EXPECT_EQ(stored.fields, FieldsState::kept);
    ASSERT_EQ(stored.runs.size(), 2u);
    EXPECT_FALSE(stored.runs[0].fields_only);
    EXPECT_TRUE(stored.runs[1].fields_only);
  }
}

TEST_F(ManagerTest, WritesLostFieldsAgain) {
  submit(3, {}, {}, "sweep", KeepFields::all);
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 3);  // the fake writes no files, so they count as lost
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 6);
  for (int position = 1; position <= 3; ++position) {
    write_fields("sweep", position);
  }
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 6);
}

/// As the fake writes no files, they count as lost unless the test does.
TEST_F(ManagerTest, WritesTheFieldsOfTheCasesShownFirstWhenAllAreDecided) {
  submit(12, {}, {}, "sweep", KeepFields::shown);
  EXPECT_EQ(run_shown({5, 2, 9}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 15);
  EXPECT_EQ(FakeRunner::fields_steps, std::set<KeepFields>{KeepFields::stages});
  std::set<std::string> folders = {""};  // cases run without
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("");
  for (const std::int64_t id : {5, 2, 9}) {
    const long position = store.decided_case(info.id, id).position;
    folders.insert(store.fields_folder("sweep", position));
    const StoredCase stored = store.stored_case(info.id, std::to_string(position));
    EXPECT_EQ(stored.fields, FieldsState::kept);
    ASSERT_EQ(stored.runs.size(), 2u);
    EXPECT_TRUE(stored.runs[1].fields_only);
  }
  EXPECT_EQ(FakeRunner::fields_folders, folders);
  EXPECT_EQ(info.n_done, 12);
  EXPECT_EQ(info.n_fields_kept, 3);
  EXPECT_THAT(events(),
              ::testing::HasSubstr("fields: all cases are decided; the fault fields of the "
                                   "cases ranked first follow: 5, 2, 9\n"));
  EXPECT_TRUE(store.integrity_problems().empty());
}

TEST_F(ManagerTest, ASecondRunWritesMissingFieldsOfCasesShownFirstOnly) {
  submit(6, {}, {}, "sweep", KeepFields::shown);
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  for (const int position : {1, 2, 3}) write_fields("sweep", position);
  FakeRunner::n_runs = 0;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 0);
  EXPECT_EQ(run_shown({4, 2, 3}), ExitCode::done) << "the order is another since";
  EXPECT_EQ(FakeRunner::n_runs, 1);
  EXPECT_EQ(Store::open_reader(folder_).campaign("").n_fields_kept, 4) << "those of 1 stay";
  std::filesystem::remove_all(folder_ / "fields" / "sweep" / "1");
  write_fields("sweep", 4);
  EXPECT_EQ(run_shown({4, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 1) << "nobody looks at 1 any more";
}

/// With `abort` too: what is decided is not undone by an extra.
TEST_F(ManagerTest, FieldsOfCasesShownFirstThatFailAreNoFailureOfTheCampaign) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(6, {}, policy, "sweep", KeepFields::shown);
  FakeRunner::fields_fail = true;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 9) << "all three were tried";
  const CampaignInfo info = Store::open_reader(folder_).campaign("");
  EXPECT_EQ(info.n_done, 6);
  EXPECT_EQ(info.n_failed, 0);
  EXPECT_EQ(info.n_fields_failed, 3);
  EXPECT_THAT(events(), ::testing::HasSubstr("case failed: fields of case 1 world: disk full"));
  EXPECT_THAT(events(), ::testing::Not(::testing::HasSubstr("aborted")));
  FakeRunner::n_runs = 0;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 0) << "they wait for retry";
  FakeRunner::fields_fail = false;
  EXPECT_EQ(Store::open_owner(folder_).retry(info.id, false, std::nullopt), 3);
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(Store::open_reader(folder_).campaign("").n_fields_kept, 3);
}

TEST_F(ManagerTest, KilledAtAnyTurnFieldsOfCasesShownFirstComeInTheEnd) {
  submit(6, {1}, {}, "sweep", KeepFields::shown);
  for (int turns = 0; turns < 40; ++turns) {
    run_shown({1, 3, 4}, turns);
    const Store store = Store::open_reader(folder_);
    for (const int position : {1, 3, 4}) {
      const auto fields = store.stored_case(1, std::to_string(position)).fields;
      if (fields == FieldsState::kept) write_fields("sweep", position);
    }
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  const CampaignInfo info = Store::open_reader(folder_).campaign("");
  EXPECT_EQ(info.n_done, 5);
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_EQ(info.n_fields_kept, 3);
  const Store store = Store::open_reader(folder_);
  for (int position = 1; position <= 6; ++position) {
    const bool shown = position == 1 || position == 3 || position == 4;
    EXPECT_EQ(store.stored_case(1, std::to_string(position)).runs.size(), shown ? 2u : 1u);
  }
}

TEST_F(ManagerTest, AsksForCasesShownFirstAfterTheLastRoundAndOnlyWhereTheirFieldsAreKept) {
  for (const KeepFields keep : {KeepFields::none, KeepFields::stages}) {
    submit(3, {}, {}, to_string(keep), keep);
    EXPECT_EQ(run_shown({1}), ExitCode::done);
  }
  EXPECT_EQ(n_asked_, 0);
  submit(3, {}, {}, "sweep", KeepFields::shown);
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_,
                  {.campaign = "sweep",
                   .next_round =
                       [&](Store& s, const std::string& name) {
                         return next_round_of_three(s, name, asked_with);
                       },
                   .shown_first =
                       [&](const Store& s, const CampaignInfo& info) {
                         EXPECT_EQ(s.campaign(info.name).conclusion, "enough");
                         return std::vector<std::int64_t>{1};
                       }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_THAT(asked_with, ::testing::ElementsAre(0, 1, 1)) << "not again after the fields";
  EXPECT_EQ(store.campaign("sweep").n_fields_kept, 1);
}

/// With the same operator another number is a bug, with another operator the world's doing; either
/// way the fields do not stay and the stored result does.
TEST_F(ManagerTest, RefusesFieldsOfOtherNumbers) {
  for (const char* fingerprint : {"print", "other"}) {
    std::filesystem::remove_all(folder_);
    FakeRunner::strength = 0.7;
    FakeRunner::operator_fingerprint = "print";
    submit_for_fields();
    FakeRunner::strength = std::nextafter(0.7, 1.0);
    FakeRunner::operator_fingerprint = fingerprint;
    std::filesystem::create_directories(folder_ / "fields" / "fields" / "5");
    EXPECT_EQ(run(), ExitCode::incomplete);
    Store store = Store::open_reader(folder_);
    const CampaignInfo info = store.campaign("fields");
    EXPECT_EQ(info.n_failed, 12);
    EXPECT_EQ(info.n_fields_failed, 12);
    const StoredCase stored = store.stored_case(info.id, "5");
    EXPECT_EQ(stored.fields, FieldsState::failed);
    EXPECT_EQ(stored.result.whole.chi_bar, 0.7);
    const bool same = std::string(fingerprint) == "print";
    EXPECT_EQ(stored.runs.at(1).status, same ? "bug" : "world");
    EXPECT_EQ(stored.runs.at(1).reason,
              "the fields are not those of the stored result, from which this run differs in load "
              "step 1 (primary_production)" +
                  std::string(same ? ", with the same operator"
                                   : ": it used the operator other, the stored one comes from "
                                     "print"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "fields" / "fields" / "5"));
  }
}

TEST_F(ManagerTest, RetriesRunsForFieldsAsTheSpecSays) {
  Policy policy;
  policy.on_failure = FailureAction::retry;
  policy.retries = 1;
  submit_for_fields(policy);
  FakeRunner::strength = 0.8;
  EXPECT_EQ(run(), ExitCode::incomplete);
  Store store = Store::open_reader(folder_);
  EXPECT_EQ(store.stored_case(store.campaign("fields").id, "3").runs.size(), 3u);
}

}  // namespace
}  // namespace faultsweep
