#include "campaign/store/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "campaign/spec/metrics.h"
#include "campaign/store/migrations.h"
#include "campaign/store/sqlite.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::StorageError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::made_up_result;

class StoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "store_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  /// The first column of the first row, as another program reads it.
  std::int64_t count(const char* sql) const {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
    Statement query(connection, sql);
    query.step();
    return query.integer(0);
  }
  std::filesystem::path folder_;
};

/// n cases in two families, strengths i/n.
Submission submission(int n, const std::string& name = "sweep") {
  Submission s;
  s.name = name;
  s.source = "sweep.json";
  s.spec_given = "{}";
  s.spec_resolved = "{}";
  s.parameters = {{"strength", faultsim::Dimension::number, false}};
  s.rank_by = "activated_area";
  s.scenes = {{"scene.json", R"({"title": "base"})"}};
  s.families = {{"family-a", 1000, 100, 2.5, 1e8}, {"family-b", 500, 50, 1.0, 1e7}};
  for (int i = 0; i < n; ++i) {
    const std::string number = std::to_string(i);
    s.cases.push_back({"identity-" + number,
                       i % 2,
                       0,
                       R"({"/title": "case )" + number + "\"}",
                       {{0, static_cast<double>(i), number + " m"}}});
  }
  return s;
}

RunRecord completed(std::int64_t case_id, double strength) {
  RunRecord run;
  run.case_id = case_id;
  run.status = RunStatus::completed;
  run.host = "here";
  run.rank = 1;
  run.wall_seconds = 0.5;
  run.result = made_up_result(strength);
  return run;
}

RunRecord crashed(std::int64_t case_id, bool final) {
  RunRecord run;
  run.case_id = case_id;
  run.status = RunStatus::crashed;
  run.reason = "killed by SIGSEGV";
  run.signal = 11;
  run.log_tail = "last words";
  run.final = final;
  return run;
}

std::vector<std::int64_t> waiting(const Store& store, std::int64_t campaign) {
  std::vector<std::int64_t> ids;
  for (const WaitingFamily& family : store.waiting_families(campaign)) {
    ids.insert(ids.end(), family.cases.begin(), family.cases.end());
  }
  return ids;
}

TEST_F(StoreTest, KeepsTheThreeCopiesOfTheSpec) {
  Store store = Store::open_writer(folder_);
  Submission s = submission(4);
  s.spec_given = "{ \"as\": \"given\" }";
  s.spec_resolved = "{\"resolved\":1}";
  const SubmitOutcome outcome = store.submit(s);
  const Store::SpecCopies copies = store.spec_copies(outcome.campaign);
  EXPECT_EQ(copies.given, s.spec_given);
  EXPECT_EQ(copies.resolved, s.spec_resolved);
  EXPECT_EQ(copies.expanded_hash.size(), 32u);
}

TEST_F(StoreTest, RecognisesTheSameSpecAndNumbersAnother) {
  Store store = Store::open_writer(folder_);
  const SubmitOutcome first = store.submit(submission(4));
  const SubmitOutcome again = store.submit(submission(4));
  EXPECT_TRUE(again.existed);
  EXPECT_EQ(again.campaign, first.campaign);
  const SubmitOutcome longer = store.submit(submission(6));
  EXPECT_FALSE(longer.existed);
  EXPECT_EQ(longer.name, "sweep-2");
  EXPECT_EQ(store.campaign("").name, "sweep-2");
  EXPECT_EQ(store.campaign("sweep").n_cases, 4);
}

TEST_F(StoreTest, FindsTheCaseOfEachRowOfADesign) {
  Store store = Store::open_writer(folder_);
  Submission s = submission(3);
  s.design_rows = {{1, 2, 2}, {0, 1, 1}, {1, 1, 3}, {1, 3, 2}};  // row 3 was merged with row 2
  const std::int64_t first = store.submit(s).campaign;
  const std::int64_t other = store.submit(submission(3, "other")).campaign;
  std::vector<std::vector<long>> rows;
  for (const DesignRow& one : store.design_rows(first)) {
    rows.push_back({one.design, one.row, one.position});
  }
  EXPECT_THAT(rows, ElementsAre(ElementsAre(0, 1, 1), ElementsAre(1, 1, 3), ElementsAre(1, 2, 2),
                                ElementsAre(1, 3, 2)));
  EXPECT_THAT(store.design_rows(other), IsEmpty());
  EXPECT_TRUE(store.submit(s).existed);
  EXPECT_EQ(store.design_rows(first).size(), 4u);
  s.name = "beyond";
  s.design_rows = {{0, 1, 4}};
  EXPECT_THROW(store.submit(s), faultsim::InternalError) << "there is no case 4";
}

