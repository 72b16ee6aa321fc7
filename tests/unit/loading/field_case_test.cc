// Whole cases of coarse fields: what must hold whatever the mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// A field of 8 km, offset and dipping, weak enough to slip: plane strain, 1 s at most.
json field() {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", "400 m"}, {"dip", "50 m"}, {"normal", "100 m"}, {"growth", 1.6}};
  scene["numerics"] = {{"plane_strain", "on"}};
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["friction"]["friction_angle"] = "18 deg";
  return scene;
}

CaseResult run(const json& document, const CachePolicy& cache = {}) {
  const Scene scene = read_scene(parse_json(document.dump(), "test"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  SilentMonitor monitor;
  return run_case(scene, prepare_operator(scene, plan, cache, false, monitor), monitor);
}

bool warns(const CaseResult& result, const std::string& of) {
  return std::any_of(result.warnings.begin(), result.warnings.end(),
                     [&](const std::string& text) { return text.find(of) != std::string::npos; });
}

/// Every metric of two faults agrees to a relative tolerance.
void expect_alike(const FaultMetrics& a, const FaultMetrics& b, double tolerance) {
  const auto near = [&](double x, double y, const char* what) {
    EXPECT_NEAR(x, y, tolerance * std::max({std::abs(x), std::abs(y), 1e-6})) << what;
  };
  near(a.chi_bar, b.chi_bar, "chi_bar");
  near(a.chi_max, b.chi_max, "chi_max");
  near(a.area_chi_080, b.area_chi_080, "area_chi_080");
  near(a.thickness_chi_080_max, b.thickness_chi_080_max, "thickness_chi_080_max");
  near(a.thickness_chi_080_mean, b.thickness_chi_080_mean, "thickness_chi_080_mean");
  near(a.slipping_area, b.slipping_area, "slipping_area");
  near(a.activated_area, b.activated_area, "activated_area");
  near(a.activated_length, b.activated_length, "activated_length");
  near(a.max_slip, b.max_slip, "max_slip");
  near(a.mean_slip, b.mean_slip, "mean_slip");
  near(a.potency, b.potency, "potency");
  near(a.moment, b.moment, "moment");
  near(a.moment_step, b.moment_step, "moment_step");
  EXPECT_EQ(a.activated, b.activated);
}

/// Half-yearly cycles from a table, in steps of so many per year.
json half_yearly(int steps_per_year) {
  json scene = field();
  scene["stages"] = {{{"name", "production"}, {"duration", "4 year"}, {"steps", 4}},
                     {{"name", "storage"}, {"duration", "3 year"}, {"steps", 3 * steps_per_year}}};
  scene["pressure_csv"] = "history.csv";
  json lines = {"time [year], west [bar], east [bar]", "0, 0, 0", "4, -60, -60"};
  for (int half = 1; half <= 6; ++half) {
    const std::string change = half % 2 == 1 ? "-200" : "-60";
    lines.push_back(std::to_string(4 + 0.5 * half) + ", " + change + ", " + change);
  }
  scene["tables"]["history.csv"] = lines;
  return scene;
}

double chi_bar(const CaseResult& result, std::size_t stage) {
  return result.stages.at(stage).chi_bar;
}

TEST(FieldCase, SeesTheTurningPointsOfATableBetweenItsSteps) {
  const CaseResult yearly = run(half_yearly(1));
  const CaseResult fine = run(half_yearly(2));
  ASSERT_EQ(yearly.steps.size(), fine.steps.size());
  for (std::size_t k = 0; k < fine.steps.size(); ++k) {
    for (std::size_t f = 0; f < fine.fault_names.size(); ++f) {
      EXPECT_EQ(yearly.steps[k].faults[f], fine.steps[k].faults[f]) << "the very same numbers";
    }
  }
  json blind = half_yearly(1);
  blind["numerics"]["turning_points"] = "report";
  const CaseResult skipped = run(blind);
  EXPECT_EQ(skipped.steps.size(), yearly.steps.size() - 3);
  EXPECT_GT(std::abs(chi_bar(skipped, 1) - chi_bar(yearly, 1)), 0.01) << "what that misses";
  EXPECT_TRUE(
      warns(skipped, "load step 5 skips a turning point: the pressure of west reaches -200"));
  EXPECT_FALSE(warns(yearly, "turning point"));
}

TEST(FieldCase, KeepsTheCyclesOfALaggingBlock) {
  json scene = field();
  for (json& stage : scene["stages"]) {
    if (stage.contains("cycles")) stage["steps"] = 2 * int(stage["cycles"]);
  }
  const CaseResult together = run(scene);
  scene["compartments"]["east"]["lag"] = "0.25 year";
  const CaseResult lagging = run(scene);
  EXPECT_GT(lagging.steps.size(), together.steps.size());
  std::vector<double> least(2, 0), most(2, -1e9);  // of the changes seen in storage, Pa
  for (const StepResult& step : lagging.steps) {
    if (step.time < 13 * 31557600.0) continue;
    for (std::size_t r = 0; r < 2; ++r) {
      least[r] = std::min(least[r], step.pressure_change[r]);
      most[r] = std::max(most[r], step.pressure_change[r]);
    }
  }
  EXPECT_NEAR(least[1], least[0], 1) << "each cycle reaches both its ends";
  EXPECT_NEAR(most[1], most[0], 1);
}

/// A block's own overpressure changes no total stress: strong faults start at rest, every traction
/// is that of the column but for the fluid of the faults beside the block.
TEST(FieldCase, ABlocksOwnOverpressureActsInItsFaultsAlone) {
  json scene = field();
  scene["friction"]["cohesion"] = "100 MPa";
  scene["stages"] = {{{"name", "rest"}, {"duration", "1 year"}, {"pressure_change", "0 bar"}}};
  const auto start = [](const json& document) {
    const Scene read = read_scene(parse_json(document.dump(), "test"));
    std::vector<Problem> problems;
    const Plan plan = make_plan(read, problems);
    SilentMonitor monitor;
    const auto op = prepare_operator(read, plan, {}, false, monitor).op;
    std::vector<FaultFields> fields;
    const CaseResult result =
        run_case(read, *op, elastic_steps(*op, nullptr), monitor,
                 {{[&](const StepResult&, const FaultFields& f) { fields.push_back(f); }}});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.whole.max_slip, 0);
    return std::make_pair(fields.at(0).traction, op->geometry);
  };
  const auto [column, geometry] = start(scene);
  scene["geometry"]["blocks"][1]["overpressure"] = "85 bar";  // 25 bar in the column, at 0 offset
  const auto [own, same] = start(scene);
  EXPECT_EQ((own - column).bottomRows(2).cwiseAbs().maxCoeff(), 0) << "no shear";
  const Eigen::VectorXd change = (own - column).row(0);
  EXPECT_GE(change.minCoeff(), 0) << "less compression";
  const auto of = [&](std::size_t fault) {
    const OperatorFault& f = geometry.faults[fault];
    return change.segment(f.first_node, f.n_nodes).maxCoeff();
  };
  EXPECT_EQ(of(0), 0) << "beside west only";
  EXPECT_NEAR(of(1), 0.5 * 85e5, 1) << "the mean of west, as the column, and 85 bar below it";
  EXPECT_NEAR(of(2), 0.5 * 85e5, 1);
}

TEST(FieldCase, SeenInAMirrorHasTheFaultsInMirroredOrder) {
  json east = field();
  east["output"]["observation_points"][0]["position"] = {"500 m", "0 m", "0 m"};
  json west = east;
  west["geometry"]["blocks"] = {
      {{"name", "east"}, {"from", "-2000 m"}, {"to", "0 m"}, {"offset", "100 m"}},
      {{"name", "west"}, {"from", "0 m"}, {"to", "2000 m"}}};
  west["faults"] = {
      {{"name", "F3"}}, {{"name", "F2"}, {"dip_from_vertical", "-10 deg"}}, {{"name", "F1"}}};
  west["output"]["observation_points"][0]["position"] = {"-500 m", "0 m", "0 m"};
  const CaseResult a = run(east), b = run(west);
  ASSERT_EQ(a.outcome, Outcome::converged) << a.reason;
  ASSERT_TRUE(a.whole.activated);
  EXPECT_EQ(a.whole.activated_fault, b.whole.activated_fault);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    for (std::size_t f = 0; f < 3; ++f) {
      expect_alike(a.steps[i].faults[f], b.steps[i].faults[2 - f], 1e-8);
    }
    EXPECT_NEAR(a.steps[i].observed[0], -b.steps[i].observed[0], 1e-9);
    EXPECT_NEAR(a.steps[i].observed[2], b.steps[i].observed[2], 1e-9);
  }
}

