// Slip events and episodes in the store: their way in and out, their views, and the migration of
// stores from before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/store/migrations.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "simulator/common/fingerprint.h"
#include "simulator/result/result_json.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using faultsim::Outcome;
using faultsim::StorageError;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::made_up_result;
using testing::made_up_result_with_events;

class EventsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "events_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::int64_t submit(Store& store, int n) const {
    Submission s;
    s.name = "sweep";
    s.parameters = {};
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    for (int k = 0; k < n; ++k) s.cases.push_back({"identity" + std::to_string(k), 0, 0, "{}", {}});
    return store.submit(s).campaign;
  }
  static RunRecord run_of(std::int64_t case_id, CaseResult result) {
    RunRecord run;
    run.case_id = case_id;
    run.status = RunStatus::completed;
    run.result = std::move(result);
    return run;
  }
  /// Results with the outcomes given, as cases 1, 2, ...
  static void record(Store& store, std::int64_t campaign, const std::vector<Outcome>& outcomes) {
    std::int64_t id = 0;
    for (const Outcome outcome : outcomes) {
      CaseResult result = made_up_result(0.9);
      result.outcome = outcome;
      store.record_runs(campaign, {run_of(++id, result)});
    }
  }
  std::int64_t count(const char* sql) const {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
    Statement query(connection, sql);
    EXPECT_TRUE(query.step()) << sql;
    return query.integer(0);
  }
  std::filesystem::path folder_;
};

/// What the store does not keep of a result.
json without_what_is_not_stored(json result) {
  for (const char* key : {"title", "identity", "regions", "observations", "wall_s"}) {
    result.erase(key);
  }
  for (json& step : result["steps"]) {
    for (const char* key : {"observed_m", "wall_s"}) step.erase(key);
    for (const char* key : {"sub_steps", "wasted_newton_iterations"}) step["counts"].erase(key);
  }
  return result;
}

/// Every field, by the list of fields that result.json is written from, so that a field that the
/// store forgets is found; the made-up result must give each a value of its own.
TEST_F(EventsTest, EveryFieldComesBackFromTheStore) {
  const CaseResult result = made_up_result_with_events(0.8);
  const json events = faultsim::result_to_json(result);
  CaseResult plain;
  plain.events.emplace_back();
  plain.episodes.emplace_back();
  const json defaults = faultsim::result_to_json(plain);
  for (const char* list : {"events", "episodes"}) {
    for (const auto& [key, value] : defaults[list][0].items()) {
      EXPECT_NE(events[list][0][key], value) << list << " " << key << " would not be missed";
    }
  }
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = submit(store, 1);
  store.record_runs(campaign, {run_of(1, result)});
  const auto back = store.stored_result(1);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(json::diff(without_what_is_not_stored(events),
                       without_what_is_not_stored(faultsim::result_to_json(*back))),
            json::array());
  EXPECT_EQ(back->events, result.events);
  EXPECT_EQ(back->episodes, result.episodes);
}

TEST_F(EventsTest, PlaneStrainHasNoMagnitudeAndAnEventNeedNotBeLocated) {
  CaseResult result = made_up_result_with_events(0.8);
  result.events[0].magnitude.reset();
  result.events[0].fault.clear();
  result.episodes[0].magnitude_if_at_once.reset();
  Store store = Store::open_owner(folder_);
  store.record_runs(submit(store, 1), {run_of(1, result)});
  EXPECT_EQ(store.stored_result(1)->events, result.events);
  EXPECT_EQ(store.stored_result(1)->episodes, result.episodes);
  EXPECT_EQ(count("SELECT count(*) FROM case_events WHERE fault IS NULL"), 1);
}