TEST_F(StoreTest, SharesCasesBetweenCampaigns) {
  Store store = Store::open_owner(folder_);
  const std::int64_t first = store.submit(submission(4)).campaign;
  const auto ids = waiting(store, first);
  store.record_runs(first, {completed(ids[0], 0.7), completed(ids[1], 0.2)});
  const SubmitOutcome second = store.submit(submission(6, "other"));
  EXPECT_EQ(second.n_cached, 2);
  EXPECT_EQ(store.preview(submission(1, "third")).n_cached, 1);
  EXPECT_TRUE(store.preview(submission(6, "other")).existed);
  EXPECT_EQ(store.campaigns().size(), 2u) << "a preview adds nothing";
  EXPECT_EQ(waiting(store, second.campaign).size(), 4u);
  EXPECT_THAT(store.campaigns_with(ids[0]), ElementsAre("sweep", "other"));
}

TEST_F(StoreTest, GivesBackWhatARunStored) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(2)).campaign;
  const auto ids = waiting(store, campaign);
  RunRecord run = completed(ids[0], 0.8);
  run.result->warnings = {"one", "two"};
  store.record_runs(campaign, {run});
  const StoredCase stored = store.stored_case(campaign, "1");
  ASSERT_TRUE(stored.has_result);
  EXPECT_EQ(stored.state, "done");
  EXPECT_THAT(stored.parameters, ElementsAre(CaseParameter{0, 0.0, "0 m"}));
  const faultsim::CaseResult& wanted = *run.result;
  ASSERT_EQ(stored.result.steps.size(), wanted.steps.size());
  EXPECT_EQ(stored.result.steps[7].stage, wanted.steps[7].stage);
  EXPECT_EQ(stored.result.steps[7].pressure_change, wanted.steps[7].pressure_change);
  EXPECT_EQ(stored.result.steps[7].faults[1].chi_bar, wanted.steps[7].faults[1].chi_bar);
  EXPECT_EQ(stored.result.fault_names, wanted.fault_names);
  ASSERT_EQ(stored.result.stages.size(), 3u);
  EXPECT_EQ(stored.result.stages[2].moment, wanted.stages[2].moment);
  EXPECT_EQ(stored.result.whole.activated_fault, "F1");
  EXPECT_EQ(stored.result.warnings, wanted.warnings);
  EXPECT_EQ(store.stored_case(campaign, "identity-0").position, 1);
  EXPECT_THROW(store.stored_case(campaign, "3"), faultsim::InputError);
}

TEST_F(StoreTest, NeverStoresASecondSuccess) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(2)).campaign;
  const auto ids = waiting(store, campaign);
  store.record_runs(campaign, {completed(ids[0], 0.8)});
  store.record_runs(campaign, {completed(ids[0], 0.1)});
  const StoredCase stored = store.stored_case(campaign, "1");
  EXPECT_EQ(stored.runs.size(), 1u);
  EXPECT_EQ(stored.result.whole.chi_bar, 0.8);
}

TEST_F(StoreTest, KeepsEachAttemptAndWaitsUntilTheFinalOne) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(2)).campaign;
  const auto ids = waiting(store, campaign);
  store.record_runs(campaign, {crashed(ids[0], false)});
  EXPECT_EQ(store.campaign("").n_waiting, 2);
  store.record_runs(campaign, {crashed(ids[0], true)});
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_EQ(info.n_waiting, 1);
  const StoredCase stored = store.stored_case(campaign, "1");
  ASSERT_EQ(stored.runs.size(), 2u);
  EXPECT_EQ(stored.runs[1].attempt, 2);
  EXPECT_EQ(stored.runs[1].signal, 11);
  EXPECT_EQ(stored.runs[1].log_tail, "last words");
  const auto failures = store.failure_counts(campaign);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failures[0].reason, "killed by SIGSEGV");
  Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
  const auto count = [&](const char* sql) {
    Statement query(connection, sql);
    query.step();
    return query.integer(0);
  };
  EXPECT_EQ(count("SELECT attempt FROM failures"), 2) << "the last attempt alone";
  EXPECT_EQ(store.retry(campaign, false, std::nullopt), 1);
  EXPECT_EQ(store.campaign("").n_waiting, 2);
  store.record_runs(campaign, {completed(ids[0], 0.5)});
  EXPECT_EQ(count("SELECT count(*) FROM failures"), 0) << "a retry that succeeds is no failure";
  store.record_runs(campaign, {crashed(ids[1], true)});
  EXPECT_EQ(count("SELECT \"case\" FROM failures"), 2);
}

