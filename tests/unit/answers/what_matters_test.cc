// What matters in campaigns that are no sample: trajectories of a morris design, one parameter at a
// time, whole grids.
#include "campaign/answers/sensitivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/answers/one_at_a_time.h"
#include "campaign/answers/screening.h"
#include "campaign/render/render.h"
#include "campaign/reports/ranking_answer.h"
#include "tests/unit/answers/answers_fixture.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class WhatMatters : public FrictionAndOffset {
 protected:
  /// A case with χ̄ = strength of F1.
  void add(const CaseParameters& parameters, double strength) {
    add_case(parameters, testing::made_up_result(strength));
  }
  /// χ̄ = 0.1 + 0.3 of the whole range of friction, 0.4 to 0.7, + 0.15 of that of the offset, 0 to
  /// 120 m, + 0.06 of both together.
  void add_trajectories(int n) {
    std::mt19937_64 random(3);
    const auto strength = [](const int(&level)[2]) {
      const double a = level[0] / 3.0, b = level[1] / 3.0;
      return 0.1 + 0.3 * a + 0.15 * b + 0.06 * a * b;
    };
    for (int t = 0; t < n; ++t) {
      int level[2] = {static_cast<int>(random() % 4), static_cast<int>(random() % 4)};
      const std::size_t first = random() % 2;
      const auto row = [&] { add(both(0.4 + 0.1 * level[0], 40.0 * level[1]), strength(level)); };
      row();
      for (const std::size_t k : {first, 1 - first}) {
        level[k] += level[k] < 2 ? 2 : -2;
        row();
      }
    }
  }
  /// Each case gets what follows from its offset.
  void add_throws() {
    s_.parameters = {{"friction", Dimension::number, false},
                     {"offset", Dimension::length, false},
                     {"throw", Dimension::length, false}};
    for (auto& one : s_.cases) {
      const double offset = one.parameters.at(1).si.value();
      one.parameters.push_back({2, 2 * offset, std::to_string(2 * offset) + " m"});
    }
  }
  Screening screened() {
    const auto found = screen(*store_, campaign_, {.metrics = "F1.chi_bar"});
    EXPECT_TRUE(found);
    return found.value();
  }
};

/// Of the model above the effect of friction is 0.3 + 0.06 b: 0.33 on average.
TEST_F(WhatMatters, TrajectoriesGiveElementaryEffects) {
  add_trajectories(60);
  submit_as("morris");
  record();
  const Screening s = screened();
  EXPECT_EQ(s.n_trajectories, 60);
  const auto& [friction, offset] =
      std::tie(s.metrics.at(0).effects.at(0), s.metrics[0].effects.at(1));
  EXPECT_EQ(friction.n, 60);
  EXPECT_LT(friction.mean_magnitude.bounds.low, 0.33);
  EXPECT_GT(friction.mean_magnitude.bounds.high, 0.33);
  EXPECT_NEAR(friction.mean_magnitude.value, 0.33, 0.01);
  EXPECT_NEAR(offset.mean.value, 0.18, 0.01);
  EXPECT_GT(friction.deviation.value, 0.01) << "it depends on the offset";
  EXPECT_LT(friction.deviation.value, 0.03);
  const Answer answer = what_matters(*store_, campaign_, {.metrics = "F1.chi_bar"});
  testing::expect_same_renderings(answer);
  EXPECT_THAT(answer.headline.at(0),
              HasSubstr("F1.chi_bar changes most with friction: by 0.33 over its "
                        "whole range on average (0.32 to 0.3"));
  const json document = render_json(answer);
  EXPECT_EQ(document.at("kind"), "effects");
  EXPECT_EQ(document.at("effects").at(0).at("parameter"), "friction");
  EXPECT_EQ(document.at("effects").at(0).at("mean_magnitude").get<double>(),
            friction.mean_magnitude.value);
}