TEST_F(EventsTest, AReplacedResultTakesItsEventsAlong) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = submit(store, 1);
  CaseResult stopped = made_up_result_with_events(0.8);
  stopped.outcome = Outcome::unconverged;
  store.record_runs(campaign, {run_of(1, stopped)});
  EXPECT_EQ(count("SELECT count(*) FROM slip_events"), 2);
  EXPECT_EQ(store.retry(campaign, true, std::nullopt), 1);
  store.record_runs(campaign, {run_of(1, made_up_result(0.8))});
  EXPECT_EQ(count("SELECT count(*) FROM slip_events"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM episodes"), 0);
}

TEST_F(EventsTest, AreCompleteHistoriesCountedApart) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = submit(store, 6);
  record(store, campaign,
         {Outcome::unconverged, Outcome::unstable, Outcome::unresolved_event, Outcome::event,
          Outcome::converged, Outcome::interrupted});
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 6);
  EXPECT_EQ(info.n_converged, 1);
  EXPECT_EQ(info.n_event, 1);
  EXPECT_EQ(info.n_unresolved, 1);
  std::vector<long> order;
  std::vector<int> classes;
  for (const RankedCase& row : store.ranking(campaign, {})) {
    order.push_back(row.position);
    classes.push_back(row.rank_class);
  }
  EXPECT_THAT(order, ElementsAre(4, 5, 3, 2, 1, 6));
  EXPECT_THAT(classes, ElementsAre(0, 0, 1, 2, 3, 3));
  std::vector<std::string> why;
  for (const FailureCount& failure : store.failure_counts(campaign)) why.push_back(failure.reason);
  EXPECT_THAT(why, ElementsAre("interrupted", "unconverged", "unstable"));
  EXPECT_EQ(count("SELECT count(*) FROM failures"), 3);
  EXPECT_EQ(count("SELECT with_events FROM campaign_progress"), 1);
  EXPECT_EQ(count("SELECT with_unresolved_events FROM campaign_progress"), 1);
  EXPECT_EQ(store.retry(campaign, true, std::nullopt), 3) << "nothing complete runs again";
}

