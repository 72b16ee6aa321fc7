// Two simulations in one process at once, with different settings: built for the thread sanitizer
// too.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "simulator/reading/read_scene.h"
#include "simulator/result/result_bytes.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {
namespace {

std::string bits(CaseResult result) {
  result.seconds = 0;
  for (StepResult& step : result.steps) step.seconds = 0;
  return result_to_bytes(result);
}

struct Settings {
  Changes scene;
  Changes cases;  ///< one after the other
  int n_threads;
};

/// What one who knows nothing of the other does: reads, builds, runs.
std::vector<std::string> run_all(const Settings& settings, const CachePolicy& cache) {
  Simulation simulation = Simulation::from_text(starter_scene("field"));
  simulation.keep_operators(cache);
  SilentMonitor silent;
  const RunContext context(silent, {}, settings.n_threads);
  std::vector<std::string> results;
  for (const Change& one : settings.cases) {
    Changes changes = settings.scene;
    changes.push_back(one);
    results.push_back(bits(simulation.run(changes, context)));
  }
  return results;
}

TEST(TwoSimulations, AtOnceGiveTheBitsOfOneAfterTheOther) {
  const Settings first = {
      {{"/tier", "screening"}, {"friction_angle", "20 deg"}},
      {{"ratio_across", "0.74"}, {"ratio_across", "0.7"}, {"cohesion", "0.5 MPa"}},
      1};
  const Settings second = {
      {{"/tier", "screening"}, {"offset_east", "50 m"}, {"friction_angle", "25 deg"}},
      {{"fault_pressure", "max"}, {"biot", "0.9"}, {"offset_east", "100 m"}},
      2};
  const auto scratch =
      std::filesystem::temp_directory_path() / ("faultsim-two-" + std::to_string(getpid()));
  std::vector<std::string> one, other;
  {
    std::jthread a([&] { one = run_all(first, {scratch}); });
    std::jthread b([&] { other = run_all(second, {scratch}); });
  }
  std::filesystem::remove_all(scratch);
  EXPECT_EQ(one, run_all(first, {}));
  EXPECT_EQ(other, run_all(second, {}));
}

TEST(TwoSimulations, TwinsShareTheOperatorAndNothingElse) {
  Simulation first = Simulation::from_text(starter_scene("field"));
  first.change({{"/tier", "screening"}, {"friction_angle", "20 deg"}});
  first.prepare();
  Simulation second = first.twin();
  EXPECT_FALSE(second.needs_operator());
  EXPECT_EQ(second.geometry(), first.geometry());
  EXPECT_EQ(second.identity(), first.identity());

  const auto run_all = [](Simulation& simulation, bool backwards) {
    std::vector<std::string> results(4);
    const Changes cases = {{"ratio_across", "0.74"},
                           {"friction_angle", "25 deg"},
                           {"offset_east", "50 m"},  // another operator, of its own
                           {"cohesion", "0.5 MPa"}};
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const std::size_t i = backwards ? cases.size() - 1 - k : k;
      results[i] = bits(simulation.run({{"/tier", "screening"}, cases[i]}));
    }
    return results;
  };
  std::vector<std::string> one, other;
  {
    std::jthread a([&] { one = run_all(first, false); });
    std::jthread b([&] { other = run_all(second, true); });
  }
  EXPECT_EQ(one, other);
  Simulation alone = Simulation::from_text(starter_scene("field"));
  EXPECT_EQ(one, run_all(alone, false));
}

TEST(TwoSimulations, OneIsStoppedAndTheOtherIsNot) {
  std::atomic<bool> stop = false;
  CaseResult stopped, whole;
  {
    std::jthread a([&] {
      Simulation simulation = Simulation::from_text(starter_scene("field"));
      simulation.change({{"/tier", "screening"}});
      SilentMonitor silent;
      stopped = simulation.run({silent, StopToken(stop)},
                               {.tried = [&](int step, const SubStepTrace&) { stop = step >= 4; }});
    });
    std::jthread b([&] {
      Simulation simulation = Simulation::from_text(starter_scene("field"));
      whole = simulation.run({{"/tier", "screening"}, {"friction_angle", "20 deg"}});
    });
  }
  EXPECT_EQ(stopped.outcome, Outcome::interrupted);
  EXPECT_EQ(whole.outcome, Outcome::converged);
}

}  // namespace
}  // namespace faultsim
