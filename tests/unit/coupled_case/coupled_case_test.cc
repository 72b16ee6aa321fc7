// A scene on both paths: the same tractions, slips and measures.

#include "simulator/coupled_case/coupled_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// What one path says of every load step.
struct History {
  CaseResult result;
  std::vector<FaultFields> fields;
  std::vector<SubStepTrace> tried;
  Verdict worst;  ///< of the steps of the coupled path.

  int most(int StepResult::*count) const {
    int most = 0;
    for (const StepResult& step : result.steps) most = std::max(most, step.*count);
    return most;
  }
};

struct Planned {
  explicit Planned(const json& document) : scene(read_scene(parse_json(document.dump(), "test"))) {
    std::vector<Problem> problems;
    plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
  }
  Scene scene;
  Plan plan;
};

History condensed(const json& document) {
  const Planned p(document);
  History history;
  const PreparedOperator prepared = prepare_operator(p.scene, p.plan, {}, false);
  history.result = run_case(
      p.scene, prepared, {},
      {{[&](const StepResult&, const FaultFields& fields) { history.fields.push_back(fields); }}});
  return history;
}

History coupled(const json& document, const SolverChoice& solver) {
  const Planned p(document);
  History history;
  CoupledCase one(SceneBulk(p.scene, p.plan), solver);
  CaseProbe probe;
  probe.tried = [&](int, const SubStepTrace& part) { history.tried.push_back(part); };
  probe.accepted = [&](int, const ContactLaws& laws, const AcceptedStep& step) {
    EXPECT_FALSE(step.elastic) << "there is no H";
    history.worst.take_worst(judge_step(one.faults(), laws, step));
  };
  probe.step = [&](const StepResult&, const FaultFields& fields) {
    history.fields.push_back(fields);
  };
  history.result = one.run({}, probe);
  EXPECT_LT(history.worst.relative.largest(), 1e-6) << "judged by the conditions themselves";
  return history;
}

void near(double a, double b, double scale, double tolerance, const char* what) {
  EXPECT_NEAR(a, b, tolerance * scale) << what;
}

/// Node by node, and in every measure, to a tolerance relative to the largest value.
void expect_same(const History& a, const History& b, double tolerance) {
  ASSERT_EQ(a.result.outcome, Outcome::converged) << a.result.reason;
  ASSERT_EQ(b.result.outcome, Outcome::converged) << b.result.reason;
  ASSERT_EQ(a.fields.size(), b.fields.size());
  double slip = 1e-6, traction = 0;  // of the history: where all of a fault is open there is none
  for (const FaultFields& fields : b.fields) {
    slip = std::max(slip, fields.jump.cwiseAbs().maxCoeff());
    traction = std::max(traction, fields.traction.cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    SCOPED_TRACE(concat("load step ", i));
    const FaultFields &x = a.fields[i], &y = b.fields[i];
    EXPECT_LT((x.traction - y.traction).cwiseAbs().maxCoeff(), tolerance * traction);
    EXPECT_LT((x.jump - y.jump).cwiseAbs().maxCoeff(), tolerance * slip);
    EXPECT_EQ(x.state, y.state);
    EXPECT_LT((x.fault_pressure_change - y.fault_pressure_change).norm(), 1e-9);
    const StepResult &p = a.result.steps[i], &q = b.result.steps[i];
    for (std::size_t f = 0; f < q.faults.size(); ++f) {
      near(p.faults[f].chi_bar, q.faults[f].chi_bar, 1, 10 * tolerance, "chi_bar");
      near(p.faults[f].max_slip, q.faults[f].max_slip, slip, tolerance, "max_slip");
      near(p.faults[f].moment, q.faults[f].moment, std::max(1.0, q.faults[f].moment), tolerance,
           "moment");
      EXPECT_EQ(p.faults[f].activated, q.faults[f].activated);
    }
    for (std::size_t row = 0; row < q.observed.size(); ++row) {
      near(p.observed[row], q.observed[row], 0.1, tolerance, "displacement observed");
    }
  }
  EXPECT_EQ(a.result.whole.activated, b.result.whole.activated);
  EXPECT_EQ(a.result.episodes.size(), b.result.episodes.size());
  EXPECT_EQ(a.result.stages.size(), b.result.stages.size());
  EXPECT_EQ(a.result.observation_names, b.result.observation_names);
  EXPECT_EQ(a.result.identity, b.result.identity);
}

/// A fault in a box that a depleting block makes slip, then fluid in it opens, and back: 3D.
json box() {
  json scene = json::parse(starter_scene("box"));
  scene["geometry"]["from"] = {"-500 m", "-250 m", "-2400 m"};
  scene["geometry"]["to"] = {"500 m", "250 m", "-1600 m"};
  scene["geometry"]["regions"][0]["from"] = {"-500 m", "-250 m", "-2100 m"};
  scene["geometry"]["regions"][0]["to"] = {"0 m", "250 m", "-1900 m"};
  scene["faults"][0]["length"] = "350 m";
  scene["faults"][0]["width"] = "370 m";
  scene["faults"][0]["strike"] = "0 deg";
  scene["faults"][0]["dip_from_vertical"] = "15 deg";
  scene["mesh"] = {{"strike", "100 m"},
                   {"dip", "75 m"},
                   {"normal", "120 m"},
                   {"growth", 2.0},
                   {"fine_margin", "30 m"}};
  scene["friction"] = {{"cohesion", "0 MPa"}, {"friction_angle", "14 deg"}};
  scene["fault_pressure"] = {
      {"rule", "prescribed"},
      {"prescribed", "14 MPa"},
      {"table", {{"time", {"0 year", "4 year", "6 year", "8 year"}}, {"factor", {0, 0, 1, 0}}}}};
  scene["stages"] = json::parse(
      R"([{"name": "depletion", "duration": "4 year", "steps": 3, "pressure_change": "-150 bar"},
          {"name": "injection", "duration": "4 year", "steps": 4, "pressure_change": "-150 bar"}])");
  scene["output"]["observation_points"] =
      json::parse(R"([{"name": "top", "position": ["100 m", "0 m", "-1600 m"]}])");
  return scene;
}

