// Probabilities, curves, quantiles and posteriors of made-up campaigns whose answers are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/answers/curves.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/probability.h"
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

TEST(DefaultConditions, NameFaultsAndStagesThatAreNoWords) {
  Selection selection;
  selection.faults = {
      {1, "F2"}, {2, "western end"}, {3, "7"}, {4, "F-3"}, {7, R"(5" 'old', \west)"}};
  selection.stages = {{5, ""}, {6, "first \"year\""}};
  Symbols symbols;
  for (const auto& [name, metric] : known_metrics(selection))
    symbols[name] = {metric.sql, Type{metric.is_flag ? Kind::boolean : Kind::number, {}}};
  const std::vector<std::string> conditions = default_conditions(selection);
  EXPECT_EQ(conditions.size(), 10u);
  EXPECT_EQ(conditions[0], "F2.slides");
  EXPECT_EQ(conditions[3], "\"western end\".slides in 'first \"year\"'");
  for (const std::string& one : conditions)
    EXPECT_NO_THROW(Expression::parse(one, symbols, scopes_of(selection))) << one;
}

TEST_F(AnswersTest, AProbabilityIsAShareWithExactBounds) {
  submit("monte-carlo", even(40));
  record();
  const Probability p = probability({.condition = "F1.slides"});
  ASSERT_EQ(p.shares.size(), 1u);
  EXPECT_TRUE(p.sampling.is_random);
  EXPECT_EQ(p.shares[0].counts.n, 40);
  EXPECT_EQ(p.shares[0].counts.n_holds, 20);
  EXPECT_EQ(p.shares[0].counts.estimate(), 0.5);
  EXPECT_EQ(p.shares[0].bounds.low, proportion_bounds(20, 40, 0.95).low);
  EXPECT_EQ(p.shares[0].bounds.high, proportion_bounds(20, 40, 0.95).high);
  EXPECT_GT(p.n_for_half, 120);
  EXPECT_THAT(render_text(to_answer(p)),
              HasSubstr("F1.slides: 20 of 40 cases, 50 % (33.8 to 66.2 %)."));
}

TEST_F(AnswersTest, WhatIsNotKnownMayBeEither) {
  submit("monte-carlo", even(40));
  runs_[0].result.reset(), runs_[0].status = RunStatus::hung;
  runs_[39].result->outcome = faultsim::Outcome::unstable;
  record();
  const Probability p = probability({.condition = "F1.slides"});
  const Share& share = p.shares.at(0);
  EXPECT_EQ(share.counts.n, 40);
  EXPECT_EQ(share.counts.n_unknown, 2);
  EXPECT_EQ(share.counts.n_holds, 19);
  EXPECT_EQ(share.counts.estimate(), 0.5);
  EXPECT_EQ(share.bounds.low, proportion_bounds(19, 40, 0.95).low);
  EXPECT_EQ(share.bounds.high, proportion_bounds(21, 40, 0.95).high);
  // A bar stands at the share of what is known, and beside it are the numbers it is made of.
  const faultsim::figure::IntervalChart::Row bar = chart_of(p).rows.at(0);
  EXPECT_EQ(bar.value.value, 19.0 / 38);
  EXPECT_EQ(bar.note, "19 of 38, 2 unknown");
}

TEST_F(AnswersTest, IsAskedForEachPartOfAParameter) {
  submit("monte-carlo", even(40));
  record();
  const Probability parts = probability({.condition = "F1.slides", .by = "strength"});
  ASSERT_EQ(parts.shares.size(), 10u);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_EQ(parts.shares[k].counts.n, 4) << k;
    EXPECT_EQ(parts.shares[k].counts.estimate(), k < 5 ? 0 : 1) << parts.shares[k].label;
  }
  const Probability words = probability({.condition = "F1.slides", .by = "rule"});
  ASSERT_EQ(words.shares.size(), 2u);
  EXPECT_EQ(words.shares[0].label, "mean");
  EXPECT_EQ(words.shares[0].counts.n, 20);
  EXPECT_THROW(probability({.by = "ofset"}), InputError);
  EXPECT_THROW(probability({.where = "offset > 1000 m"}), InputError);
  EXPECT_GT(probability({}).shares.size(), 2u) << "each fault, each stage";
}

