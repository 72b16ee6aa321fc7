// Where within its load step a fault begins to slide, against many small load steps.

#include "simulator/loading/onset_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/scene/identity.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// A coarse section of three faults whose east block is depleted by 0.7 of the west one, 110 bar in
/// `steps` equal load steps, and as much again.
json section_in(int steps, const char* tolerance) {
  json scene = json::parse(starter_scene("field"));
  scene["tier"] = "custom";
  scene["mesh"] = {{"strike", "400 m"}, {"dip", "50 m"}, {"normal", "100 m"}, {"growth", 1.6}};
  scene["numerics"] = {{"plane_strain", "on"}};
  if (tolerance != nullptr) scene["numerics"]["activation_tolerance"] = tolerance;
  scene["geometry"]["width"] = "10 km";
  scene["geometry"]["length"] = "8 km";
  scene["friction"]["friction_angle"] = "19 deg";
  scene["compartments"] = {{"east", {{"scale", 0.7}}}};
  scene["stages"] = {{{"name", "down"},
                      {"duration", "10 year"},
                      {"steps", steps},
                      {"pressure_change", "-110 bar"}},
                     {{"name", "deeper"},
                      {"duration", "10 year"},
                      {"steps", steps},
                      {"pressure_change", "-215 bar"}}};
  return scene;
}

CaseResult result_of(const json& document) {
  const Scene scene = read_scene(parse_json(document.dump(), "test"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  SilentMonitor monitor;
  return run_case(scene, prepare_operator(scene, plan, {}, false, monitor), monitor);
}

class OnsetSearchTest : public ::testing::Test {
 protected:
  static constexpr double kTolerance = 0.5e5;  // Pa

  /// The onsets of 5 load steps lie between those of 400, of the whole history and of each stage.
  static int compare(const StageMetrics& searched, const StageMetrics& fine, double fine_step) {
    EXPECT_EQ(searched.faults.size(), fine.faults.size());
    int n = 0;
    for (std::size_t f = 0; f < fine.faults.size(); ++f) {
      EXPECT_EQ(searched.faults[f].activated, fine.faults[f].activated);
      if (!fine.faults[f].activation || !searched.faults[f].activation) continue;
      const FaultOnset& found = *searched.faults[f].activation;
      const double expected = *leading_change(fine.faults[f].activation->pressures);
      const double change = *leading_change(found.pressures);
      EXPECT_LE(std::abs(change - *found.change_before), kTolerance) << fine.faults[f].fault;
      EXPECT_NEAR(change, expected, fine_step + kTolerance) << fine.faults[f].fault;
      EXPECT_NEAR(found.depth, fine.faults[f].activation->depth, 50) << fine.faults[f].fault;
      ++n;
    }
    return n;
  }
};

TEST_F(OnsetSearchTest, MeetsManySmallLoadSteps) {
  const CaseResult coarse = result_of(section_in(5, nullptr));
  const CaseResult searched = result_of(section_in(5, "0.5 bar"));
  const CaseResult fine = result_of(section_in(400, nullptr));
  ASSERT_EQ(searched.outcome, Outcome::converged) << searched.reason;
  ASSERT_EQ(fine.outcome, Outcome::converged) << fine.reason;
  EXPECT_EQ(compare(searched.whole, fine.whole, 0.5e5), 3);
  EXPECT_GT(compare(searched.stages.at(0), fine.stages.at(0), 0.5e5), 0);
  EXPECT_GT(compare(searched.stages.at(1), fine.stages.at(1), 0.5e5), 0);
  // What else is told of a case is what it was, bit for bit.
  for (std::size_t f = 0; f < coarse.whole.faults.size(); ++f) {
    const FaultOnset& plain = *coarse.whole.faults[f].activation;
    const FaultOnset& found = *searched.whole.faults[f].activation;
    EXPECT_FALSE(plain.load_before || plain.load_after || plain.change_before);
    EXPECT_EQ(plain.step, found.step);
    EXPECT_LT(*found.load_before, *found.load_after);
    EXPECT_LT(*found.load_after, 1);
    // Pressures fall, so that a step's end has more of the change than any load within it.
    EXPECT_LT(*leading_change(plain.pressures), *leading_change(found.pressures));
    EXPECT_EQ(coarse.whole.faults[f].max_slip, searched.whole.faults[f].max_slip);
  }
  for (std::size_t i = 0; i < coarse.steps.size(); ++i)
    EXPECT_EQ(coarse.steps[i].faults, searched.steps[i].faults) << i;
}

/// A jump of a weakening fault within the step is met by the halves as by the step.
TEST_F(OnsetSearchTest, FindsAnEventWhereTheStepHasIt) {
  json scene = section_in(4, "0.2 bar");
  scene["friction"] = {{"friction_angle", "30 deg"},
                       {"dynamic_friction_angle", "10 deg"},
                       {"slip_weakening_distance", "20 mm"}};
  scene["fault_pressure"] = {{"rule", "max"}};
  const CaseResult result = result_of(scene);
  ASSERT_TRUE(in_equilibrium(result.outcome)) << result.reason;
  int n = 0;
  for (const FaultStageMetrics& fault : result.whole.faults) {
    if (!fault.activation) continue;
    const FaultOnset& onset = *fault.activation;
    for (const SlipEvent& event : result.events) {
      if (event.fault != fault.fault || event.step != onset.step) continue;
      EXPECT_LE(*onset.load_before, event.load_factor_after + 1e-3) << fault.fault;
      ++n;
      break;
    }
  }
  EXPECT_GT(n, 0);
}

TEST_F(OnsetSearchTest, AScenesIdentityChangesOnlyWhereItIsAskedFor) {
  json none = section_in(5, nullptr), zero = section_in(5, "0 bar"), some = section_in(5, "1 bar");
  const auto identity = [](const json& document) {
    return case_identity(read_scene(parse_json(document.dump(), "test")));
  };
  EXPECT_EQ(identity(none), identity(zero));
  EXPECT_NE(identity(none), identity(some));
}

}  // namespace
}  // namespace faultsim