TEST(FieldCase, SubsidesAboveDepletionAndNoStepExceedsStrength) {
  const CaseResult result = run(field());
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  EXPECT_LT(result.steps[10].observed[2], -0.05);
  EXPECT_GT(result.steps[12].observed[2], result.steps[10].observed[2]);  // cushion gas lifts again
  for (const StepResult& step : result.steps) {
    for (const FaultMetrics& fault : step.faults) EXPECT_LE(fault.chi_max, 1 + 1e-6) << step.step;
  }
  double sum = 0;  // the moment since start never exceeds what the stages add up to
  for (const StageMetrics& stage : result.stages) sum += stage.moment;
  EXPECT_LE(result.whole.moment, sum * (1 + 1e-9));
}

/// The kind of Ferronato et al. (SIAM GS 2019): level blocks and an offset of 200 m, a small
/// friction angle, production to −200 bar, then cushion gas and storage. @param recovered  pressure
/// change after production.
json storage_field(const char* recovered, const char* lower) {
  json scene = field();
  scene["mesh"] = {{"strike", "400 m"}, {"dip", "20 m"}, {"normal", "40 m"}, {"growth", 1.6}};
  scene["friction"]["friction_angle"] = "20 deg";
  scene["geometry"]["blocks"][1]["offset"] = "200 m";
  scene["faults"] = {{{"name", "F1"}}, {{"name", "F2"}}, {{"name", "F3"}}};
  scene["stages"] = {{{"name", "primary_production"},
                      {"duration", "10 year"},
                      {"steps", 10},
                      {"pressure_change", "-200 bar"}},
                     {{"name", "cushion_gas_injection"},
                      {"duration", "2 year"},
                      {"steps", 2},
                      {"pressure_change", recovered}},
                     {{"name", "gas_storage"},
                      {"duration", "2 year"},
                      {"steps", 4},
                      {"cycles", 2},
                      {"pressure_between", {lower, recovered}}}};
  return scene;
}

