#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "campaign/query/parameters.h"
#include "campaign/render/shown.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/reports/status_report.h"
#include "campaign/spec/metrics.h"
#include "simulator/result/approximation.h"
#include "tests/unit/reports/report_world.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ShownNumbers, HaveTheDigitsThatAScreenNeeds) {
  EXPECT_EQ(format_number(1.23456e15, 3), "1.23e+15");
  EXPECT_EQ(format_number(std::nan("")), "-");
  EXPECT_EQ(short_number("18.9238690858494 deg"), "18.9239 deg");
  EXPECT_EQ(short_number("-1.23456789e-07"), "-1.23457e-07");
  for (const char* kept :
       {"20 deg", "0.125", "12345678", "min", "", "F1.12345678", "1.5.2345678"}) {
    EXPECT_EQ(short_number(kept), kept);
  }
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
  const std::string text = render_text(to_answer(make_ranking(*store_, campaign_, {})), 200);
  EXPECT_THAT(text, HasSubstr("3 of 5 cases slide"));
  EXPECT_THAT(text, HasSubstr("Riskiest is case 2: F1 slides from step 1 on, χ̄ 0.9"));
  EXPECT_THAT(text, HasSubstr("rank  case  offset, m  rule  slides  resolved"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\n1 +2 +10  min +yes +yes"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\n[*] +5 +40  mean +yes +no .*unstable, mesh too "
                                             "coarse for its weakening"));
  EXPECT_THAT(text, HasSubstr("* history ends early: listed separately, not ranked"));
  const auto none = render_json(to_answer(make_ranking(*store_, campaign_,
                                                       request("",
                                                               "chi_bar > "
                                                               "7"))));
  EXPECT_EQ(none["headline"][0], "No case of sweep matches.");
  EXPECT_TRUE(none["cases"].empty());
}

TEST_F(ReportTest, TheJsonIsInSiWithUnitsInTheColumns) {
  const auto json = render_json(to_answer(make_ranking(*store_, campaign_, request("moment"))));
  ASSERT_EQ(json["cases"].size(), 5u);
  const auto& first = json["cases"][0];
  EXPECT_EQ(first["rank"], 1);
  EXPECT_EQ(first["case"], 2);
  EXPECT_EQ(first["parameters"]["offset"], 10.0);
  EXPECT_EQ(first["parameters"]["rule"], "min");
  EXPECT_EQ(first["score"], first["moment_nm"]);
  EXPECT_EQ(first["resolved"], true);
  EXPECT_EQ(first["activation"]["change_minus_pa"], -1e6);
  EXPECT_TRUE(json["cases"][4]["rank"].is_null());
  EXPECT_EQ(json["cases"][4]["resolved"], false);
  for (const auto& column : json["columns"]["cases"]) {
    if (column["key"] != "offset") continue;
    EXPECT_EQ(column["unit"], "m");
    EXPECT_EQ(column["in"], "parameters");
  }
  EXPECT_EQ(render_json(metrics_answer())["metrics"].size(), metric_catalogue().size());
}

TEST_F(ReportTest, ARankingSaysTheSameInAllRenderings) {
  for (const char* by : {"", "moment", "chi_bar * 2"}) {
    const Answer answer = to_answer(make_ranking(*store_, campaign_, request(by)));
    testing::expect_the_same_numbers(answer);
    testing::expect_to_fit(answer);
  }
  testing::expect_to_fit(metrics_answer());
}

/// What can be done without goes, what cannot stays.
TEST_F(ReportTest, ANarrowScreenKeepsWhatARankingIsReadFor) {
  const Answer answer = to_answer(make_ranking(*store_, campaign_, {}));
  const std::string narrow = render_text(answer, 80);
  EXPECT_THAT(narrow, ::testing::ContainsRegex("rank +case +m +rule +slides +resolved +χ̄ +m "));
  EXPECT_THAT(narrow, HasSubstr("Not shown on 80 columns: "));
  EXPECT_THAT(render_text(answer, 1000), Not(HasSubstr("Not shown")));
}

/// Where counting would take longer than the ranking, only what is listed is counted.
TEST_F(ReportTest, TheHeadlineCountsWhatTheConditionSelects) {
  RankRequest top = request("chi_bar", "offset > 5 m");
  top.top = 1;
  const auto json = render_json(to_answer(make_ranking(*store_, campaign_, top)));
  EXPECT_EQ(json["cases"].size(), 1u);
  EXPECT_EQ(json["headline"][0], "3 of 4 cases slide.");
  EXPECT_EQ(json["counted"], 4);
  EXPECT_EQ(json["sliding"], 3);
}