/// Ten parts differ by one row at most, and none is left out.
TEST_F(AnswersTest, PartsHaveAllRowsWhateverTheirNumber) {
  submit("monte-carlo", even(43));
  record();
  const Probability parts = probability({.condition = "F1.slides", .by = "offset"});
  ASSERT_EQ(parts.shares.size(), 10u);
  long n = 0, n_holds = 0;
  for (const Share& one : parts.shares) {
    EXPECT_GE(one.counts.n, 4);
    EXPECT_LE(one.counts.n, 5);
    n += one.counts.n, n_holds += one.counts.n_holds;
  }
  EXPECT_EQ(n, 43);
  EXPECT_EQ(n_holds, probability({.condition = "F1.slides"}).shares.at(0).counts.n_holds);
}

/// Of 60 offsets 25 are the same: they stand in one part.
TEST_F(AnswersTest, PartsDoNotSplitEqualValues) {
  std::vector<std::array<double, 2>> values = even(60);
  for (std::size_t k = 0; k < 60; ++k)
    values[k][1] = k % 12 < 5 ? 100 : 10 * static_cast<double>(k) + 1;
  submit("monte-carlo", values);
  record();
  const Probability parts = probability({.condition = "F1.slides", .by = "offset"});
  long n = 0, n_parts_of_it = 0;
  for (const Share& one : parts.shares) {
    n += one.counts.n;
    n_parts_of_it += one.label.find("100 ") != std::string::npos ? 1 : 0;
    EXPECT_GT(one.counts.n, 0);
  }
  EXPECT_EQ(n, 60);
  EXPECT_EQ(n_parts_of_it, 1);
  EXPECT_LT(parts.shares.size(), 10u);
}

/// To halve the distance between the bounds takes as many cases as bring the half of it.
TEST_F(AnswersTest, HalfTheDistanceBetweenTheBoundsIsReachedWithTheCasesSaid) {
  submit("monte-carlo", even(40));
  record();
  const Probability p = probability({.condition = "F1.slides"});
  const Interval now = p.shares[0].bounds;
  const Interval then = proportion_bounds(p.n_for_half / 2, p.n_for_half, 0.95);
  EXPECT_NEAR(then.high - then.low, 0.5 * (now.high - now.low), 0.005);
}

TEST_F(AnswersTest, SharesOfChosenCasesAreNoProbabilities) {
  submit("list", even(24));
  record();
  const Probability p = probability({.condition = "F1.slides"});
  EXPECT_THAT(render_text(to_answer(p)), HasSubstr("not drawn at random"));
  EXPECT_EQ(p.shares.at(0).bounds.low, 0.5) << "no sample, no bound";
  EXPECT_EQ(p.shares.at(0).bounds.high, 0.5);
  EXPECT_THROW(analyse_sensitivity(*store_, campaign_, {}), InputError);
}

/// In each block of D + 2 rows only the first and the last are of the sample.
TEST_F(AnswersTest, OfASobolDesignTheIndependentBlocksCount) {
  submit("sobol", even(30), {"strength"});
  record();
  store_.reset();
  std::filesystem::remove_all(folder_ / "store");
  store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  for (long row = 1; row <= 30; ++row) s_.design_rows.push_back({0, row, row});
  store_->submit(s_);
  campaign_ = store_->campaign("");
  record();
  EXPECT_EQ(probability({.condition = "F1.slides"}).shares.at(0).counts.n, 20)
      << "of 10 blocks of 3";
}

