#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "campaign/report/case_report.h"
#include "campaign/report/parameters.h"
#include "campaign/report/ranking_report.h"
#include "campaign/report/status_report.h"
#include "campaign/report/text_table.h"
#include "campaign/spec/metrics.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(TextTable, AlignsNumbersRightWordsLeftAndDropsEmptyColumns) {
  TextTable table({"name", "χ̄", "empty", "n"});
  table.add_row({"F1", "0.5", "", "12"});
  table.add_row({"long name", "0.75", "", "3"});
  EXPECT_EQ(table.text(),
            "name          χ̄   n\n"
            "F1          0.5  12\n"
            "long name  0.75   3\n");
  EXPECT_THROW(table.add_row({"too few"}), faultsim::InternalError);
  EXPECT_EQ(format_number(1.23456e15, 3), "1.23e+15");
  EXPECT_EQ(format_number(std::nan("")), "-");
}

TEST(TextTable, KeepsWithinTheScreen) {
  TextTable table({"case", "first metric", "second metric", "reason"});
  table.add_row(
      {"17", "0.123456", "12.5", "the history ends in step 9: no convergence of the contact"});
  table.add_row({"8", "0.9", "3", ""});
  EXPECT_EQ(table.text(40),
            "case  first metric  second metric\n"
            "  17      0.123456           12.5\n"
            "   8           0.9              3\n"
            "\n"
            "case  reason\n"
            "  17  the history ends in step 9: no\n"
            "      convergence of the contact\n"
            "   8\n");
  EXPECT_THAT(table.text(1000), HasSubstr("case  first metric  second metric  reason\n"));
  EXPECT_EQ(TextTable({"nothing"}).text(), "");
}

TEST(TextTable, ShowsTheDigitsThatAScreenNeeds) {
  EXPECT_EQ(short_number("18.9238690858494 deg"), "18.9239 deg");
  EXPECT_EQ(short_number("-1.23456789e-07"), "-1.23457e-07");
  for (const char* kept :
       {"20 deg", "0.125", "12345678", "min", "", "F1.12345678", "1.5.2345678"}) {
    EXPECT_EQ(short_number(kept), kept);
  }
  TextTable table({"angle"});
  table.add_row({"18.9238690858494 deg"});
  EXPECT_EQ(table.text(), "angle\n18.9239 deg\n");
}

TEST(Parameters, TravelThroughTheStore) {
  const std::vector<StoredParameter> parameters = {{"offset", Dimension::length, false},
                                                   {"rule", Dimension::number, true}};
  const auto back = parameters_from_json(parameters_to_json(parameters));
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].dimension, Dimension::length);
  EXPECT_TRUE(back[1].is_text);
  EXPECT_THROW(parameters_from_json("[{}]"), faultsim::StorageError);
  for (const faultsim::DimensionInfo& one : faultsim::dimensions()) {
    const auto text = parameters_to_json({{"p", one.dimension, false}});
    EXPECT_EQ(parameters_from_json(text)[0].dimension, one.dimension);
  }
}

