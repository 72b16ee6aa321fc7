// Which parameters matter at each load step: histories whose chi_bar is a known sum.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/answers/sensitivity.h"
#include "campaign/render/render.h"
#include "tests/unit/answers/answers_fixture.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using faultsim::InputError;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr int kSteps = 12;
/// Friction matters early, the offset late.
double weight_of_friction(int step) { return 0.4 * step / kSteps * (kSteps - step) / kSteps; }
double weight_of_offset(int step) { return 0.4 * std::pow(1.0 * step / kSteps, 3); }

class ByStep : public FrictionAndOffset {
 protected:
  /// χ̄ of F1 is 0.1 + the weighted sum of both, that of F2 with each other's weights.
  void add(double friction, double offset, int n_steps = kSteps) {
    faultsim::CaseResult result = testing::made_up_result(0.3, n_steps);
    for (faultsim::StepResult& step : result.steps) {
      const double early = weight_of_friction(step.step), late = weight_of_offset(step.step);
      step.faults[0].chi_bar = 0.1 + early * friction + late * offset;
      step.faults[1].chi_bar = 0.1 + late * friction + early * offset;
    }
    add_case(both(friction, offset), std::move(result));
  }
  void add_random(int n) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < n; ++k) {
      const double friction = uniform(random);
      add(friction, uniform(random));
    }
  }
  Sensitivity analysed(SensitivityRequest request) {
    request.by_step = true;
    return analyse_sensitivity(*store_, campaign_, request);
  }
  std::string refusal(SensitivityRequest request) {
    try {
      analysed(std::move(request));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

/// S = w_a² V_a / (w_a² V_a + w_b² V_b) at each step; of all steps the same with sums over them.
TEST_F(ByStep, IndicesOfAGridAreFiniteSums) {
  constexpr int kA = 4, kB = 5;
  for (int a = 0; a < kA; ++a)
    for (int b = 0; b < kB; ++b) add(0.2 * a, 0.25 * b);
  submit_as("grid");
  record();
  const Sensitivity s = analysed({.metrics = "F1.chi_bar, F2.chi_bar"});
  const double v_friction = 0.2 * 0.2 * (kA * kA - 1) / 12.0;
  const double v_offset = 0.25 * 0.25 * (kB * kB - 1) / 12.0;
  ASSERT_EQ(s.steps.size(), kSteps + 1u);
  ASSERT_EQ(s.metrics.size(), 2 * s.steps.size());
  ASSERT_EQ(s.over_steps.size(), 2u);
  for (const std::size_t fault : {0u, 1u}) {
    double of_friction = 0, of_both = 0;
    for (int k = 1; k <= kSteps; ++k) {
      double early = weight_of_friction(k), late = weight_of_offset(k);
      if (fault == 1) std::swap(early, late);
      const double a = early * early * v_friction, b = late * late * v_offset;
      of_friction += a, of_both += a + b;
      const auto at = fault * s.steps.size() + static_cast<std::size_t>(k);
      EXPECT_NEAR(s.metrics[at].first_order.at(0).value, a / (a + b), 1e-12) << k;
      EXPECT_NEAR(s.metrics[at].total_order.at(1), b / (a + b), 1e-12) << k;
    }
    const MetricSensitivity& all = s.over_steps[fault];
    EXPECT_NEAR(all.first_order.at(0).value, of_friction / of_both, 1e-12);
    EXPECT_NEAR(all.total_order.at(1), 1 - of_friction / of_both, 1e-12);
  }
  testing::expect_same_renderings(to_answer(s));
}

TEST_F(ByStep, OfASampleTheLeadingParameterChanges) {
  add_random(400);
  submit_as("monte-carlo");
  record();
  const Answer answer =
      what_matters(*store_, campaign_, {.metrics = "F1.chi_bar", .by_step = true});
  testing::expect_same_renderings(answer);
  EXPECT_THAT(answer.headline.at(0), HasSubstr("Over all load steps F1.chi_bar depends most on "));
  EXPECT_THAT(answer.headline[0], HasSubstr(" At first friction explains most, from step "));
  EXPECT_THAT(answer.headline[0], HasSubstr(" on offset."));
  const json document = render_json(answer);
  EXPECT_EQ(document.at("kind"), "shares-by-step");
  long n_together = 0;
  for (const json& one : document.at("indices")) {
    EXPECT_EQ(one.at("metric"), "F1.chi_bar");
    if (one.at("step").is_null()) ++n_together;
    if (one.at("step") != 12 || one.at("parameter") != "offset") continue;
    EXPECT_NEAR(one.at("value").get<double>(), 1, 0.02);  // friction has no weight there
    EXPECT_EQ(one.at("time_s"), 12 * 3.15576e7);
  }
  EXPECT_EQ(n_together, 2);
  const std::string chart = first_chart(answer);
  EXPECT_THAT(chart, HasSubstr("gas storage"));
  EXPECT_THAT(chart, HasSubstr("friction"));
}

/// What all steps together say is what the index of one number with their variance would: here
/// that of a step, as the others do not vary.
TEST_F(ByStep, OneStepThatVariesSaysAllOfThem) {
  add_random(300);
  for (RunRecord& run : runs_)
    for (faultsim::StepResult& step : run.result->steps)
      if (step.step != 5) step.faults[0].chi_bar = 0.25;
  submit_as("monte-carlo");
  record();
  const Sensitivity s = analysed({.metrics = "F1.chi_bar"});
  const auto &all = s.over_steps.at(0).first_order, &fifth = s.metrics.at(5).first_order;
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_NEAR(all.at(p).value, fifth.at(p).value, 1e-12);
    EXPECT_NEAR(all[p].bounds.low, fifth[p].bounds.low, 1e-12);
  }
  EXPECT_NEAR(s.over_steps[0].standard_deviation,
              s.metrics[5].standard_deviation / std::sqrt(kSteps + 1.0), 1e-12);
}

/// A flag that is true in few rows has no index at any step, nor of all of them.
TEST_F(ByStep, ARareFlagHasNoIndices) {
  add_random(200);
  for (std::size_t k = 0; k < runs_.size(); ++k)
    for (faultsim::StepResult& step : runs_[k].result->steps)
      step.faults[0].activated = k < 12 && step.step > 6;
  submit_as("monte-carlo");
  record();
  const Sensitivity s = analysed({.metrics = "F1.slides"});
  EXPECT_TRUE(s.metrics.back().first_order.empty());
  EXPECT_TRUE(s.over_steps.at(0).first_order.empty());
  EXPECT_EQ(to_answer(s).headline.at(0), "The metrics that vary have too few rows for indices.");
}

TEST_F(ByStep, AStageHasItsSteps) {
  add_random(200);
  submit_as("monte-carlo");
  record();
  const Sensitivity s = analysed({.cases = {.stage = "gas_storage"}});
  ASSERT_EQ(s.steps.size(), 4u);
  EXPECT_EQ(s.steps.front().step, 9);
  EXPECT_EQ(s.over_steps.size(), 2u) << "chi_bar of each fault";
}

TEST_F(ByStep, WhatHasNoStepsIsRefusedInOneMessage) {
  add_random(200);
  submit_as("monte-carlo");
  record();
  const std::string text =
      refusal({.metrics = "chi_bar, F1.activation_depth, F2.chi_bar in gas_storage"});
  EXPECT_THAT(text, HasSubstr("chi_bar at a load step belongs to a fault"));
  EXPECT_THAT(text, HasSubstr("F1.activation_depth is not kept load step by load step"));
  EXPECT_THAT(text, HasSubstr("F2.chi_bar in gas_storage belongs to a stage"));
}

TEST_F(ByStep, OtherLoadStepsAreNotCompared) {
  for (int k = 0; k < 200; ++k) add(0.001 * k, 0.5, k < 150 ? 12 : 6);
  submit_as("monte-carlo");
  record();
  EXPECT_THAT(refusal({}), HasSubstr("their stages have different steps"));
}

TEST_F(ByStep, WithoutAResultThereIsNothingToSay) {
  add_random(3);
  submit_as("monte-carlo");
  EXPECT_THAT(refusal({}), HasSubstr("no case has a result"));
  EXPECT_THAT(refusal({.metrics = "chi_bar"}), HasSubstr("no case has a result"));
}

TEST_F(ByStep, TrajectoriesHaveNoSteps) {
  add_random(200);
  submit_as("morris");
  record();
  EXPECT_THAT(refusal({}), HasSubstr("neither a sample nor a grid"));
}

}  // namespace
}  // namespace faultsweep
