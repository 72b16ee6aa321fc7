// Fields that a campaign keeps beside its results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "campaign/store/sqlite.h"
#include "tests/unit/store/store_fixture.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A campaign of four cases that keeps fields; case 1 was completed with them.
class FieldsTest : public StoreTest {
 protected:
  void SetUp() override {
    StoreTest::SetUp();
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    Submission s = submission(4);
    s.keep_fields = KeepFields::stages;
    campaign_ = store_->submit(s).campaign;
    ids_ = waiting(*store_, campaign_);  // by family: positions 1, 3, 2, 4
    record(with_fields(completed(ids_[0], 0.7)));
  }
  void TearDown() override {
    store_.reset();
    StoreTest::TearDown();
  }
  void record(const RunRecord& run) { store_->record_runs(campaign_, {run}); }
  static RunRecord with_fields(RunRecord run) {
    run.has_fields = true;
    return run;
  }
  static RunRecord fields_only(RunRecord run) {
    run.fields_only = true;
    return run;
  }
  StoredCase stored(const char* name) const { return store_->stored_case(campaign_, name); }
  void write_files(long position) const {
    const auto folder = store_->fields_folder("sweep", position);
    std::filesystem::create_directories(folder);
    for (const char* file : {"faults.h5", "faults.xmf"}) std::ofstream(folder / file) << "x";
  }

  std::unique_ptr<Store> store_;
  std::int64_t campaign_ = 0;
  std::vector<std::int64_t> ids_;
};

TEST_F(FieldsTest, AreKeptWithTheRunThatWroteThem) {
  EXPECT_EQ(store_->campaign("").keep_fields, KeepFields::stages);
  EXPECT_EQ(stored("1").fields, FieldsState::kept);
  EXPECT_EQ(stored("2").fields, FieldsState::wanted);
  EXPECT_EQ(stored("1").fields_folder, folder_ / "fields" / "sweep" / "1");
  const CampaignInfo info = store_->campaign("");
  EXPECT_EQ(info.n_done, 1);
  EXPECT_EQ(info.n_waiting, 3);
  EXPECT_EQ(info.n_fields_waiting, 0);
}

TEST_F(FieldsTest, OfAnotherCampaignAreAddedToTheStoredResult) {
  Submission s = submission(4, "other");
  s.keep_fields = KeepFields::all;
  EXPECT_EQ(store_->preview(s).n_fields, 1);
  const SubmitOutcome other = store_->submit(s);
  EXPECT_EQ(other.n_cached, 1);
  EXPECT_EQ(other.n_fields, 1);
  EXPECT_EQ(store_->preview(s).n_fields, 1) << "now that it exists";
  const auto families = store_->waiting_families(other.campaign);
  EXPECT_THAT(families[0].cases, ElementsAre(ids_[0], ids_[1]));
  EXPECT_THAT(families[0].fields_only, ElementsAre(ids_[0]));
  EXPECT_THAT(families[1].fields_only, IsEmpty());
  CampaignInfo info = store_->campaign("other");
  EXPECT_EQ(info.n_done, 0) << "not done here without its fields";
  EXPECT_EQ(info.n_waiting, 4);
  EXPECT_EQ(info.n_fields_waiting, 1);

  store_->record_runs(other.campaign, {fields_only(with_fields(completed(ids_[0], 0.7)))});
  const StoredCase added = store_->stored_case(other.campaign, "1");
  EXPECT_EQ(added.fields, FieldsState::kept);
  ASSERT_EQ(added.runs.size(), 2u);
  EXPECT_FALSE(added.runs[0].fields_only);
  EXPECT_TRUE(added.runs[1].fields_only);
  info = store_->campaign("other");
  EXPECT_EQ(info.n_done, 1);
  EXPECT_EQ(info.n_fields_waiting, 0);
  EXPECT_EQ(stored("1").fields, FieldsState::kept) << "the first campaign's stay";
  EXPECT_THAT(store_->integrity_problems(), IsEmpty());
}