/// A field in plane strain with offset, dipping faults that slip.
json field() {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", "400 m"}, {"dip", "100 m"}, {"normal", "100 m"}, {"growth", 1.8}};
  scene["numerics"] = {{"plane_strain", "on"}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["friction"]["friction_angle"] = "18 deg";
  return scene;
}

const History& box_on_both_sides() {
  static const History history = coupled(box(), {LeadingKind::amg, SchurKind::rac});
  return history;
}

TEST(CoupledCase, IsTheCondensedCaseWithStickSlipAndOpening) {
  const History on_operator = condensed(box());
  EXPECT_GT(on_operator.most(&StepResult::n_stick), 5);
  EXPECT_GT(on_operator.most(&StepResult::n_slip), 5);
  EXPECT_GT(on_operator.most(&StepResult::n_open), 5);
  expect_same(box_on_both_sides(), on_operator, 1e-6);
}

TEST(CoupledCase, IsTheCondensedCaseInPlaneStrain) {
  const History on_operator = condensed(field());
  EXPECT_GT(on_operator.most(&StepResult::n_slip), 5);
  const History both_sides = coupled(field(), {LeadingKind::amg_by_component, SchurKind::rac});
  expect_same(both_sides, on_operator, 1e-6);
  EXPECT_LE(both_sides.result.coupled->most_krylov_iterations, 40) << "on stretched cells";
}

/// All of the faults open: no traction is left to measure the tolerance by.
json opened() {
  json scene = box();
  scene["friction"] = {{"cohesion", "2 MPa"}, {"friction_angle", "6 deg"}};
  scene["faults"][0]["width"] = "250 m";
  scene["fault_pressure"]["prescribed"] = "18 MPa";
  return scene;
}

TEST(CoupledCase, OpensFaultsAsAWhole) {
  const History on_operator = condensed(opened());
  EXPECT_EQ(on_operator.most(&StepResult::n_open),
            static_cast<int>(on_operator.fields[0].state.size()));
  const History both_sides = coupled(opened(), {LeadingKind::amg_by_component, SchurKind::rac});
  expect_same(both_sides, on_operator, 1e-6);
  EXPECT_EQ(both_sides.result.counts.wasted_newton_iterations, 0);
}

/// A large step of weak faults: nodes that are set to slip too far turn back.
json weak_in_one_step() {
  json scene = field();
  scene["friction"] = {{"cohesion", "0.5 MPa"}, {"friction_angle", "8 deg"}};
  scene["faults"][0]["dip_from_vertical"] = "10 deg";
  scene["geometry"]["blocks"][0]["offset"] = "50 m";
  scene["geometry"]["blocks"][1]["offset"] = "150 m";
  scene["stages"][0]["steps"] = 1;
  return scene;
}

TEST(CoupledCase, TakesALargeStepAtOnceWhereNodesTurnBack) {
  const History on_operator = condensed(weak_in_one_step());
  const History both_sides =
      coupled(weak_in_one_step(), {LeadingKind::amg_by_component, SchurKind::rac});
  expect_same(both_sides, on_operator, 1e-6);
  EXPECT_EQ(both_sides.result.counts.wasted_newton_iterations, 0);
  for (const StepResult& step : both_sides.result.steps) EXPECT_EQ(step.counts.sub_steps, 1);
  EXPECT_EQ(both_sides.result.warnings, on_operator.result.warnings);
}

TEST(CoupledCase, WarnsOfLoadStepsTakenInParts) {
  CaseResult result;
  result.steps.resize(5);
  for (int i = 0; i < 5; ++i) {
    result.steps[i].step = i;
    result.steps[i].counts.sub_steps = 1;
  }
  EXPECT_EQ(parts_warning(result), "");
  result.steps[2].counts.sub_steps = 2;
  result.steps[4].counts.sub_steps = 8;
  EXPECT_EQ(parts_warning(result),
            "load steps were cut because Newton's method did not converge over the whole: 2 (2 "
            "parts), 4 (8 parts); slip depends on the path, so it may differ slightly from that of "
            "the condensed path");
}

/// What is observed on the side that is not modelled is that of the other one, mirrored.
TEST(CoupledCase, IsTheCondensedCaseInHalfADomain) {
  json scene = field();
  scene["numerics"] = {{"plane_strain", "off"}, {"half_domain", "on"}};
  scene["mesh"] = {{"strike", "1500 m"}, {"dip", "200 m"}, {"normal", "1 km"}, {"growth", 2.0}};
  scene["stages"] = json::parse(
      R"([{"name": "production", "duration": "4 year", "steps": 2, "pressure_change": "-150 bar"}])");
  scene["output"]["observation_points"] = json::parse(
      R"([{"name": "north", "position": ["300 m", "2500 m", "0 m"]},
          {"name": "south", "position": ["300 m", "-2500 m", "0 m"]}])");
  const Planned p(scene);
  ASSERT_TRUE(p.plan.half_domain);
  const History both_sides = coupled(scene, {LeadingKind::amg, SchurKind::rac});
  expect_same(both_sides, condensed(scene), 1e-6);
  const std::vector<double>& last = both_sides.result.steps.back().observed;
  ASSERT_EQ(last.size(), 6u);
  EXPECT_GT(std::abs(last[1]), 1e-4);
  const CoupledCase one(SceneBulk(p.scene, p.plan), {LeadingKind::amg, SchurKind::rac});
  const PreparedOperator prepared = prepare_operator(p.scene, p.plan, {}, false);
  const std::vector<ObservationRow>& rows = one.faults().observed.rows;
  const std::vector<ObservationRow>& others = prepared.op->observed.rows;
  ASSERT_EQ(rows.size(), others.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k].name, others[k].name);
    EXPECT_EQ(rows[k].position, others[k].position);
    EXPECT_EQ(rows[k].position.y() > 0, k < 3) << "where the point was asked for";
  }
  EXPECT_EQ(last[0], last[3]);
  EXPECT_EQ(last[1], -last[4]);
  EXPECT_EQ(last[2], last[5]);
}

