// How a case with creeping salt is stepped in time, on bodies with closed forms: the column of V8,
// and the slider of V7 on a spring that relaxes.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "simulator/loading/case_contact.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr double kYear = 31557600;
constexpr double kTau = 6.5e6;  // s, of the salt of V8

Scene scene_of(const std::string& file, const Settings& settings) {
  JsonDocument document = read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/verification/" + file);
  for (const auto& [pointer, value] : settings) set_value(document, pointer, value);
  return read_scene(document);
}

/// A scene with its ladder, run as often as wanted.
struct Case {
  Scene scene;
  PreparedOperator prepared;
  CaseResult result;
  std::vector<FaultFields> fields;

  explicit Case(Scene given) : scene(std::move(given)) {
    std::vector<Problem> problems;
    const Plan plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
    SilentMonitor monitor;
    prepared = prepare_operator(scene, plan, {}, false, monitor);
    run();
  }
  void run() {
    SilentMonitor monitor;
    fields.clear();
    result = run_case(scene, prepared, monitor,
                      {{[&](const StepResult&, const FaultFields& f) { fields.push_back(f); }}});
  }
  const StepCreep& creep(std::size_t step) const { return result.steps.at(step).creep.value(); }
};

double difference(const FaultFields& a, const FaultFields& b) {
  return (a.traction - b.traction).cwiseAbs().maxCoeff();
}

/// The column of V8 over one load step of τ.
Case column(const std::string& numerics) {
  return Case(scene_of(
      "v8_column.json",
      {{"/stages", R"([{"name": "one", "duration": "6.5e6 s"}])"},
       {"/numerics", R"({"creep": "on", "traction_tolerance": 1e-12, )" + numerics + "}"}}));
}

TEST(CreepMarch, HalvesOnceAndKeepsTheHalvesWhereThatIsEnough) {
  const Case controlled = column(R"("creep_refinements": 3, "creep_tolerance": "1 GPa")");
  const Case whole = column(R"("creep_time_step": "6.5e6 s")");
  const Case halves = column(R"("creep_time_step": "3.25e6 s")");
  EXPECT_EQ(controlled.creep(1).time_steps, 2);
  EXPECT_TRUE(controlled.creep(1).time_resolved);
  EXPECT_LT(difference(controlled.fields[1], halves.fields[1]), 1e-6);
  const double change = difference(whole.fields[1], halves.fields[1]);
  EXPECT_NEAR(controlled.creep(1).time_error, change, 1e-6);
  EXPECT_GT(change, 1e4);
  EXPECT_EQ(whole.creep(1).time_steps, 1);
  EXPECT_EQ(whole.creep(1).time_error, 0) << "nothing was compared";
  EXPECT_TRUE(whole.creep(1).time_resolved);
}

TEST(CreepMarch, SaysThatTheShortestStepsAreTooLong) {
  const Case controlled = column(R"("creep_refinements": 3, "creep_tolerance": "1e-3 Pa")");
  const Case eighths = column(R"("creep_time_step": "812500 s")");
  const Case quarters = column(R"("creep_time_step": "1625000 s")");
  EXPECT_EQ(controlled.creep(1).time_steps, 8);
  EXPECT_FALSE(controlled.creep(1).time_resolved);
  EXPECT_LT(difference(controlled.fields[1], eighths.fields[1]), 1e-6);
  // the largest change when a quarter was halved, not the sum of four
  const double sum = difference(quarters.fields[1], eighths.fields[1]);
  EXPECT_GT(controlled.creep(1).time_error, sum / 4);
  EXPECT_LT(controlled.creep(1).time_error, 2 * sum);
  const Case unrefined = column(R"("creep_refinements": 0, "creep_tolerance": "1e-3 Pa")");
  EXPECT_EQ(unrefined.creep(1).time_steps, 1);
  EXPECT_EQ(unrefined.creep(1).time_error, 0);
  EXPECT_TRUE(unrefined.creep(1).time_resolved) << "nothing was measured";
}

/// Steps of τ next to steps of τ/2: the shorter rung is there, but is not for halving; with one
/// refinement it is, and so is its own half.
TEST(CreepMarch, HalvesNothingWithoutRefinements) {
  const auto of = [](const char* refinements) {
    return Case(scene_of("v8_column.json",
                         {{"/stages", R"([{"name": "long", "duration": "6.5e6 s"},
                         {"name": "short", "duration": "6.5e6 s", "steps": 2}])"},
                          {"/numerics", std::string(R"({"creep": "on", "creep_tolerance": "1e-3 Pa",
                                       "creep_refinements": )") +
                                            refinements + "}"}}));
  };
  const Case none = of("0");
  for (const std::size_t step : {1U, 2U, 3U}) {
    EXPECT_EQ(none.creep(step).time_steps, 1);
    EXPECT_EQ(none.creep(step).time_error, 0);
    EXPECT_TRUE(none.creep(step).time_resolved);
  }
  const Case one = of("1");
  EXPECT_EQ(one.creep(1).time_steps, 4);
  EXPECT_EQ(one.creep(2).time_steps, 2);
}