/// Fault f of the k-th of n cases begins to slide at the end of step k, at −k bar, but F2 never.
TEST_F(AnswersTest, ACurveCountsTheFaultsThatHaveBegunToSlide) {
  submit("monte-carlo", even(12));
  for (std::size_t k = 0; k < 12; ++k) {
    faultsim::CaseResult& result = *runs_[k].result;
    const int step = static_cast<int>(k) + 1;
    for (faultsim::StageMetrics* stage :
         {&result.whole, &result.stages[0], &result.stages[1], &result.stages[2]}) {
      stage->faults[1].activation.reset();
      stage->faults[0].activation.reset();
      if (stage->first_step > step || stage->last_step < step) continue;
      stage->faults[0].activation =
          faultsim::FaultOnset{step, 2000, testing::made_up_pressures(-1e5 * step)};
    }
  }
  // One whose fault never slid up to step 6, where it ends, and one without any result.
  runs_[10].result->outcome = faultsim::Outcome::unstable;
  for (faultsim::FaultStageMetrics& fault : runs_[10].result->whole.faults)
    fault.activation.reset();
  runs_[10].result->whole.last_step = 6;
  runs_[11].result.reset(), runs_[11].status = RunStatus::hung;
  record();
  const Curves steps = probability_curves(*store_, campaign_, {CurveAxis::step});
  ASSERT_EQ(steps.curves.size(), 2u);
  const Curve& f1 = steps.curves[0];
  EXPECT_EQ(f1.fault, "F1");
  ASSERT_EQ(f1.points.size(), 13u);
  for (long k = 0; k <= 12; ++k) {
    const CurvePoint& point = f1.points[static_cast<std::size_t>(k)];
    EXPECT_EQ(point.at, static_cast<double>(k));
    const ShareCounts& c = point.counts;
    EXPECT_EQ(c.n_holds, std::min(k, 10L)) << k;
    EXPECT_EQ(c.n_unknown, k <= 6 ? 1 : 2) << k;
    EXPECT_EQ(c.n_undecided, 0) << "steps are whole";
    const Interval bounds = proportion_bounds(c.n_holds, c.n_unknown, 12, 0.95);
    EXPECT_EQ(point.bounds.low, bounds.low);
    EXPECT_EQ(point.bounds.high, bounds.high);
    EXPECT_EQ(steps.curves[1].points[static_cast<std::size_t>(k)].counts.n_holds, 0) << "F2 never";
  }
  const Curves times = probability_curves(*store_, campaign_, {CurveAxis::time});
  EXPECT_EQ(times.curves[0].points[4].at, 4 * 3.15576e7);
  EXPECT_EQ(times.curves[0].points[4].counts.n_holds, 4);
  EXPECT_EQ(times.curves[0].points[7].counts.n_unknown, 2);
  EXPECT_THAT(render_csv(table_named(to_answer(times), "curves")), HasSubstr("\nF1,,126230400,"));
}

TEST_F(AnswersTest, ACurveAgainstPressureGoesTheWayOfTheStage) {
  submit("monte-carlo", even(12));
  for (std::size_t k = 0; k < 12; ++k) {
    for (faultsim::StageMetrics& stage : runs_[k].result->stages) {
      for (faultsim::FaultStageMetrics& fault : stage.faults) fault.activation.reset();
      stage.faults[0].activation = faultsim::FaultOnset{
          stage.last_step, 2000, testing::made_up_pressures(-5e5 * static_cast<double>(k))};
    }
  }
  record();
  const Curves curves = probability_curves(*store_, campaign_, {CurveAxis::pressure});
  ASSERT_EQ(curves.curves.size(), 6u) << "two faults in three stages";
  const Curve& first = curves.curves[0];
  EXPECT_EQ(first.stage, "primary_production");
  EXPECT_TRUE(first.falls);
  EXPECT_EQ(first.points.front().at, 0);
  EXPECT_LE(first.points.back().at, -2e7 / 3) << "the way of the stage";
  for (const CurvePoint& point : first.points) {
    long expected = 0;
    for (int k = 0; k < 12; ++k) expected += -5e5 * k >= point.at;
    EXPECT_EQ(point.counts.n_holds, expected) << point.at;
  }
  EXPECT_THAT(render_text(to_answer(curves)), HasSubstr("in gas_storage"));
  EXPECT_EQ(render_json(to_answer(curves)).at("against"), "pressure_change_pa");
  EXPECT_EQ(
      probability_curves(*store_, campaign_, {.axis = CurveAxis::pressure, .stage = "gas_storage"})
          .curves.size(),
      2u);
  EXPECT_THROW(probability_curves(*store_, campaign_, {.where = "offset > 1000 m"}), InputError);
}

