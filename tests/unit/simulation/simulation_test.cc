#include "simulator/simulation/simulation.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "simulator/common/thread_team.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/result_bytes.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

Simulation field() {
  Simulation simulation = Simulation::from_text(starter_scene("field"), "field.json");
  JsonDocument document = Inside::scene(simulation).document;
  apply({{"/tier", "screening"}, {"friction_angle", "22 deg"}}, document);
  Inside::hold(simulation, std::move(document));
  return simulation;
}

/// All of a result but how long it took.
std::string bits(CaseResult result) {
  result.seconds = 0;
  for (StepResult& step : result.steps) step.seconds = 0;
  return result_to_bytes(result);
}

class Notes final : public Monitor {
 public:
  void progress(double, const std::string&) override { ++n_told; }
  void note(const std::string&) override {}
  int n_told = 0;
};

TEST(Simulation, GeometryIsThatOfTheFieldsAndOutlivesIt) {
  std::shared_ptr<const FaultGeometry> geometry;
  std::vector<FaultPoint> points;
  Eigen::Index n_values = 0;
  {
    Simulation simulation = Simulation::from_text(starter_scene("field"));
    RunWatch watch;
    watch.step = [&](const StepResult&, const FaultFields& fields) {
      n_values = fields.critical_index.size();
    };
    simulation.run({{"/tier", "screening"}}, {}, watch);
    geometry = simulation.geometry();
    points = simulation.points();
  }
  ASSERT_EQ(static_cast<Eigen::Index>(geometry->nodes.size()), n_values);
  ASSERT_EQ(points.size(), geometry->nodes.size());
  std::size_t k = 0;
  for (const OperatorFault& fault : geometry->faults) {
    EXPECT_FALSE(fault.profiles.empty());
    for (int i = 0; i < fault.n_nodes; ++i, ++k) {
      EXPECT_EQ(points[k].fault, fault.name);
      EXPECT_EQ(points[k].position, geometry->nodes[k].position);
      EXPECT_EQ(points[k].area, geometry->nodes[k].area);
    }
  }
}

TEST(Simulation, RunsAsTheFunctionsBelowItDo) {
  Simulation simulation = field();
  const LoadedScene& scene = Inside::scene(simulation);
  const PreparedOperator prepared = prepare_operator(scene.scene, scene.plan, {}, false);
  const CaseResult expected = run_case(scene.scene, prepared, {});
  EXPECT_TRUE(simulation.needs_operator());
  EXPECT_EQ(bits(simulation.run()), bits(expected));
  EXPECT_EQ(simulation.identity(), expected.identity);
  EXPECT_THAT(simulation.plan_text(), HasSubstr("plane strain"));
}

TEST(Simulation, ChangesAreToTheHeldSceneAndUseItsOperator) {
  Simulation simulation = field();
  const std::string before = bits(simulation.run());
  const PreparedOperator* op = &Inside::prepared(simulation);
  const CaseResult weak = simulation.run({{"friction_angle", "18 deg"}});
  const CaseResult both =
      simulation.run({{"/friction/friction_angle", "18 deg"}, {"ratio_across", "0.7"}});
  EXPECT_EQ(Inside::prepared(simulation).op, op->op);
  EXPECT_NE(bits(weak), before);
  EXPECT_NE(both.identity, weak.identity);
  EXPECT_EQ(bits(simulation.run(Changes{})), before) << "nothing of earlier changes stays";

  Simulation fresh = field();
  EXPECT_EQ(bits(fresh.run({{"friction_angle", "18 deg"}})), bits(weak));
}

TEST(Simulation, SaysWhereTheFieldsOfAStepLie) {
  Simulation simulation = field();
  simulation.prepare();
  const std::vector<FaultPoint> points = simulation.points();
  std::map<std::string, double> lowest;  // z, m, by fault
  RunWatch watch;
  watch.step = [&](const StepResult&, const FaultFields& fields) {
    ASSERT_EQ(fields.jump.cols(), static_cast<Eigen::Index>(points.size()));
  };
  simulation.run(RunContext(), watch);
  for (const FaultPoint& point : points) {
    EXPECT_NEAR(point.normal.cross(point.strike).dot(point.dip), 1, 1e-12) << "right-handed";
    EXPECT_LT(point.dip.z(), 0) << "dip points down";
    EXPECT_GT(point.area, 0);
    lowest[point.fault] = std::min(lowest[point.fault], point.position.z());
  }
  EXPECT_EQ(lowest.size(), Inside::scene(simulation).scene.faults.size());
  // Down a plane-strain fault shares of the dip line add up to the length between its ends.
  for (const auto& [fault, z] : lowest) {
    double length = 0, highest = z;
    for (const FaultPoint& point : points) {
      if (point.fault != fault) continue;
      length += point.area;
      highest = std::max(highest, point.position.z());
    }
    EXPECT_GT(length, (highest - z) * (1 - 1e-12));
    EXPECT_LT(length, 1.2 * (highest - z));
  }
}