TEST_F(StoreTest, ReplacesAnUnconvergedResultWhenItsRetryEnds) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(1)).campaign;
  const auto ids = waiting(store, campaign);
  RunRecord run = completed(ids[0], 0.3);
  run.result->outcome = faultsim::Outcome::unconverged;
  run.result->steps.back().outcome = faultsim::Outcome::unconverged;
  store.record_runs(campaign, {run});
  EXPECT_EQ(store.retry(campaign, false, std::nullopt), 0);
  EXPECT_EQ(store.retry(campaign, true, std::nullopt), 1);
  EXPECT_TRUE(store.stored_case(campaign, "1").has_result);
  store.record_runs(campaign, {completed(ids[0], 0.9)});
  const StoredCase stored = store.stored_case(campaign, "1");
  EXPECT_EQ(stored.result.whole.chi_bar, 0.9);
  EXPECT_EQ(stored.runs.size(), 2u);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

/// Values of other faults and stages, more of them than rows are joined: each is that of its row as
/// it was recorded, and a case without a result has none, where an expression of nothing would be
/// 0.
TEST_F(StoreTest, TablesHaveTheValuesOfManyFaultsAndStages) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(3)).campaign;
  std::map<long, faultsim::CaseResult> results;
  for (const long id : {1, 3}) {
    RunRecord run = completed(id, 0.5 + 0.1 * static_cast<double>(id));
    results[id] = *run.result;
    store.record_runs(campaign, {run});
  }
  Store::TableQuery query;
  struct Asked {
    std::size_t fault, stage;  // the last stage is the whole history
  };
  std::vector<Asked> asked;
  const auto stages = store.stages(campaign), faults = store.faults(campaign);
  ASSERT_EQ(stages.size(), 4u);
  ASSERT_EQ(faults.size(), 2u);
  const auto id_of = [](const std::vector<NamedId>& all, const std::string& name) {
    return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; })
        ->id;
  };
  const faultsim::CaseResult& any = results.at(1);  // all have the same faults and stages
  for (std::size_t f = 0; f < 2; ++f) {
    for (std::size_t s = 0; s < 4; ++s) {
      const MetricScope scope{id_of(faults, any.fault_names[f]),
                              id_of(stages, s < 3 ? any.stages[s].stage : "")};
      asked.push_back({f, s});
      for (const char* metric : {"chi_bar", "activation_resolved", "slips"})
        query.columns.push_back({metric_sql(metric, scope, 0), {}});
    }
  }
  for (int k = 0; k < 60; ++k)  // of stages that there are not
    query.columns.push_back({metric_sql("chi_bar", {.stage = 1000 + k}, 0), {}});
  query.where = {
      "(" + metric_sql("chi_bar", {.stage = id_of(stages, "gas_storage")}, 0) + ") IS NOT 0.7 OR ?",
      {Value(true)}};
  long n_cases = 0;
  store.for_each_case(campaign, query, [&](const CaseRow& row) {
    ++n_cases;
    const auto found = results.find(row.position);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const Cell &chi = row.metrics[3 * k], &resolved = row.metrics[3 * k + 1],
                 &slips = row.metrics[3 * k + 2];
      if (found == results.end()) {
        EXPECT_EQ(chi, Cell());
        EXPECT_EQ(resolved, Cell()) << "not 0";
        EXPECT_EQ(slips, Cell());
        continue;
      }
      const auto& [f, s] = asked[k];
      const faultsim::CaseResult& result = found->second;
      const auto& own = (s < 3 ? result.stages[s] : result.whole).faults[f];
      EXPECT_EQ(chi, Cell(own.chi_bar));
      EXPECT_EQ(resolved, Cell(std::int64_t{own.activation_resolved}));
      EXPECT_EQ(slips, Cell(std::int64_t{own.slips}));
    }
    for (std::size_t k = 3 * asked.size(); k < row.metrics.size(); ++k)
      EXPECT_EQ(row.metrics[k], Cell());
  });
  EXPECT_EQ(n_cases, 3);
}