/// A load that turns within a load step: the step is cut there, its two lengths have rungs of their
/// own, and the salt ends as if the stages had been cut by hand.
TEST(CreepMarch, TakesTheStepsOfTurningPoints) {
  const auto column_with = [](const std::string& stages, const std::string& turning_points) {
    return scene_of(
        "v8_column.json",
        {{"/stages", stages},
         {"/geometry/boundary/1/table",
          R"({"time": ["0 s", "1.95e6 s", "6.5e6 s"], "factor": [0, 1, 0.2]})"},
         {"/numerics", R"({"creep": "on", "traction_tolerance": 1e-12, "creep_refinements": 1,
                           "creep_tolerance": "1e-3 Pa", "turning_points": ")" +
                           turning_points + "\"}"}});
  };
  const std::string one = R"([{"name": "one", "duration": "6.5e6 s"}])";
  const Case cut(column_with(one, "steps"));
  const Case by_hand(column_with(R"([{"name": "up", "duration": "1.95e6 s"},
                                     {"name": "down", "duration": "4.55e6 s"}])",
                                 "steps"));
  const Case across(column_with(one, "report"));
  ASSERT_EQ(cut.fields.size(), 3U);
  ASSERT_EQ(by_hand.fields.size(), 3U);
  EXPECT_EQ(cut.prepared.bulk->n_rungs(), 1 + 4);
  for (const std::size_t step : {1U, 2U}) {
    EXPECT_LT(difference(cut.fields[step], by_hand.fields[step]), 1e-3) << step;
    EXPECT_EQ(cut.creep(step).time_steps, 2);
  }
  ASSERT_EQ(across.fields.size(), 2U);
  EXPECT_GT(difference(across.fields[1], cut.fields[2]), 1e4) << "Pa: what it would have missed";
}

/// Creep is fast at first: the halves of the load step are divided each as far as it needs.
TEST(CreepMarch, TakesShortStepsWhereCreepIsFast) {
  const Case controlled(scene_of(
      "v8_column.json",
      {{"/stages", R"([{"name": "one", "duration": "65e6 s"}])"},
       {"/numerics", R"({"creep": "on", "creep_refinements": 6, "creep_tolerance": "20 kPa"})"}}));
  EXPECT_TRUE(controlled.creep(1).time_resolved);
  EXPECT_LE(controlled.creep(1).time_error, 2e4);
  EXPECT_GT(controlled.creep(1).time_steps, 8);
  EXPECT_LT(controlled.creep(1).time_steps, 40) << "of 64";
}

/// Early quarters too long for the tolerance are not made good by late ones, when creep is over.
TEST(CreepMarch, IsNotResolvedWhereItsFirstStepsAreNot) {
  const Case whole(scene_of(
      "v8_column.json",
      {{"/stages", R"([{"name": "one", "duration": "130e6 s"}])"},
       {"/numerics", R"({"creep": "on", "creep_refinements": 2, "creep_tolerance": "20 kPa"})"}}));
  EXPECT_EQ(whole.creep(1).time_steps, 4);
  EXPECT_GT(whole.creep(1).time_error, 2e4);
  EXPECT_FALSE(whole.creep(1).time_resolved);
}

/// The length of a step is the difference of its times, of which few digits are left here; and it
/// is very much shorter than the longest step allowed.
TEST(CreepMarch, FindsAShortStepAfterALongOne) {
  for (const char* numerics : {R"({"creep": "on", "creep_refinements": 2})",
                               R"({"creep": "on", "creep_time_step": "1e13 s"})"}) {
    const Case run(scene_of(
        "v8_maxwell.json", {{"/stages", R"([{"name": "long", "duration": "6.5e11 s"},
                                            {"name": "short", "duration": "6.7 s", "steps": 3}])"},
                            {"/geometry/boundary/0/table",
                             R"({"time": ["0 s", "6.5e11 s", "6.6e11 s"], "factor": [0, 0, 1e9]})"},
                            {"/numerics", numerics}}));
    ASSERT_EQ(run.result.outcome, Outcome::converged);
    // ε = 0.67e-3 comes within 1e-6 τ: elastic. σ_x = ε λ.
    EXPECT_NEAR(run.fields[4].traction(0, 0), -200e6 + 0.67e-3 * 23.076923e9, 2e3) << numerics;
  }
}