/// A stage begins where the one before has ended, and its curve with it.
TEST_F(AnswersTest, ACurveAgainstPressureBeginsWhereItsStageDoes) {
  submit("monte-carlo", even(12));
  for (RunRecord& run : runs_) {
    for (faultsim::StageMetrics& stage : run.result->stages)
      for (faultsim::FaultStageMetrics& fault : stage.faults) fault.activation.reset();
  }
  record();
  const std::vector<faultsim::StepResult>& steps = runs_[0].result->steps;
  for (const faultsim::StageMetrics& stage : runs_[0].result->stages) {
    const Curves found =
        probability_curves(*store_, campaign_, {.axis = CurveAxis::pressure, .stage = stage.stage});
    const double begin = steps[static_cast<std::size_t>(stage.first_step - 1)].pressure_change[0];
    const double end = steps[static_cast<std::size_t>(stage.last_step)].pressure_change[0];
    const std::vector<CurvePoint>& points = found.curves.at(0).points;
    const double distance = points[0].at - points[1].at;
    EXPECT_GT(distance, 0) << "it falls";
    EXPECT_GE(points.front().at, begin - 1) << stage.stage;
    EXPECT_LT(points.front().at, begin + distance) << stage.stage;
    EXPECT_LE(points.back().at, end + 1) << stage.stage;
    EXPECT_GT(points.back().at, end - distance) << stage.stage;
  }
}

/// χ̄ of F1 is its strength below 1, so what is seen of the one is seen of the other.
TEST_F(AnswersTest, APosteriorIsThePriorWeightedByWhatWasSeen) {
  submit("monte-carlo", even(1000));
  record();
  const auto posterior = [&](std::vector<std::string> seen) {
    return find_posterior(*store_, campaign_, {std::move(seen), {"F1.slides"}, "", 0.95});
  };
  const Posterior p = posterior({"F1.chi_bar = 0.5 +- 0.05"});
  ASSERT_EQ(p.parameters.size(), 2u);
  EXPECT_EQ(p.parameters[0].name, "strength");
  EXPECT_NEAR(p.parameters[0].before[0].estimate, 0.05, 0.002);
  EXPECT_NEAR(p.parameters[0].after[0].estimate, 0.5 - 1.644854 * 0.05, 0.002);
  EXPECT_NEAR(p.parameters[0].after[1].estimate, 0.5, 0.002);
  EXPECT_NEAR(p.parameters[0].after[2].estimate, 0.5 + 1.644854 * 0.05, 0.002);
  EXPECT_NEAR(p.parameters[1].after[1].estimate, 150, 30) << "offset says nothing";
  EXPECT_EQ(p.parameters[1].unit, "m");
  EXPECT_NEAR(p.probabilities.at(0).after.value, 0.5, 0.01);
  EXPECT_NEAR(p.effective_size, 1000 * 0.05 * 2 * std::sqrt(std::acos(-1.0)), 2);
  ASSERT_EQ(p.words.size(), 2u);
  EXPECT_NEAR(p.words[0].after.value, 0.5, 0.01);
  EXPECT_THAT(render_text(to_answer(p)), HasSubstr("effective sample of"));
  EXPECT_EQ(render_json(to_answer(p)).at("rows"), 1000);
  // Half of the cases agree with what is exact, and it makes the condition certain.
  const Posterior slid = posterior({"F1 slid before 2 yr"});
  EXPECT_NEAR(slid.agreement.at(0), 0.5, 1e-9);
  EXPECT_NEAR(slid.effective_size, 500, 1e-6);
  EXPECT_EQ(slid.probabilities.at(0).after.value, 1);
  EXPECT_NEAR(slid.probabilities.at(0).before.value, 0.5, 1e-9);
  EXPECT_THAT(render_text(to_answer(slid)), HasSubstr("taken as exact"));
}

/// Errors are independent: two statements weigh a case by the product of what each does.
TEST_F(AnswersTest, StatementsWeighTogether) {
  submit("monte-carlo", even(2000));
  record();
  const auto posterior = [&](std::vector<std::string> seen) {
    return find_posterior(*store_, campaign_, {std::move(seen), {"F1.slides"}, "", 0.95});
  };
  // Of two normal errors the weights are those of one: 1/σ² adds, and the mean is weighted by it.
  const Posterior both = posterior({"F1.chi_bar = 0.4 +- 0.1", "F1.chi_bar = 0.6 +- 0.05"});
  const Posterior one = posterior({"F1.chi_bar = 0.56 +- 0.0447213595499958"});
  for (std::size_t q = 0; q < 3; ++q)
    EXPECT_NEAR(both.parameters[0].after[q].estimate, one.parameters[0].after[q].estimate, 1e-9);
  EXPECT_NEAR(both.probabilities[0].after.value, one.probabilities[0].after.value, 1e-9);
  EXPECT_NEAR(both.effective_size, one.effective_size, 1e-6);
  const Posterior turned = posterior({"F1.chi_bar = 0.6 +- 0.05", "F1.chi_bar = 0.4 +- 0.1"});
  EXPECT_NEAR(both.effective_size, turned.effective_size, 1e-9);
  EXPECT_NEAR(both.agreement[0], turned.agreement[1], 1e-12);
}

