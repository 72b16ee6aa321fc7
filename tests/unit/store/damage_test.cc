#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "campaign/store/migrations.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

/// Damage to a store, and files that are none.
namespace faultsweep {
namespace {

using faultsim::StorageError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

template <typename Body>
std::string error_of(const Body& body) {
  try {
    body();
  } catch (const StorageError& error) {
    return error.what();
  }
  return "no error";
}

class Damage : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "damage_XXXXXX";
    folder_ = mkdtemp(name.data());
    file_ = folder_ / "campaign.sqlite";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// n cases, the first `n_done` with a result; the whole store is in its file.
  void make_store(int n, int n_done) const {
    Store store = Store::open_owner(folder_);
    Submission s;
    s.name = "sweep";
    s.source = "sweep.json";
    s.spec_given = s.spec_resolved = "{}";
    s.parameters = {{"strength", faultsim::Dimension::number, false}};
    s.rank_by = "activated_area";
    s.scenes = {{"scene.json", R"({"title": "base"})"}};
    s.families = {{"family", 1000, 100, 2.5, 1e8}};
    for (int i = 0; i < n; ++i) {
      const std::string number = std::to_string(i);
      s.cases.push_back({"identity-" + number,
                         0,
                         0,
                         R"({"/title": "case )" + number + "\"}",
                         {{0, std::stod(number), number + " m"}}});
    }
    const std::int64_t campaign = store.submit(s).campaign;
    std::vector<RunRecord> runs;
    for (int i = 0; i < n_done; ++i) {
      RunRecord run;
      run.case_id = i + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(0.1 + 0.1 * i);
      runs.push_back(run);
    }
    store.record_runs(campaign, runs);
    store.checkpoint();
  }
  void change(const char* sql) const { Connection(file_, Connection::Mode::owner).execute(sql); }
  std::vector<std::string> problems() const {
    return Store::open_reader(folder_).integrity_problems();
  }

  std::filesystem::path folder_, file_;
};

TEST_F(Damage, ChecksumsNoticeAChangedNumberInEveryTableOfAResult) {
  make_store(5, 4);
  EXPECT_THAT(problems(), IsEmpty());
  for (const char* sql : {"UPDATE case_metrics SET newton_iterations = newton_iterations + 1",
                          "UPDATE stage_metrics SET chi_bar = chi_bar + 1e-15",
                          "UPDATE load_steps SET time_s = time_s + 1",
                          "UPDATE chi_history SET max_slip_m = -max_slip_m - 1e-9",
                          "UPDATE runs SET reason = 'another'", "DELETE FROM load_steps"}) {
    const std::string before = bytes_of(file_);
    change((std::string(sql) + " WHERE case_id = 2").c_str());
    EXPECT_THAT(problems(), ElementsAre("the result of case identity-1 differs from its checksum"))
        << sql;
    std::filesystem::remove(folder_ / "campaign.sqlite-wal");
    std::filesystem::remove(folder_ / "campaign.sqlite-shm");
    std::ofstream(file_, std::ios::binary) << before;
    EXPECT_THAT(problems(), IsEmpty());
  }
}

TEST_F(Damage, ChecksumsNoticeChangedParametersScenesAndSpecs) {
  make_store(3, 1);
  change("UPDATE case_parameters SET text = '7 m' WHERE position = 3");
  EXPECT_THAT(problems(), ElementsAre("the cases of campaign sweep differ from their checksum"));
  change("UPDATE scenes SET document = '{}'");
  EXPECT_THAT(problems(), ::testing::Contains("base scene 1 differs from its checksum"));
  change("UPDATE campaigns SET spec_given = '{ }'");
  EXPECT_THAT(problems(),
              ::testing::Contains("the spec of campaign sweep differs from its checksum"));
  EXPECT_THAT(Store::damage_of(folder_).value_or(""), HasSubstr("restore a backup"));
}

TEST_F(Damage, AResultThatIsReplacedGetsANewChecksum) {
  make_store(2, 2);
  Store store = Store::open_owner(folder_);
  change("UPDATE cases SET state = 'failed' WHERE id = 1");
  ASSERT_EQ(store.retry(1, false, {}), 1);
  RunRecord run;
  run.case_id = 1;
  run.status = RunStatus::completed;
  run.result = testing::made_up_result(0.9);
  store.record_runs(1, {run});
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(Damage, AnOlderStoreIsSealedOnceItIsOpenedForWriting) {
  make_store(2, 2);
  change("UPDATE checksum_schema SET version = 0; DELETE FROM result_checksums");
  EXPECT_THAT(problems(), IsEmpty()) << "nothing to check against";
  Store::open_writer(folder_);
  change("UPDATE stage_metrics SET chi_bar = 0 WHERE case_id = 1");
  EXPECT_EQ(problems().size(), 1u);
}

TEST_F(Damage, ABackupIsCheckedAndOneOfADamagedStoreIsRefused) {
  make_store(40, 30);
  Store::open_reader(folder_).backup_to(folder_ / "good");
  EXPECT_EQ(bytes_of(folder_ / "good").size(), bytes_of(file_).size());
  change("UPDATE chi_history SET chi_bar = chi_bar + 1e-9 WHERE case_id = 3 AND step = 2");
  const std::string flipped =
      error_of([&] { Store::open_reader(folder_).backup_to(folder_ / "flipped"); });
  EXPECT_THAT(flipped,
              HasSubstr("no backup was made, as the store is damaged: the result of case"));
  std::string bytes = bytes_of(file_);
  bytes.replace(bytes.size() / 2, 4096, 4096, '\0');
  std::filesystem::remove(folder_ / "campaign.sqlite-wal");
  std::filesystem::remove(folder_ / "campaign.sqlite-shm");
  std::ofstream(file_, std::ios::binary) << bytes;
  const std::string zeroed =
      error_of([&] { Store::open_reader(folder_).backup_to(folder_ / "zeroed"); });
  EXPECT_THAT(zeroed, HasSubstr("damaged"));
  EXPECT_THAT(zeroed, HasSubstr("restore a backup"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".tmp")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "flipped"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "zeroed"));
}

TEST_F(Damage, AnotherProgramsDatabaseIsRefusedAndLeftAsItWas) {
  { Connection(file_, Connection::Mode::owner).execute("CREATE TABLE tracks (title TEXT)"); }
  const std::string before = bytes_of(file_);
  const std::string said = error_of([&] { Store::open_writer(folder_); });
  EXPECT_THAT(said, HasSubstr("another program's database"));
  EXPECT_THAT(said, HasSubstr("choose another --store"));
  EXPECT_THAT(error_of([&] { Store::open_reader(folder_); }), HasSubstr("another program's"));
  EXPECT_EQ(bytes_of(file_), before);
}

TEST_F(Damage, AnEmptyFileIsNoStoreToRead) {
  std::ofstream(file_).close();
  EXPECT_THAT(error_of([&] { Store::open_reader(folder_); }), HasSubstr("is empty"));
  make_store(1, 0);
  EXPECT_THAT(problems(), IsEmpty());
}

}  // namespace
}  // namespace faultsweep
