// Sensitivities of made-up campaigns whose answers are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/render/render.h"
#include "tests/unit/answers/answers_fixture.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using faultsim::InputError;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(AnswersTest, SensitivityNamesTheParameterThatMatters) {
  submit("latin-hypercube", even(300));
  runs_[7].result.reset(), runs_[7].status = RunStatus::hung;
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar, slides"});
  ASSERT_EQ(s.parameters, (std::vector<std::string>{"strength", "offset", "rule"}));
  ASSERT_EQ(s.metrics.size(), 2u);
  EXPECT_EQ(s.metrics[0].n, 299);
  EXPECT_GT(s.metrics[0].first_order[0].value, 0.99);
  for (const std::size_t other : {1u, 2u}) {
    const Estimate& e = s.metrics[0].first_order[other];
    EXPECT_LT(std::abs(e.value), 4 * e.standard_error) << other;
  }
  const Answer answer = to_answer(s);
  const std::string text = render_text(answer);
  EXPECT_THAT(text, HasSubstr("299 of 300 rows; left out: 1 without a result."));
  EXPECT_THAT(text, HasSubstr("F1.chi_bar depends most on strength: "));
  EXPECT_THAT(text, HasSubstr("interaction"));
  testing::expect_same_renderings(answer);
  const auto indices = render_json(answer).at("indices");
  ASSERT_EQ(indices.size(), 6u) << "two metrics, three parameters";
  EXPECT_EQ(indices[0].at("parameter"), "strength");
  EXPECT_EQ(indices[0].at("method"), "ranks");
  EXPECT_EQ(indices[0].at("value").get<double>(), s.metrics[0].first_order[0].value);
  EXPECT_EQ(indices[0].at("low").get<double>(), s.metrics[0].first_order[0].bounds.low);
}

/// Where inputs depend on each other, indices overlap: their sum says nothing.
TEST_F(AnswersTest, OfCorrelatedInputsNothingIsSaidOfInteraction) {
  const auto text = [&](const SensitivityRequest& request) {
    return render_text(to_answer(analyse_sensitivity(*store_, campaign_, request)), 1000);
  };
  design_keys_ = {{"correlated", {{"parameters", {0, 1}}, {"rank", {{1, -0.6}, {-0.6, 1}}}}}};
  submit("monte-carlo", even(140));
  record();
  const std::string correlated = text({.metrics = "F1.chi_bar"});
  EXPECT_THAT(correlated, HasSubstr("Inputs are correlated: an index is the share that knowing the "
                                    "parameter alone would explain, including that of"));
  EXPECT_THAT(correlated, HasSubstr("is not interaction"));
  EXPECT_THAT(correlated, Not(HasSubstr("together")));
}

/// So they do where cases are chosen by them, or come from a file of samples.
TEST_F(AnswersTest, WhatLeavesCasesOutMakesInputsDependOnEachOther) {
  excluded_ = {"strength > 0.9 and offset > 200 m"};
  submit("monte-carlo", even(140));
  record();
  EXPECT_THAT(analyse_sensitivity(*store_, campaign_, {}).dependence, HasSubstr("excluded"));
}

TEST_F(AnswersTest, SelectedCasesAreNotIndependent) {
  submit("monte-carlo", even(200));
  record();
  EXPECT_EQ(analyse_sensitivity(*store_, campaign_, {}).dependence, "");
  EXPECT_THAT(
      analyse_sensitivity(*store_, campaign_, {.cases = {.where = "chi_bar > 0.2"}}).dependence,
      HasSubstr("selected"));
}

TEST_F(AnswersTest, SamplesOfAFileMayBeCorrelated) {
  submit("samples", even(140));
  record();
  EXPECT_THAT(analyse_sensitivity(*store_, campaign_, {}).dependence, HasSubstr("from a file"));
}

