// The weakening reference scene end to end: every step in equilibrium, every event with evidence,
// and the work that it takes, which must not creep up (results/reference-events has all 240 cases).

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

struct ReferenceCase {
  const char *offset, *dip, *friction_angle, *weakening_distance;
  std::size_t n_events;
  int newton, wasted, passes;  ///< as recorded; BLAS kernels move them a little.
};

void PrintTo(const ReferenceCase& c, std::ostream* out) {
  *out << c.offset << ", dip " << c.dip << ", " << c.friction_angle << ", d_c "
       << c.weakening_distance;
}

constexpr ReferenceCase kCases[] = {
    {"0 m", "25 deg", "20 deg", "20 mm", 1, 133, 129, 162},
    {"100 m", "25 deg", "30 deg", "100 mm", 1, 190, 331, 407},
    {"100 m", "0 deg", "30 deg", "20 mm", 20, 1918, 3408, 2927},
    {"200 m", "0 deg", "20 deg", "20 mm", 1, 275, 298, 380},
    {"200 m", "25 deg", "20 deg", "100 mm", 0, 105, 33, 101},
    {"0 m", "0 deg", "20 deg", "2 mm", 37, 1878, 6601, 4337},
};

CaseResult run(const ReferenceCase& c) {
  JsonDocument document = read_json_file(std::string(FAULTSIM_SOURCE_DIR) +
                                         "/docs/examples/scenes/rotliegend-weakening.json");
  // Even cells: the record does not move with a tier.
  set_value(document, "/tier", "custom");
  set_value(document, "/mesh", R"({"dip": "10 m", "normal": "10 m"})");
  set_value(document, "/numerics/plane_strain", "on");
  for (const auto& [name, value] :
       {std::pair{"offset_east", c.offset}, std::pair{"central_dip", c.dip},
        std::pair{"friction_angle", c.friction_angle},
        std::pair{"slip_weakening_distance", c.weakening_distance}}) {
    set_value(document, resolve_parameter(document, name), value);
  }
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  SilentMonitor monitor;
  return run_case(scene, prepare_operator(scene, plan, {}, false, monitor), monitor);
}

class ReferenceEvents : public testing::TestWithParam<ReferenceCase> {};

TEST_P(ReferenceEvents, EveryStepEndsInEquilibriumForTheRecordedWork) {
  const ReferenceCase& expected = GetParam();
  const CaseResult result = run(expected);
  ASSERT_TRUE(in_equilibrium(result.outcome)) << result.reason;
  EXPECT_EQ(result.steps.size(), 25u);
  for (const StepResult& step : result.steps) {
    EXPECT_TRUE(in_equilibrium(step.outcome)) << step.step << ": " << step.reason;
  }
  EXPECT_EQ(result.events.size(), expected.n_events);
  for (const SlipEvent& event : result.events) {
    EXPECT_TRUE(event.evidence_holds) << "step " << event.step;
    EXPECT_GT(event.negative_pivots, 0);
    EXPECT_GE(event.energy_released, event.energy_dissipated);
    EXPECT_LE(event.load_factor_after - event.load_factor_before, 5e-4);
  }
  constexpr double kMargin = 1.05;
  EXPECT_LE(result.counts.newton_iterations, kMargin * expected.newton);
  EXPECT_LE(result.counts.wasted_newton_iterations, kMargin * expected.wasted);
  EXPECT_LE(result.counts.active_set_passes, kMargin * expected.passes);
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceEvents, testing::ValuesIn(kCases));

}  // namespace
}  // namespace faultsim