TEST(SlidingCounts, TellWhatTheCellsDoNotResolve) {
  SlidingCounts counts;
  for (int k = 0; k < 5; ++k) counts.add(k < 3, k != 0 && k != 4);
  EXPECT_EQ(sliding_sentence(counts, {}),
            "3 of 5 cases slide; 1 of these are not resolved by the cells; 1 more may slide, which "
            "the cells do not resolve.");
  EXPECT_EQ(sliding_sentence({7, 0, 0, 0}, {.stage = "storage"}),
            "None of 7 cases slides in storage.");
  EXPECT_EQ(sliding_sentence({2, 2, 2, 0}, {.fault = "F2"}),
            "F2 slides in 2 of 2 cases; all of these are not resolved by the cells.");
}

TEST(RegionPressures, AreOfTheCellsWithAFlowField) {
  EXPECT_TRUE(has_flow_field(R"({"scene": {"pressure_field": {"file": "a.csv"}}})"));
  EXPECT_TRUE(has_flow_field(R"({"pointers": ["/pressure_field/file"]})"));
  EXPECT_FALSE(has_flow_field(R"({"scene": {"title": "pressure fields"}})"));
  EXPECT_EQ(region_pressures(false, 3), RegionPressures::at_depth);
  EXPECT_EQ(region_pressures(true, 7), RegionPressures::of_cells);
  EXPECT_EQ(region_pressures(true, 6), RegionPressures::means);
  EXPECT_EQ(place_columns(RegionPressures::of_cells, "", Need::data)[1].heading, "Δp");
  EXPECT_EQ(place_columns(RegionPressures::means, "", Need::data)[1].heading, "mean Δp");
  EXPECT_THAT(pressure_note(RegionPressures::of_cells), HasSubstr("cells beside the place"));
  EXPECT_THAT(pressure_note(RegionPressures::means), HasSubstr("not the value at the place"));
}

TEST_F(ReportTest, ShowTellsParametersStagesAndHistory) {
  const Answer good = shown(campaign_, "2");
  const std::string text = render_text(good, 1000);
  EXPECT_THAT(text, HasSubstr("Case 2 of sweep: converged; 13 load steps"));
  EXPECT_THAT(text,
              HasSubstr("F1 slides from step 1 on, first at 2000 m depth, slip 0.004 m; F2 "));
  EXPECT_THAT(text, ::testing::ContainsRegex("offset +10 m\nrule +min\n"));
  EXPECT_THAT(text, HasSubstr("primary_production"));
  const auto json = render_json(good);
  EXPECT_EQ(json["result"]["steps"].size(), 13u);
  EXPECT_TRUE(json["result"]["surface"].is_null());
  EXPECT_EQ(json["parameters"]["offset"], 10.0);
  EXPECT_EQ(json["stages"].size(), 4u) << "three and the whole history";
  EXPECT_EQ(json["histories"].size(), 26u) << "13 steps of two faults";
  EXPECT_EQ(json["histories"][25]["pressure_change_pa"]["region 1"], -2e7);
  EXPECT_EQ(json["faults"][0]["activation"]["change_pa"], -1e6);
  const Answer failed = shown(campaign_, "6");
  EXPECT_THAT(failed.headline.at(0), HasSubstr("has no result: crashed: killed by SIGSEGV (11)"));
  EXPECT_THAT(render_text(failed), HasSubstr("    | first line\n    | last words\n"));
  EXPECT_THAT(render_text(failed), Not(HasSubstr("load steps")));
  EXPECT_TRUE(render_json(failed)["result"].is_null());
  for (const Answer& one :
       {good, failed, explanation(*store_, campaign_, store_->stored_case(campaign_.id, "6"))}) {
    testing::expect_the_same_numbers(one);
    testing::expect_to_fit(one);
  }
}