/// The traction by creep is σ_x(t) − σ_x(0) of the column.
TEST(CreepMarch, SeparatesWhatTheSaltDid) {
  const Case whole(scene_of("v8_column.json", {}));
  EXPECT_EQ(whole.creep(0).time_steps, 0);
  EXPECT_NEAR(whole.creep(0).faults[0].normal_min, 0, 1e-6);
  const FaultCreep& end = whole.creep(3).faults[0];
  EXPECT_NEAR(end.normal_min, -10e6 + 30e6 / 7, 1);
  EXPECT_EQ(end.normal_max, 0);
  EXPECT_NEAR(end.shear_max, 0, 1e-6);
  EXPECT_NEAR(whole.fields[3].creep_traction.row(0).minCoeff(), end.normal_min, 0);
}

TEST(CreepMarch, IsElasticWhereSaltIsStiff) {
  const Settings stiff = {{"/materials/salt/viscosity", "1e25 Pa s"}};
  const Case on(scene_of("v8_column.json", stiff));
  Settings off = stiff;
  off.push_back({"/numerics", R"({"creep": "off", "traction_tolerance": 1e-12})"});
  const Case elastic(scene_of("v8_column.json", off));
  EXPECT_FALSE(elastic.result.steps[3].creep);
  // k t of 50 τ of 1e17 Pa s: 10 MPa (1−2ν)/(1−ν) k t
  const double change = 10e6 * 4 / 7 * 40e9 / (6 * 1e25 * 0.7) * 325e6;
  EXPECT_NEAR(difference(on.fields[3], elastic.fields[3]), change, 1e-4 * change);
}

TEST(CreepMarch, GivesTheSameBitsWhateverRanBefore) {
  Case first = column(R"("creep_refinements": 4, "creep_tolerance": "1 kPa")");
  const Eigen::Matrix3Xd traction = first.fields[1].traction;
  const std::vector<double> observed = first.result.steps[1].observed;
  Scene other = first.scene;
  other.initial.tensor->at(0) *= 0.9;
  std::swap(other, first.scene);
  first.run();
  EXPECT_NE(traction, first.fields[1].traction);
  std::swap(other, first.scene);
  first.run();
  EXPECT_EQ(traction, first.fields[1].traction);
  EXPECT_EQ(observed, first.result.steps[1].observed);
  const Case again = column(R"("creep_refinements": 4, "creep_tolerance": "1 kPa")");
  EXPECT_EQ(traction, again.fields[1].traction);
}

/// The slider of V7 on blocks with τ = 10 years, driven by v = 0.4 m/year. Before it slips the
/// shear is k v τ (1 − e^{−t/τ}), so that 12 MPa of strength are reached at t* = −τ ln 0.7; μ falls
/// from 0.6 to 0.4 faster than k = 10 MPa/m unloads: one event, which slips by 4 MPa/k and ends at
/// 8 MPa. Then the slider creeps on at the rate v − 8 MPa/(k τ).
Scene slider(const Settings& settings) {
  Settings all = {
      {"/materials/block/viscosity", "6.31152e15 Pa s"},
      {"/friction/slip_weakening_distance", "0.2 m"},
      {"/geometry/boundary/1/table", R"({"time": ["0 year", "6 year"], "factor": [0, 2.4]})"}};
  all.insert(all.end(), settings.begin(), settings.end());
  return scene_of("v7_slider.json", all);
}
const double kOnset = -10 * std::log(0.7);  // year

void expect_event(const Case& run, double shortest) {
  ASSERT_TRUE(in_equilibrium(run.result.outcome)) << run.result.reason;
  ASSERT_EQ(run.result.events.size(), 1U);
  const SlipEvent& event = run.result.events[0];
  EXPECT_TRUE(event.evidence_holds);
  EXPECT_EQ(event.step, 4);
  EXPECT_NEAR(event.time / kYear, kOnset, shortest);
  EXPECT_LE(event.load_factor_before, event.load_factor_after);
  EXPECT_GE(event.load_factor_before, 0.5);
  EXPECT_LE(event.load_factor_after, 0.75);
  EXPECT_NEAR(event.max_slip, 0.4, 1e-3);
  // To the end of the load step of 4 years, and to that of 6: on the way the slider moves by
  // v − 8 MPa/(k τ) = 0.32 m/year. The event's place in its step is good to the step.
  const auto slip = [&](std::size_t step) { return run.fields[step].jump.col(0).norm(); };
  EXPECT_EQ(slip(3), 0);
  EXPECT_NEAR(slip(4), 0.4 + 0.32 * (4 - kOnset), 0.1 * shortest);
  EXPECT_NEAR(slip(6) - slip(4), 0.64, 1e-9);
  EXPECT_NEAR(run.fields[6].traction.col(0).tail<2>().norm(), 8e6, 1);
}