TEST(CoupledCase, CountsItsWork) {
  const History& history = box_on_both_sides();
  ASSERT_TRUE(history.result.coupled);
  const CaseCoupled& whole = *history.result.coupled;
  EXPECT_EQ(whole.leading + whole.schur, "amgrac");
  EXPECT_GT(whole.n_displacements, 10 * whole.n_multipliers);
  EXPECT_GT(whole.n_multipliers, 30);
  int sum = 0, most = 0, newton = 0;
  for (const StepResult& step : history.result.steps) {
    ASSERT_TRUE(step.coupled);
    EXPECT_EQ(step.counts.newton_iterations,
              static_cast<int>(step.coupled->krylov_iterations.size()));
    newton += step.counts.newton_iterations;
    for (const int n : step.coupled->krylov_iterations) {
      sum += n;
      most = std::max(most, n);
    }
  }
  EXPECT_EQ(whole.krylov_iterations, sum);
  EXPECT_EQ(whole.most_krylov_iterations, most);
  EXPECT_EQ(history.result.counts.newton_iterations, newton);
  EXPECT_LE(most, 20) << "over stick, slip and opening";
  int traced = 0;
  for (const SubStepTrace& part : history.tried) {
    for (const SearchIteration& at : part.searches.at(0).history.last) traced += at.krylov;
  }
  EXPECT_EQ(traced, sum);
}

