// Fields that a campaign keeps beside its results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "campaign/store/migrations.h"
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

/// A campaign of four decided cases that keeps the fields of those shown first.
class ShownFieldsTest : public StoreTest {
 protected:
  void SetUp() override {
    StoreTest::SetUp();
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    submission_ = submission(4);
    submission_.keep_fields = KeepFields::shown;
    campaign_ = store_->submit(submission_).campaign;
    ids_ = waiting(*store_, campaign_);
    for (const std::int64_t id : ids_) record(completed(id, 0.7));
  }
  /// In place of its full history.
  void end_early(std::int64_t id) {
    Connection(folder_ / "campaign.sqlite", Connection::Mode::read_write)
        .run("UPDATE cases SET state = 'waiting' WHERE id = ?", id);
    RunRecord run = completed(id, 0.7);
    run.result->outcome = faultsim::Outcome::unconverged;
    record(run);
  }
  void TearDown() override {
    store_.reset();
    StoreTest::TearDown();
  }
  void record(const RunRecord& run) { store_->record_runs(campaign_, {run}); }
  void add_fields(std::int64_t id) {
    RunRecord run = completed(id, 0.7);
    run.has_fields = run.fields_only = true;
    record(run);
  }
  FieldsState fields_of(std::int64_t id) const {
    return store_->decided_case(campaign_, id).fields;
  }
  CampaignInfo info() const { return store_->campaign(""); }

  Submission submission_;
  std::unique_ptr<Store> store_;
  std::int64_t campaign_ = 0;
  std::vector<std::int64_t> ids_;
};

TEST_F(ShownFieldsTest, AreAnExtraOfCasesThatAreDone) {
  EXPECT_EQ(info().keep_fields, KeepFields::shown);
  EXPECT_EQ(info().n_done, 4);
  EXPECT_THAT(store_->waiting_families(campaign_), IsEmpty()) << "nobody asked for fields yet";
  store_->want_fields(campaign_, {ids_[0], ids_[2]});
  EXPECT_EQ(info().n_done, 4);
  EXPECT_EQ(info().n_waiting, 0);
  EXPECT_EQ(info().n_fields_waiting, 2);
  EXPECT_EQ(info().n_fields_kept, 0);
  const auto families = store_->waiting_families(campaign_);
  ASSERT_EQ(families.size(), 2u);
  EXPECT_THAT(families[0].cases, ElementsAre(ids_[0]));
  EXPECT_THAT(families[0].fields_only, ElementsAre(ids_[0]));
  EXPECT_THAT(families[1].fields_only, ElementsAre(ids_[2]));
  add_fields(ids_[0]);
  EXPECT_EQ(info().n_fields_kept, 1);
  EXPECT_EQ(info().n_fields_waiting, 1);
  EXPECT_EQ(count("SELECT done FROM campaign_progress"), 4);
  EXPECT_THAT(store_->integrity_problems(), IsEmpty());
}

TEST_F(ShownFieldsTest, ThatCannotBeAddedFailNothingAndAreSaid) {
  store_->want_fields(campaign_, {ids_[1]});
  RunRecord run = crashed(ids_[1], true);
  run.fields_only = true;
  run.reason = "disk full";
  record(run);
  EXPECT_EQ(info().n_done, 4);
  EXPECT_EQ(info().n_failed, 0);
  EXPECT_EQ(info().n_complete(), 4);
  EXPECT_EQ(info().n_fields_failed, 1);
  EXPECT_THAT(store_->waiting_families(campaign_), IsEmpty());
  const auto failures = store_->failure_counts(campaign_);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failures[0].reason, "fields: disk full");
  EXPECT_EQ(store_->retry(campaign_, false, std::nullopt), 1);
  EXPECT_EQ(info().n_fields_waiting, 1);
}

/// One that ended early is told for that, too, where its fields failed.
TEST_F(ShownFieldsTest, OfCasesThatEndedEarlyHideNothing) {
  end_early(ids_[3]);
  store_->want_fields(campaign_, {ids_[3]});
  RunRecord run = crashed(ids_[3], true);
  run.fields_only = true;
  record(run);
  const auto failures = store_->failure_counts(campaign_);
  ASSERT_EQ(failures.size(), 2u);
  EXPECT_EQ(failures[0].reason, "unconverged");
}

