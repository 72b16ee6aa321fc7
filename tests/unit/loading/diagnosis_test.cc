// The diagnosis of a case: its verdict on numbers, and that it sees a case as run_case() does.

#include "simulator/loading/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <utility>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

Diagnosis sound_diagnosis() {
  Diagnosis d;
  d.result.outcome = Outcome::converged;
  d.op.condition = 10;
  d.n_steps = 1;
  return d;
}

std::vector<Violation> judged(Diagnosis d) {
  judge({}, 1e-8, d);
  return d.violations;
}

TEST(Judge, FindsNothingWhereNothingIs) { EXPECT_TRUE(judged(sound_diagnosis()).empty()); }

TEST(Judge, NamesEachLimit) {
  using Plant = void (*)(Diagnosis&);
  const std::pair<Plant, const char*> cases[] = {
      {[](Diagnosis& d) { d.worst.relative.over_limit = 2e-7; },
       "a load step misses equilibrium or contact by 2e-07, above the limit of 1e-07"},
      {[](Diagnosis& d) { d.worst.energy = 1; },
       "the energies of a load step miss their identity by 1, above the limit of 1e-07"},
      {[](Diagnosis& d) { d.op.asymmetry = 1e-3; }, "H is not symmetric, by 0.001"},
      {[](Diagnosis& d) { d.op.condition.reset(); }, "H is not positive definite"},
      {[](Diagnosis& d) { d.op.condition = 1e12; },
       "H has the condition 1e+12, above the limit of 1e+10"},
      {[](Diagnosis& d) { d.noise.slip_change = 0.5; },
       "noise of 1e-12 changes the answer by 0.5, above the limit of 1e-06"},
      {[](Diagnosis& d) { d.noise.changed = {"events 1 -> 2"}; },
       "noise of 1e-12 changes the events 1 -> 2"},
      {[](Diagnosis& d) { d.result.events.emplace_back(); },
       "the evidence of 1 slip events does not hold"},
  };
  for (const auto& [plant, text] : cases) {
    Diagnosis d = sound_diagnosis();
    plant(d);
    const auto violations = judged(d);
    ASSERT_EQ(violations.size(), 1u) << text;
    EXPECT_EQ(violations[0].what, text);
    EXPECT_FALSE(violations[0].told) << text;
  }
}

TEST(Judge, TakesSensitivityAsToldWhereTheOutcomeIsNoFullResult) {
  Diagnosis d = sound_diagnosis();
  d.noise.changed = {"events 1 -> 2"};
  d.result.outcome = Outcome::unresolved_event;
  EXPECT_TRUE(judged(d).at(0).told);
}

TEST(Judge, FollowsTheToleranceOfTheScene) {
  Diagnosis d = sound_diagnosis();
  d.worst.relative.equilibrium = 5e-6;
  judge({}, 1e-6, d);
  EXPECT_TRUE(d.sound());
}

TEST(CompareWithTwin, SeesChiSlipOutcomeActivationAndEvents) {
  CaseResult a;
  a.outcome = Outcome::converged;
  a.steps.resize(2);
  for (StepResult& step : a.steps) step.faults.resize(2);
  a.steps[1].faults[1].chi_bar = 2;
  a.steps[1].faults[0].max_slip = 0.5;
  CaseResult b = a;
  EXPECT_EQ(compare_with_twin(a, b).change(), 0);
  EXPECT_TRUE(compare_with_twin(a, b).changed.empty());
  b.steps[1].faults[1].chi_bar = 2 + 1e-9;
  b.steps[1].faults[0].max_slip = 0.5 + 1e-10;
  EXPECT_NEAR(compare_with_twin(a, b).chi_bar_change, 5e-10, 1e-15);
  EXPECT_NEAR(compare_with_twin(a, b).slip_change, 2e-10, 1e-15);
  EXPECT_NEAR(compare_with_twin(a, b).amplification(), 500, 1);
  b.outcome = Outcome::event;
  b.events.resize(1);
  b.whole.activated = true;
  b.whole.activated_fault = "F2";
  b.whole.activation_step = 7;
  EXPECT_THAT(compare_with_twin(a, b).changed,
              testing::ElementsAre("outcome converged -> event", "activation none -> F2 in step 7",
                                   "events 0 -> 1"));
}