/// A store with 6 cases: offset k x 10 m, rule "mean" or "min", strengths that mix the order.
class ReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "report_XXXXXX";
    folder_ = mkdtemp(name.data());
    Submission s;
    s.name = "sweep";
    s.source = "sweep.json";
    s.rank_by = "activated_area";
    s.parameters = parameters_to_json(
        {{"offset", Dimension::length, false}, {"rule", Dimension::number, true}});
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    for (int k = 0; k < 6; ++k) {
      const std::string rule = k % 2 == 0 ? "mean" : "min";
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, 10.0 * k, std::to_string(10 * k) + " m"}, {1, std::nullopt, rule}}});
    }
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    const std::int64_t id = store_->submit(s).campaign;
    const double strengths[] = {0.2, 0.9, 0.4, 0.6, 0.95};
    for (int k = 0; k < 5; ++k) {
      RunRecord run;
      run.case_id = k + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(strengths[k]);
      if (k == 4) {
        run.result->outcome = faultsim::Outcome::unstable;
        run.result->reason = "slip weakening outran the stiffness at step 7";
        run.result->weakening_resolved = false;
      }
      store_->record_runs(id, {run});
    }
    RunRecord crash;
    crash.case_id = 6;
    crash.reason = "killed by SIGSEGV (11)";
    crash.log_tail = "first line\nlast words";
    store_->record_runs(id, {crash});
    campaign_ = store_->campaign("");
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  std::vector<long> order(RankRequest request) {
    std::vector<long> positions;
    for (const auto& row : make_ranking(*store_, campaign_, std::move(request)).rows) {
      positions.push_back(row.position);
    }
    return positions;
  }
  static RankRequest request(const std::string& by, const std::string& where = "") {
    RankRequest r;
    r.by = by;
    r.where = where;
    return r;
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

TEST_F(ReportTest, EveryMetricOfTheCatalogueCanBeRankedBy) {
  for (const MetricInfo& metric : metric_catalogue()) {
    EXPECT_EQ(order(request(metric.name)).size(), 5u) << metric.name;
  }
}

TEST_F(ReportTest, ExpressionsOverMetricsAndParametersOrderAndFilter) {
  EXPECT_THAT(order(request("")), ElementsAre(2, 4, 3, 1, 5));
  EXPECT_THAT(order(request("chi_bar", "offset > 5 m and not (rule = \"mean\")")),
              ElementsAre(2, 4));
  EXPECT_THAT(order(request("-offset", "outcome = \"converged\"")), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(order(request("moment / activated_area", "activated")), ElementsAre(2, 4, 5));
  EXPECT_THROW(order(request("chi_bor")), InputError);
  EXPECT_THROW(order(request("chi_bar", "offset > 5 deg")), InputError);
  EXPECT_THROW(order(request("chi_bar", "offset")), InputError);
  EXPECT_THROW(order(request("outcome")), InputError);
  RankRequest stage;
  stage.stage = "gas_storrage";
  EXPECT_THROW(order(stage), InputError);
}

TEST_F(ReportTest, UserTextNeverReachesTheDatabase) {
  EXPECT_TRUE(order(request("chi_bar", "rule = \"'; DROP TABLE cases; --\"")).empty());
  EXPECT_THROW(order(request("1; DROP TABLE cases")), InputError);
  EXPECT_EQ(order(request("")).size(), 5u);
}

TEST_F(ReportTest, TheTableShowsFlagsAndListsEarlyEndsApart) {
  const std::string text = ranking_to_text(make_ranking(*store_, campaign_, {}));
  EXPECT_THAT(text, HasSubstr("rank  case  offset  rule  outcome"));
  EXPECT_THAT(text, HasSubstr("   1     2  10 m    min   converged"));
  EXPECT_THAT(text,
              HasSubstr("   *     5  40 m    mean  unstable, mesh too coarse for its weakening"));
  EXPECT_THAT(text, HasSubstr("* history ends early: listed apart, not ranked"));
  EXPECT_THAT(ranking_to_text(make_ranking(*store_, campaign_, request("", "chi_bar > 7"))),
              HasSubstr("no case of sweep matches"));
}

TEST_F(ReportTest, TheJsonIsInSiWithUnitsInTheNames) {
  const auto json = ranking_to_json(make_ranking(*store_, campaign_, request("moment")));
  ASSERT_EQ(json["cases"].size(), 5u);
  const auto& first = json["cases"][0];
  EXPECT_EQ(first["rank"], 1);
  EXPECT_EQ(first["case"], 2);
  EXPECT_EQ(first["parameters"]["offset"]["value"], 10.0);
  EXPECT_EQ(first["parameters"]["offset"]["unit"], "m");
  EXPECT_EQ(first["parameters"]["rule"]["value"], "min");
  EXPECT_EQ(first["score"], first["moment_nm"]);
  EXPECT_TRUE(json["cases"][4]["rank"].is_null());
  EXPECT_EQ(metrics_to_json().size(), metric_catalogue().size());
}

TEST_F(ReportTest, ShowTellsParametersStagesAndHistory) {
  const std::string good = case_to_text(campaign_, store_->stored_case(campaign_.id, "2"));
  EXPECT_THAT(good, HasSubstr("  offset = 10 m\n  rule = min\n"));
  EXPECT_THAT(good, HasSubstr("primary_production"));
  EXPECT_THAT(good, HasSubstr("fault F2:"));
  const std::string failed = case_to_text(campaign_, store_->stored_case(campaign_.id, "6"));
  EXPECT_THAT(failed, HasSubstr("crashed: killed by SIGSEGV (11)"));
  EXPECT_THAT(failed, HasSubstr("    | last words\n"));
  EXPECT_THAT(failed, Not(HasSubstr("fault F")));
  const auto json = case_to_json(campaign_, store_->stored_case(campaign_.id, "2"));
  EXPECT_EQ(json["result"]["steps"].size(), 13u);
  EXPECT_TRUE(case_to_json(campaign_, store_->stored_case(campaign_.id, "6"))["result"].is_null());
}

TEST_F(ReportTest, ExplainSaysWhy) {
  const auto explain = [&](const char* name) {
    return explain_case(*store_, campaign_, store_->stored_case(campaign_.id, name));
  };
  EXPECT_THAT(explain("1"), HasSubstr("will not run: it has a result (converged)"));
  EXPECT_THAT(explain("6"), HasSubstr("will not run: attempt 1 crashed: killed by SIGSEGV (11); "
                                      "`faultsweep retry sweep --case 6` lets it run again"));
  store_->retry(campaign_.id, false, 6);
  EXPECT_THAT(explain("6"), HasSubstr("will run: it waits for another attempt"));
}

/// The same six cases in a campaign that keeps fields: of the first they are there, of the second
/// gone, of the third failed.
TEST_F(ReportTest, SaysWhereTheFieldsAre) {
  Submission s;
  s.name = "fields";
  s.parameters = "[]";
  s.keep_fields = KeepFields::stages;
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  for (int k = 0; k < 6; ++k) {
    s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {}});
  }
  const std::int64_t id = store_->submit(s).campaign;
  for (int k = 1; k <= 3; ++k) {
    RunRecord run;
    run.case_id = k;
    run.fields_only = true;
    run.status = k == 3 ? RunStatus::world : RunStatus::completed;
    run.reason = k == 3 ? "cannot write faults.h5: No space left on device" : "";
    run.has_fields = k != 3;
    if (k != 3) run.result = testing::made_up_result(0.2);
    store_->record_runs(id, {run});
  }
  const auto folder = folder_ / "fields" / "fields" / "1";
  std::filesystem::create_directories(folder);
  for (const char* file : {"faults.h5", "faults.xmf"}) std::ofstream(folder / file) << "x";
  const CampaignInfo info = store_->campaign("fields");
  const auto show = [&](const char* name) {
    return case_to_text(info, store_->stored_case(id, name));
  };
  const auto explain = [&](const char* name) {
    return explain_case(*store_, info, store_->stored_case(id, name));
  };
  EXPECT_THAT(show("1"),
              HasSubstr("fault fields (initial state and ends of stages): " +
                        (folder / "faults.xmf").string() + " for ParaView, faults.h5\n"));
  EXPECT_THAT(show("1"), HasSubstr("for the fields only): completed"));
  EXPECT_THAT(explain("1"), HasSubstr("will not run: it has a result"));
  EXPECT_THAT(show("2"),
              HasSubstr("fault fields: gone from " + (folder_ / "fields/fields/2").string() +
                        "; `faultsweep run fields` writes them again"));
  EXPECT_THAT(explain("2"), HasSubstr("will run, for its fault fields only: their files are gone"));
  EXPECT_THAT(show("3"), HasSubstr("`faultsweep retry fields --case 3` lets them be tried again"));
  EXPECT_THAT(explain("3"), HasSubstr("could not be added: world, cannot write faults.h5: No space "
                                      "left on device; `faultsweep retry fields --case 3`"));
  EXPECT_THAT(show("4"), HasSubstr("not yet; `faultsweep run fields` writes them"));
  EXPECT_THAT(explain("4"), HasSubstr("will run, for its fault fields only: it has a result"));
  EXPECT_THAT(case_to_text(campaign_, store_->stored_case(campaign_.id, "1")),
              Not(HasSubstr("fault fields")));
  const auto json = [&](const char* name) {
    return case_to_json(info, store_->stored_case(id, name))["fields"];
  };
  EXPECT_EQ(json("1")["state"], "kept");
  EXPECT_EQ(json("1")["steps"], "stages");
  EXPECT_EQ(json("1")["folder"], folder.string());
  EXPECT_EQ(json("2")["state"], "gone");
  EXPECT_EQ(json("3")["state"], "failed");
  EXPECT_TRUE(case_to_json(campaign_, store_->stored_case(campaign_.id, "1"))["fields"].is_null());
  const StatusReport status = make_status(*store_, "fields");
  EXPECT_THAT(status_to_text(status),
              HasSubstr("fault fields: stages; 3 cases have a result and lack them (1 failed)"));
  EXPECT_THAT(status_to_text(status), HasSubstr("fields: cannot write faults.h5"));
  EXPECT_EQ(status_to_json(status)["waiting_for_fields_only"], 2);
}