/// The same short name means another place where the scene has its blocks in another order.
TEST(Simulation, ShortNamesAreThoseOfTheSceneThatIsHeld) {
  JsonDocument one =
      Inside::scene(Simulation::from_text(starter_scene("field"), "field.json")).document;
  apply({{"/tier", "screening"}}, one);
  JsonDocument other = one;
  nlohmann::json& blocks = other.value["geometry"]["blocks"];
  const std::string first = blocks[0]["name"], second = blocks[1]["name"];
  blocks[0]["name"] = second, blocks[1]["name"] = first;
  const Changes changes = {{"offset_" + second, "70 m"}};
  Simulation simulation;
  Inside::hold_base(simulation, one);
  simulation.change(changes);
  EXPECT_EQ(Inside::scene(simulation).scene.field.blocks[1].offset, 70);
  Inside::hold_base(simulation, other);
  simulation.change(changes);
  EXPECT_EQ(Inside::scene(simulation).scene.field.blocks[0].offset, 70);
  EXPECT_NE(Inside::scene(simulation).scene.field.blocks[1].offset, 70);
}

/// What a flow result does is worked out anew where the mesh or the faults' rules are others.
TEST(Simulation, AFlowResultActsOnTheSceneThatIsHeld) {
  std::string name = testing::TempDir() + "simulation_XXXXXX";
  const std::filesystem::path folder = mkdtemp(name.data());
  std::ofstream(folder / "p.csv")
      << "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 1994-01-01 [bar]\n"
         "-5000, 0, 3000, 10000, 9000, 6000, 350, 210\n5000, 0, 3000, 10000, 9000, 6000, 350, "
         "290\n";
  const auto document = [&](const Changes& changes) {
    nlohmann::json scene = nlohmann::json::parse(starter_scene("field"));
    scene["tier"] = "custom";
    scene["mesh"] = {{"strike", "400 m"}, {"dip", "100 m"}, {"normal", "300 m"}, {"growth", 2.0}};
    scene["numerics"] = {{"plane_strain", "on"}};
    scene["geometry"]["width"] = "10 km", scene["geometry"]["length"] = "8 km";
    scene["stages"] = {{{"name", "production"}, {"until", "1994-01-01"}, {"steps", 1}}};
    scene.erase("compartments");
    scene["pressure_field"] = {{"file", "p.csv"}};
    JsonDocument made = parse_json(scene.dump(), (folder / "scene.json").string());
    apply(changes, made);
    return made;
  };
  Simulation simulation;
  Inside::hold(simulation, document({}));
  const CaseResult first = simulation.run();
  ASSERT_TRUE(first.field_coverage);
  EXPECT_NEAR(*first.field_coverage, 1, 1e-12);
  const std::string before = bits(first);
  for (const Changes& changes : {Changes{{"offset_east", "60 m"}},
                                 {{"/fault_pressure/rule", "max"}},
                                 {{"/materials/reservoir/biot", "0.6"}},
                                 {{"friction_angle", "20 deg"}}}) {
    Simulation fresh;
    Inside::hold(fresh, document(changes));
    EXPECT_EQ(bits(simulation.run(changes)), bits(fresh.run())) << changes[0].parameter;
  }
  EXPECT_EQ(bits(simulation.run(Changes{})), before);
  std::filesystem::remove_all(folder);
}

/// In three dimensions, where much slides.
TEST(Simulation, GivesTheSameBitsWhoeverSharesTheWorkOfACase) {
  Simulation simulation = field();
  const Changes changes = {
      {"/tier", "custom"},
      {"/mesh", R"({"strike": "250 m", "dip": "40 m", "normal": "150 m", "growth": 2})"},
      {"friction_angle", "12 deg"},
      {"ratio_across", "0.6"}};
  SilentMonitor silent;
  RunContext context(silent);
  const CaseResult alone = simulation.run(changes, context);
  EXPECT_FALSE(alone.plane_strain);
  EXPECT_GT(std::ranges::max(alone.steps, {}, &StepResult::n_slip).n_slip, 100);
  ThreadTeam team(2);
  context.team = &team;
  EXPECT_EQ(bits(simulation.run(changes, context)), bits(alone));
  EXPECT_GT(team.n_works(), 20) << "there was nothing to share";
}

