// A scene on both paths: the same tractions, slips and measures.

#include "simulator/coupled_case/coupled_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>

#include "simulator/scene/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// What one path says of every load step.
struct History {
  CaseResult result;
  std::vector<FaultFields> fields;
  std::vector<SubStepTrace> tried;

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
      [&](const StepResult&, const FaultFields& fields) { history.fields.push_back(fields); });
  return history;
}

History coupled(const json& document, const SolverChoice& solver) {
  const Planned p(document);
  History history;
  CoupledCase one(p.scene, p.plan, solver);
  history.result = one.run(
      {}, [&](const StepResult&, const FaultFields& fields) { history.fields.push_back(fields); },
      [&](int, const SubStepTrace& part) { history.tried.push_back(part); });
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
  double slip = 1e-6;
  for (const FaultFields& fields : b.fields) {
    slip = std::max(slip, fields.jump.cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    SCOPED_TRACE(concat("load step ", i));
    const FaultFields &x = a.fields[i], &y = b.fields[i];
    const double traction = y.traction.cwiseAbs().maxCoeff();
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
    EXPECT_THAT(error.what(), HasSubstr("take rac as its Schur complement"));
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
  EXPECT_EQ(problems.size(), 1 + 2 * p.scene.faults.size()) << "all of them";
  EXPECT_THROW(CoupledCase(p.scene, p.plan, {}), InputError);
  const Planned strong(field());
  EXPECT_TRUE(unsupported_by_coupled(strong.scene, strong.plan).empty());
}

TEST(CoupledCase, SaysWhereGmresGivesUp) {
  json scene = box();
  const Planned p(scene);
  SolverChoice poor{LeadingKind::fsai, SchurKind::exact};  // 200 iterations where others take 20
  poor.fsai.steps = 1;
  CoupledCase one(p.scene, p.plan, poor);
  one.limit_krylov(3);
  const CaseResult result = one.run();
  EXPECT_EQ(result.outcome, Outcome::unconverged);
  EXPECT_EQ(result.failed_step, 0);
  EXPECT_THAT(result.reason, HasSubstr("GMRES (fsai, exact) does not reach 0.0001 within 3"));
  EXPECT_EQ(result.coupled->krylov_iterations, 3) << "no smaller step helps a linear system";
}

TEST(CoupledCase, EndsWhenItIsToldTo) {
  const Planned p(box());
  CoupledCase one(p.scene, p.plan, {LeadingKind::amg, SchurKind::rac});
  std::atomic<bool> flag = false;
  SilentMonitor silent;
  const CaseResult result =
      one.run({silent, StopToken(flag)}, [&](const StepResult& step, const FaultFields&) {
        if (step.step == 2) flag = true;
      });
  EXPECT_EQ(result.outcome, Outcome::interrupted);
  EXPECT_EQ(result.steps.size(), 3u);
}

}  // namespace
}  // namespace faultsim