TEST_F(WhatMatters, FewTrajectoriesHaveNoIntervals) {
  add_trajectories(10);
  submit_as("morris");
  record();
  const Screening s = screened();
  EXPECT_GT(s.metrics.at(0).effects.at(0).mean_magnitude.value, 0.3);
  EXPECT_TRUE(std::isnan(s.metrics[0].effects[0].mean_magnitude.bounds.low));
  EXPECT_TRUE(std::isnan(s.metrics[0].effects[0].deviation.bounds.low));
  const std::string text = render_text(to_answer(s), 1000);
  EXPECT_THAT(text, HasSubstr("10 trajectories: intervals of μ* and μ need at least 30 and are "
                              "left out, those of σ need 50."));
  EXPECT_THAT(text, Not(HasSubstr("±")));
}

/// A row that is missing takes the effects before and behind it along, and no others.
TEST_F(WhatMatters, AMissingRowTakesItsEffectsAlong) {
  add_trajectories(60);
  submit_as("morris");
  runs_[4].result.reset(), runs_[4].status = RunStatus::hung;  // in the middle of the second
  record();
  const Screening s = screened();
  EXPECT_EQ(s.n_without, 1);
  EXPECT_EQ(s.metrics.at(0).effects.at(0).n, 59);
  EXPECT_EQ(s.metrics[0].effects.at(1).n, 59);
  EXPECT_THAT(render_text(to_answer(s), 1000), HasSubstr("179 of 180 rows; each without"));
}

TEST_F(WhatMatters, TrajectoriesAreNotTakenApart) {
  add_trajectories(30);
  submit_as("morris");
  record();
  EXPECT_THROW(screen(*store_, campaign_, {.cases = {.where = "offset < 50 m"}}), InputError);
}

/// The first case is the base case, each other one differs from it in one parameter; a row that is
/// the base case once more moves nothing.
TEST_F(WhatMatters, OneAtATimeIsATornado) {
  add(both(0.5, 60), 0.3);
  add(both(0.4, 60), 0.45);
  add(both(0.7, 60), 0.25);
  add(both(0.5, 0), 0.3);
  add(both(0.5, 120), 0.62);
  for (const long position : {1, 2, 1, 3, 4, 5})
    s_.design_rows.push_back({0, static_cast<long>(s_.design_rows.size()) + 1, position});
  submit_as("one-at-a-time");
  record();
  const auto found = compare_one_at_a_time(*store_, campaign_, {.metrics = "F1.chi_bar"});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->tornados.size(), 1u);
  EXPECT_EQ(found->tornados[0].moves.size(), 4u);
  EXPECT_EQ(found->tornados[0].base.position, 1);
  const Answer answer = what_matters(*store_, campaign_, {.metrics = "F1.chi_bar"});
  testing::expect_same_renderings(answer);
  EXPECT_EQ(answer.headline.at(0),
            "F1.chi_bar is 0.3 in the base case; it changes most with offset: 0.3 (base) to 0.62 "
            "(120.000000 m).");
  const json moves = render_json(answer).at("moves");
  ASSERT_EQ(moves.size(), 5u);
  EXPECT_EQ(moves[1].at("parameter"), "friction");
  EXPECT_NEAR(moves[1].at("change").get<double>(), 0.15, 1e-12);
  EXPECT_EQ(moves[4].at("case"), 5);
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("was not computed"));
  EXPECT_NE(first_chart(answer).find("<svg"), std::string::npos);
}

/// The offset moves the metric by rounding only: that is no change.
TEST_F(WhatMatters, RoundingIsNoSwing) {
  add(both(0.5, 60), 0.3);
  add(both(0.4, 60), 0.45);
  add(both(0.5, 120), 0.3 + 1e-14);
  submit_as("one-at-a-time");
  record();
  const Answer answer = what_matters(*store_, campaign_, {.metrics = "F1.chi_bar"});
  testing::expect_same_renderings(answer);
  EXPECT_THAT(first_chart(answer), HasSubstr("no change"));
  EXPECT_THAT(first_chart(answer), Not(HasSubstr("120")));
}

/// What is derived from a parameter moves with it, and is no move of its own.
TEST_F(WhatMatters, DerivedParametersAreNotMoved) {
  add(both(0.5, 60), 0.3);
  add(both(0.4, 60), 0.45);
  add(both(0.5, 120), 0.62);
  add_throws();
  submit_as("one-at-a-time");
  record();
  const auto found = compare_one_at_a_time(*store_, campaign_, {.metrics = "F1.chi_bar"});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->tornados.at(0).moves.size(), 2u);
  EXPECT_EQ(found->tornados[0].moves[1].parameter, 1u);
  EXPECT_EQ(found->tornados[0].n_unplaced, 0);
}