TEST_F(ReportTest, SaysWhereOperatorsAreNotShared) {
  EXPECT_THAT(status_to_text(make_status(*store_, "")), Not(HasSubstr("salt creeps")));
  Submission s;
  s.name = "salt";
  s.parameters = "[]";
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}, {"family-b", 1000, 100, 1, 1.98e10, 4}};
  s.cases = {{"elastic", 0, 0, "{}", {}}, {"viscous", 1, 0, "{}", {}}};
  const std::int64_t id = store_->submit(s).campaign;
  EXPECT_FALSE(store_->waiting_families(id).at(0).predicted.creeps());
  EXPECT_TRUE(store_->waiting_families(id).at(1).predicted.creeps());
  const StatusReport status = make_status(*store_, "salt");
  EXPECT_THAT(status_to_text(status),
              HasSubstr("salt creeps in 1 family: operators are built by each worker that runs it, "
                        "at most 20 GB each\n"));
  const auto family = status_to_json(status)["families"].at(1);
  EXPECT_EQ(family["creeps"], true);
  EXPECT_EQ(family["n_operators"], 4);
  EXPECT_EQ(family["predicted_memory_bytes"], 1.98e10);
}

/// The first three cases again, with events, in a campaign with two new ones: resolved, unresolved.
class EventReportTest : public ReportTest {
 protected:
  void SetUp() override {
    ReportTest::SetUp();
    Submission s;
    s.name = "events";
    s.parameters = "[]";
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    for (const char* identity : {"identity-1", "event-1", "event-2"}) {
      s.cases.push_back({identity, 0, 0, "{}", {}});
    }
    id_ = store_->submit(s).campaign;
    const auto ids = store_->waiting_families(id_).at(0).cases;
    RunRecord run;
    run.status = RunStatus::completed;
    run.case_id = ids.at(0);
    run.result = testing::made_up_result_with_events(0.95);
    store_->record_runs(id_, {run});
    run.case_id = ids.at(1);
    run.result->outcome = faultsim::Outcome::event;
    run.result->weakening_resolved = true;
    run.result->unexpected.reset();
    run.result->whole.activation_resolved = true;
    for (faultsim::SlipEvent& event : run.result->events) event.resolved = true;
    store_->record_runs(id_, {run});
    events_ = store_->campaign("events");
  }
  std::string show(const char* name) const {
    return case_to_text(events_, store_->stored_case(id_, name));
  }
  std::int64_t id_ = 0;
  CampaignInfo events_;
};

