#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/store/same_numbers.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

/// How exact a result is stands with it in the store.
namespace faultsweep {
namespace {

using faultsim::CaseResult;
using faultsim::concat;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::made_up_result;

/// Numbers that need all their bits.
CaseResult approximate() {
  CaseResult result = made_up_result(0.8);
  result.surface = faultsim::CaseSurface{75,       70,       12,       1e-3 / 3, 1.2e-4 / 7,
                                         3e-5 / 7, 2e-6 / 7, 6e-4 / 7, 9e-4 / 7};
  result.surface->n_cases = 24;
  result.surface->chi_tolerance = 3e-3 / 7;
  result.surface->chi_bar = 1e-3 / 7;
  result.surface->largest_slip = 2e-2 / 7;
  result.surface->flags_that_differ = 2;
  result.field_coverage = 0.26 / 3;
  result.field_assumed = 0.71 / 3;
  result.steps[1].temperature_change = {-12.5 / 3, 0};
  return result;
}

RunRecord run_of(std::int64_t case_id, const CaseResult& result) {
  RunRecord run;
  run.case_id = case_id;
  run.status = RunStatus::completed;
  run.result = result;
  return run;
}

class Approximation : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "approximation_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A store of cases 1, 2, ... with these results, and one more case.
  void make_store(const std::vector<CaseResult>& results) const {
    Store store = Store::open_owner(folder_);
    Submission s;
    s.name = "sweep";
    s.parameters = {};
    s.spec_given = s.spec_resolved = "{}";
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    for (std::size_t k = 0; k <= results.size(); ++k) {
      s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {}});
    }
    ASSERT_EQ(store.submit(s).campaign, 1);
    std::vector<RunRecord> runs;
    for (const CaseResult& result : results) {
      runs.push_back(run_of(std::ssize(runs) + 1, result));
    }
    store.record_runs(1, runs);
    store.checkpoint();
  }
  void change(const std::string& sql) const {
    Connection(folder_ / "campaign.sqlite", Connection::Mode::owner).execute(sql.c_str());
  }
  double number(const std::string& sql) const {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
    Statement query(connection, sql);
    EXPECT_TRUE(query.step()) << sql;
    return query.real(0);
  }
  std::vector<std::string> problems() const {
    return Store::open_reader(folder_).integrity_problems();
  }

  std::filesystem::path folder_;
};

TEST_F(Approximation, ComesBackBitForBit) {
  const CaseResult result = approximate();
  make_store({result, made_up_result(0.3)});
  const Store store = Store::open_reader(folder_);
  const CaseResult back = *store.stored_result(1), exact = *store.stored_result(2);
  EXPECT_EQ(back.surface, result.surface);
  EXPECT_EQ(back.field_coverage, result.field_coverage);
  EXPECT_EQ(back.field_assumed, result.field_assumed);
  EXPECT_EQ(first_difference(back, result), "");
  EXPECT_EQ(back.steps[1].temperature_change, result.steps[1].temperature_change);
  EXPECT_TRUE(back.steps[0].temperature_change.empty());
  EXPECT_FALSE(exact.surface);
  EXPECT_FALSE(exact.field_coverage);
  EXPECT_FALSE(exact.field_assumed);
  EXPECT_TRUE(store.stored_case(1, "1").result.surface) << "as it is shown";
}