/// χ̄ of F1 is its strength, 0.1 to 0.4, whatever the offset: of a grid that is known exactly.
TEST_F(AnswersTest, OfAGridIndicesAreExactAndHaveNoIntervals) {
  std::vector<std::array<double, 2>> values;
  for (int k = 0; k < 4; ++k)
    for (int offset = 0; offset < 10; ++offset) values.push_back({0.1 * (k + 1), 10.0 * offset});
  submit("grid", values, {"strength", "offset"});
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  const MetricSensitivity& chi_bar = s.metrics.at(0);
  EXPECT_NEAR(chi_bar.first_order.at(0).value, 1, 1e-12);
  EXPECT_NEAR(chi_bar.first_order.at(1).value, 0, 1e-12);
  EXPECT_TRUE(std::isnan(chi_bar.first_order[0].bounds.low));
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("no intervals"));
  EXPECT_THAT(text, Not(HasSubstr("±")));
  EXPECT_TRUE(render_json(answer).at("indices").at(0).at("low").is_null());
  EXPECT_EQ(render_json(answer).at("indices").at(0).at("method"), "levels");
}

/// Rows A, AB_1, AB_2, B of each base sample: what follows from strength alone goes with it wholly.
TEST_F(AnswersTest, ASobolDesignHasTotalIndices) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::array<double, 2>> values;
  for (int k = 0; k < 140; ++k) {
    const std::array<double, 2> a = {uniform(random), uniform(random)};
    const std::array<double, 2> b = {uniform(random), uniform(random)};
    values.insert(values.end(), {a, {b[0], a[1]}, {a[0], b[1]}, b});
  }
  for (long row = 1; row <= 560; ++row) s_.design_rows.push_back({0, row, row});
  submit("sobol", values, {"strength", "offset"});
  runs_[5].result.reset(), runs_[5].status = RunStatus::hung;
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  ASSERT_EQ(s.frozen, (std::vector<std::string>{"strength", "offset"}));
  const MetricSensitivity& chi_bar = s.metrics.at(0);
  EXPECT_EQ(chi_bar.n_base_samples, 139) << "the one with a row that has no result is left out";
  EXPECT_NEAR(chi_bar.sobol.at(0).total.value, 1, 3 * chi_bar.sobol.at(0).total.standard_error);
  EXPECT_NEAR(chi_bar.sobol.at(0).first.value, 1, 1e-12);
  EXPECT_NEAR(chi_bar.sobol.at(1).total.value, 0, 1e-12);
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer), HasSubstr("total order, by pick-freeze"));
  EXPECT_THAT(render_text(answer), HasSubstr("139 of 140")) << "beside the totals";
  const auto document = render_json(answer);
  EXPECT_EQ(document.at("base_samples"), 140);
  const auto& total = document.at("indices").back();
  EXPECT_EQ(total.at("order"), "total");
  EXPECT_EQ(total.at("parameter"), "offset");
  EXPECT_EQ(total.at("base_samples"), 139);
  EXPECT_EQ(total.at("value").get<double>(), chi_bar.sobol.at(1).total.value);
  // Of some of the cases there are no whole base samples.
  EXPECT_TRUE(analyse_sensitivity(*store_, campaign_, {.cases = {.where = "offset < 0.9 m"}})
                  .frozen.empty());
}

/// Activations have no depth where nothing slides: those rows are left out with their parameters.
TEST_F(AnswersTest, SensitivityOfWhatNotAllCasesHaveIsThatOfThoseThatHaveIt) {
  submit("monte-carlo", even(400));
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    faultsim::FaultStageMetrics& fault = runs_[k].result->whole.faults[0];
    if (fault.activation) fault.activation->depth = 2000 + *s_.cases[k].parameters[1].si;
  }
  record();
  const Sensitivity some =
      analyse_sensitivity(*store_, campaign_, {.metrics = "F1.activation_depth"});
  ASSERT_EQ(some.metrics.at(0).n, 200);
  EXPECT_LT(std::abs(some.metrics[0].first_order[0].value), 0.4) << "strength";
  EXPECT_GT(some.metrics[0].first_order[1].value, 0.9) << "offset, of which the depth is made";
}