TEST(CreepMarch, FollowsAnEventWithinACreepingStep) {
  const Case fixed(slider({{"/numerics", R"({"creep": "on", "creep_time_step": "0.125 year"})"}}));
  expect_event(fixed, 0.125);
  EXPECT_EQ(fixed.creep(4).time_steps, 8);
  EXPECT_TRUE(fixed.creep(4).time_resolved) << "the jump came with the load";
  const Case finer(
      slider({{"/numerics", R"({"creep": "on", "creep_time_step": "0.015625 year"})"}}));
  expect_event(finer, 0.015625);
}

/// Steps that the event makes impossible are shortened whatever the tolerance; what they would
/// have given is not compared with.
TEST(CreepMarch, ShortensStepsThatAnEventMakesImpossible) {
  const Case controlled(slider({{"/numerics", R"({"creep": "on", "creep_refinements": 4})"}}));
  expect_event(controlled, 1.0 / 16);
  EXPECT_GT(controlled.creep(4).time_steps, 4);
  EXPECT_TRUE(controlled.creep(4).time_resolved);
  EXPECT_LE(controlled.creep(4).time_error, 2e4);
}

/// Friction falls by 9.95 MPa/m: more slowly than the slider unloads in a step of 1/16 year, faster
/// than in one of 1/8, 10 MPa/m (1 − e^{−x})/x with x = Δt/τ. So 1/8 year cannot be taken whole,
/// its halves can, without an event: with nothing to compare they are not known to be short enough.
TEST(CreepMarch, IsNotResolvedWhereOnlyTheShortestStepsHaveAnAnswer) {
  const auto refined = [](const char* refinements) {
    return Case(slider(
        {{"/friction/slip_weakening_distance", "0.402 m"},
         {"/numerics", concat(R"({"creep": "on", "creep_refinements": )", refinements, "}")}}));
  };
  const Case coarse = refined("4"), fine = refined("5");
  for (const Case* run : {&coarse, &fine}) {
    ASSERT_TRUE(in_equilibrium(run->result.outcome)) << run->result.reason;
    EXPECT_TRUE(run->result.events.empty());
    EXPECT_LE(run->creep(4).time_error, 1) << "Pa: of what could be compared";
  }
  EXPECT_EQ(coarse.creep(4).time_steps, 8);
  EXPECT_FALSE(coarse.creep(4).time_resolved);
  EXPECT_EQ(fine.creep(4).time_steps, 10);
  EXPECT_TRUE(fine.creep(4).time_resolved);
}

/// A column that is pulled loses lateral compression as it creeps: σ_x from −9.7 to −4 MPa under
/// 6 MPa of shear. It jumps under constant load, with whatever the shortest step has relaxed: the
/// ladder is too coarse for it, and the step says so.
TEST(CreepMarch, MarksAJumpThatCreepItselfMakes) {
  const Case pulled(scene_of(
      "v8_column.json",
      {{"/geometry/boundary/1/stress",
        R"([["0 MPa","0 MPa","0 MPa"],["0 MPa","0 MPa","0 MPa"],["0 MPa","0 MPa","10 MPa"]])"},
       {"/initial_state/tensor",
        R"([["-14 MPa","0 MPa","6 MPa"],["0 MPa","-14 MPa","0 MPa"],["6 MPa","0 MPa","-30 MPa"]])"},
       {"/friction",
        R"({"law": "coefficient", "cohesion": "0 MPa", "friction_coefficient": 0.9,
            "dynamic_friction_coefficient": 0.1, "slip_weakening_distance": "1 um"})"},
       {"/stages", R"([{"name": "one", "duration": "65e6 s"}])"},
       {"/numerics", R"({"creep": "on", "creep_refinements": 0})"}}));
  ASSERT_TRUE(in_equilibrium(pulled.result.outcome)) << pulled.result.reason;
  ASSERT_GE(pulled.result.events.size(), 1U);
  EXPECT_EQ(pulled.result.events[0].step, 1);
  EXPECT_TRUE(pulled.result.events[0].evidence_holds);
  EXPECT_FALSE(pulled.creep(1).time_resolved);
}

