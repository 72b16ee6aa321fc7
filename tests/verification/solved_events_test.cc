// The weakening reference scene on columns of H that are solved for, against the same scene on its
// operator: the same events, by a solver that never has H.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/coupled_case/coupled_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

struct ReferenceScene {
  ReferenceScene() {
    JsonDocument document = read_json_file(std::string(FAULTSIM_SOURCE_DIR) +
                                           "/docs/examples/scenes/rotliegend-weakening.json");
    set_value(document, "/tier", "screening");
    set_value(document, "/numerics/plane_strain", "on");
    scene = read_scene(document);
    std::vector<Problem> problems;
    plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
  }
  Scene scene;
  Plan plan;
};

double relative(double a, double b) { return std::abs(a - b) / std::max(std::abs(b), 1e-300); }

class SolvedEvents : public testing::TestWithParam<LeadingKind> {};

TEST_P(SolvedEvents, AreThoseOfTheOperator) {
  const ReferenceScene of;
  const CaseResult a = run_case(of.scene, prepare_operator(of.scene, of.plan, {}, false), {});
  const CaseResult b = CoupledCase(SceneBulk(of.scene, of.plan), {.leading = GetParam()}).run();
  ASSERT_TRUE(in_equilibrium(a.outcome));
  EXPECT_EQ(b.outcome, a.outcome) << b.reason;
  EXPECT_GE(a.events.size(), 5u);
  ASSERT_EQ(b.events.size(), a.events.size());
  // Asked for is 1e-3; the columns are good to 1e-11, and contact to 1e-8.
  constexpr double kTolerance = 1e-6;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    SCOPED_TRACE(concat("event ", i));
    const SlipEvent &x = a.events[i], &y = b.events[i];
    EXPECT_EQ(x.step, y.step);
    EXPECT_EQ(x.fault, y.fault);
    EXPECT_LT(relative(y.pressures.change_in_fault, x.pressures.change_in_fault), kTolerance)
        << "at onset";
    EXPECT_LT(relative(y.moment, x.moment), kTolerance);
    EXPECT_LT(relative(y.max_slip, x.max_slip), kTolerance);
    EXPECT_LT(relative(y.energy_released, x.energy_released), kTolerance);
    EXPECT_EQ(y.evidence_holds, x.evidence_holds);
    EXPECT_EQ(y.negative_pivots, x.negative_pivots);
  }
  std::size_t n_solves = 0;
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    n_solves += b.steps[i].coupled->krylov_iterations.size();
    for (std::size_t f = 0; f < a.steps[i].faults.size(); ++f)
      EXPECT_NEAR(b.steps[i].faults[f].chi_bar, a.steps[i].faults[f].chi_bar, 1e-8);
  }
  const auto n_jumps = static_cast<std::size_t>(b.coupled->n_multipliers);
  EXPECT_LT(n_solves, n_jumps / 2) << "of what sticks there are no columns";
}

INSTANTIATE_TEST_SUITE_P(All, SolvedEvents,
                         testing::Values(LeadingKind::exact, LeadingKind::amg_by_component),
                         [](const auto& kind) { return kind.index == 0 ? "exact" : "amg_u"; });

}  // namespace
}  // namespace faultsim
