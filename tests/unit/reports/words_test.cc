// Rankings, filters, tables and comparisons per fault and stage, with pressures and units that say
// what they are (docs/words.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaign/reports/case_report.h"
#include "campaign/reports/export.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/store/sqlite.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/reports/renderings.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using faultsim::FaultOnset;
using faultsim::FaultStageMetrics;
using faultsim::InputError;
using faultsim::StageMetrics;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Slip of F1 and F2 in production and in storage, m; from 1 mm on a fault slides.
CaseResult result_of(double f1_production, double f2_production, double f1_storage,
                     double f2_storage, bool plane_strain = false) {
  CaseResult result;
  result.outcome = faultsim::Outcome::converged;
  result.fault_names = {"F1", "F2"};
  result.plane_strain = plane_strain;
  faultsim::StepResult step;
  step.stage = "initial";
  step.outcome = result.outcome;
  step.faults.resize(2);
  result.steps = {step};
  const auto stage = [](const char* name, int first, double slip_1, double slip_2) {
    StageMetrics m;
    m.stage = name;
    m.first_step = first;
    m.last_step = first + 1;
    for (const double slip : {slip_1, slip_2}) {
      FaultStageMetrics f;
      f.fault = m.faults.empty() ? "F1" : "F2";
      f.max_slip = slip;
      f.slips = slip > 0;
      f.activated = slip >= 1e-3;
      f.activated_area = f.activated ? 1e3 * slip : 0;
      f.moment = 1e12 * slip;
      f.chi_bar = std::min(1.0, 0.5 + 100 * slip);
      if (f.activated) f.activation = FaultOnset{first, 2100, testing::made_up_pressures(-5e6)};
      m.max_slip = std::max(m.max_slip, slip);
      m.slips = m.slips || f.slips;
      m.chi_bar = std::max(m.chi_bar, f.chi_bar);
      m.activated_area += f.activated_area;
      m.moment += f.moment;
      if (f.activated && !m.activated) {
        m.activated = true;
        m.activation_step = first;
        m.activated_fault = f.fault;
      }
      m.faults.push_back(f);
    }
    return m;
  };
  result.stages = {stage("production", 1, f1_production, f2_production),
                   stage("gas_storage", 3, f1_storage, f2_storage)};
  result.whole =
      stage("", 0, std::max(f1_production, f1_storage), std::max(f2_production, f2_storage));
  return result;
}

class WordsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "words_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    // Case 1: F1 slides in production. 2: F2 there. 3: F2 there and back in storage. 4: F2 slips in
    // storage. 5: nothing.
    campaign_ = submit(
        "sweep", {result_of(4e-3, 0, 0, 0), result_of(0, 3e-3, 0, 0), result_of(0, 2e-3, 0, 5e-3),
                  result_of(0, 0, 0, 5e-4), result_of(0, 0, 0, 0)});
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  CampaignInfo submit(const std::string& name, const std::vector<CaseResult>& results) {
    Submission s;
    s.name = name;
    s.parameters = {};
    s.spec_resolved = name;
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    for (std::size_t k = 0; k < results.size(); ++k)
      s.cases.push_back({name + "-" + std::to_string(k), 0, 0, "{}", {}});
    const std::int64_t id = store_->submit(s).campaign;
    const auto ids = store_->waiting_families(id).at(0).cases;
    for (std::size_t k = 0; k < results.size(); ++k) {
      RunRecord run;
      run.case_id = ids.at(k);
      run.status = RunStatus::completed;
      run.result = results[k];
      store_->record_runs(id, {run});
    }
    return store_->campaign(name);
  }
  Ranking ranking(const RankRequest& request) const {
    return make_ranking(*store_, campaign_, request);
  }
  std::vector<long> order(const RankRequest& request) const {
    std::vector<long> positions;
    for (const RankedCase& row : ranking(request).rows) positions.push_back(row.position);
    return positions;
  }
  std::vector<long> where(const std::string& condition) const {
    return order({.by = "-potency", .where = condition});
  }
  std::string refusal(const RankRequest& request) const {
    try {
      ranking(request);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

TEST_F(WordsTest, RankOfOneFaultInOneStage) {
  EXPECT_THAT(order({.by = "slip", .stage = "gas_storage", .fault = "F2"}),
              ElementsAre(3, 4, 1, 2, 5));
  EXPECT_THAT(order({.by = "slip", .stage = "production", .fault = "F2"}),
              ElementsAre(2, 3, 1, 4, 5));
  EXPECT_THAT(order({.by = "slip", .fault = "F1"}), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(order({.fault = "F2"}), ElementsAre(3, 2, 4, 1, 5)) << "by area, moment, chi";
  const Ranking two = ranking({.by = "slip", .stage = "gas_storage", .fault = "F2", .top = 2});
  ASSERT_EQ(two.rows.size(), 2u);
  EXPECT_EQ(two.rows[0].score, 5e-3);
  ASSERT_TRUE(two.rows[0].fault_metrics);
  EXPECT_EQ(two.rows[0].fault_metrics->activation->depth, 2100);
  const auto json = render_json(to_answer(two));
  EXPECT_EQ(json["headline"][0], "F2 slides in 1 of 5 cases in gas_storage.");
  EXPECT_EQ(json["cases"][0]["activated_fault"], "F2");
  EXPECT_EQ(json["cases"][0]["activation_step"], 3);
  EXPECT_EQ(json["cases"][0]["activation"]["depth_m"], 2100.0);
  EXPECT_EQ(json["cases"][0]["activation"]["change_pa"], -5e6);
  EXPECT_EQ(json["cases"][1]["slides"], false);
  EXPECT_EQ(json["cases"][1]["slides_note"], "slips");
  EXPECT_TRUE(json["cases"][1]["activation"]["depth_m"].is_null());
  EXPECT_THAT(render_text(to_answer(two)), HasSubstr("no, slips"));
}

TEST_F(WordsTest, ConditionsOfFaultsAndStages) {
  EXPECT_THAT(where("F2.slides in gas_storage"), ElementsAre(3));
  EXPECT_THAT(where("F2.slips in gas_storage"), ElementsAre(3, 4));
  EXPECT_THAT(where("F2.slides in production and not F2.slides in gas_storage"), ElementsAre(2));
  EXPECT_THAT(where("F1.slides"), ElementsAre(1)) << "of the whole history";
  EXPECT_THAT(where("case > 1 and case < 3"), ElementsAre(2));
  EXPECT_THAT(where("slides in gas_storage"), ElementsAre(3)) << "some fault";
  EXPECT_THAT(where("F2.max_slip in gas_storage > 0.4 mm"), ElementsAre(3, 4));
  EXPECT_THAT(where("F2.max_slip in gas_storage > F2.max_slip in production"), ElementsAre(3, 4));
  EXPECT_THAT(where("\"F2\".slides in \"gas_storage\""), ElementsAre(3));
  EXPECT_THAT(where("F2.activation_pressure_change < -40 bar"), ElementsAre(2, 3));
  EXPECT_THAT(where("F2.activation_pressure_absolute in production = 150 bar"), ElementsAre(2, 3));
  EXPECT_THAT(where("not F1.slips and not F2.slips"), ElementsAre(5));
  EXPECT_THAT(where("activated"), ElementsAre(1, 2, 3)) << "the word of the files";
  EXPECT_THAT(order({.by = "slip", .stage = "gas_storage", .where = "F2.slides"}), ElementsAre(3))
      << "of the stage asked for";
  EXPECT_THAT(order({.by = "slip",
                     .stage = "gas_storage",
                     .fault = "F1",
                     .where = "F2.slides in whole_history and slides in production"}),
              IsEmpty());
  EXPECT_THAT(order({.by = "F2.max_slip in gas_storage", .top = 1}), ElementsAre(3));
}

TEST_F(WordsTest, UnknownFaultsAndStagesAreNamedWithTheNearest) {
  EXPECT_THAT(refusal({.stage = "gas_storrage"}),
              HasSubstr("there is no stage 'gas_storrage' in the results; did you mean "
                        "gas_storage? there are: production, gas_storage"));
  EXPECT_THAT(refusal({.fault = "F9"}),
              HasSubstr("there is no fault 'F9' in the results; did you mean F1? there are: F1, "
                        "F2"));
  EXPECT_THAT(refusal({.where = "F9.slides"}),
              HasSubstr("there is no fault \"F9\" in the results; did you mean F1?"));
  EXPECT_THAT(refusal({.where = "F2.slides in gas_storrage"}),
              HasSubstr("there is no stage \"gas_storrage\" in the results; did you mean "
                        "gas_storage? there are: production, gas_storage, whole_history"));
  EXPECT_THAT(refusal({.where = "F2.slidez"}), HasSubstr("did you mean F2.slides?"));
  EXPECT_THAT(refusal({.where = "F2.slides in"}), HasSubstr("a stage is missing after \"in\""));
  EXPECT_THAT(refusal({.where = "F2.slides in \"gas"}), HasSubstr("this quote is not closed"));
}

/// Names reach the database as numbers only.
TEST_F(WordsTest, NamesOfFaultsAndStagesAreNoSql) {
  CaseResult odd = result_of(2e-3, 0, 0, 0);
  const std::string evil = "F'; DROP TABLE cases; --";
  odd.fault_names[0] = evil;
  for (StageMetrics* stage : {&odd.whole, &odd.stages[0], &odd.stages[1]}) {
    stage->faults[0].fault = evil;
    if (stage->activated) stage->activated_fault = evil;
  }
  odd.stages[1].stage = "last 'stage'; DROP TABLE names; --";
  campaign_ = submit("odd", {odd});
  EXPECT_THAT(order({.fault = evil}), ElementsAre(1));
  EXPECT_THAT(where("\"" + evil + "\".slides"), ElementsAre(1));
  EXPECT_THAT(where("\"" + evil + "\".slides in \"last 'stage'; DROP TABLE names; --\""),
              IsEmpty());
  EXPECT_THAT(order({.stage = "last 'stage'; DROP TABLE names; --"}), ElementsAre(1));
}

TEST_F(WordsTest, ShowTellsWhatEachFaultDoesInEachStage) {
  const auto show = [&](const char* name, const ShowRequest& request = {}) {
    return to_answer(
        shown_case(*store_, campaign_, store_->stored_case(campaign_.id, name), request));
  };
  const std::string all = render_text(show("3"), 1000);
  EXPECT_THAT(all, HasSubstr("Δp, p: change, and absolute pressure at the depth beside"));
  EXPECT_THAT(all, HasSubstr("sticks"));
  const auto faults = render_json(show("3"))["faults"];
  EXPECT_EQ(faults.size(), 6u) << "two faults, two stages and the whole history";
  EXPECT_EQ(faults[3]["activation"]["region_minus"], "west");
  EXPECT_EQ(faults[3]["activation"]["absolute_minus_pa"], 1.5e7);
  const auto one = render_json(show("3", {"gas_storage", "F2"}));
  ASSERT_EQ(one["faults"].size(), 1u);
  EXPECT_EQ(one["faults"][0]["fault"], "F2");
  EXPECT_EQ(one["faults"][0]["stage"], "gas_storage");
  EXPECT_EQ(one["faults"][0]["does"], "slides");
  EXPECT_EQ(one["stages"].size(), 1u);
  EXPECT_EQ(render_json(show("4"))["faults"][4]["does"], "slips");
  EXPECT_THROW(show("3", {"gas", ""}), InputError);
  EXPECT_THROW(show("3", {"", "F3"}), InputError);
}

TEST_F(WordsTest, ExportOfOneFaultAndOfNamedOnes) {
  ExportRequest request;
  request.target = folder_ / "cases.csv";
  request.metrics = "max_slip, F1.slides in production, F2.moment in gas_storage";
  request.fault = "F2";
  export_campaign(*store_, campaign_, request);
  std::ifstream file(request.target);
  std::string header, first, second, third;
  std::getline(file, header);
  std::getline(file, first);
  std::getline(file, second);
  std::getline(file, third);
  EXPECT_THAT(header, HasSubstr("max_slip_m,F1.slides_in_production,"
                                "F2.moment_in_gas_storage_nm"));
  EXPECT_THAT(first, ::testing::EndsWith("F1,0,1,0"));
  EXPECT_THAT(third, ::testing::EndsWith("F2,0.005,0,5e+09"));
  request.fault = "F7";
  EXPECT_THROW(export_campaign(*store_, campaign_, request), InputError);
  request.fault.clear();
  request.metrics = "F2.max_slipp";
  EXPECT_THROW(export_campaign(*store_, campaign_, request), InputError);
}

/// Plane strain and 3D side by side.
class MixedTest : public WordsTest {
 protected:
  void SetUp() override {
    WordsTest::SetUp();
    plane_ = submit("plane", {result_of(0, 2e-3, 0, 0, true)});
    campaign_ = mixed_ =
        submit("mixed", {result_of(0, 2e-3, 0, 0, true), result_of(0, 3e-3, 0, 0)});
  }
  CampaignInfo plane_, mixed_;
};

TEST_F(MixedTest, WhatIsPerMetreSaysSo) {
  campaign_ = plane_;
  const Answer answer = to_answer(ranking({}));
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("sliding area, m²/m"));
  EXPECT_THAT(text, HasSubstr("M0, N m/m"));
  const auto json = render_json(answer)["cases"][0];
  EXPECT_TRUE(json.contains("moment_nm_per_m"));
  EXPECT_FALSE(json.contains("moment_nm"));
  const Answer show =
      to_answer(shown_case(*store_, plane_, store_->stored_case(plane_.id, "1"), {}));
  EXPECT_THAT(render_text(show, 1000), HasSubstr("M0, N m/m"));
  for (const char* table : {"stages", "faults", "histories"}) {
    EXPECT_TRUE(render_json(show)[table][0].contains("moment_nm_per_m")) << table;
    EXPECT_FALSE(render_json(show)[table][0].contains("moment_nm")) << table;
  }
  ExportRequest request;
  request.target = folder_ / "plane.csv";
  request.metrics = "moment,max_slip";
  export_campaign(*store_, plane_, request);
  std::stringstream csv;
  csv << std::ifstream(request.target).rdbuf();
  EXPECT_THAT(csv.str(), HasSubstr("moment_nm_per_m,max_slip_m"));
  request.histories = true;
  request.metrics.clear();
  export_campaign(*store_, plane_, request);
  std::stringstream histories;
  histories << std::ifstream(request.target).rdbuf();
  EXPECT_THAT(histories.str(), HasSubstr(",moment_nm_per_m,"));
  EXPECT_THAT(histories.str(), Not(HasSubstr(",moment_nm,")));
}

TEST_F(MixedTest, NumbersPerMetreAndTotalsAreNotRankedTogether) {
  EXPECT_THAT(
      refusal({.by = "activated_area"}),
      HasSubstr("activated_area is per metre of strike in the plane-strain cases and a total"));
  EXPECT_THAT(refusal({.by = "moment / 1e9"}), HasSubstr("moment is per metre of strike"));
  EXPECT_THAT(refusal({.by = "F2.moment in production"}), HasSubstr("per metre of strike"));
  EXPECT_THAT(order({.by = "slip"}), ElementsAre(2, 1));
  const auto rows = render_json(to_answer(ranking({.by = "slip"})))["cases"];
  EXPECT_EQ(rows[0]["moment_nm"], 3e9);
  EXPECT_TRUE(rows[0]["moment_nm_per_m"].is_null());
  EXPECT_TRUE(rows[1]["moment_nm"].is_null());
  EXPECT_EQ(rows[1]["moment_nm_per_m"], 2e9);
  EXPECT_THAT(order({.where = "plane_strain"}), ElementsAre(1));
  // The campaign's own order, as `faultsweep rank` asks for it, is that of the totals.
  EXPECT_THAT(order({}), ElementsAre(2));
  EXPECT_THAT(order({.where = "max_slip > 1 m or plane_strain"}), ElementsAre(1));
  EXPECT_THAT(render_text(to_answer(ranking({}))),
              HasSubstr("plane-strain cases are not ranked here"));
  const auto is_apart = [&](const RankRequest& request) {
    return render_json(to_answer(ranking(request))).at("plane_strain_apart");
  };
  EXPECT_EQ(is_apart({}), true);
  EXPECT_EQ(is_apart({.where = "plane_strain"}), false);
  EXPECT_THAT(order({.by = "moment", .where = "not plane_strain"}), ElementsAre(2));
}

TEST_F(MixedTest, AnExportKeepsThemInColumnsOfTheirOwn) {
  ExportRequest request;
  request.target = folder_ / "mixed.csv";
  request.metrics = "moment";
  export_campaign(*store_, mixed_, request);
  std::stringstream csv;
  csv << std::ifstream(request.target).rdbuf();
  EXPECT_THAT(csv.str(), HasSubstr("moment_nm,moment_nm_per_m\n"));
  EXPECT_THAT(csv.str(), HasSubstr("F2,,2e+09\n"));
  EXPECT_THAT(csv.str(), HasSubstr("F2,3e+09,\n"));
  request.format = ExportFormat::dakota;
  EXPECT_THROW(export_campaign(*store_, mixed_, request), InputError);
}

TEST_F(MixedTest, ViewsHaveAColumnForEachKind) {
  Connection connection(folder_ / "store" / "campaign.sqlite", Connection::Mode::read_only);
  for (const char* view : {"ranking", "stage_ranking", "fault_ranking"}) {
    Statement query(connection,
                    faultsim::concat("SELECT sum(moment_nm IS NULL AND moment_nm_per_m > 0),"
                                     " sum(moment_nm > 0 AND moment_nm_per_m IS NULL) FROM ",
                                     view, " WHERE campaign = 'mixed' AND activated")
                        .c_str());
    ASSERT_TRUE(query.step());
    EXPECT_GT(query.integer(0), 0) << view;
    EXPECT_EQ(query.integer(0), query.integer(1)) << view;
  }
  Statement fault(connection,
                  "SELECT count(*) FROM fault_ranking WHERE campaign = 'sweep' AND fault = 'F2'"
                  " AND stage = 'gas_storage' AND activated AND activation_change_minus_pa = -5e6"
                  " AND activation_absolute_minus_pa = 1.5e7 AND activation_region_plus = 'east'");
  ASSERT_TRUE(fault.step());
  EXPECT_EQ(fault.integer(0), 1);
}

}  // namespace
}  // namespace faultsweep
