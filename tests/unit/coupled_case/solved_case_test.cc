// Cases on columns of H that are solved for, against the same cases on the H of the factor: contact
// without weakening, and the events of weakening faults.

#include "simulator/coupled_case/solved_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>

#include "simulator/coupled_case/coupled_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/solved_compliance/solved_compliance.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct SceneAndPlan {
  explicit SceneAndPlan(const json& document)
      : scene(read_scene(parse_json(document.dump(), "test"))) {
    std::vector<Problem> problems;
    plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
  }
  Scene scene;
  Plan plan;
};

struct Walk {
  CaseResult result;
  std::vector<FaultFields> fields;
  Verdict worst;
  int n_columns = 0, n_jumps = 0;
};

CaseProbe watching(Walk& walk, const FaultOperator& op) {
  CaseProbe probe;
  probe.step = [&walk](const StepResult&, const FaultFields& fields) {
    walk.fields.push_back(fields);
  };
  probe.accepted = [&walk, &op](int, const ContactLaws& laws, const AcceptedStep& step) {
    EXPECT_TRUE(step.elastic);
    walk.worst.take_worst(judge_step(op, laws, step));
  };
  return probe;
}

Walk by_factor(const json& document) {
  const SceneAndPlan p(document);
  Walk walk;
  const PreparedOperator prepared = prepare_operator(p.scene, p.plan, {}, false);
  walk.result = run_case(p.scene, prepared, {}, watching(walk, *prepared.op));
  return walk;
}

Walk by_columns(const json& document, LeadingKind leading = LeadingKind::amg) {
  const SceneAndPlan p(document);
  Walk walk;
  SolvedCase one(SceneBulk(p.scene, p.plan), {.leading = leading});
  walk.n_jumps = one.compliance().size();
  CaseProbe probe = watching(walk, one.faults());
  int made = 0;
  const auto accepted = probe.accepted;
  probe.accepted = [&](int step, const ContactLaws& laws, const AcceptedStep& what) {
    made = one.compliance().n_made();  // before the judge asks for more
    accepted(step, laws, what);
  };
  walk.result = one.run({}, probe);
  walk.n_columns = made;
  return walk;
}

/// Node by node, and in every measure, to a tolerance relative to the largest value.
void expect_same(const Walk& a, const Walk& b, double tolerance) {
  ASSERT_EQ(a.result.outcome, b.result.outcome) << a.result.reason << b.result.reason;
  ASSERT_EQ(a.fields.size(), b.fields.size());
  double slip = 1e-6, traction = 0;
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
    const StepResult &p = a.result.steps[i], &q = b.result.steps[i];
    EXPECT_EQ(p.counts.newton_iterations, q.counts.newton_iterations);
    for (std::size_t f = 0; f < q.faults.size(); ++f) {
      EXPECT_NEAR(p.faults[f].chi_bar, q.faults[f].chi_bar, 10 * tolerance);
      EXPECT_NEAR(p.faults[f].moment, q.faults[f].moment, tolerance * (1 + q.faults[f].moment));
    }
    for (std::size_t row = 0; row < q.observed.size(); ++row)
      EXPECT_NEAR(p.observed[row], q.observed[row], 0.1 * tolerance);
  }
  EXPECT_EQ(a.result.observation_names, b.result.observation_names);
  EXPECT_EQ(a.result.warnings, b.result.warnings);
  EXPECT_LT(a.worst.relative.largest(), 1e-7);
  EXPECT_LT(a.worst.largest_energy(), 1e-7);
}

void expect_same_events(const CaseResult& a, const CaseResult& b, double tolerance) {
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < b.events.size(); ++i) {
    SCOPED_TRACE(concat("event ", i));
    const SlipEvent &x = a.events[i], &y = b.events[i];
    EXPECT_EQ(x.step, y.step);
    EXPECT_EQ(x.fault, y.fault);
    EXPECT_EQ(x.load_factor_before, y.load_factor_before);
    EXPECT_EQ(x.pressures.change_minus, y.pressures.change_minus) << "at onset";
    EXPECT_EQ(x.pressures.change_plus, y.pressures.change_plus);
    EXPECT_NEAR(x.moment, y.moment, tolerance * y.moment);
    EXPECT_NEAR(x.max_slip, y.max_slip, tolerance * y.max_slip);
    EXPECT_NEAR(x.nucleation_length, y.nucleation_length, tolerance * y.nucleation_length);
    EXPECT_NEAR(x.energy_released, y.energy_released, tolerance * y.energy_released);
    EXPECT_EQ(x.negative_pivots, y.negative_pivots);
    EXPECT_EQ(x.evidence_holds, y.evidence_holds);
  }
}

