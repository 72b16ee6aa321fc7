// What `creep: automatic` leaves out stays within the bound that the plan names: cases of the
// reference field near the threshold viscosity, with and without creep.

#include <gtest/gtest.h>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct FieldRun {
  Plan plan;
  std::vector<Eigen::Matrix3Xd> traction;  // per load step
  double largest_slip = 0;
};

FieldRun run(const Settings& settings) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json");
  for (const auto& [pointer, value] : settings) set_value(document, pointer, value);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  FieldRun result;
  result.plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  SilentMonitor monitor;
  const PreparedOperator prepared = prepare_operator(scene, result.plan, {}, false, monitor);
  const CaseResult end =
      run_case(scene, prepared, monitor, {{[&](const StepResult&, const FaultFields& fields) {
                 result.traction.push_back(fields.traction);
                 result.largest_slip = std::max(result.largest_slip,
                                                fields.jump.bottomRows<2>().cwiseAbs().maxCoeff());
               }}});
  EXPECT_EQ(end.outcome, Outcome::converged) << end.reason;
  return result;
}

/// Largest change of a traction by creep; load steps are steps of creep, so that friction follows
/// the same path in both.
double change_by_creep(const Settings& settings, FieldRun& automatic) {
  Settings on = settings;
  on.push_back({"/numerics/creep", "on"});
  on.push_back({"/numerics/creep_time_step", "1 year"});
  const FieldRun creeping = run(on);
  EXPECT_TRUE(creeping.plan.creep.active);
  automatic = run(settings);
  double change = 0;
  EXPECT_EQ(creeping.traction.size(), automatic.traction.size());
  for (std::size_t i = 0; i < creeping.traction.size(); ++i) {
    change = std::max(change, (creeping.traction[i] - automatic.traction[i]).cwiseAbs().maxCoeff());
  }
  return change;
}

/// Slipping faults in the plane, on 20 m cells: a hundredth of the bound, whatever the viscosity.
TEST(CreepOff, StaysWithinItsBoundWhereFaultsSlip) {
  double last = 0;
  for (const char* viscosity : {"1.3e24 Pa s", "1.3e25 Pa s"}) {
    FieldRun off;
    const double change =
        change_by_creep({{"/tier", "custom"},
                         {"/mesh", R"({"dip": "20 m", "normal": "20 m", "growth": 1.4})"},
                         {"/numerics/plane_strain", "on"},
                         {"/numerics/traction_tolerance", "1e-10"},
                         {"/geometry/blocks/1/offset", "100 m"},
                         {"/friction/friction_angle", "20 deg"},
                         {"/materials/salt/viscosity", viscosity}},
                        off);
    ASSERT_FALSE(off.plan.creep.active) << "just below the threshold";
    ASSERT_TRUE(off.plan.creep.bound);
    EXPECT_GT(off.largest_slip, 0.01);
    EXPECT_LT(change, 0.05 * *off.plan.creep.bound);
    EXPECT_GT(change, 1e-3 * *off.plan.creep.bound) << "creep did something";
    if (last > 0) {
      EXPECT_NEAR(last / change, 10, 0.5);
    }
    last = change;
  }
}

TEST(CreepOff, StaysWithinItsBoundInThreeDimensions) {
  FieldRun off;
  const double change = change_by_creep(
      {{"/tier", "custom"},
       {"/mesh", R"({"strike": "400 m", "dip": "60 m", "normal": "100 m", "growth": 1.8})"},
       {"/geometry/blocks/1/offset", "100 m"},
       {"/friction/friction_angle", "20 deg"},
       {"/materials/salt/viscosity", "1.3e24 Pa s"}},
      off);
  ASSERT_FALSE(off.plan.creep.active);
  EXPECT_GT(off.largest_slip, 0.01);
  EXPECT_LT(change, 0.05 * off.plan.creep.bound.value());
  EXPECT_GT(change, 0);
}

}  // namespace
}  // namespace faultsim