TEST_F(StoreTest, RanksByAreaMomentMarginAndKeepsUnstableApart) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(6)).campaign;
  const double strengths[] = {0.2, 0.9, 0.4, 0.6, 0.95, 0.3};
  for (const auto id : waiting(store, campaign)) {
    RunRecord run = completed(id, strengths[id - 1]);
    if (id == 5) run.result->outcome = faultsim::Outcome::unstable;
    store.record_runs(campaign, {run});
  }
  std::vector<long> order;
  for (const RankedCase& row : store.ranking(campaign, {})) order.push_back(row.position);
  EXPECT_THAT(order, ElementsAre(2, 4, 3, 6, 1, 5));  // 5 is unstable
  Store::RankingQuery query;
  query.by = {metric_sql("chi_bar"), {}};
  query.ascending = true;
  query.limit = 2;
  query.where = {metric_sql("chi_bar") + " > ?", {Value(0.25)}};
  order.clear();
  for (const RankedCase& row : store.ranking(campaign, query)) order.push_back(row.position);
  EXPECT_THAT(order, ElementsAre(6, 3));
  query = {};
  query.stage = "gas_storage";
  query.where = {parameter_sql(0, false) + " = ?", {Value(1.0)}};
  const auto rows = store.ranking(campaign, query);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].position, 2);
  EXPECT_DOUBLE_EQ(rows[0].metrics.moment, 1e15 * 0.4 * 0.5);
}

TEST_F(StoreTest, AllViewsWork) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(2)).campaign;
  const auto ids = waiting(store, campaign);
  store.record_runs(campaign, {completed(ids[0], 0.8), crashed(ids[1], true)});
  EXPECT_EQ(count("SELECT count(*) FROM ranking"), 1);
  EXPECT_EQ(count("SELECT count(*) FROM stage_ranking"), 4);
  EXPECT_EQ(count("SELECT count(*) FROM chi_history_wide"), 26);
  EXPECT_EQ(count("SELECT count(*) FROM failures"), 1);
  EXPECT_EQ(count("SELECT done FROM campaign_progress"), 1);
}

TEST_F(StoreTest, LivingManagerKeepsOthersOutAndADeadOneIsTakenOver) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(1)).campaign;
  const pid_t child = fork();
  if (child == 0) {
    {
      Store theirs = Store::open_owner(folder_);
      theirs.claim_ownership(campaign, 2);
    }
    pause();
    _exit(0);
  }
  for (int k = 0; k < 500 && !store.owner(); ++k) usleep(10000);
  try {
    store.claim_ownership(campaign, 2);
    ADD_FAILURE() << "two managers";
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is managed by process " + std::to_string(child)));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(store.owner()->alive);
  store.claim_ownership(campaign, 2);
  EXPECT_TRUE(store.owner()->alive);
  EXPECT_EQ(store.events(campaign, 5).at(0).kind, "takeover");
  store.release_ownership();
  EXPECT_FALSE(store.owner());
}

TEST_F(StoreTest, AStatementThatIsInUseIsNotRestarted) {
  Connection connection(folder_ / "other.sqlite", Connection::Mode::owner);
  connection.execute("CREATE TABLE numbers (n); INSERT INTO numbers VALUES (1), (2)");
  std::vector<std::int64_t> seen;
  Statement outer = connection.prepared("SELECT n FROM numbers ORDER BY n");
  while (outer.step()) {
    Statement inner = connection.prepared("SELECT n FROM numbers ORDER BY n");
    while (inner.step()) seen.push_back(10 * outer.integer(0) + inner.integer(0));
  }
  EXPECT_EQ(seen, (std::vector<std::int64_t>{11, 12, 21, 22}));
}