/// Nor is it a factor of a grid or a move of a trajectory: the throw follows from the offset.
TEST_F(WhatMatters, DerivedParametersExplainNothingOfTheirOwn) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 4; ++b) add(both(a, b), 0.1 * a + 0.05 * b);
  add_throws();
  submit_as("grid");
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  EXPECT_THAT(s.parameters, ElementsAre("friction", "offset"));
  EXPECT_NEAR(s.metrics.at(0).total_order.at(0) + s.metrics[0].total_order.at(1), 1, 1e-12);
  EXPECT_THAT(render_text(to_answer(s), 1000),
              HasSubstr("Computed from others, so not told apart from them: throw."));
}

TEST_F(WhatMatters, DerivedParametersAreNoMovesOfTrajectories) {
  add_trajectories(40);
  add_throws();
  submit_as("morris");
  record();
  const Screening s = screened();
  EXPECT_THAT(s.parameters, ElementsAre("friction", "offset"));
  EXPECT_EQ(s.n_trajectories, 40);
  EXPECT_THAT(render_text(to_answer(s), 1000), HasSubstr("not told apart from them: throw."));
}

TEST_F(WhatMatters, WithoutItsBaseCaseNothingChanges) {
  add(both(0.5, 60), 0.3);
  add(both(0.4, 60), 0.45);
  submit_as("one-at-a-time");
  runs_[0].result.reset(), runs_[0].status = RunStatus::hung;
  record();
  EXPECT_THROW(compare_one_at_a_time(*store_, campaign_, {}), InputError);
}

/// 90 rows: the indices are the finite sums, here made from all triples directly.
TEST_F(WhatMatters, IndicesOfAWholeGridAreFiniteSums) {
  constexpr int kA = 9, kB = 10;
  double y[kA][kB], mean = 0;
  for (int a = 0; a < kA; ++a) {
    for (int b = 0; b < kB; ++b) {
      y[a][b] = 0.1 + 0.2 * std::sin(0.7 * a) * std::cos(0.3 * b) + 0.01 * b;
      mean += y[a][b] / (kA * kB);
      add(both(a, 10.0 * b), y[a][b]);
    }
  }
  submit_as("grid");
  record();
  double variance = 0, first_a = 0, total_a = 0;
  for (int a = 0; a < kA; ++a) {
    double row = 0;
    for (int b = 0; b < kB; ++b) {
      variance += (y[a][b] - mean) * (y[a][b] - mean) / (kA * kB);
      row += y[a][b] / kB;
      double column = 0;
      for (int other = 0; other < kA; ++other) column += y[other][b] / kA;
      total_a += (y[a][b] - column) * (y[a][b] - column) / (kA * kB);
    }
    first_a += (row - mean) * (row - mean) / kA;
  }
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  EXPECT_NEAR(s.metrics.at(0).first_order.at(0).value, first_a / variance, 1e-12);
  EXPECT_NEAR(s.metrics[0].total_order.at(0), total_a / variance, 1e-12);
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  EXPECT_EQ(render_json(answer).at("indices").back().at("order"), "total");
}

/// What is left of a grid has shares of levels, and no totals.
TEST_F(WhatMatters, AGridThatIsNotWholeHasNoTotals) {
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) add(both(a, b), 0.1 * a);
  submit_as("grid");
  runs_[5].result.reset(), runs_[5].status = RunStatus::hung;
  record();
  const Sensitivity s = analyse_sensitivity(*store_, campaign_, {.metrics = "F1.chi_bar"});
  EXPECT_NEAR(s.metrics.at(0).first_order.at(0).value, 1, 1e-12);
  EXPECT_TRUE(s.metrics[0].total_order.empty());
  EXPECT_THAT(render_text(to_answer(s), 1000), HasSubstr("the grid is incomplete"));
}