/// Rows A, AB_1, AB_2, BA_1, BA_2, B.
TEST_F(AnswersTest, ASobolDesignOfSecondOrderHasTheSameIndices) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::array<double, 2>> values;
  for (int k = 0; k < 140; ++k) {
    const std::array<double, 2> a = {uniform(random), uniform(random)};
    const std::array<double, 2> b = {uniform(random), uniform(random)};
    values.insert(values.end(), {a, {b[0], a[1]}, {a[0], b[1]}, {a[0], b[1]}, {b[0], a[1]}, b});
    values[values.size() - 3][1] += 1e-6, values[values.size() - 2][1] += 1e-6;  // no twins
  }
  for (long row = 1; row <= 840; ++row) s_.design_rows.push_back({0, row, row});
  submit("sobol", values, {"strength", "offset"}, true);
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  const MetricSensitivity& chi_bar = s.metrics.at(0);
  EXPECT_EQ(chi_bar.n_base_samples, 140);
  EXPECT_EQ(chi_bar.n, 280) << "A and B";
  EXPECT_NEAR(chi_bar.sobol.at(0).first.value, 1, 1e-12) << "B and AB_1 have the same strength";
  EXPECT_NEAR(chi_bar.sobol.at(0).total.value, 1, 3 * chi_bar.sobol.at(0).total.standard_error);
  EXPECT_NEAR(chi_bar.sobol.at(1).first.value, 0, 4 * chi_bar.sobol.at(1).first.standard_error);
  EXPECT_NEAR(chi_bar.sobol.at(1).total.value, 0, 1e-12);
}

/// Every second case is plane strain: its moments are per metre, and --where tells them apart.
TEST_F(AnswersTest, OfAMixedCampaignOneKindCanBeChosen) {
  submit("monte-carlo", even(300));
  for (std::size_t k = 0; k < runs_.size(); k += 2) runs_[k].result->plane_strain = true;
  // Only those in three dimensions have F3, and a last stage.
  for (std::size_t k = 1; k < runs_.size(); k += 2) {
    faultsim::CaseResult& result = *runs_[k].result;
    result.fault_names.push_back("F3");
    result.stages.push_back(result.stages.back());
    result.stages.back().stage = "abandonment";
    for (faultsim::StepResult& step : result.steps) step.faults.push_back(step.faults.back());
    for (faultsim::StageMetrics& stage : result.stages) {
      stage.faults.push_back(stage.faults.back());
      stage.faults.back().fault = "F3";
    }
    result.whole.faults.push_back(result.whole.faults.back());
    result.whole.faults.back().fault = "F3";
  }
  record();
  const auto is_plane = [&](const SampledCases& cases) {
    return analyse_sensitivity(*store_, campaign_, {.cases = cases, .metrics = "moment"})
        .plane_strain;
  };
  EXPECT_TRUE(is_plane({.where = "plane_strain"}));
  EXPECT_FALSE(is_plane({.where = "not plane_strain"}));
  EXPECT_FALSE(is_plane({.stage = "abandonment"}));
  EXPECT_FALSE(is_plane({.fault = "F3"}));
  EXPECT_THROW(is_plane({}), InputError);
  EXPECT_THROW(is_plane({.stage = "gas_storage", .fault = "F1"}), InputError);
  const auto quantiles = [&](const std::string& where) {
    return find_quantiles(*store_, campaign_, {.metrics = "moment", .where = where});
  };
  EXPECT_EQ(quantiles("plane_strain").metrics.at(0).n, 150);
  EXPECT_TRUE(quantiles("plane_strain").plane_strain);
  EXPECT_FALSE(quantiles("not plane_strain").plane_strain);
  EXPECT_THROW(quantiles("strength > 0.2"), InputError);
}

/// A case may have −1 of what the cases of another group have not at all.
TEST_F(FrictionAndOffset, AParameterThatAGroupLacksDiffersFromAnyValue) {
  for (int k = 0; k < 4; ++k) {
    CaseParameters values = both(k, -1);
    if (k < 2) values.pop_back();
    add_case(values, testing::made_up_result(0.2 + 0.1 * k));
  }
  submit_as("grid");
  record();
  const Sample sample = read_sample(*store_, campaign_, {}, "F1.chi_bar");
  ASSERT_EQ(sample.x.size(), 2u) << "it varies";
  EXPECT_LT(sample.x[1][0], -1e300);
  EXPECT_EQ(sample.x[1][2], -1);
}

TEST_F(AnswersTest, TooFewCasesAreRefused) {
  submit("monte-carlo", even(10));
  record();
  EXPECT_THROW(analyse_sensitivity(*store_, campaign_, {}), InputError);
}

}  // namespace
}  // namespace faultsweep