TEST_F(AnswersTest, AFewCasesDoNotSpeakForAll) {
  submit("monte-carlo", even(200));
  runs_[3].result.reset(), runs_[3].status = RunStatus::hung;
  record();
  EXPECT_THROW(find_posterior(*store_, campaign_, {.seen = {"F1.chi_bar = 0.5 +- 0.01"}}),
               InputError);
  EXPECT_EQ(find_posterior(*store_, campaign_, {.seen = {"slides"}}).n_unknown, 1);
}

/// Seven histories of eighty are not known to their end.
TEST_F(AnswersTest, APosteriorOfWhatSaysNothingHasTheBoundsOfTheProbability) {
  submit("monte-carlo", even(80));
  for (const std::size_t k : {3u, 17u, 31u, 44u, 58u})
    runs_[k].result.reset(), runs_[k].status = RunStatus::hung;
  for (const std::size_t k : {62u, 71u}) {
    runs_[k].result->outcome = faultsim::Outcome::unstable;
    for (faultsim::FaultStageMetrics& fault : runs_[k].result->whole.faults)
      fault.activation.reset();
  }
  record();
  for (const char* condition : {"F1.slides", "F2.slides", "max_slip > -1 mm", "max_slip > 1 km"}) {
    const Share prior = probability({.condition = condition}).shares.at(0);
    EXPECT_EQ(prior.counts.n_unknown, 7);
    for (const std::vector<std::string>& seen : std::vector<std::vector<std::string>>{
             {}, {"F1.chi_bar = 0.5 +- 1e12"}, {"max_slip > -1 mm, wrong 0.4999999999"}}) {
      const Posterior p = find_posterior(*store_, campaign_, {seen, {condition}, "", 0.95});
      EXPECT_EQ(p.n_rows, 73);
      EXPECT_EQ(p.n_unknown, 7);
      for (const Estimate& one : {p.probabilities.at(0).before, p.probabilities.at(0).after}) {
        EXPECT_NEAR(one.value, prior.counts.estimate(), 1e-8) << condition;
        EXPECT_NEAR(one.bounds.low, prior.bounds.low, 1e-8) << condition;
        EXPECT_NEAR(one.bounds.high, prior.bounds.high, 1e-8) << condition;
      }
      EXPECT_THAT(render_text(to_answer(p), 500), HasSubstr("bounds allow for any outcome"));
    }
  }
}

TEST_F(AnswersTest, AWidthTakesMoreCases) {
  submit("monte-carlo", even(40));
  record();
  const Share share = probability({.condition = "F1.slides", .width = 0.1}).shares.at(0);
  EXPECT_EQ(share.n_more, samples_for_half_width(0.5, 0.05, 0.95) - 40);
  EXPECT_EQ(probability({.condition = "F1.slides", .width = 0.5}).shares.at(0).n_more, 0);
}