TEST(FieldCase, AFaultThatSlidInProductionSlidesBackUnexpectedlyAsPressureRecovers) {
  const CaseResult result = run(storage_field("-60 bar", "-120 bar"));
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  ASSERT_TRUE(result.unexpected);
  const Episode& again = result.episodes.at(result.unexpected->episode - 1);
  const Episode& before = result.episodes.at(result.unexpected->after - 1);
  EXPECT_EQ(again.fault, "F2");
  EXPECT_EQ(before.fault, "F2");
  EXPECT_EQ(again.stage, "cushion_gas_injection");
  EXPECT_EQ(before.stage, "primary_production");
  EXPECT_TRUE(again.after_recovery);
  EXPECT_GT(*again.pressures.change_minus, -200e5);
  EXPECT_EQ(again.pressures.region_minus, "west");
  EXPECT_EQ(again.pressures.region_plus, "east");
}

/// Their preliminary indication: a limited recovery of pressure avoids it. The second stage of
/// production adds a second episode, which no reactivation is.
TEST(FieldCase, ALimitedRecoveryIsNotUnexpected) {
  const CaseResult result = run(storage_field("-150 bar", "-170 bar"));
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  ASSERT_TRUE(result.stages.at(0).activated);
  EXPECT_FALSE(result.unexpected);
  json deeper = storage_field("-205 bar", "-212 bar");
  const CaseResult down = run(deeper);
  ASSERT_GT(down.episodes.size(), 3u) << "faults slide on in the later stages";
  EXPECT_FALSE(down.unexpected);
}

