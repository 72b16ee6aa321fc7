// Campaigns, their cases and what became of them.
#include "campaign/store/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/unit/store/store_fixture.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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

TEST_F(StoreTest, TheBeginningOfAnIdentityNamesOneCaseOrNone) {
  Store store = Store::open_owner(folder_);
  Submission s = submission(12);
  s.cases[1].identity = "123456789";
  const std::int64_t campaign = store.submit(s).campaign;
  EXPECT_EQ(store.stored_case(campaign, "identity-3").position, 4);
  EXPECT_EQ(store.stored_case(campaign, "identity-11").position, 12);
  EXPECT_EQ(store.stored_case(campaign, "123456").position, 2) << "there is no such number";
  EXPECT_THROW(store.stored_case(campaign, "12345"), faultsim::InputError) << "too short";
  try {
    store.stored_case(campaign, "identity-1");
    ADD_FAILURE() << "it fits two";
  } catch (const faultsim::InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("several cases begin with 'identity-1': 11 (identity-10), 12 (ident"));
  }
  s = submission(11, "all of it");
  EXPECT_EQ(store.stored_case(store.submit(s).campaign, "identity-1").position, 2)
      << "identity-10 begins so too";
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

/// A fault has the history that was recorded under its name, wherever its case lists it.
TEST_F(StoreTest, AHistoryIsThatOfItsFault) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(3)).campaign;
  RunRecord other_way = completed(2, 0.8);
  faultsim::CaseResult& result = *other_way.result;
  std::ranges::reverse(result.fault_names);
  std::ranges::reverse(result.whole.faults);
  for (faultsim::StageMetrics& stage : result.stages) std::ranges::reverse(stage.faults);
  for (faultsim::StepResult& step : result.steps) std::ranges::reverse(step.faults);
  store.record_runs(campaign, {completed(1, 0.4), other_way});
  const std::vector<NamedId> faults = store.faults(campaign), stages = store.stages(campaign);
  const auto id_of = [](const std::vector<NamedId>& all, const std::string& name) {
    return std::ranges::find(all, name, &NamedId::name)->id;
  };
  Store::TableQuery query;
  constexpr int kHalfWay = 6, kBeyond = 13;  // of 12 steps
  for (const int step : {kHalfWay, kBeyond}) {
    for (const char* fault : {"F1", "F2"}) {
      query.columns.push_back(
          {history_sql("chi_bar", id_of(faults, fault), id_of(stages, ""), step), {}});
    }
  }
  // Half of the strength in F1, a quarter in F2; the third case waits.
  const std::vector<std::vector<Cell>> expected = {
      {0.2, 0.1, {}, {}}, {0.4, 0.2, {}, {}}, {{}, {}, {}, {}}};
  std::vector<std::vector<Cell>> seen;
  store.for_each_case(campaign, query, [&](const CaseRow& row) { seen.push_back(row.metrics); });
  EXPECT_EQ(seen, expected);
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

/// Pages of an order by a score, from either end, are those of the store as it is now.
TEST_F(StoreTest, PagesOfAnOrderAreThoseOfTheStoreAsItIs) {
  Store store = Store::open_owner(folder_);
  const std::int64_t campaign = store.submit(submission(6)).campaign;
  const auto run = [&](std::int64_t id, double strength) {
    store.record_runs(campaign, {completed(id, strength)});
  };
  for (int id = 1; id <= 5; ++id) run(id, 1 - 0.1 * id);
  Store::RankingQuery query;
  const auto places = [&] {
    std::vector<long> order;
    for (const RankedCase& row : store.ranking(campaign, query)) order.push_back(row.position);
    return order;
  };
  for (const std::string& by : {metric_sql("chi_bar"), "-" + parameter_sql(0, false)}) {
    query = {};
    query.by = {by + " + ?", {Value(1.0)}};
    EXPECT_THAT(places(), ElementsAre(1, 2, 3, 4, 5));
    query.limit = 2, query.skip = 1;
    EXPECT_THAT(places(), ElementsAre(2, 3));
    query.from_end = true;
    EXPECT_THAT(places(), ElementsAre(3, 4));
    query.ascending = true;
    EXPECT_THAT(places(), ElementsAre(3, 2));
    query.skip = 9;
    EXPECT_THAT(places(), IsEmpty());
  }
  query = {};
  query.by = {metric_sql("chi_bar"), {}};
  query.limit = 1;
  EXPECT_THAT(places(), ElementsAre(1));
  run(6, 0.95);
  EXPECT_THAT(places(), ElementsAre(6));
  query.by = {"? * " + metric_sql("chi_bar"), {Value(-1.0)}};
  EXPECT_THAT(places(), ElementsAre(5));
  query.by.parameters = {Value(1.0)};
  EXPECT_THAT(places(), ElementsAre(6)) << "the same words with another value";
}

/// A score of one table is read from it alone, with the values that a join finds: of a campaign
/// whose positions run against its case_ids, in a store with cases of others.
TEST_F(StoreTest, AScoreOfOneTableIsThatOfAJoin) {
  Store store = Store::open_owner(folder_);
  store.submit(submission(7));
  Submission other_way = submission(6, "other way");
  std::ranges::reverse(other_way.cases);
  const std::int64_t campaign = store.submit(other_way).campaign;
  for (int id = 1; id <= 5; ++id)
    store.record_runs(campaign, {completed(id, 0.3 + 0.1 * (id * 3 % 5))});
  Store::RankingQuery query;
  using Row = std::pair<long, std::optional<double>>;
  const auto ranked = [&](const std::string& by) {
    query.by = {by, {}};
    std::vector<Row> rows;
    for (const RankedCase& row : store.ranking(campaign, query))
      rows.emplace_back(row.position, row.score);
    return rows;
  };
  const std::string strength = parameter_sql(0, false);
  EXPECT_THAT(ranked(strength), ElementsAre(Row(2, 4), Row(3, 3), Row(4, 2), Row(5, 1), Row(6, 0)));
  EXPECT_EQ(ranked(metric_sql("chi_bar")).front().first, 4) << "case 3, of 0.7";
  const std::string joined = " + 0 * (SELECT 1)";
  for (const char* stage : {"", "gas_storage"}) {
    for (const auto fault : {std::optional<std::int64_t>(), {store.faults(campaign)[1].id}}) {
      for (const std::string& where : {std::string(), strength + " > 1"}) {
        query = {};
        query.stage = stage, query.fault = fault, query.where = {where, {}};
        for (const std::string& by :
             {strength, metric_sql("chi_bar", fault.has_value()), metric_sql("pressure_margin"),
              metric_sql("n_events"),
              std::string("CASE WHEN cc.position > 3 THEN s.chi_bar END")}) {
          EXPECT_EQ(ranked(by), ranked("(" + by + ")" + joined)) << by;
          EXPECT_EQ(ranked(by).size(), where.empty() ? 5u : 3u);
        }
      }
    }
  }
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
  EXPECT_EQ(families[0].peak_bytes, 1 << 20);
  store.record_operator(store.waiting_families(campaign)[1].family,
                        {"other", true, 0.1, 1000, 100, 80000, 1 << 19});
  EXPECT_FALSE(store.family_progress(campaign)[1].peak_bytes) << "to read it takes less";
  EXPECT_EQ(store.waiting_families(campaign)[0].operator_fingerprint, "op");
}

}  // namespace
}  // namespace faultsweep