/// A fault in a box that a depleting block makes slip, then fluid in it opens, and back: 3D.
json sliding_box() {
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

/// A field in plane strain whose faults weaken so fast that they jump.
json weakening_field() {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"dip", "40 m"}, {"normal", "40 m"}, {"growth", 1.8}};
  scene["numerics"] = {{"plane_strain", "on"}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["friction"] = {{"cohesion", "0 MPa"},
                       {"friction_angle", "24 deg"},
                       {"dynamic_friction_angle", "12 deg"},
                       {"slip_weakening_distance", "10 mm"}};
  return scene;
}

/// The same in half of three dimensions, with few cells.
json weakening_block() {
  json scene = weakening_field();
  scene["numerics"] = {{"plane_strain", "off"}, {"half_domain", "on"}};
  scene["mesh"] = {{"strike", "1500 m"}, {"dip", "100 m"}, {"normal", "400 m"}, {"growth", 2.0}};
  scene["stages"] = json::parse(
      R"([{"name": "production", "duration": "4 year", "steps": 4, "pressure_change": "-200 bar"}])");
  scene["output"]["observation_points"] =
      json::parse(R"([{"name": "south", "position": ["300 m", "-1500 m", "0 m"]}])");
  return scene;
}

TEST(SolvedCase, IsTheCondensedCaseWithStickSlipAndOpening) {
  const Walk columns = by_columns(sliding_box()), factor = by_factor(sliding_box());
  expect_same(columns, factor, 1e-8);
  EXPECT_EQ(factor.result.outcome, Outcome::converged);
}

TEST(SolvedCase, HasTheEventsOfTheCondensedCaseInPlaneStrain) {
  const Walk factor = by_factor(weakening_field());
  EXPECT_GE(factor.result.events.size(), 1u);
  for (const LeadingKind leading : {LeadingKind::exact, LeadingKind::amg_by_component}) {
    SCOPED_TRACE(to_string(leading));
    const Walk columns = by_columns(weakening_field(), leading);
    expect_same(columns, factor, 1e-7);
    expect_same_events(columns.result, factor.result, 1e-7);
    EXPECT_LT(columns.n_columns, columns.n_jumps) << "nodes that stick need none";
  }
}

TEST(SolvedCase, HasTheEventsOfTheCondensedCaseInHalfADomain) {
  const SceneAndPlan p(weakening_block());
  ASSERT_TRUE(p.plan.half_domain && !p.plan.plane_strain);
  const Walk factor = by_factor(weakening_block());
  EXPECT_GE(factor.result.events.size(), 1u);
  const Walk columns = by_columns(weakening_block(), LeadingKind::exact);
  expect_same(columns, factor, 1e-7);
  expect_same_events(columns.result, factor.result, 1e-7);
  EXPECT_GT(factor.result.steps.back().observed[1], 1e-5) << "of the side that is not modelled";
}

TEST(SolvedCase, FollowsTheJumpOfCohesionThatIsLostBySlip) {
  json scene = weakening_field();
  scene["friction"] = {
      {"cohesion", "2 MPa"}, {"friction_angle", "16 deg"}, {"cohesion_after_slip", false}};
  const Walk factor = by_factor(scene);
  EXPECT_GE(factor.result.events.size(), 1u);
  const Walk columns = by_columns(scene, LeadingKind::exact);
  expect_same(columns, factor, 1e-7);
  expect_same_events(columns.result, factor.result, 1e-7);
}