TEST_F(WhatMatters, FewRandomCasesAreRefused) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 127; ++k) add(both(uniform(random), uniform(random)), uniform(random));
  submit_as("monte-carlo");
  record();
  try {
    what_matters(*store_, campaign_, {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("127 cases with a full history are too few: intervals of "
                                        "indices need at least 128"));
  }
}

/// χ̄ that is 1 but for rounding, or 0, does not depend on anything.
TEST_F(WhatMatters, RoundingIsNotExplained) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double friction = uniform(random);
    add(both(friction, uniform(random)), 0.25 + 1e-15 * friction);
  }
  submit_as("monte-carlo");
  record();
  const Answer answer = what_matters(*store_, campaign_, {.metrics = "F1.chi_bar"});
  EXPECT_EQ(answer.headline.at(0), "None of these metrics varies.");
  EXPECT_THAT(render_text(answer, 1000), HasSubstr("The same in all cases: F1.chi_bar."));
  const auto indices = render_json(answer).at("indices");
  for (const auto& one : indices) EXPECT_EQ(one.at("value"), 0);
}

/// Of a metric that few rows have, and of a flag that is rare, nothing is said, in words.
TEST_F(WhatMatters, MetricsWithFewRowsHaveNoIndices) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double friction = uniform(random);
    add(both(friction, uniform(random)), k < 12 ? 0.9 : 0.3 * friction);  // above 0.5 it slides
  }
  submit_as("monte-carlo");
  record();
  const Sensitivity s = analyse_sensitivity(
      *store_, campaign_, {.metrics = "F1.chi_bar, F1.slides, F1.activation_depth"});
  EXPECT_EQ(s.metrics.at(0).first_order.size(), 2u);
  EXPECT_TRUE(s.metrics.at(1).first_order.empty());
  EXPECT_TRUE(s.metrics.at(2).first_order.empty());
  const Answer answer = to_answer(s);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text, HasSubstr("Without indices, as intervals need more rows: F1.slides (true in 12 "
                              "rows of 20), F1.activation_depth (12 rows of 128)."));
}

/// Answers over interpolated results say so, with their errors, and how many there are.
TEST_F(AnswersTest, AnswersSayHowTheirResultsCameAbout) {
  submit("monte-carlo", even(200));
  for (std::size_t k = 0; k < 50; ++k) {
    runs_[k].result->surface = faultsim::CaseSurface{75, 73, 12, 0.01, 2e-3, 3e-3, 4e-3, 5e-3};
    runs_[k].result->surface->slip = k == 7 ? 0.0123 : 5e-3;
  }
  for (std::size_t k = 0; k < 200; ++k) runs_[k].result->field_coverage = k == 3 ? 0.74 : 1.0;
  record();
  const char* interpolated =
      "50 of 200 results have an interpolated operator, off by at most 0.002 in H and 0.012 in "
      "slip without friction (relative errors, where measured); the others have exact operators.";
  const char* covered =
      "1 of 200 results use a flow result that covers the compartments only in part: at least "
      "74 % of them.";
  const Ranking ranking = make_ranking(*store_, campaign_, {.top = 0});
  for (const Answer& answer :
       {to_answer(probability({})), to_answer(analyse_sensitivity(*store_, campaign_, {})),
        to_answer(ranking), to_answer(why(1))}) {
    const std::string text = render_text(answer, 100000);
    EXPECT_THAT(text, HasSubstr(interpolated));
    EXPECT_THAT(text, HasSubstr(covered));
  }
  long n_interpolated = 0;
  const auto rows = render_json(to_answer(ranking)).at("cases");
  for (const auto& row : rows) n_interpolated += row.at("interpolated").get<bool>() ? 1 : 0;
  EXPECT_EQ(n_interpolated, 50);
  EXPECT_EQ(probability({.condition = "interpolated"}).shares.at(0).counts.n_holds, 50);
  EXPECT_EQ(probability({.condition = "surface_error > 0.01"}).shares.at(0).counts.n_holds, 1);
  EXPECT_EQ(probability({.condition = "field_coverage < 0.8"}).shares.at(0).counts.n_holds, 1);
}

}  // namespace
}  // namespace faultsweep