TEST(FieldCase, PressuresAreThoseBesideTheFaultNotOfTheMostDepletedRegion) {
  json scene = storage_field("-60 bar", "-120 bar");
  scene["friction"]["friction_angle"] = "16 deg";
  scene["compartments"] = {{"east", {{"scale", 0.8}}}};
  const CaseResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  const std::vector<FaultStageMetrics>& faults = result.stages.at(0).faults;
  ASSERT_TRUE(faults.at(1).activated && faults.at(2).activated) << "F2 and F3 slide";
  for (const std::size_t f : {1u, 2u}) {
    const FaultOnset& onset = *faults[f].activation;
    const double west = result.steps.at(onset.step).pressure_change.at(0);
    const SidePressures& p = onset.pressures;
    EXPECT_EQ(f == 1 ? p.region_plus : p.region_minus, "east");
    EXPECT_NEAR(f == 1 ? *p.change_plus : *p.change_minus, 0.8 * west, 1);
    // Hydrostatic: the overpressure is in the depth range of the layer, which the east block left.
    const double initial = 1000 * 9.81 * onset.depth;
    EXPECT_NEAR(f == 1 ? *p.absolute_plus : *p.absolute_minus, initial + 0.8 * west, 1);
    EXPECT_GT(onset.depth, 1950);
    EXPECT_LT(onset.depth, 2450);
  }
  const FaultOnset& central = *faults[1].activation;
  EXPECT_EQ(central.pressures.region_minus, "west");
  EXPECT_NEAR(*central.pressures.absolute_minus - *central.pressures.change_minus,
              1000 * 9.81 * central.depth + 25e5, 1);
  EXPECT_EQ(faults[2].activation->pressures.region_plus, "") << "nothing east of F3";
}

TEST(FieldCase, AFaultThatOpensIsAnOutcomeOfItsOwn) {
  json scene = field();
  scene["friction"]["friction_angle"] = "60 deg";
  scene["fault_pressure"] = {{"rule", "prescribed"}, {"prescribed", "400 bar"}};
  scene["stages"] = {
      {{"name", "injection"}, {"duration", "4 year"}, {"steps", 4}, {"pressure_change", "0 bar"}}};
  const CaseResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  EXPECT_TRUE(result.whole.opens);
  ASSERT_TRUE(result.whole.opening_step);
  EXPECT_GT(*result.whole.opening_step, 0);
  EXPECT_GT(result.whole.open_area, 0);
  ASSERT_NE(first_opening(result.whole), nullptr);
  const double share = *result.whole.opening_step / 4.0;  // of 400 bar, by node and window
  EXPECT_EQ(first_opening(result.whole)->pressures.change_plus.value_or(0), 0);
  EXPECT_NEAR(first_opening(result.whole)->pressures.change_in_fault, 400e5 * share, 1);
  EXPECT_TRUE(std::isnan(result.pressure_margin)) << "no margin of depletion helps";
  EXPECT_TRUE(warns(result, "above the least total principal stress"));
}

TEST(FieldCase, WithoutDepletionStaysAtItsStart) {
  json scene = field();
  scene["friction"]["friction_angle"] = "30 deg";
  scene["compartments"] = {{"west", {{"scale", 0}}}, {"east", {{"scale", 0}}}};
  const CaseResult result = run(scene);
  for (const StepResult& step : result.steps) {
    EXPECT_EQ(step.n_slip + step.n_open, 0);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(step.faults[f].chi_bar, result.steps[0].faults[f].chi_bar);
    }
  }
}

TEST(FieldCase, SaysWhatWeightIsLeftOutAndWhereAPointWasObserved) {
  json scene = field();
  scene["output"]["observation_points"][0]["position"] = {"2777 m", "0 m", "0 m"};
  const CaseResult offset = run(scene);
  EXPECT_TRUE(warns(offset, "up to 1.962 bar is left out"));  // 100 m x 200 kg/m3 x 9.81 m/s2
  EXPECT_TRUE(warns(offset, "above_centre is taken at the mesh node"));
  scene["geometry"]["blocks"][1]["offset"] = "0 m";
  scene["output"].erase("observation_points");
  scene["numerics"]["activation_length"] = "900 m";
  const CaseResult level = run(scene);
  EXPECT_FALSE(warns(level, "left out"));
  EXPECT_FALSE(warns(level, "nearest mesh node"));
  EXPECT_TRUE(
      warns(level, "fault F1 extends 500 m down dip, less than the activation_length of 900 m"));
  EXPECT_FALSE(level.whole.activated);
}