TEST_F(ReportTest, ShowSaysHowAResultCameAboutAndWhyFiguresDiffer) {
  ShownCase one{campaign_, store_->stored_case(campaign_.id, "2")};
  const auto text = [&] { return render_text(to_answer(one), 1000); };
  EXPECT_THAT(text(), Not(HasSubstr("is summed over its steps")));
  EXPECT_THAT(text(), Not(HasSubstr("interpolated")));
  one.initial = {{"west", 2000, -4e7, -3e7, -3e7, 2e7}, {"east", 2100, -4e7, -3e7, -3e7, 2e7}};
  EXPECT_THAT(text(), HasSubstr("Δp west, bar  Δp east, bar"));
  EXPECT_EQ(render_json(to_answer(one))["initial_state"][1]["depth_m"], 2100.0);
  EXPECT_THAT(text(), Not(HasSubstr("ΔT")));
  EXPECT_THAT(text(), Not(HasSubstr("pressure is")));
  for (faultsim::StepResult& step : one.stored.result.steps)
    step.temperature_change = {0, -1.0 * step.step};
  one.initial[1].source = "report of 1990-01-01";
  EXPECT_THAT(text(), HasSubstr("ΔT east, K"));
  EXPECT_EQ(render_json(to_answer(one))["histories"][25]["temperature_change_k"]["east"], -12.0);
  EXPECT_THAT(text(), HasSubstr("mean of the report of 1990-01-01"));
  one.stored.result.stages[2].moment = 4.59e14;
  one.stored.result.whole.moment = 4.52e14;
  for (const std::size_t k : {0u, 1u}) one.stored.result.stages[k].moment = 0;
  EXPECT_THAT(text(),
              HasSubstr("M0 of a stage is summed over its steps, in all stages 4.59e+14 N m; "
                        "that of the whole history is from the slip at its end, "
                        "4.52e+14 N m"));
  one.stored.result.surface = faultsim::CaseSurface{75, 73, 12, 0.01, 2e-3, 3e-3, 4e-3, 5e-3};
  const std::string sentence = faultsim::approximation_sentence(one.stored.result);
  EXPECT_THAT(sentence, HasSubstr("interpolated between 75 exact ones"));
  EXPECT_THAT(render_text(to_answer(one), 1000), HasSubstr(sentence));
  EXPECT_EQ(render_json(to_answer(one))["result"]["surface"]["error_of_slip"], 5e-3);
  EXPECT_THAT(render_html(to_answer(one)), HasSubstr(sentence));
  one.pressures = RegionPressures::means;
  EXPECT_THAT(text(), HasSubstr("mean Δp -10 bar"));
  EXPECT_THAT(text(), HasSubstr("not the value at the place"));
}

TEST_F(ReportTest, ExplainSaysWhy) {
  EXPECT_THAT(explained(campaign_, "1"), HasSubstr("will not run: it has a result (converged)"));
  EXPECT_THAT(explained(campaign_, "6"),
              HasSubstr("Case 6 of sweep will not run: attempt 1 crashed: killed by SIGSEGV (11); "
                        "`faultsweep retry sweep --case 6` runs it again"));
  store_->retry(campaign_.id, false, 6);
  EXPECT_THAT(explained(campaign_, "6"), HasSubstr("will run: it waits for another attempt"));
  const auto json =
      render_json(explanation(*store_, campaign_, store_->stored_case(campaign_.id, "1")));
  EXPECT_EQ(json["will_run"], false);
  EXPECT_EQ(json["family"]["done"], 5);
}

/// The same six cases in a campaign that keeps fields: of the first they are there, of the second
/// gone, of the third failed.
TEST_F(ReportTest, SaysWhereTheFieldsAre) {
  Submission s;
  s.name = "fields";
  s.parameters = {};
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
  const auto show = [&](const char* name) { return shown_text(info, name); };
  const auto explain = [&](const char* name) { return explained(info, name); };
  EXPECT_THAT(show("1"),
              HasSubstr("fault fields (initial state and ends of stages): " +
                        (folder / "faults.xmf").string() + " for ParaView, faults.h5\n"));
  EXPECT_EQ(render_json(shown(info, "1"))["runs"][1]["fields_only"], true);
  EXPECT_THAT(explain("1"), HasSubstr("will not run: it has a result"));
  EXPECT_THAT(show("2"),
              HasSubstr("fault fields: gone from " + (folder_ / "fields/fields/2").string() +
                        "; `faultsweep run fields` writes them again"));
  EXPECT_THAT(explain("2"), HasSubstr("will run, for its fault fields only: their files are gone"));
  EXPECT_THAT(show("3"), HasSubstr("`faultsweep retry fields --case 3` tries again"));
  EXPECT_THAT(explain("3"), HasSubstr("could not be added: world, cannot write faults.h5: No space "
                                      "left on device; `faultsweep retry fields --case 3`"));
  EXPECT_THAT(show("4"), HasSubstr("not yet; `faultsweep run fields` writes them"));
  EXPECT_THAT(explain("4"), HasSubstr("will run, for its fault fields only: it has a result"));
  EXPECT_THAT(shown_text(campaign_, "1"), Not(HasSubstr("fault fields")));
  const auto json = [&](const char* name) { return render_json(shown(info, name))["fields"]; };
  EXPECT_EQ(json("1")["state"], "kept");
  EXPECT_EQ(json("1")["steps"], "stages");
  EXPECT_EQ(json("1")["folder"], folder.string());
  EXPECT_EQ(json("2")["state"], "gone");
  EXPECT_EQ(json("3")["state"], "failed");
  EXPECT_TRUE(render_json(shown(campaign_, "1"))["fields"].is_null());
  const StatusReport status = make_status(*store_, "fields");
  EXPECT_THAT(render_text(to_answer(status), 200),
              HasSubstr("fault fields: stages; 3 cases have a result and lack them (1 failed)"));
  EXPECT_THAT(render_text(to_answer(status), 200), HasSubstr("fields: cannot write faults.h5"));
  EXPECT_EQ(render_json(to_answer(status))["waiting_for_fields_only"], 2);
}

