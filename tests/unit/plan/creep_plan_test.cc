#include "simulator/plan/creep_plan.h"

#include <gtest/gtest.h>

#include "simulator/scene/read_scene.h"

namespace faultsim {
namespace {

constexpr double kYear = 31557600;

/// The reference scene with viscous salt and some values set.
Scene viscous(const std::vector<std::pair<std::string, std::string>>& sets) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
  set_value(document, "/materials/salt/viscosity", "1e17 Pa s");
  for (const auto& [pointer, value] : sets) set_value(document, pointer, value);
  return read_scene(document);
}

void expect_rungs(const Scene& scene, const std::vector<double>& expected) {
  const std::vector<double> rungs = creep_rungs(scene);
  ASSERT_EQ(rungs.size(), expected.size());
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    EXPECT_NEAR(rungs[i], expected[i], 1e-12 * expected[i]) << i;
  }
}

TEST(CreepRungs, AreTheLoadStepsAndTheirHalves) {
  // yearly and half-yearly steps, each halved once: the half years are one rung
  expect_rungs(viscous({}), {kYear, 0.5 * kYear, 0.25 * kYear});
  expect_rungs(viscous({{"/numerics/creep_refinements", "0"}}), {kYear, 0.5 * kYear});
  expect_rungs(viscous({{"/numerics/creep_refinements", "3"}}),
               {kYear, 0.5 * kYear, 0.25 * kYear, 0.125 * kYear, 0.0625 * kYear});
  expect_rungs(viscous({{"/stages/1/steps", "3"}, {"/numerics/creep_refinements", "0"}}),
               {kYear, 2 * kYear / 3, 0.5 * kYear});
}

TEST(CreepRungs, OfFixedStepsCutTheLoadStepsEvenly) {
  const auto of = [](const char* step) { return viscous({{"/numerics/creep_time_step", step}}); };
  expect_rungs(of("0.25 year"), {0.25 * kYear});
  expect_rungs(of("0.4 year"), {kYear / 3, 0.25 * kYear});  // 3 in a year, 2 in half a year
  expect_rungs(of("7 year"), {kYear, 0.5 * kYear});
}

/// 1 year / 10 is not a whole multiple of 0.1 year in the last bit: neither an eleventh step nor a
/// second rung may come of it.
TEST(CreepRungs, DoNotSplitOnRounding) {
  const Scene scene = viscous({{"/numerics/creep_time_step", "0.1 year"},
                               {"/stages/1/duration", "0.9 year"},
                               {"/stages/1/steps", "3"}});
  expect_rungs(scene, {0.1 * kYear});
  Scene apart = scene;
  apart.numerics.creep_time_step = 0;
  apart.numerics.creep_refinements = 0;
  apart.stages = {{"a", 1, 1}, {"b", 1 + 1e-10, 1}, {"c", 1 + 1e-8, 1}};
  expect_rungs(apart, {1 + 1e-8, 1 + 1e-10});
}

}  // namespace
}  // namespace faultsim