TEST(FieldCase, EventsInCoarseCellsAreNotCalledResolved) {
  json scene = field();
  scene["friction"] = {{"friction_angle", "30 deg"},
                       {"dynamic_friction_angle", "10 deg"},
                       {"slip_weakening_distance", "2 mm"}};
  scene["fault_pressure"] = {{"rule", "max"}};
  const CaseResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::unresolved_event);
  EXPECT_FALSE(result.weakening_resolved);
  EXPECT_GT(result.max_nucleation_ratio, 10);  // 50 m cells, h_n about 2 m
  EXPECT_TRUE(warns(result, "not resolved"));
  ASSERT_FALSE(result.events.empty());
  int n_events = 0;
  for (const StageMetrics& stage : result.stages) n_events += stage.n_events;
  EXPECT_EQ(n_events, result.whole.n_events);
  EXPECT_EQ(n_events, static_cast<int>(result.events.size()));
  double time = 0;
  for (const SlipEvent& event : result.events) {
    EXPECT_FALSE(event.resolved);
    EXPECT_TRUE(event.evidence_holds);
    EXPECT_GE(event.time, time);
    time = event.time;
    EXPECT_LT(leading_change(event.pressures).value_or(1), 0);
    EXPECT_GT(event.moment, 0);
    EXPECT_LE(event.moment, result.whole.event_moment);
    EXPECT_GT(event.energy_released, event.energy_dissipated);
    EXPECT_FALSE(event.fault.empty());
    EXPECT_GT(event.depth, 1500);
    EXPECT_LT(event.depth, 2600);
    EXPECT_EQ(result.steps[static_cast<std::size_t>(event.step)].outcome, Outcome::event);
  }
  scene["numerics"]["follow_events"] = false;
  const CaseResult stopped = run(scene);
  EXPECT_EQ(stopped.outcome, Outcome::unstable);
  EXPECT_TRUE(stopped.events.empty());
  EXPECT_EQ(*stopped.failed_step, result.events[0].step);
}

TEST(FieldCase, TakesFaultNamesFromTheSceneNotFromTheOperator) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "faultsim_names";
  std::filesystem::remove_all(folder);
  json scene = field();
  const CaseResult first = run(scene, {folder});
  scene["faults"][0]["name"] = "north_sea_fault";
  scene["faults"][1]["name"] = "mid";
  const CaseResult again = run(scene, {folder});
  EXPECT_EQ(first.operator_fingerprint, again.operator_fingerprint);
  EXPECT_EQ(again.fault_names, (std::vector<std::string>{"north_sea_fault", "mid", "F3"}));
  EXPECT_EQ(first.whole.moment, again.whole.moment);
  const Scene renamed = read_scene(parse_json(scene.dump(), "test"));
  std::vector<Problem> problems;
  SilentMonitor monitor;
  const PreparedOperator prepared =
      prepare_operator(renamed, make_plan(renamed, problems), {folder}, false, monitor);
  EXPECT_TRUE(prepared.from_cache);
  EXPECT_EQ(prepared.op->geometry.faults[0].name, "north_sea_fault");  // fields and messages
}