TEST_F(EventReportTest, ShowAndRankTellWhatTheSaltDid) {
  const std::string text = show("2");
  const auto result = testing::made_up_result_with_events(0.95);
  double shear = 0, normal = 0;
  int n_time_steps = 0;
  for (const faultsim::StepResult& step : result.steps) {
    n_time_steps += step.creep->time_steps;
    for (const faultsim::FaultCreep& one : step.creep->faults) {
      shear = std::max(shear, one.shear_max);
      normal = std::min(normal, one.normal_min);
    }
  }
  EXPECT_THAT(text, HasSubstr("salt creeps: it changed fault tractions by " +
                              format_number(normal / 1e5, 3) + " bar (compression) to "));
  EXPECT_THAT(text, HasSubstr(" bar in shear; " + std::to_string(n_time_steps) + " time steps"));
  EXPECT_THAT(text, HasSubstr("creep |ΔtT|/bar  time steps"));
  EXPECT_THAT(text, HasSubstr("time steps of 13 load steps (marked !)"));
  EXPECT_THAT(show("1"), Not(HasSubstr("creep")));
  const auto scores = [&](const std::string& by, const std::string& stage = "") {
    RankRequest asked = request(by);
    asked.stage = stage;
    std::vector<std::optional<double>> found;
    for (const RankedCase& row : make_ranking(*store_, events_, asked).rows) {
      found.push_back(row.score);
    }
    return found;
  };
  // Case 3 is complete and creeps, case 1 has no creep, case 2 has unresolved events.
  EXPECT_THAT(scores("creep_shear_max"), ElementsAre(shear, std::nullopt, shear));
  EXPECT_THAT(scores("creep_normal_min"), ElementsAre(normal, std::nullopt, normal));
  EXPECT_THAT(scores("creep_time_steps"), ElementsAre(n_time_steps, std::nullopt, n_time_steps));
  EXPECT_EQ(scores("creep_shear_max", "primary_production")[0],
            result.steps[4].creep->faults[1].shear_max);
}