TEST(Simulation, SaysWhenAChangeNeedsAnotherOperator) {
  Simulation simulation = field();
  EXPECT_TRUE(simulation.prepare());
  EXPECT_FALSE(simulation.prepare());
  simulation.change({{"friction_angle", "18 deg"}, {"primary_production_pressure", "-150 bar"}});
  EXPECT_FALSE(simulation.needs_operator());
  simulation.change({{"offset_east", "50 m"}});
  EXPECT_TRUE(simulation.needs_operator());
  EXPECT_THROW(Inside::prepared(simulation), InternalError);
  const CaseResult moved = simulation.run();
  EXPECT_FALSE(simulation.needs_operator());
  Simulation fresh = field();
  fresh.change({{"offset_east", "50 m"}});
  EXPECT_EQ(bits(moved), bits(fresh.run()));
}

TEST(Simulation, TakesWhatCasesOfAFamilySayAgainAndWhatTheyNoLongerSay) {
  Simulation simulation = field();
  const std::vector<Changes> cases = {{{"offset_east", "50 m"}, {"friction_angle", "18 deg"}},
                                      {{"offset_east", "50 m"}, {"friction_angle", "20 deg"}},
                                      {{"offset_east", "50 m"}, {"ratio_across", "0.7"}},
                                      {{"friction_angle", "20 deg"}},
                                      {{"offset_east", "60 m"}, {"friction_angle", "20 deg"}},
                                      {{"offset_east", "60 m"}},
                                      {}};
  for (const Changes& changes : cases) {
    Simulation fresh = field();
    fresh.change(changes);
    simulation.change(changes);
    EXPECT_EQ(simulation.identity(), fresh.identity());
    EXPECT_EQ(Inside::scene(simulation).document.value, Inside::scene(fresh).document.value);
    EXPECT_EQ(bits(simulation.run()), bits(fresh.run()));
  }
}

TEST(Simulation, ListsAllThatIsWrongAndStaysAsItWas) {
  Simulation simulation = field();
  simulation.change({{"friction_angle", "18 deg"}});
  const std::string identity = simulation.identity();
  try {
    simulation.change({{"frictoin_angle", "20 deg"}, {"/stages/9/steps", "3"}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2u);
    EXPECT_THAT(error.what(), HasSubstr("friction_angle"));
  }
  EXPECT_THROW(simulation.change({{"friction_angle", "20"}}), InputError);
  EXPECT_EQ(simulation.identity(), identity);
}

TEST(Simulation, GivesFieldsAndTrace) {
  Simulation simulation = field();
  int n_steps = 0, n_tried = 0, n_slip = 0;
  RunWatch watch;
  watch.step = [&](const StepResult&, const FaultFields& fields) {
    ++n_steps;
    n_slip += (fields.state.array() == static_cast<int>(FaultState::slip)).any();
  };
  watch.tried = [&](int step, const SubStepTrace& trace) {
    ++n_tried;
    EXPECT_EQ(step, n_steps);
    EXPECT_STREQ(trace.verdict, "accepted");
  };
  const CaseResult result = simulation.run(RunContext{}, watch);
  EXPECT_EQ(n_steps, static_cast<int>(result.steps.size()));
  EXPECT_GE(n_tried, n_steps);
  EXPECT_GT(n_slip, 0);
}

TEST(Simulation, StopsACaseWithTheStepsThatItReached) {
  Simulation simulation = field();
  std::atomic<bool> stop = false;
  SilentMonitor silent;
  const RunContext context(silent, StopToken(stop));
  simulation.prepare(context);
  const CaseResult whole = simulation.run(context);
  const CaseResult part =
      simulation.run(context, {.tried = [&](int step, const SubStepTrace&) { stop = step >= 6; }});
  EXPECT_EQ(part.outcome, Outcome::interrupted);
  EXPECT_EQ(part.reason, "stopped in load step 7");
  ASSERT_EQ(part.steps.size(), 7u);
  EXPECT_EQ(part.steps.back().faults, whole.steps[6].faults);
  stop = false;
  EXPECT_EQ(bits(simulation.run(context)), bits(whole)) << "a stop leaves nothing behind";
}

TEST(Simulation, StopsTheBuildingOfAnOperator) {
  Simulation simulation = field();
  std::atomic<bool> stop = true;
  Notes monitor;
  EXPECT_THROW(simulation.prepare({monitor, StopToken(stop)}), Interrupted);
  EXPECT_TRUE(simulation.needs_operator());
  stop = false;
  EXPECT_TRUE(simulation.prepare({monitor, StopToken(stop)}));
  EXPECT_GT(monitor.n_told, 2);
}

}  // namespace
}  // namespace faultsim