TEST_F(FieldsTest, ThatCannotBeAddedLeaveTheResultAndWaitForRetry) {
  Submission s = submission(4, "other");
  s.keep_fields = KeepFields::all;
  const std::int64_t other = store_->submit(s).campaign;
  RunRecord run = fields_only(crashed(ids_[0], false));
  store_->record_runs(other, {run});
  EXPECT_EQ(store_->campaign("other").n_fields_waiting, 1) << "another attempt follows";
  run.final = true;
  run.reason = "disk full";
  store_->record_runs(other, {run});
  const CampaignInfo info = store_->campaign("other");
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_EQ(info.n_fields_failed, 1);
  EXPECT_EQ(info.n_fields_waiting, 0);
  const StoredCase failed = store_->stored_case(other, "1");
  EXPECT_EQ(failed.fields, FieldsState::failed);
  EXPECT_EQ(failed.state, "done");
  EXPECT_EQ(failed.result.whole.chi_bar, 0.7);
  const auto failures = store_->failure_counts(other);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failures[0].reason, "fields: disk full");
  EXPECT_EQ(failures[0].count, 1);
  EXPECT_THAT(store_->failure_counts(campaign_), IsEmpty());
  EXPECT_EQ(store_->campaign("sweep").n_done, 1);
  EXPECT_EQ(store_->retry(other, false, 2), 0);
  EXPECT_EQ(store_->retry(other, false, 1), 1);
  EXPECT_EQ(store_->campaign("other").n_fields_waiting, 1);
}

TEST_F(FieldsTest, ThatAWaitingCaseCouldNotWriteAreAFailedCase) {
  record(crashed(ids_[1], true));
  CampaignInfo info = store_->campaign("");
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_EQ(info.n_fields_failed, 0);
  EXPECT_EQ(store_->retry(campaign_, false, std::nullopt), 1);
  record(with_fields(completed(ids_[1], 0.2)));
  EXPECT_EQ(stored("3").fields, FieldsState::kept);
  EXPECT_EQ(store_->campaign("").n_done, 2);
}

TEST_F(FieldsTest, WhoseFilesAreGoneAreWantedAgain) {
  record(with_fields(completed(ids_[1], 0.2)));
  write_files(1);
  EXPECT_EQ(store_->requeue_missing_fields(store_->campaign("")), 1);
  EXPECT_EQ(stored("1").fields, FieldsState::kept);
  EXPECT_EQ(stored("3").fields, FieldsState::wanted);
  EXPECT_EQ(store_->campaign("").n_fields_waiting, 1);
  std::filesystem::remove(store_->fields_folder("sweep", 1) / "faults.xmf");
  EXPECT_EQ(store_->requeue_missing_fields(store_->campaign("")), 1);
}

TEST_F(FieldsTest, OfAReplacedResultAreWantedAgain) {
  RunRecord run = with_fields(completed(ids_[1], 0.3));
  run.result->outcome = faultsim::Outcome::unconverged;
  record(run);
  const std::int64_t plain = store_->submit(submission(4, "plain")).campaign;
  EXPECT_EQ(store_->retry(plain, true, std::nullopt), 1);
  store_->record_runs(plain, {completed(ids_[1], 0.9)});
  EXPECT_EQ(stored("3").fields, FieldsState::wanted);
  EXPECT_EQ(store_->stored_case(plain, "3").fields, FieldsState::none);
  EXPECT_THAT(store_->waiting_families(campaign_)[0].fields_only, ElementsAre(ids_[1]));
}

TEST_F(FieldsTest, ViewsCountThem) {
  Submission s = submission(4, "other");
  s.keep_fields = KeepFields::all;
  const std::int64_t other = store_->submit(s).campaign;
  store_->record_runs(other, {fields_only(crashed(ids_[0], true))});
  Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
  const auto count = [&](const char* sql) {
    Statement query(connection, sql);
    query.step();
    return query.integer(0);
  };
  EXPECT_EQ(count("SELECT done FROM campaign_progress WHERE campaign = 'sweep'"), 1);
  EXPECT_EQ(count("SELECT done FROM campaign_progress WHERE campaign = 'other'"), 0);
  EXPECT_EQ(count("SELECT failed FROM campaign_progress WHERE campaign = 'other'"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM failures WHERE campaign = 'sweep'"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM failures WHERE campaign = 'other' AND fields_only"), 1);
}

}  // namespace
}  // namespace faultsweep