TEST(FieldCase, MapsTheHostsOwnCopyOfACachedOperator) {
  const std::filesystem::path base = std::filesystem::path(testing::TempDir()) / "faultsim_copies";
  std::filesystem::remove_all(base);
  const std::filesystem::path shared = base / "shared", near = base / "near";
  const Scene scene = read_scene(parse_json(field().dump(), "test"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  SilentMonitor monitor;
  const auto prepare = [&](const CachePolicy& cache) {
    return prepare_operator(scene, plan, cache, false, monitor);
  };
  const CachePolicy policy = {shared, CachePolicy{}.max_bytes, near};
  const PreparedOperator built = prepare(policy);
  EXPECT_FALSE(built.from_cache);
  const std::string file = built.op->fingerprint + ".h5";
  EXPECT_TRUE(std::filesystem::exists(shared / file)) << "for all hosts";
  const PreparedOperator copied = prepare(policy);
  EXPECT_TRUE(copied.from_cache);
  EXPECT_EQ(copied.op->h(), built.op->h());
  ASSERT_TRUE(std::filesystem::exists(near / file));
  std::filesystem::remove_all(shared);
  EXPECT_TRUE(prepare(policy).from_cache) << "the copy is enough";
  std::filesystem::remove_all(near);
  EXPECT_FALSE(prepare(policy).from_cache);
  const PreparedOperator uncopied = prepare({shared, CachePolicy{}.max_bytes, "/dev/null/near"});
  EXPECT_TRUE(uncopied.from_cache);
  EXPECT_NE(uncopied.remark.find("not copied"), std::string::npos) << uncopied.remark;
  std::filesystem::remove_all(base);
}

TEST(FieldCase, RunsWithoutACacheThatCannotBeWritten) {
  const Scene scene = read_scene(parse_json(field().dump(), "test"));
  std::vector<Problem> problems;
  SilentMonitor monitor;
  const PreparedOperator prepared =
      prepare_operator(scene, make_plan(scene, problems), {"/dev/null/cache"}, false, monitor);
  ASSERT_TRUE(prepared.op);
  EXPECT_NE(prepared.remark.find("not kept"), std::string::npos) << prepared.remark;
}

TEST(FieldCase, RefusesWhatNoMachineHolds) {
  json document = field();
  document["mesh"]["dip"] = "0.015 m";
  const Scene scene = read_scene(parse_json(document.dump(), "test"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  EXPECT_GT(plan.memory_bytes, 1e12);
  SilentMonitor monitor;
  EXPECT_THROW(prepare_operator(scene, plan, {}, false, monitor), ResourceError);
}

/// Where nothing varies along strike, plane strain is the 3D field per metre.
TEST(PlaneStrain, EqualsAFieldWithoutEnds) {
  json scene = field();
  scene["mesh"] = {{"strike", "700 m"}, {"dip", "100 m"}, {"normal", "250 m"}, {"growth", 2.0}};
  for (const char* key : {"length", "block_length", "fault_length"})
    scene["geometry"][key] = "2 km";
  const CaseResult plane = run(scene);
  scene["numerics"] = json::object();
  const CaseResult solid = run(scene);
  ASSERT_EQ(solid.outcome, Outcome::converged) << solid.reason;
  ASSERT_TRUE(plane.whole.activated);
  for (std::size_t i = 0; i < plane.steps.size(); ++i) {
    for (std::size_t f = 0; f < 3; ++f) {
      FaultMetrics per_metre = solid.steps[i].faults[f];
      for (double* integral : {&per_metre.area_chi_080, &per_metre.slipping_area,
                               &per_metre.open_area, &per_metre.activated_area, &per_metre.potency,
                               &per_metre.moment, &per_metre.moment_step}) {
        *integral /= 2000;
      }
      expect_alike(plane.steps[i].faults[f], per_metre, 1e-6);
    }
    EXPECT_NEAR(plane.steps[i].observed[2], solid.steps[i].observed[2], 1e-8);
  }
}

/// The half domain is exact: all metrics, doubled areas, potency and M0, and points on either side.
TEST(HalfDomain, EqualsTheWholeOne) {
  json scene = field();
  scene["mesh"] = {{"strike", "500 m"}, {"dip", "100 m"}, {"normal", "250 m"}, {"growth", 2.0}};
  scene["geometry"]["depth"] = "4 km";
  scene["numerics"] = {{"half_domain", "on"}};
  scene["output"]["observation_points"] = {
      {{"name", "north"}, {"position", {"0 m", "1000 m", "0 m"}}},
      {{"name", "south"}, {"position", {"0 m", "-1000 m", "0 m"}}}};
  const CaseResult half = run(scene);
  scene["numerics"]["half_domain"] = "off";
  const CaseResult whole = run(scene);
  ASSERT_EQ(half.outcome, Outcome::converged) << half.reason;
  ASSERT_GT(half.whole.moment, 0);
  ASSERT_EQ(half.steps.size(), whole.steps.size());
  for (std::size_t i = 0; i < half.steps.size(); ++i) {
    for (std::size_t f = 0; f < 3; ++f) {
      expect_alike(half.steps[i].faults[f], whole.steps[i].faults[f], 1e-9);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(half.steps[i].observed[k], whole.steps[i].observed[k], 1e-10) << k;
    }
  }
  EXPECT_NEAR(half.whole.moment, whole.whole.moment, 1e-9 * whole.whole.moment);
  EXPECT_NEAR(*half.whole.magnitude_if_at_once, *whole.whole.magnitude_if_at_once, 1e-9);
  // The points see the field from opposite sides: it contracts.
  EXPECT_LT(half.steps[10].observed[1], -1e-3);
  EXPECT_GT(half.steps[10].observed[4], 1e-3);
}

}  // namespace
}  // namespace faultsim
