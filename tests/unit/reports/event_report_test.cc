#include <gmock/gmock.h>

#include "campaign/reports/status_report.h"
#include "tests/unit/reports/report_world.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// The first three cases again, with events, in a campaign with two new ones: resolved, unresolved.
class EventReportTest : public ReportTest {
 protected:
  void SetUp() override {
    ReportTest::SetUp();
    Submission s;
    s.name = "events";
    s.parameters = {};
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
  std::string show(const char* name) const { return shown_text(events_, name); }
  std::int64_t id_ = 0;
  CampaignInfo events_;
};

TEST_F(EventReportTest, ShowAndRankTellWhatTheSaltDid) {
  const std::string text = show("2");
  const auto result = testing::made_up_result_with_events(0.95);
  double shear = 0, normal = 0, of_first = 0;
  int n_time_steps = 0;
  for (const faultsim::StepResult& step : result.steps) {
    n_time_steps += step.creep->time_steps;
    of_first = std::min(of_first, step.creep->faults.at(0).normal_min);
    for (const faultsim::FaultCreep& one : step.creep->faults) {
      shear = std::max(shear, one.shear_max);
      normal = std::min(normal, one.normal_min);
    }
  }
  EXPECT_THAT(text, HasSubstr("salt creeps: it changed tractions on F1 by " +
                              format_number(of_first / 1e5, 3) + " bar (compression) to "));
  EXPECT_THAT(text, HasSubstr(" bar in shear; " + std::to_string(n_time_steps) + " time steps"));
  EXPECT_THAT(text, HasSubstr("creep |ΔtT|, bar  time steps"));
  EXPECT_THAT(text, HasSubstr("time steps of 13 load steps are coarser"));
  const auto steps = render_json(shown(events_, "2"))["histories"];
  EXPECT_EQ(steps[4]["creep_shear_max_pa"], result.steps[4].creep->faults[0].shear_max);
  EXPECT_EQ(steps[4]["creep_time_resolved"], false);
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
  const Answer answer = to_answer(make_ranking(*store_, events_, {}));
  const std::string text = render_text(answer, 200);
  EXPECT_THAT(text, ::testing::ContainsRegex("\n1 +3 +yes +yes .* event "));
  EXPECT_THAT(text, ::testing::ContainsRegex("\n2 +1 +yes +yes .* converged "));
  EXPECT_THAT(text, ::testing::ContainsRegex("\n[+]1 +2 +yes +no .* unresolved_event, mesh too "
                                             "coarse for its weakening .* yes, F1"));
  EXPECT_THAT(text, HasSubstr("3 of 3 cases slide; 1 of these are not resolved by the cells."));
  EXPECT_THAT(text, HasSubstr("+ complete, but whether a fault slides (resolved: no)"));
  EXPECT_THAT(text, Not(HasSubstr("ends early")));
  const auto json = render_json(answer);
  EXPECT_EQ(json["cases"][0]["n_events"], 2);
  EXPECT_EQ(json["cases"][0]["event_moment_nm"], 2e13 / 3);
  EXPECT_EQ(json["cases"][2]["rank_class"], 1);
  EXPECT_EQ(json["cases"][2]["unexpected"], true);
  EXPECT_TRUE(json["cases"][2]["rank"].is_null());
  EXPECT_EQ(json["cases"][2]["rank_note"], "+1");
}

TEST_F(EventReportTest, ActivationThatHangsOnTheMeshIsSaid) {
  const auto json = render_json(to_answer(make_ranking(*store_, events_, {})));
  EXPECT_EQ(json["cases"][0]["activation_resolved"], true);
  EXPECT_EQ(json["cases"][0]["resolved"], true);
  EXPECT_EQ(json["cases"][2]["activation_resolved"], false);
  EXPECT_EQ(json["cases"][2]["resolved"], false);
  std::vector<long> found;
  for (const auto& row :
       make_ranking(*store_, events_, request("chi_bar", "not activation_resolved")).rows)
    found.push_back(row.position);
  EXPECT_THAT(found, ElementsAre(2));
  EXPECT_THAT(show("2"), HasSubstr("UNRESOLVED: whether a fault slides depends on the mesh"));
  const auto one = render_json(shown(events_, "2"));
  EXPECT_EQ(one["stages"][1]["slides"], true);
  EXPECT_EQ(one["stages"][1]["activation_resolved"], false);
  EXPECT_EQ(one["histories"][13 + 3]["activation_resolved"], false) << "F2 in step 3";
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
  const Answer answer = shown(events_, "2");
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text,
              HasSubstr("UNEXPECTED REACTIVATION: fault F1 slides again in gas_storage, steps "));
  EXPECT_THAT(text, HasSubstr("UNRESOLVED: the size of its slip events depends on the mesh."));
  EXPECT_THAT(text, HasSubstr("\nslip events:\n"));
  EXPECT_THAT(text, HasSubstr("no, mesh too coarse"));
  EXPECT_THAT(text, HasSubstr("\nepisodes (pressures at their first step):\n"));
  const auto result = testing::made_up_result_with_events(0.95);
  const auto json = render_json(answer);
  EXPECT_EQ(json["slip_events"][1]["stress_drop_pa"], result.events[1].stress_drop);
  EXPECT_EQ(json["slip_events"][0]["resolved"], false);
  EXPECT_EQ(json["slip_events"][0]["change_minus_pa"], *result.events[0].pressures.change_minus);
  EXPECT_EQ(json["episodes"][1]["after_recovery"], true);
  testing::expect_the_same_numbers(answer);
  testing::expect_to_fit(answer);
  EXPECT_THAT(show("3"), Not(HasSubstr("UN")));
  EXPECT_THAT(show("1"), Not(HasSubstr("slip events")));
}

TEST_F(EventReportTest, StatusCountsThemAsDoneButNotAsConverged) {
  const StatusReport status = make_status(*store_, "events");
  EXPECT_THAT(render_text(to_answer(status), 200),
              HasSubstr("events: 3 cases, 3 done (1 converged, 1 with slip events, 1 with "
                        "unresolved slip events), 0 failed, 0 waiting"));
  EXPECT_THAT(render_text(to_answer(status), 200), Not(HasSubstr("without a full result")));
  EXPECT_EQ(render_json(to_answer(status))["event"], 1);
  EXPECT_EQ(render_json(to_answer(status))["unresolved_event"], 1);
}

}  // namespace
}  // namespace faultsweep