/// The same column with two patches, of which the second jumps in a load step of another length.
/// In the end both slide at a steady rate, whatever the steps were: so the bulk carries the
/// tractions that the faults say.
TEST(CreepMarch, FollowsJumpsOnRungsOfDifferentLengths) {
  const auto pulled = [](const std::string& first_stages) {
    const std::string friction =
        R"("friction": {"law": "coefficient", "cohesion": "0 MPa", "dynamic_friction_coefficient": 0.1,
           "slip_weakening_distance": "1 um", "friction_coefficient": )";
    const std::string size = R"("length": "2 m", "width": "2 m")";
    return Case(scene_of(
        "v8_column.json",
        {{"/geometry/boundary/1/stress",
          R"([["0 MPa","0 MPa","0 MPa"],["0 MPa","0 MPa","0 MPa"],["0 MPa","0 MPa","10 MPa"]])"},
         {"/initial_state/tensor",
          R"([["-14 MPa","0 MPa","6 MPa"],["0 MPa","-14 MPa","0 MPa"],["6 MPa","0 MPa","-30 MPa"]])"},
         {"/faults", R"([{"name": "F1", "center": ["-1 m", "0 m", "-2 m"], )" + size + ", " +
                         friction + R"(0.7}}, {"name": "F2", "center": ["1 m", "0 m", "-2 m"], )" +
                         size + ", " + friction + "1.2}}]"},
         {"/stages", "[" + first_stages + R"(,
           {"name": "on", "duration": "650e6 s", "steps": 25}])"},
         {"/numerics", R"({"creep": "on", "creep_time_step": "1000 year"})"}}));
  };
  const Case mixed = pulled(R"({"name": "a", "duration": "6.5e6 s"})");
  const Case even = pulled(R"({"name": "a", "duration": "26e6 s"})");
  ASSERT_TRUE(in_equilibrium(mixed.result.outcome)) << mixed.result.reason;
  ASSERT_EQ(mixed.result.events.size(), 2U);
  EXPECT_EQ(mixed.result.events[0].fault, "F1");
  EXPECT_EQ(mixed.result.events[0].step, 1);
  EXPECT_EQ(mixed.result.events[1].fault, "F2");
  EXPECT_EQ(mixed.result.events[1].step, 2);
  const auto rate = [](const Case& run) {
    return Eigen::Vector2d(run.fields[26].jump(2, 0) - run.fields[25].jump(2, 0),
                           run.fields[26].jump(2, 1) - run.fields[25].jump(2, 1));
  };
  EXPECT_GT(rate(even).cwiseAbs().minCoeff(), 1e-6);
  EXPECT_LT((rate(mixed) - rate(even)).norm(), 1e-9 * rate(even).norm());
}

/// A march that is asked for a step without an equilibrium next to the last one.
TEST(CreepMarch, LeavesEverythingAsItWasWhereAStepFails) {
  const Case failed(
      slider({{"/numerics",
               R"({"creep": "on", "creep_time_step": "0.125 year", "follow_events": false})"}}));
  EXPECT_EQ(failed.result.outcome, Outcome::unstable);
  ASSERT_TRUE(failed.result.failed_step);
  EXPECT_EQ(*failed.result.failed_step, 4);
  EXPECT_TRUE(failed.result.events.empty());
  ASSERT_EQ(failed.fields.size(), 4U) << "steps 0 to 3";
  EXPECT_EQ(failed.fields[3].jump.cwiseAbs().maxCoeff(), 0);

  const FaultOperator& op = *failed.prepared.op;
  const CaseLoads loads(failed.scene, op);
  const ContactLaws laws = contact_laws(failed.scene, op.geometry);
  const auto march = creep_steps(*failed.prepared.bulk)({failed.scene, laws, loads, {}});
  ContactState state = initial_state(op);
  const auto advance = [&](double to) {
    return march->advance({0, "", to}, loads.at(to), state).contact.outcome;
  };
  const auto displacement = [&] { return march->displacement(loads.at(3 * kYear), state); };
  ASSERT_TRUE(in_equilibrium(advance(0)));
  ASSERT_TRUE(in_equilibrium(advance(3 * kYear)));
  const ContactState before = state;
  const Eigen::Matrix3Xd moved = displacement();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(advance(4 * kYear), Outcome::unstable);
    EXPECT_EQ(state.traction, before.traction);
    EXPECT_EQ(state.jump, before.jump);
    EXPECT_EQ(displacement(), moved);
  }
  // From there the march goes on as if nothing had been tried.
  ASSERT_TRUE(in_equilibrium(advance(3.5 * kYear)));
  const double shear = 40e6 * (1 - std::exp(-0.35));
  EXPECT_NEAR(std::hypot(state.traction[1], state.traction[2]), shear, 1e-6 * shear);
}

}  // namespace
}  // namespace faultsim