TEST_F(StoreTest, EveryMeasureIsAColumnOfItsTablesAndViews) {
  { Store::open_writer(folder_); }
  Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
  const faultsim::Measures measures;
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto&) {
    for (const char* view : {"ranking", "stage_ranking", "fault_ranking"}) {
      EXPECT_NO_THROW(
          Statement(connection, faultsim::concat("SELECT ", field.key, " FROM ", view)));
    }
    if (!field.sql.empty()) return;
    for (const char* table : {"stage_metrics", "fault_metrics"}) {
      EXPECT_NO_THROW(
          Statement(connection, faultsim::concat("SELECT ", field.key, " FROM ", table)));
    }
  });
}

TEST_F(StoreTest, RefusesANewerSchemaAndForeignFiles) {
  { Store::open_writer(folder_); }
  {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
    connection.execute("PRAGMA user_version = 99");
  }
  EXPECT_THROW(Store::open_writer(folder_), StorageError);
  EXPECT_THROW(Store::open_reader(folder_), StorageError);
  {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
    connection.execute("PRAGMA application_id = 7");
  }
  EXPECT_THROW(Store::open_writer(folder_), StorageError);
}

TEST_F(StoreTest, MigratesStepByStepAndNotesEach) {
  Connection connection(folder_ / "other.sqlite", Connection::Mode::owner);
  std::vector<Migration> migrations = store_migrations();
  migrate(connection, migrations);
  const int last = migrations.back().version;
  migrations.push_back({last + 1, "2026-01-01 colour", "ALTER TABLE cases ADD COLUMN colour TEXT"});
  migrate(connection, migrations);
  migrate(connection, migrations);
  Statement query(connection, "SELECT max(version), count(*) FROM migrations");
  query.step();
  EXPECT_EQ(query.integer(0), last + 1);
  EXPECT_EQ(query.integer(1), last + 1);
  Statement uses(connection, "SELECT colour FROM cases");
  migrations.push_back({last + 2, "broken", "CREATE TABLE half (a); SELECT nonsense"});
  EXPECT_THROW(migrate(connection, migrations), StorageError);
  Statement version(connection, "PRAGMA user_version");
  version.step();
  EXPECT_EQ(version.integer(0), last + 1);
  Statement half(connection, "SELECT count(*) FROM sqlite_master WHERE name = 'half'");
  half.step();
  EXPECT_EQ(half.integer(0), 0);
}

TEST_F(StoreTest, BringsAStoreOfTheFirstVersionUpToDate) {
  {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
    migrate(connection, {store_migrations().front()});
    connection.execute(
        "INSERT INTO scenes VALUES (1, 'h', 'scene.json', '{}');"
        "INSERT INTO families VALUES (1, 'family', 1, 1, 1, 1, NULL);"
        "INSERT INTO campaigns VALUES (1, 'old', 5, 'open', 'f', '{}', 'h', '{}', 'h', 'h',"
        " '[{\"name\": \"a\", \"dimension\": \"length\"},"
        " {\"name\": \"b\", \"dimension\": \"text\"},"
        " {\"name\": \"c\", \"dimension\": \"text\"}]',"
        " 'moment', 0, 0, 'continue', 0, NULL, NULL);"
        "INSERT INTO cases VALUES (1, 'id-1', 1, 1, '{}', 'done', 'converged', 1);"
        "INSERT INTO cases VALUES (2, 'id-2', 1, 1, '{}', 'waiting', NULL, NULL);"
        "INSERT INTO campaign_cases VALUES (1, 1, 1,"
        " '[0.30000000000000004,\"mean\",null]', '[\"0.3 m\",\"mean\",null]'),"
        " (1, 2, 2, '[-7e-23,null,\"1\"]', '[\"-7e-23 m\",null,\"1\"]');"
        "INSERT INTO runs VALUES (1, 1, 1, 1, 5, 1, 'here', 1, 'completed', 'converged', '', NULL,"
        " NULL, '', 'op', 1);");
  }
  EXPECT_THROW(Store::open_reader(folder_), StorageError) << "readers change nothing";
  Store store = Store::open_writer(folder_);
  const CampaignInfo info = store.campaign("old");
  EXPECT_EQ(info.keep_fields, KeepFields::none);
  EXPECT_EQ(info.n_done, 1);
  EXPECT_EQ(info.n_waiting, 1);
  EXPECT_EQ(info.n_fields_waiting, 0);
  const StoredCase stored = store.stored_case(info.id, "1");
  EXPECT_EQ(stored.fields, FieldsState::none);
  ASSERT_EQ(stored.runs.size(), 1u);
  EXPECT_FALSE(stored.runs[0].fields_only);
  EXPECT_THAT(stored.parameters, ElementsAre(CaseParameter{0, 0.30000000000000004, "0.3 m"},
                                             CaseParameter{1, std::nullopt, "mean"}));
  EXPECT_THAT(
      store.stored_case(info.id, "2").parameters,
      ElementsAre(CaseParameter{0, -7e-23, "-7e-23 m"}, CaseParameter{2, std::nullopt, "1"}));
  ASSERT_EQ(store.rounds(info.id).size(), 1u);
  EXPECT_EQ(store.rounds(info.id)[0].n_cases, 2);
  EXPECT_THAT(store.integrity_problems(),
              ElementsAre("base scene 1 differs from its checksum",
                          "the spec of campaign old differs from its checksum",
                          "the result of case id-1 differs from its checksum"))
      << "hashes 'h' and a result without rows are made up, and noticed; nothing else is wrong";
}

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

