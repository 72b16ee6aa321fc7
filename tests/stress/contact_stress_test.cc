// Random small scenes on real operators: nothing ends in a state that violates (3)–(5), friction
// never gives energy, and nothing ends unsolved but what has no solution.
//
//   RC_PARAMS="seed=7 max_success=10000"   other and more scenes; a failure is shrunk and printed
//   FAULTSIM_STRESS=survey                 prints every scene that fails and goes on
//   FAULTSIM_STRESS=strict                 an excused end fails too, so that it is shrunk

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

#include "tests/stress/scene_check.h"
#include "tests/stress/stress_operators.h"

namespace faultsim {
namespace {

constexpr int kScenes = 2000;

/// What is not in RC_PARAMS is as always, so that a run without it can be repeated.
void set_default_parameters() {
  const char* given = std::getenv("RC_PARAMS");
  std::string parameters = given != nullptr ? given : "";
  if (parameters.find("seed=") == std::string::npos) parameters += " seed=20231";
  if (parameters.find("max_success=") == std::string::npos) {
    parameters += " max_success=" + std::to_string(kScenes);
  }
  setenv("RC_PARAMS", parameters.c_str(), 1);
}

std::string mode() {
  const char* given = std::getenv("FAULTSIM_STRESS");
  return given != nullptr ? given : "";
}

void print(const StressTally& t) {
  std::cout << t.n_scenes << " scenes ended: converged " << t.scenes_ended[0] << ", with events "
            << t.scenes_ended[1] << ", unstable " << t.scenes_ended[2]
            << " (jumps not followed), unconverged " << t.scenes_ended[3] << " ("
            << t.n_edge_of_opening << " where cohesion outlives opening)\n"
            << t.n_steps << " load steps, " << t.n_cut << " cut, " << t.n_jumps << " jumps, "
            << t.n_lost_cohesion << " cohesions lost by slip; nodes at their ends: stick "
            << t.n_stick << ", slip " << t.n_slip << ", open " << t.n_open << ", closed again "
            << t.n_closed_again << "\n"
            << t.iterations << " iterations, most in one step " << t.most_iterations << "\n";
}

TEST(ContactStress, OperatorsAreSmallAndReal) {
  for (const StressOperator& small : stress_operators()) {
    std::cout << small.name << ": " << small.op->geometry.nodes.size() << " nodes, "
              << small.op->geometry.n_dofs << " dofs, " << small.op->loads.traction.cols()
              << " loads\n";
    EXPECT_GE(small.op->geometry.nodes.size(), 4u) << small.name;
    EXPECT_LE(small.op->geometry.nodes.size(), 120u) << small.name;
    EXPECT_GT(small.op->loads.traction.cols(), 0) << small.name;
  }
}

/// Empty if the scene did what it must; else what was wrong, and the scene.
std::string fault_found(const RandomScene& scene, StressTally& tally, const std::string& how) {
  const SceneReport report = check_scene(scene, tally);
  std::ostringstream text;
  for (const std::string& violation : report.violations) text << violation << "\n";
  if (!in_equilibrium(report.outcome) && (!report.excused || how == "strict")) {
    text << to_string(report.outcome) << ": " << report.unsolved << "\n";
  }
  if (!text.str().empty()) text << scene;
  return text.str();
}

/// The seed must have led through everything that is to be tested.
void expect_variety(const StressTally& t) {
  const int n = t.n_scenes;
  EXPECT_GT(t.scenes_ended[0], n / 4);
  EXPECT_GT(t.scenes_ended[1], n / 5);
  EXPECT_GT(t.scenes_ended[2], n / 20);
  EXPECT_GT(t.n_cut, n / 4);
  EXPECT_GT(t.n_jumps, n);
  EXPECT_GT(t.n_lost_cohesion, n);
  EXPECT_GT(t.n_stick, 20 * n);
  EXPECT_GT(t.n_slip, 20 * n);
  EXPECT_GT(t.n_open, 5 * n);
  EXPECT_GT(t.n_closed_again, 5 * n);
}

TEST(ContactStress, RandomScenesHoldWhatIsPromised) {
  set_default_parameters();
  StressTally tally;
  const std::string how = mode();
  int n_failed = 0;
  rc::detail::checkGTest([&] {
    const std::string found = fault_found(draw_scene(), tally, how);
    if (found.empty()) return;
    if (how != "survey") RC_FAIL(found);
    ++n_failed;
    std::cout << "--- scene " << tally.n_scenes << "\n" << found << "\n";
  });
  print(tally);
  if (HasFailure()) return;
  EXPECT_EQ(n_failed, 0);
  EXPECT_EQ(tally.n_unsolved_followed, 0);
  EXPECT_LT(tally.scenes_ended[3], 0.01 * tally.n_scenes);
  expect_variety(tally);
}

}  // namespace
}  // namespace faultsim