TEST_F(EventsTest, ActivationThatHangsOnTheMeshIsRankedApartInTheStageThatItIsOf) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = submit(store, 3);
  faultsim::CaseResult in_doubt = made_up_result(0.9), sure = made_up_result(0.6);
  in_doubt.whole.activation_resolved = in_doubt.stages[2].activation_resolved = false;
  faultsim::CaseResult quiet = made_up_result(0.2);
  quiet.whole.activation_resolved = quiet.stages[2].activation_resolved = false;
  store.record_runs(campaign, {run_of(1, in_doubt), run_of(2, sure), run_of(3, quiet)});
  const auto places = [&](const char* stage) {
    std::vector<std::pair<long, int>> rows;
    Store::RankingQuery query;
    query.stage = stage;
    for (const RankedCase& row : store.ranking(campaign, query)) {
      rows.emplace_back(row.position, row.rank_class);
      EXPECT_EQ(row.metrics.activation_resolved, row.rank_class == 0);
    }
    return rows;
  };
  EXPECT_THAT(places(""), ElementsAre(std::pair(2L, 0), std::pair(1L, 1), std::pair(3L, 1)));
  EXPECT_THAT(places("gas_storage"),
              ElementsAre(std::pair(2L, 0), std::pair(1L, 1), std::pair(3L, 1)));
  EXPECT_THAT(places("primary_production"),
              ElementsAre(std::pair(1L, 0), std::pair(2L, 0), std::pair(3L, 0)));
  EXPECT_EQ(store.retry(campaign, true, std::nullopt), 0) << "the histories are complete";
  EXPECT_EQ(count("SELECT sum(activation_resolved) FROM ranking"), 1);
  EXPECT_EQ(count("SELECT sum(activation_resolved) FROM stage_ranking WHERE stage <> ''"), 7);
  EXPECT_EQ(count("SELECT count(*) FROM chi_history_wide WHERE NOT activation_resolved"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM fault_ranking WHERE NOT activation_resolved"), 0);
}

TEST_F(EventsTest, ViewsShowThemWithUnits) {
  Store store = Store::open_owner(folder_);
  store.record_runs(submit(store, 1), {run_of(1, made_up_result_with_events(0.8))});
  EXPECT_EQ(count("SELECT count(*) FROM case_events WHERE depth_m > 0 AND NOT resolved"
                  " AND stage = 'gas_storage' AND fault = 'F2'"),
            1);
  EXPECT_EQ(count("SELECT count(*) FROM case_episodes WHERE change_minus_pa < 0 AND"
                  " absolute_plus_pa > 0 AND region_minus = 'west' AND depth_m > 0"),
            2);
  EXPECT_EQ(count("SELECT episode FROM case_episodes WHERE unexpected AND after_episode = 1"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM ranking WHERE opens AND opened_fault = 'F2' AND"
                  " opening_depth_m > 0 AND activation_pressure_change_pa = -1e6 AND"
                  " activation_pressure_absolute_pa = 1.9e7 AND activation_depth_m = 2000"),
            1);
  EXPECT_EQ(count("SELECT n_events FROM ranking WHERE unexpected AND n_episodes = 2"), 2);
  EXPECT_EQ(count("SELECT n_events FROM stage_ranking WHERE stage = 'primary_production'"), 1);
  EXPECT_EQ(count("SELECT sum(activated_at_edge) FROM chi_history_wide"), 1);
}

/// A store as version 2 wrote it: four cases, of which one still waits, with one row in each table.
constexpr const char* kVersion2 =
    "INSERT INTO scenes VALUES (1, 'h', 'scene.json', '{}');"
    "INSERT INTO families VALUES (1, 'family', 1, 1, 1, 1, NULL);"
    "INSERT INTO campaigns VALUES (1, 'old', 5, 'open', 'f', '{}', 'h', '{}', 'h', 'h', '[]',"
    " 'moment', 0, 0, 'continue', 0, NULL, NULL, 'none');"
    "INSERT INTO cases VALUES (1, 'id-1', 1, 1, '{}', 'done', 'converged', 1),"
    " (2, 'id-2', 1, 1, '{}', 'done', 'unstable', 2),"
    " (3, 'id-3', 1, 1, '{}', 'done', 'unconverged', 4), (4, 'id-4', 1, 1, '{}', 'waiting', NULL,"
    " NULL);"
    "INSERT INTO campaign_cases SELECT 1, id, id, '[]', '[]', 'none' FROM cases;"
    "INSERT INTO runs VALUES"
    " (1, 1, 1, 1, 5, 1, 'here', 1, 'completed', 'converged', '', NULL, NULL, '', 'op', 1, 0),"
    " (2, 2, 1, 1, 5, 1, 'here', 1, 'completed', 'unstable', 'x', NULL, NULL, '', 'op', 1, 0),"
    " (3, 3, 1, 1, 5, 1, 'here', 1, 'crashed', NULL, 'y', 11, NULL, 'tail', NULL, NULL, 0),"
    " (4, 3, 1, 2, 6, 1, 'here', 1, 'completed', 'unconverged', 'z', NULL, NULL, '', 'op', 1, 1);"
    "INSERT INTO names VALUES (1, ''), (2, 'initial'), (3, 'F1');"
    "INSERT INTO case_metrics SELECT id, run_id, outcome, '', 1, NULL, 0, 1, 0.25, NULL, 3, 2, 1, "
    "0,"
    " 'careful' FROM cases WHERE id < 4;"
    "INSERT INTO stage_metrics SELECT 1, id, id - 1, 1, 1, -1e6, 3, id / 10.0, 0.5, 1, 2, 3, 4, 5,"
    " 6, 7, 8, 9, NULL, 0, 1 FROM cases WHERE id < 4;"
    "INSERT INTO load_steps VALUES (1, 0, 2, 0, '[0]', 'converged', '', 5, 0, 0, 1, 1);"
    "INSERT INTO chi_history VALUES (1, 0, 0, 3, .1, .2, .3, 4, 5, 6, 7, 8, 9, 10, 1, 11, 12, 13, "
    "14,"
    " 15);"
    "INSERT INTO events VALUES (1, 5, 1, 'submitted', 'long ago');";

TEST_F(EventsTest, AnOlderStoreIsBroughtUpToDateWithAllItsRows) {
  {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
    migrate(connection, {store_migrations()[0], store_migrations()[1]});
    connection.execute(kVersion2);
    const std::string spec = faultsim::fingerprint("{}");
    const std::string scene = faultsim::fingerprint("scene.json\n{}");
    connection.execute(("UPDATE scenes SET hash = '" + scene +
                        "'; UPDATE campaigns SET spec_given_hash = '" + spec +
                        "', spec_resolved_hash = '" + spec + "'")
                           .c_str());
  }
  Store store = Store::open_writer(folder_);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
  std::vector<int> classes;
  std::vector<double> indices;
  for (const RankedCase& row : store.ranking(1, {})) {
    classes.push_back(row.rank_class);
    indices.push_back(row.metrics.chi_bar);
    EXPECT_EQ(row.metrics.n_events, 0);
    EXPECT_EQ(row.metrics.activated_fault, "F1");
    EXPECT_FALSE(row.metrics.activation_resolved);  // nobody looked
    EXPECT_EQ(row.metrics.max_slip, 6);
    EXPECT_EQ(row.metrics.magnitude_if_at_once, 9);
    EXPECT_EQ(row.metrics.last_step, 1);
  }
  EXPECT_THAT(classes, ElementsAre(0, 2, 3));
  EXPECT_THAT(indices, ElementsAre(0.1, 0.2, 0.3));
  const StoredCase first = store.stored_case(1, "1");
  EXPECT_EQ(first.result.steps.at(0).faults.at(0).moment_step, 15);
  EXPECT_FALSE(first.result.steps[0].faults[0].activated_at_edge);
  EXPECT_TRUE(std::isnan(first.result.max_penetration)) << "it was not written down then";
  const StoredCase third = store.stored_case(1, "3");
  ASSERT_EQ(third.runs.size(), 2u);
  EXPECT_EQ(third.runs[0].signal, 11);
  EXPECT_EQ(third.runs[0].log_tail, "tail");
  EXPECT_TRUE(third.runs[1].fields_only);
  EXPECT_EQ(store.events(1, 5).at(0).text, "long ago");
  EXPECT_EQ(count("SELECT count(*) FROM case_metrics WHERE unexpected_episode IS NULL"), 3);
  EXPECT_TRUE(first.result.whole.faults.empty()) << "faults were not written down then";
  EXPECT_EQ(first_activation(first.result.whole), nullptr);
  // The constraints are in force again, and the new outcomes pass them.
  store.record_runs(1, {run_of(4, made_up_result_with_events(0.8))});
  EXPECT_EQ(store.stored_case(1, "4").result.events.size(), 2u);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(EventsTest, AStoreWithLostRowsIsRefusedAndLeftAsItIs) {
  {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::owner);
    migrate(connection, {store_migrations()[0], store_migrations()[1]});
    connection.execute(kVersion2);
    connection.execute("PRAGMA foreign_keys = OFF; DELETE FROM runs WHERE id = 2");
  }
  try {
    Store::open_writer(folder_);
    ADD_FAILURE() << "a broken store was migrated";
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rows of case_metrics that refer to missing rows of runs"));
  }
  EXPECT_EQ(count("PRAGMA user_version"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM sqlite_schema WHERE name = 'slip_events'"), 0);
  EXPECT_EQ(count("SELECT count(*) FROM runs"), 3);
}

TEST_F(EventsTest, ForeignKeysAndOutcomesAreGuardedAfterTheMigration) {
  Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_write);
  migrate(connection, store_migrations());
  EXPECT_THROW(
      connection.execute(
          "INSERT INTO episodes (case_id, number, stage_id, fault_id, first_step, last_step,"
          " after_recovery, activated_area_m2, max_slip_m, moment_nm)"
          " VALUES (9, 1, 9, 9, 1, 2, 0, 1, 1, 1)"),
      StorageError);
  EXPECT_THROW(connection.execute("INSERT INTO stage_metrics (stage_id) VALUES (1)"), StorageError);
}

}  // namespace
}  // namespace faultsweep
