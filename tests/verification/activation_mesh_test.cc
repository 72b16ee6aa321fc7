// Activation must not depend on the mesh, while nodal max χ is known to grow.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

CaseResult run_reference(const std::string& offset, const std::string& angle,
                         const std::string& cell) {
  JsonDocument document =
      read_json_file(std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/scenes/rotliegend.json");
  set_value(document, "/tier", "custom");
  set_value(document, "/numerics/plane_strain", "on");
  set_value(document, "/mesh/dip", cell);
  set_value(document, "/mesh/normal", cell);
  set_value(document, resolve_parameter(document, "offset_east"), offset);
  set_value(document, resolve_parameter(document, "friction_angle"), angle);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  SilentMonitor monitor;
  return run_case(scene, prepare_operator(scene, plan, {}, false, monitor), monitor);
}

/// Nodal max χ and χ̄ over the faults while everything still sticks.
struct Peaks {
  double nodal = 0, window = 0;
};
Peaks peaks_at(const CaseResult& result, std::size_t step) {
  Peaks peaks;
  EXPECT_EQ(result.steps[step].n_slip, 0);
  for (const FaultMetrics& fault : result.steps[step].faults) {
    peaks.nodal = std::max(peaks.nodal, fault.chi_max);
    peaks.window = std::max(peaks.window, fault.chi_bar);
  }
  return peaks;
}

TEST(ActivationMesh, StepMovesByAtMostOneWhileNodalPeaksGrow) {
  for (const auto& [offset, angle] : {std::pair{"100 m", "20 deg"}, std::pair{"200 m", "15 deg"}}) {
    std::vector<int> steps;
    for (const char* cell : {"10 m", "5 m", "2.5 m"}) {
      const CaseResult result = run_reference(offset, angle, cell);
      ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
      ASSERT_TRUE(result.whole.activation_step.has_value());
      steps.push_back(*result.whole.activation_step);
    }
    const auto [low, high] = std::minmax_element(steps.begin(), steps.end());
    EXPECT_LE(*high - *low, 1) << offset << " " << angle;
    EXPECT_GT(*low, 1);  // something to detect
  }
  std::vector<Peaks> peaks;
  for (const char* cell : {"10 m", "5 m", "2.5 m"}) {
    peaks.push_back(peaks_at(run_reference("100 m", "45 deg", cell), 5));
  }
  EXPECT_GT(peaks[1].nodal, 1.08 * peaks[0].nodal);
  EXPECT_GT(peaks[2].nodal, 1.08 * peaks[1].nodal);
  EXPECT_NEAR(peaks[1].window, peaks[0].window, 0.05 * peaks[0].window);
  EXPECT_NEAR(peaks[2].window, peaks[1].window, 0.03 * peaks[1].window);
}

/// A tier's cells in plane strain.
CaseResult run_tier(const std::string& tier, const std::string& offset, const std::string& angle) {
  JsonDocument document =
      read_json_file(std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/scenes/rotliegend.json");
  set_value(document, "/tier", tier);
  set_value(document, "/numerics/plane_strain", "on");
  set_value(document, resolve_parameter(document, "offset_east"), offset);
  set_value(document, resolve_parameter(document, "friction_angle"), angle);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  SilentMonitor monitor;
  return run_case(scene, prepare_operator(scene, plan, {}, false, monitor), monitor);
}

/// Cells of 50 m cannot tell whether 40 m slide where χ̄ comes near 1; small ones can, on either
/// side.
TEST(ActivationMesh, CellsThatCannotTellSaySo) {
  const CaseResult sticks = run_reference("0 m", "40 deg", "5 m");
  EXPECT_FALSE(sticks.whole.activated);
  EXPECT_TRUE(sticks.whole.activation_resolved);
  const CaseResult coarse = run_reference("0 m", "30 deg", "50 m");
  EXPECT_FALSE(coarse.whole.activation_resolved);
  EXPECT_FALSE(coarse.stages[0].activation_resolved);
  const CaseResult slides = run_reference("200 m", "15 deg", "5 m");
  EXPECT_TRUE(slides.whole.activated && slides.whole.activation_resolved);
}

/// What the tiers claim (results/measures has all steps and faults), here of one case against 2.5
/// m.
TEST(ActivationMesh, TiersAreAsCloseAsTheySay) {
  const CaseResult fine = run_reference("100 m", "20 deg", "2.5 m");
  for (const auto& [tier, chi_off] :
       {std::pair{"screening", 0.013}, std::pair{"standard", 0.020},
        std::pair{"demonstration", 0.028}, std::pair{"reference", 0.013}}) {
    const CaseResult result = run_tier(tier, "100 m", "20 deg");
    ASSERT_EQ(result.steps.size(), fine.steps.size());
    double worst = 0;
    for (std::size_t k = 0; k < fine.steps.size(); ++k)
      for (std::size_t f = 0; f < 3; ++f)
        worst = std::max(
            worst, std::abs(result.steps[k].faults[f].chi_bar - fine.steps[k].faults[f].chi_bar));
    EXPECT_LT(worst, chi_off) << tier;
    EXPECT_NEAR(result.whole.max_slip, fine.whole.max_slip, 0.06 * fine.whole.max_slip) << tier;
  }
}

}  // namespace
}  // namespace faultsim