TEST_F(EventReportTest, TheRankingKeepsUnresolvedOnesApart) {
  const std::string text = ranking_to_text(make_ranking(*store_, events_, {}));
  EXPECT_THAT(text, HasSubstr("   1     3  event\n"));
  EXPECT_THAT(text, HasSubstr("   2     1  converged"));
  EXPECT_THAT(text, HasSubstr("  +1     2  unresolved_event, mesh too coarse for its weakening, "
                              "UNEXPECTED (F1)\n"));
  EXPECT_THAT(text,
              HasSubstr("+ complete, but whether a fault slides (unresolved) or how large its"));
  EXPECT_THAT(text, Not(HasSubstr("ends early")));
  const auto json = ranking_to_json(make_ranking(*store_, events_, {}));
  EXPECT_EQ(json["cases"][0]["n_events"], 2);
  EXPECT_EQ(json["cases"][0]["event_moment_nm"], 2e13 / 3);
  EXPECT_EQ(json["cases"][2]["rank_class"], 1);
  EXPECT_EQ(json["cases"][2]["unexpected"], true);
  EXPECT_TRUE(json["cases"][2]["rank"].is_null());
}

TEST_F(EventReportTest, ActivationThatHangsOnTheMeshIsSaid) {
  EXPECT_THAT(ranking_to_text(make_ranking(*store_, events_, {})),
              ::testing::ContainsRegex("[+]1  F1 at step 1, unresolved"));
  EXPECT_THAT(ranking_to_text(make_ranking(*store_, events_, {})),
              Not(HasSubstr("   1  F1 at step 1, unresolved")));
  const auto json = ranking_to_json(make_ranking(*store_, events_, {}));
  EXPECT_EQ(json["cases"][0]["activation_resolved"], true);
  EXPECT_EQ(json["cases"][2]["activation_resolved"], false);
  std::vector<long> found;
  for (const auto& row :
       make_ranking(*store_, events_, request("chi_bar", "not activation_resolved")).rows)
    found.push_back(row.position);
  EXPECT_THAT(found, ElementsAre(2));
  const std::string text = show("2");
  EXPECT_THAT(text, HasSubstr("UNRESOLVED: whether a fault slides depends on the mesh"));
  EXPECT_THAT(text,
              ::testing::ContainsRegex("cushion_gas_injection +5-8 +F1 at step 1, unresolved"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\n +3  primary_production .* yes[?]\n"));
}

TEST_F(EventReportTest, EventsOrderAndFilter) {
  const auto positions = [&](const std::string& where) {
    std::vector<long> all;
    for (const auto& row : make_ranking(*store_, events_, request("event_moment", where)).rows) {
      all.push_back(row.position);
    }
    return all;
  };
  EXPECT_THAT(positions("n_events >= 1 and event_magnitude > 2"), ElementsAre(3, 2));
  EXPECT_THAT(positions("unexpected"), ElementsAre(2));
  EXPECT_THAT(positions("not weakening_resolved"), ElementsAre(2));
  EXPECT_THAT(positions("n_episodes = 0"), ElementsAre(1));
}

TEST_F(EventReportTest, ShowListsEventsAndEpisodes) {
  TextTable::set_screen_width(1000);
  const std::string text = show("2");
  EXPECT_THAT(text,
              HasSubstr("UNEXPECTED REACTIVATION: fault F1 slides again in gas_storage, steps "));
  EXPECT_THAT(text, HasSubstr("UNRESOLVED: the size of its slip events depends on the mesh\n"));
  EXPECT_THAT(text, HasSubstr("\nslip events:\nevent  step  stage "));
  EXPECT_THAT(text, HasSubstr("NO, mesh too coarse  holds\n"));
  EXPECT_THAT(text, HasSubstr("\nepisodes (pressures at their first step):\nepisode  stage "));
  EXPECT_THAT(text, HasSubstr("has recovered"));
  EXPECT_THAT(show("3"), Not(HasSubstr("UN")));
  EXPECT_THAT(show("1"), Not(HasSubstr("slip events")));
  TextTable::set_screen_width(kScreenWidth);
}

TEST_F(EventReportTest, StatusCountsThemAsDoneButNotAsConverged) {
  const StatusReport status = make_status(*store_, "events");
  EXPECT_THAT(status_to_text(status),
              HasSubstr("events: 3 cases, 3 done (1 converged, 1 with slip events, 1 with "
                        "unresolved slip events), 0 failed, 0 waiting"));
  EXPECT_THAT(status_to_text(status), Not(HasSubstr("without a full result")));
  EXPECT_EQ(status_to_json(status)["event"], 1);
  EXPECT_EQ(status_to_json(status)["unresolved_event"], 1);
}

TEST_F(ReportTest, StatusCountsAndGivesReasons) {
  const StatusReport status = make_status(*store_, "");
  const std::string text = status_to_text(status);
  EXPECT_THAT(text, HasSubstr("sweep: 6 cases, 5 done (4 converged), 1 failed, 0 waiting"));
  EXPECT_THAT(text, HasSubstr("killed by SIGSEGV (11)"));
  EXPECT_THAT(text, HasSubstr("unstable"));
  const auto json = status_to_json(status);
  EXPECT_EQ(json["failures"].size(), 2u);
  EXPECT_TRUE(json["manager"].is_null());
}

}  // namespace
}  // namespace faultsweep