/// χ̄ of F1 is (k + ½) / 200; two histories that are not known may lie on either side. The tier of
/// the cases names an error of 0.011.
TEST_F(AnswersTest, QuantilesHaveBoundsWhateverTheDistribution) {
  submit("monte-carlo", even(200));
  record();
  const auto chi_bar = [&] {
    return find_quantiles(*store_, campaign_, {.metrics = "F1.chi_bar", .at = {0.5, 0.999}});
  };
  const MetricQuantiles all = chi_bar().metrics.at(0);
  EXPECT_NEAR(all.values.at(0).estimate, 0.5, 1e-9);
  EXPECT_NEAR(all.values.at(0).low.value(), 0.4275 - 0.011, 1e-12) << "the 86th";
  EXPECT_NEAR(all.values.at(0).high.value(), 0.5725 + 0.011, 1e-12) << "the 115th";
  EXPECT_FALSE(all.values.at(1).high) << "200 cases do not bound it from above";
  store_.reset();
  std::filesystem::remove_all(folder_ / "store");
  store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  store_->submit(s_);
  for (const std::size_t k : {3u, 150u}) runs_[k].result.reset(), runs_[k].status = RunStatus::hung;
  record();
  const Quantiles some = chi_bar();
  EXPECT_EQ(some.n_unknown, 2);
  EXPECT_LT(some.metrics.at(0).values.at(0).low.value(), 0.4275);
  EXPECT_GT(some.metrics.at(0).values.at(0).high.value(), 0.5725);
  const Answer answer = to_answer(some);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer), HasSubstr("open"));
  const auto rows = render_json(answer).at("quantiles");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("low").get<double>(), some.metrics.at(0).values.at(0).low.value());
  EXPECT_TRUE(rows[1].at("high").is_null());
  EXPECT_THROW(find_quantiles(*store_, campaign_, {.metrics = "chi_bar", .at = {1}}), InputError);
}

/// What was chosen has no distribution: a value that was run, and nothing about others.
TEST_F(AnswersTest, OfChosenCasesOrderStatisticsWithoutBounds) {
  submit("list", even(20));
  record();
  const Quantiles found = find_quantiles(
      *store_, campaign_, {.metrics = "F1.chi_bar, max_slip", .at = {0.05, 0.5, 0.52, 0.95}});
  const std::vector<QuantileBounds>& values = found.metrics.at(0).values;
  const double expected[] = {0.025, 0.475, 0.525, 0.925};  // the 1st, 10th, 11th and 19th
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(values.at(k).estimate, expected[k], 1e-9) << k;
    EXPECT_FALSE(values[k].low) << k;
    EXPECT_FALSE(values[k].high) << k;
  }
  const Answer answer = to_answer(found);
  testing::expect_same_renderings(answer);
  const std::string text = render_text(answer, 1000);
  EXPECT_THAT(text,
              HasSubstr("of the 20 cases that were run and have a value 5 % have at most 0.025"));
  EXPECT_THAT(text, HasSubstr("Order statistics of the cases run"));
  EXPECT_THAT(text, Not(HasSubstr("confidence")));
  EXPECT_FALSE(render_json(answer).at("quantiles").at(0).contains("low"));
}

/// Lines of a file are a sample, unless they are places: of those there are shares alone.
TEST_F(AnswersTest, PlacesAreNoSample) {
  design_keys_ = {{"names", "rule"}};
  submit("places", even(20));
  record();
  const Probability found = probability({.condition = "F1.slides"});
  EXPECT_FALSE(found.sampling.is_random);
  EXPECT_EQ(found.shares.at(0).counts.n_holds, 10);
  const std::string text = render_text(to_answer(found), 1000);
  EXPECT_THAT(text, HasSubstr("Places are not a sample: shares are of these places"));
  EXPECT_THAT(text, Not(HasSubstr("confidence")));
  EXPECT_EQ(found.shares.at(0).bounds.low, 0.5) << "no sample, no bound";
  EXPECT_EQ(found.shares.at(0).bounds.high, 0.5);
  EXPECT_THROW(analyse_sensitivity(*store_, campaign_, {}), InputError);
  // A name explains nothing, and follows from nothing.
  const Sample sample = read_sample(*store_, campaign_, {}, "F1.chi_bar");
  ASSERT_EQ(sample.parameters.size(), 2u);
  EXPECT_EQ(sample.parameters[1].name, "offset");
  EXPECT_TRUE(sample.derived.empty());
}

/// Rows of a design that are one case count as often as they are rows.
TEST_F(AnswersTest, MergedRowsCountEach) {
  for (long row = 1; row <= 40; ++row) s_.design_rows.push_back({0, row, row <= 31 ? 1 : row - 30});
  submit("samples", even(10));
  record();
  const Share share = probability({.condition = "F1.slides"}).shares.at(0);
  EXPECT_EQ(share.counts.n, 40);
  EXPECT_EQ(share.counts.n_holds, 5);
}

}  // namespace
}  // namespace faultsweep
