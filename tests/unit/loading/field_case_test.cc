// Whole cases of coarse fields: what must hold whatever the mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/scene/read_scene.h"

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
  return run_case(scene, *prepare_operator(scene, plan, cache, false, monitor).op, monitor);
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
  EXPECT_TRUE(warns(offset, "above_centre is taken at the nearest mesh node"));
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
    EXPECT_LT(event.pressure_change, 0);
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
  EXPECT_EQ(copied.op->h, built.op->h);
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
  document["mesh"]["dip"] = "0.01 m";
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
  EXPECT_NEAR(*half.whole.magnitude, *whole.whole.magnitude, 1e-9);
  // The points see the field from opposite sides: it contracts.
  EXPECT_LT(half.steps[10].observed[1], -1e-3);
  EXPECT_GT(half.steps[10].observed[4], 1e-3);
}

}  // namespace
}  // namespace faultsim