/// What was wanted when a manager died, and what was deleted, is chosen anew.
TEST_F(ShownFieldsTest, AreChosenAnewByTheNextRun) {
  store_->want_fields(campaign_, {ids_[0], ids_[1]});
  add_fields(ids_[0]);
  EXPECT_EQ(fields_of(ids_[0]), FieldsState::kept);
  EXPECT_EQ(store_->requeue_missing_fields(info()), 1) << "the files of the first were never there";
  EXPECT_EQ(fields_of(ids_[0]), FieldsState::none);
  EXPECT_EQ(fields_of(ids_[1]), FieldsState::none);
  store_->want_fields(campaign_, {ids_[0]});
  add_fields(ids_[0]);
  const auto folder = store_->fields_folder("sweep", 1);
  std::filesystem::create_directories(folder);
  for (const char* file : {"faults.h5", "faults.xmf"}) std::ofstream(folder / file) << "x";
  EXPECT_EQ(store_->requeue_missing_fields(info()), 0);
  EXPECT_EQ(fields_of(ids_[0]), FieldsState::kept);
}

TEST_F(ShownFieldsTest, OfAReplacedResultAreThoseOfTheOldOne) {
  end_early(ids_[0]);
  store_->want_fields(campaign_, {ids_[0]});
  add_fields(ids_[0]);
  EXPECT_EQ(store_->retry(campaign_, true, std::nullopt), 1);
  record(completed(ids_[0], 0.9));
  EXPECT_EQ(fields_of(ids_[0]), FieldsState::wanted);
  store_->want_fields(campaign_, {ids_[1]});
  EXPECT_EQ(fields_of(ids_[0]), FieldsState::none) << "it is not shown first any more";
}

TEST_F(ShownFieldsTest, CostWhatTheCaseAndItsOperatorTook) {
  DecidedCase one = store_->decided_case(campaign_, ids_[0]);
  EXPECT_EQ(one.position, 1);
  EXPECT_EQ(one.seconds, 0.5);
  EXPECT_EQ(one.operator_seconds, 2.5) << "as predicted: it was never built here";
  EXPECT_EQ(one.operator_fingerprint, "");
  EXPECT_FALSE(one.creeps);
  const std::int64_t family = count("SELECT family_id FROM cases ORDER BY id LIMIT 1");
  store_->record_operator(family, {"print", false, 70, 1, 1, 1, 1});
  one = store_->decided_case(campaign_, ids_[0]);
  EXPECT_EQ(one.operator_seconds, 70) << "as measured";
  EXPECT_EQ(one.operator_fingerprint, "print");
}

/// Whatever the spec says now: a campaign that is in the store keeps what it kept.
TEST_F(ShownFieldsTest, AreNotThoseOfACampaignThatWasThere) {
  Submission none = submission(4, "old");
  const std::int64_t old = store_->submit(none).campaign;
  none.keep_fields = KeepFields::shown;
  EXPECT_EQ(store_->preview(none).keep_fields, KeepFields::none);
  const SubmitOutcome outcome = store_->submit(none);
  EXPECT_TRUE(outcome.existed);
  EXPECT_EQ(outcome.campaign, old);
  EXPECT_EQ(outcome.keep_fields, KeepFields::none);
  EXPECT_EQ(store_->campaign("old").keep_fields, KeepFields::none);
  EXPECT_EQ(store_->submit(submission_).keep_fields, KeepFields::shown);
  EXPECT_EQ(store_->submit(submission_).n_fields, 0) << "of no case before all are decided";
}

/// A store of before migration 19.
TEST_F(StoreTest, CampaignsOfBeforeKeepTheFieldsThatTheyKept) {
  Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
  std::vector<Migration> old = store_migrations();
  while (old.back().version > 18) old.pop_back();
  migrate(connection, old);
  const auto add = [&](const std::string& name, const std::string& keep) {
    connection.run(
        "INSERT INTO campaigns (name, submitted_at, source, spec_given, spec_given_hash,"
        " spec_resolved, spec_resolved_hash, spec_expanded_hash, parameters, rank_by, n_excluded,"
        " n_merged, on_failure, retries, keep_fields) VALUES (?, 0, '', '', '', '', '', '', '[]',"
        " '', 0, 0, 'continue', 0, ?)",
        name, keep);
  };
  for (const char* keep : {"none", "stages", "all"}) add(keep, keep);
  EXPECT_THROW(add("early", "shown"), StorageError);
  migrate(connection, store_migrations());
  EXPECT_EQ(connection.row<std::int64_t>("SELECT count(*) FROM campaigns WHERE name = keep_fields"),
            3);
  add("late", "shown");
  EXPECT_THROW(add("wrong", "some"), StorageError);
}

}  // namespace
}  // namespace faultsweep
