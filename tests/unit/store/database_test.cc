// The database of a store: who holds it, its schema and its copies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "campaign/store/migrations.h"
#include "campaign/store/sqlite.h"
#include "simulator/result/measures.h"
#include "tests/unit/store/store_fixture.h"

namespace faultsweep {
namespace {

using faultsim::StorageError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

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

/// As when this process was suspended for longer than a minute.
TEST_F(StoreTest, AManagerThatWasReplacedLearnsItAtItsNextHeartbeat) {
  Store store = Store::open_owner(folder_);
  store.claim_ownership(store.submit(submission(1)).campaign, 2);
  store.heartbeat("{}");
  Connection other(folder_ / "campaign.sqlite", Connection::Mode::read_write);
  for (const char* change : {"host = 'elsewhere'", "pid = 1", "pid_started = 1"}) {
    other.execute(concat("UPDATE owner SET heartbeat_at = 17, progress = 'theirs', ", change));
    try {
      store.heartbeat("{}");
      ADD_FAILURE() << change;
    } catch (const StorageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("was taken over by process "));
    }
    EXPECT_EQ(count("SELECT heartbeat_at FROM owner"), 17);
    EXPECT_EQ(store.owner()->progress, "theirs");
    store.release_ownership();
    store.claim_ownership(1, 2);
  }
  other.execute("DELETE FROM owner");
  EXPECT_THROW(store.heartbeat("{}"), StorageError);
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

}  // namespace
}  // namespace faultsweep