TEST(SolvedCase, IsWhatTheCoupledPathTakesForFaultsThatMayJump) {
  const SceneAndPlan weakens(weakening_field()), slides(sliding_box());
  EXPECT_TRUE(takes_columns(weakens.scene, weakens.plan));
  EXPECT_FALSE(takes_columns(slides.scene, slides.plan));
  json cohesive = sliding_box();
  cohesive["friction"] = {
      {"cohesion", "1 MPa"}, {"friction_angle", "14 deg"}, {"cohesion_after_slip", false}};
  const SceneAndPlan breaks(cohesive);
  EXPECT_TRUE(takes_columns(breaks.scene, breaks.plan));
  EXPECT_TRUE(unsupported_by_coupled(weakens.scene, weakens.plan).empty());
  CoupledCase one(SceneBulk(weakens.scene, weakens.plan), {.leading = LeadingKind::exact});
  const CaseResult result = one.run();
  EXPECT_GE(result.events.size(), 1u);
  ASSERT_TRUE(result.coupled);
  EXPECT_EQ(result.coupled->leading + " " + result.coupled->schur, "exact columns");
  EXPECT_EQ(result.coupled->n_multipliers, one.faults().geometry.n_dofs);
  EXPECT_GT(result.coupled->n_displacements, result.coupled->n_multipliers);
  int solves = 0;
  for (const StepResult& step : result.steps) {
    ASSERT_TRUE(step.coupled);
    for (const int iterations : step.coupled->krylov_iterations) solves += iterations;
    EXPECT_GE(step.coupled->krylov_iterations.size(), 1u) << "the look from outside";
  }
  EXPECT_EQ(result.coupled->krylov_iterations, solves);
  EXPECT_EQ(result.coupled->most_krylov_iterations, 1);
  EXPECT_EQ(one.mesh().nodes.size(),
            SceneBulk(weakens.scene, weakens.plan).problem()->mesh.nodes.size());
}

TEST(SolvedCase, GivesTheDisplacementsOfTheCondensedCase) {
  const SceneAndPlan p(weakening_block());
  std::vector<Eigen::Matrix3Xd> columns, factor;
  const auto into = [](std::vector<Eigen::Matrix3Xd>& all) {
    CaseProbe probe;
    probe.displaced = [&all](const StepResult&, const Eigen::Matrix3Xd& u) { all.push_back(u); };
    return probe;
  };
  SolvedCase(SceneBulk(p.scene, p.plan), {.leading = LeadingKind::exact}).run({}, into(columns));
  run_case(p.scene, prepare_operator(p.scene, p.plan, {}, true), {}, into(factor));
  ASSERT_EQ(columns.size(), factor.size());
  EXPECT_GE(columns.size(), 1u);
  for (std::size_t i = 0; i < factor.size(); ++i)
    EXPECT_LE((columns[i] - factor[i]).norm(), 1e-7 * factor[i].norm());
  EXPECT_GT(factor.back().norm(), 0.1);
}

TEST(SolvedCase, SaysWhereASolveGivesUp) {
  const SceneAndPlan p(weakening_field());
  try {
    SolvedCase one(SceneBulk(p.scene, p.plan), {.leading = LeadingKind::fsai, .max_iterations = 3});
    FAIL() << "three iterations";
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("conjugate gradients (fsai) do not reach"));
  }
}

TEST(SolvedCase, AcceptsNoStepWhoseColumnsAreTooCoarse) {
  const SceneAndPlan p(sliding_box());
  SolvedCase one(SceneBulk(p.scene, p.plan), {.leading = LeadingKind::amg}, {},
                 {.tolerance = 1e-4});
  const CaseResult result = one.run();
  EXPECT_EQ(result.outcome, Outcome::unconverged);
  EXPECT_THAT(result.reason, HasSubstr("the tractions of solved columns are off by"));
  EXPECT_THAT(result.reason, HasSubstr("by a solve with all jumps"));
  EXPECT_TRUE(result.failed_step);
}

TEST(SolvedCase, EndsWhereColumnsDoNotFit) {
  const SceneAndPlan p(weakening_field());
  SolvedCase one(SceneBulk(p.scene, p.plan), {.leading = LeadingKind::exact}, {},
                 {.column_bytes = 1e4});
  EXPECT_THROW(one.run(), ResourceError);
}

TEST(SolvedCase, EndsWhenItIsToldTo) {
  const SceneAndPlan p(weakening_field());
  SolvedCase one(SceneBulk(p.scene, p.plan), {.leading = LeadingKind::exact});
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