/// A campaign that says nothing of fields, as it goes on: nothing is decided, then six cases are,
/// of which one got its fields, one is to get them and those of another failed.
TEST_F(ReportTest, SaysWhoseFieldsAreKept) {
  EXPECT_EQ(kept_fields_text(KeepFields::none), "");
  EXPECT_EQ(kept_fields_text(KeepFields::all), "fault fields are kept (all)");
  Submission s;
  s.name = "shown";
  s.parameters = {};
  s.keep_fields = KeepFields::shown;
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  for (const int k : {0, 1, 2, 77}) {  // the last is new
    s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {}});
  }
  const std::int64_t id = store_->submit(s).campaign;
  const auto status = [&] { return render_text(to_answer(make_status(*store_, "shown")), 200); };
  EXPECT_THAT(status(), HasSubstr("fault fields of the three cases ranked first are kept once all "
                                  "are decided\n"));
  RunRecord run;
  run.case_id = store_->stored_case(id, "4").id;
  run.status = RunStatus::completed;
  run.result = testing::made_up_result(0.2);
  store_->record_runs(id, {run});
  store_->want_fields(id, {1, 2, 3});
  EXPECT_THAT(status(), HasSubstr("; 0 cases have them, 3 still to be written\n"));
  run.case_id = 1;
  run.fields_only = run.has_fields = true;
  RunRecord failed;
  failed.case_id = 3;
  failed.fields_only = true;
  failed.reason = "disk full";
  store_->record_runs(id, {run, failed});
  const std::string said = status();
  EXPECT_THAT(said, HasSubstr("4 done (4 converged), 0 failed, 0 waiting"));
  EXPECT_THAT(said, HasSubstr("; 1 case has them, 1 still to be written, 1 could not be written: "
                              "`faultsweep retry shown` tries again"));
  EXPECT_THAT(said, HasSubstr("without a full result or its fields:"));
  EXPECT_THAT(said, HasSubstr("fields: disk full"));
  const CampaignInfo info = store_->campaign("shown");
  EXPECT_EQ(render_json(shown(info, "1"))["fields"]["steps"], "stages");
  EXPECT_THAT(explained(info, "1"),
              HasSubstr("will run, for its fault fields only, if it is still ranked first: their "
                        "files are gone"));
  EXPECT_THAT(shown_text(info, "1"), HasSubstr("writes them again if the case is still ranked "));
  EXPECT_TRUE(render_json(shown(info, "4"))["fields"].is_null());
}

TEST_F(ReportTest, SaysWhereOperatorsAreNotShared) {
  EXPECT_THAT(render_text(to_answer(make_status(*store_, "")), 200), Not(HasSubstr("salt creeps")));
  Submission s;
  s.name = "salt";
  s.parameters = {};
  s.scenes = {{"scene.json", "{}"}};
  s.families = {{"family-a", 1000, 100, 1, 1}, {"family-b", 1000, 100, 1, 1.98e10, 4}};
  s.cases = {{"elastic", 0, 0, "{}", {}}, {"viscous", 1, 0, "{}", {}}};
  const std::int64_t id = store_->submit(s).campaign;
  EXPECT_FALSE(store_->waiting_families(id).at(0).predicted.creeps());
  EXPECT_TRUE(store_->waiting_families(id).at(1).predicted.creeps());
  const StatusReport status = make_status(*store_, "salt");
  EXPECT_THAT(render_text(to_answer(status), 200),
              HasSubstr("salt creeps in 1 family: each worker that runs one builds its operators, "
                        "at most 20 GB each"));
  const auto family = render_json(to_answer(status))["families"].at(1);
  EXPECT_EQ(family["creeps"], true);
  EXPECT_EQ(family["n_operators"], 4);
  EXPECT_EQ(family["predicted_memory_bytes"], 1.98e10);
}

TEST_F(ReportTest, StatusCountsAndGivesReasons) {
  const StatusReport status = make_status(*store_, "");
  const std::string text = render_text(to_answer(status), 200);
  EXPECT_THAT(text, HasSubstr("sweep: 6 cases, 5 done (4 converged), 1 failed, 0 waiting"));
  EXPECT_THAT(text, HasSubstr("killed by SIGSEGV (11)"));
  EXPECT_THAT(text, HasSubstr("unstable"));
  testing::expect_the_same_numbers(to_answer(status));
  testing::expect_to_fit(to_answer(status));
  const auto json = render_json(to_answer(status));
  EXPECT_EQ(json["failures"].size(), 2u);
  EXPECT_EQ(json["headline"][0], "sweep: 6 cases, 5 done (4 converged), 1 failed, 0 waiting.");
  EXPECT_TRUE(json["manager"].is_null());
}

}  // namespace
}  // namespace faultsweep