TEST_F(StoreTest, DropsWalOnANetworkFileSystem) {
  Store store = Store::open_writer(folder_, true);
  EXPECT_THAT(store.remark(), HasSubstr("network file system"));
  store.submit(submission(2));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "campaign.sqlite-wal"));
  EXPECT_TRUE(is_network_file_system(0x6969));
  EXPECT_TRUE(is_network_file_system(0x0BD00BD0));
  EXPECT_FALSE(is_network_file_system(0xEF53));      // ext4
  EXPECT_FALSE(is_network_file_system(0x01021994));  // tmpfs
}

TEST_F(StoreTest, RollsBackWhatIsNotCommitted) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(3)).campaign;
  const auto ids = waiting(store, campaign);
  RunRecord bad = completed(ids[1], 0.7);
  bad.result->steps[1].faults[0].chi_bar = std::nan("");
  EXPECT_THROW(store.record_runs(campaign, {completed(ids[0], 0.7), bad}), faultsim::InternalError);
  EXPECT_EQ(store.campaign("").n_waiting, 3);
  store.record_runs(campaign, {completed(ids[0], 0.7), completed(ids[1], 0.7)});
  EXPECT_EQ(store.campaign("").n_done, 2);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(StoreTest, BackupIsAWholeStore) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(3)).campaign;
  const auto ids = waiting(store, campaign);
  store.record_runs(campaign, {completed(ids[0], 0.7)});
  std::filesystem::create_directory(folder_ / "copy");
  store.backup_to(folder_ / "copy" / "campaign.sqlite");
  Store copy = Store::open_reader(folder_ / "copy");
  EXPECT_EQ(copy.campaign("").n_done, 1);
  EXPECT_THROW(store.backup_to(folder_ / "copy" / "campaign.sqlite"), StorageError);
}

TEST_F(StoreTest, SaysWhatIsMissing) {
  EXPECT_THROW(Store::open_reader(folder_ / "nowhere"), StorageError);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW(Store::open_writer(folder_ / "file" / "store"), StorageError);
  Store store = Store::open_writer(folder_);
  EXPECT_THROW(store.campaign(""), StorageError);
  store.submit(submission(1));
  EXPECT_THROW(store.campaign("sweeep"), faultsim::InputError);
}

TEST_F(StoreTest, CountsOperatorsBuiltAndFound) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(2)).campaign;
  const std::int64_t family = store.waiting_families(campaign)[0].family;
  store.record_operator(family, {"op", false, 12.5, 1000, 100, 80000, 1 << 20});
  store.record_operator(family, {"op", true, 0.1, 1000, 100, 80000, 1 << 19});
  const auto families = store.family_progress(campaign);
  ASSERT_EQ(families.size(), 2u);
  EXPECT_EQ(families[0].operator_fingerprint, "op");
  EXPECT_EQ(families[0].build_seconds, 12.5);
  EXPECT_EQ(store.waiting_families(campaign)[0].operator_fingerprint, "op");
}

}  // namespace
}  // namespace faultsweep