TEST(CheckOperator, SeesAsymmetryAndLostDefiniteness) {
  FaultOperator op;
  op.geometry.dof_area = Eigen::Vector2d(1, 4);
  Eigen::MatrixXd h(2, 2);
  h << 2, 0, 0, 8;
  op.compliance = std::make_shared<DenseCompliance>(h);
  EXPECT_EQ(check_operator(op).asymmetry, 0);
  EXPECT_DOUBLE_EQ(*check_operator(op).condition, 1) << "scaled by the areas";
  h(0, 1) = 1e-3;
  op.compliance = std::make_shared<DenseCompliance>(h);
  EXPECT_DOUBLE_EQ(check_operator(op).asymmetry, 1e-3 / 8);
  h << 1, 3, 3, 1;
  op.compliance = std::make_shared<DenseCompliance>(h);
  EXPECT_FALSE(check_operator(op).condition);
}

struct Prepared {
  Scene scene;
  PreparedOperator op;
};

/// A coarse offset field in plane strain, weak enough to slip.
Prepared field(bool salt) {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"dip", "50 m"}, {"normal", "100 m"}, {"growth", 1.6}};
  scene["numerics"] = {{"plane_strain", "on"}};
  scene["friction"]["friction_angle"] = "18 deg";
  if (salt) {
    scene["materials"]["salt"]["viscosity"] = "1e17 Pa s";
    scene["numerics"]["creep_refinements"] = 1;
  }
  Prepared prepared{read_scene(parse_json(scene.dump(), "test")), {}};
  std::vector<Problem> problems;
  const Plan plan = make_plan(prepared.scene, problems);
  EXPECT_TRUE(problems.empty());
  SilentMonitor monitor;
  prepared.op = prepare_operator(prepared.scene, plan, {}, false, monitor);
  return prepared;
}

TEST(DiagnoseCase, FindsASlippingFieldSoundAndCountsWhatItChecked) {
  const Prepared prepared = field(false);
  SilentMonitor monitor;
  const Diagnosis d = diagnose_case(prepared.scene, prepared.op, monitor);
  EXPECT_EQ(d.result.outcome, Outcome::converged);
  EXPECT_GT(d.result.whole.max_slip, 0);
  EXPECT_EQ(d.n_steps, static_cast<int>(d.result.steps.size()));
  EXPECT_EQ(d.n_elastic, d.n_steps);
  EXPECT_GT(d.n_at_once, 0);
  EXPECT_TRUE(d.sound()) << d.violations.at(0).what;
  EXPECT_GT(d.worst.relative.largest(), 0);
  EXPECT_GT(d.noise.change(), 0) << "the noise reached the answer";
  EXPECT_LT(d.noise.change(), 1e-6);
}

TEST(DiagnoseCase, SaysThatEquilibriumIsNotRecomputedWhileSaltCreeps) {
  const Prepared prepared = field(true);
  ASSERT_TRUE(prepared.op.bulk);
  SilentMonitor monitor;
  const Diagnosis d = diagnose_case(prepared.scene, prepared.op, monitor);
  EXPECT_EQ(d.n_elastic, 1) << "step 0";
  EXPECT_EQ(d.n_steps, static_cast<int>(d.result.steps.size()));
  EXPECT_TRUE(d.sound()) << d.violations.at(0).what;
  EXPECT_GT(d.noise.change(), 0);
}

/// An operator file whose H was damaged in a way that its checksum did not see.
TEST(DiagnoseCase, FlagsAnOperatorThatIsNotSymmetric) {
  Prepared prepared = field(false);
  FaultOperator damaged = *prepared.op.op;
  Eigen::MatrixXd h = damaged.h();
  h(3, 40) += 1e-3 * h.cwiseAbs().maxCoeff();
  damaged.compliance = std::make_shared<DenseCompliance>(h);
  prepared.op.op = std::make_shared<const FaultOperator>(damaged);
  SilentMonitor monitor;
  const Diagnosis d = diagnose_case(prepared.scene, prepared.op, monitor);
  ASSERT_FALSE(d.sound());
  EXPECT_THAT(d.violations.back().what, testing::HasSubstr("H is not symmetric"));
}

}  // namespace
}  // namespace faultsim