/// The block above a fault that cuts the whole body is held by it alone.
json loose_block() {
  json scene = box();
  scene["geometry"]["boundary"] = json::parse(
      R"([{"sides": ["x-", "x+", "y-", "y+", "z-"], "kind": "roller"},
          {"sides": ["z+"], "kind": "free"}])");
  scene["faults"][0]["center"] = {"0 m", "0 m", "-2000 m"};
  scene["faults"][0]["dip_from_vertical"] = "90 deg";
  scene["faults"][0]["length"] = "5 km";
  scene["faults"][0]["width"] = "5 km";
  scene["fault_pressure"] = {{"rule", "none"}};
  return scene;
}

TEST(CoupledCase, HoldsLooseBlocksByTheirFaults) {
  const History on_operator = condensed(loose_block());
  expect_same(coupled(loose_block(), {LeadingKind::amg, SchurKind::rac}), on_operator, 1e-6);
  try {
    coupled(loose_block(), {LeadingKind::exact, SchurKind::lsc});
    FAIL() << "K is singular";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("that the faults cut loose can move along z"));
    EXPECT_THAT(error.what(), HasSubstr("use rac as the Schur complement"));
  }
}

TEST(CoupledCase, RefusesWhatItDoesNotDo) {
  json scene = field();
  scene["materials"]["salt"]["viscosity"] = "1e18 Pa s";
  scene["numerics"]["creep"] = "on";
  scene["friction"] = {{"cohesion", "1 MPa"},
                       {"friction_angle", "30 deg"},
                       {"dynamic_friction_angle", "20 deg"},
                       {"slip_weakening_distance", "1 cm"},
                       {"cohesion_after_slip", false}};
  const Planned p(scene);
  const std::vector<Problem> problems = unsupported_by_coupled(p.scene, p.plan);
  EXPECT_EQ(problems.size(), 1u) << "of creep alone";
  EXPECT_THROW(CoupledCase(SceneBulk(p.scene, p.plan), {}), InputError);
  const Planned strong(field());
  EXPECT_TRUE(unsupported_by_coupled(strong.scene, strong.plan).empty());
}

TEST(CoupledCase, SaysWhereGmresGivesUp) {
  json scene = box();
  const Planned p(scene);
  SolverChoice poor{LeadingKind::fsai, SchurKind::exact};  // 200 iterations where others take 20
  poor.fsai.steps = 1;
  poor.max_iterations = 3;
  CoupledCase one(SceneBulk(p.scene, p.plan), poor);
  const CaseResult result = one.run();
  EXPECT_EQ(result.outcome, Outcome::unconverged);
  EXPECT_EQ(result.failed_step, 0);
  EXPECT_THAT(result.reason, HasSubstr("GMRES (fsai, exact) does not reach 0.001 within 3"));
  EXPECT_EQ(result.coupled->krylov_iterations, 3) << "no smaller step helps a linear system";
}

TEST(CoupledCase, EndsWhenItIsToldTo) {
  const Planned p(box());
  CoupledCase one(SceneBulk(p.scene, p.plan), {LeadingKind::amg, SchurKind::rac});
  std::atomic<bool> flag = false;
  SilentMonitor silent;
  const CaseResult result =
      one.run({silent, StopToken(flag)}, {{[&](const StepResult& step, const FaultFields&) {
                if (step.step == 2) flag = true;
              }}});
  EXPECT_EQ(result.outcome, Outcome::interrupted);
  EXPECT_EQ(result.steps.size(), 3u);
}

}  // namespace
}  // namespace faultsim