TEST_F(Approximation, GoesWithAResultThatIsReplaced) {
  CaseResult stopped = approximate();
  stopped.outcome = faultsim::Outcome::unconverged;
  make_store({stopped, stopped});
  Store store = Store::open_owner(folder_);
  EXPECT_EQ(store.retry(1, true, std::nullopt), 2);
  CaseResult better = approximate();
  better.surface->slip = 1e-9;
  better.field_coverage = 0.5;
  store.record_runs(1, {run_of(1, made_up_result(0.8)), run_of(2, better)});
  EXPECT_FALSE(store.stored_result(1)->surface);
  EXPECT_FALSE(store.stored_result(1)->field_coverage);
  EXPECT_EQ(store.stored_result(2)->surface, better.surface);
  EXPECT_EQ(store.stored_result(2)->field_coverage, 0.5);
  EXPECT_EQ(number("SELECT count(*) FROM case_surfaces"), 1);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(Approximation, IsSealedWithItsResultAndBackedUp) {
  make_store({approximate()});
  EXPECT_THAT(problems(), IsEmpty());
  std::filesystem::create_directory(folder_ / "copy");
  Store::open_reader(folder_).backup_to(folder_ / "copy" / "campaign.sqlite");
  EXPECT_EQ(Store::open_reader(folder_ / "copy").stored_result(1)->surface, approximate().surface);
  const auto differs = ElementsAre("the result of case identity-0 differs from its checksum");
  for (const char* column :
       {"operators", "basis", "checks", "tolerance", "error_of_stiffness", "error_of_traction",
        "error_of_observation", "error_of_slip", "error_of_stability", "cases",
        "tolerance_of_chi_bar", "error_of_chi_bar", "error_of_largest_slip", "flags_that_differ"}) {
    change(concat("UPDATE case_surfaces SET ", column, " = ", column, " + 1"));
    EXPECT_THAT(problems(), differs) << column;
    for (const char* end : {"", "-wal", "-shm"}) {
      std::filesystem::remove(folder_ / concat("campaign.sqlite", end));
    }
    std::filesystem::copy(folder_ / "copy" / "campaign.sqlite", folder_ / "campaign.sqlite");
    EXPECT_THAT(problems(), IsEmpty());
  }
  change("UPDATE case_metrics SET field_assumed = NULL");
  EXPECT_THAT(problems(), differs);
}

TEST_F(Approximation, StandsBesideTheMeasuresInTheViews) {
  make_store({approximate(), made_up_result(0.8)});
  const faultsim::CaseSurface surface = *approximate().surface;
  for (const std::string view : {"ranking", "stage_ranking", "fault_ranking"}) {
    const auto of = [&](const char* column, int position) {
      return number(concat("SELECT ", column, " FROM ", view, " WHERE \"case\" = ", position));
    };
    EXPECT_EQ(of("surface_operators", 1), 75);
    EXPECT_EQ(of("surface_error_of_stiffness", 1), surface.stiffness);
    EXPECT_EQ(of("surface_error_of_traction", 1), surface.traction);
    EXPECT_EQ(of("surface_error_of_slip", 1), surface.slip);
    EXPECT_EQ(of("surface_error_of_stability", 1), *surface.stability);
    EXPECT_EQ(of("field_coverage", 1), 0.26 / 3);
    EXPECT_EQ(of("field_assumed", 1), 0.71 / 3);
    const char* none =
        "coalesce(surface_operators, surface_error_of_stiffness, surface_error_of_traction,"
        " surface_error_of_slip, field_coverage, field_assumed) IS NULL";
    EXPECT_EQ(of(none, 2), 1) << view;
    EXPECT_EQ(of("count(*)", 1), of("count(*)", 2)) << "no row is lost or doubled in " << view;
  }
}

/// What the store was before migration 16, with another view of the time.
constexpr const char* kBack =
    "DROP VIEW ranking; DROP VIEW stage_ranking; DROP VIEW fault_ranking;"
    "CREATE VIEW ranking AS SELECT case_id FROM case_metrics;"
    "ALTER TABLE fault_onsets DROP COLUMN load_factor_before;"
    "ALTER TABLE fault_onsets DROP COLUMN load_factor_after;"
    "ALTER TABLE fault_onsets DROP COLUMN change_before_pa;"
    "DROP TABLE case_surfaces; ALTER TABLE case_metrics DROP COLUMN field_coverage;"
    "ALTER TABLE case_metrics DROP COLUMN field_assumed;"
    "ALTER TABLE load_steps DROP COLUMN temperature_change_k;"
    "DELETE FROM migrations WHERE version > 15; PRAGMA user_version = 15;"
    "UPDATE checksum_schema SET version = 15";

TEST_F(Approximation, OfAnOlderStoreIsNotKnown) {
  const CaseResult result = made_up_result(0.8);
  make_store({result});
  change(kBack);
  Store store = Store::open_owner(folder_);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
  const CaseResult back = *store.stored_result(1);
  EXPECT_FALSE(back.surface);
  EXPECT_FALSE(back.field_coverage);
  EXPECT_EQ(first_difference(back, result), "");
  EXPECT_EQ(number("SELECT count(*) FROM ranking WHERE surface_operators IS NULL"), 1);
  store.record_runs(1, {run_of(2, approximate())});
  EXPECT_EQ(store.stored_result(2)->surface, approximate().surface);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(Approximation, OfADamagedOlderStoreIsNotAddedOverTheDamage) {
  make_store({made_up_result(0.8)});
  change(concat(kBack, "; UPDATE stage_metrics SET chi_bar = 0"));
  EXPECT_THROW(Store::open_owner(folder_), faultsim::StorageError);
  EXPECT_EQ(number("PRAGMA user_version"), 15);
}

/// A case is interpolated or not by its identity, so that one that has nothing is of an old store.
TEST_F(Approximation, ThatIsStoredMustBeTheSameAgain) {
  const CaseResult stored = approximate(), unknown = made_up_result(0.8);
  EXPECT_EQ(first_difference(unknown, stored), "");
  CaseResult again = stored;
  again.surface->traction = std::nextafter(again.surface->traction, 1);
  EXPECT_EQ(first_difference(stored, again), "how exact it is");
  again = stored;
  again.surface.reset();
  EXPECT_EQ(first_difference(stored, again), "how exact it is");
  again = stored;
  again.field_coverage = std::nextafter(*again.field_coverage, 1);
  EXPECT_EQ(first_difference(stored, again), "how exact it is");
}

}  // namespace
}  // namespace faultsweep
