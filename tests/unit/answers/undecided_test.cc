// A condition on a case is true, false or undecided, and answers say which.
#include <gmock/gmock.h>

#include <cmath>

#include "campaign/answers/curves.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/quantiles.h"
#include "campaign/render/render.h"
#include "tests/unit/answers/answers_fixture.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;

class Undecided : public AnswersTest {
 protected:
  /// Of 40 cases those from the 21st on slide.
  void submit_forty() { submit("monte-carlo", even(40)); }
  /// Whether F1 slides over the whole history hangs on the cells.
  void leave_open(std::size_t k) {
    runs_[k].result->whole.faults[0].activation_resolved = false;
    runs_[k].result->whole.activation_resolved = false;
  }
  ShareCounts counts(const std::string& condition) {
    return probability({.condition = condition}).shares.at(0).counts;
  }
};

TEST_F(Undecided, FlagsWidenBoundsAndEstimatesTakeThemAsComputed) {
  submit_forty();
  for (const std::size_t k : {5u, 6u, 7u, 30u, 31u, 32u, 33u}) leave_open(k);
  record();
  const Probability p = probability({.condition = "F1.slides"});
  const Share& share = p.shares.at(0);
  EXPECT_EQ(share.counts.n_yes, 16);
  EXPECT_EQ(share.counts.n_undecided, 7);
  EXPECT_EQ(share.counts.n_holds, 20);
  EXPECT_EQ(share.counts.estimate(), 0.5);
  EXPECT_EQ(share.bounds.low, proportion_bounds(16, 40, 0.95).low);
  EXPECT_EQ(share.bounds.high, proportion_bounds(23, 40, 0.95).high);
  EXPECT_THAT(render_text(to_answer(p), 200),
              HasSubstr("F1.slides: 20 of 40 cases, 50 % (24.9 to 73 %: ± 16 by the number of "
                        "cases, 7 undecided by the cells)."));
}

TEST_F(Undecided, ByConditionNotByCase) {
  submit_forty();
  for (const std::size_t k : {5u, 30u}) leave_open(k);
  record();
  EXPECT_EQ(counts("F2.slides").n_undecided, 0);
  EXPECT_EQ(counts("F1.slides in gas_storage").n_undecided, 0);
  EXPECT_EQ(counts("not F1.slides").n_undecided, 2);
  EXPECT_EQ(counts("not F1.slides").n_yes, 19);
  EXPECT_EQ(counts("F1.slides and strength < 0.2").n_undecided, 1) << "the 31st is out";
  EXPECT_EQ(counts("F1.slides or F1.chi_bar >= 0").n_undecided, 0) << "holds either way";
}

TEST_F(Undecided, WhereTheMeasuredErrorReachesOverTheThreshold) {
  submit_forty();
  record();
  EXPECT_EQ(counts("chi_bar > 0.5").n_undecided, 0) << "nothing was measured";
  TradeRecord trade{1e9, "sweep.json", "tradeoff-sweep", "0", "{}", {}};
  trade.error_bars = {{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05}};
  store_->record_trade(trade);
  const ShareCounts c = counts("chi_bar > 0.5");  // χ̄ = (k + ½) / 40
  EXPECT_EQ(c.n_undecided, 4) << "0.4625, 0.4875, 0.5125, 0.5375";
  EXPECT_EQ(c.n_yes, 18);
  EXPECT_EQ(c.n_holds, 20);
}

/// χ̄ = (k + ½) / 200 is as computed whatever an event does, the slip of the fault is not.
TEST_F(Undecided, QuantilesAllowForWhatTheCellsLeaveOpen) {
  submit("monte-carlo", even(200));
  for (const std::size_t k : {20u, 150u, 151u})
    runs_[k].result->outcome = faultsim::Outcome::unresolved_event;
  record();
  const auto median = [&](const std::string& metric) {
    return find_quantiles(*store_, campaign_, {.metrics = metric, .at = {0.5}}).metrics.at(0);
  };
  EXPECT_EQ(median("F1.chi_bar").n_unresolved, 0);
  EXPECT_NEAR(median("F1.chi_bar").values.at(0).low.value(), 0.4275 - 0.011, 1e-12)
      << "by the tier";
  const MetricQuantiles slip = median("F1.max_slip");
  EXPECT_EQ(slip.n_unresolved, 3);
  EXPECT_EQ(slip.n, 200);
  std::vector<double> all, resolved;
  for (std::size_t k = 0; k < 200; ++k) {
    all.push_back(std::max(0.0, 0.01 * ((static_cast<double>(k) + 0.5) / 200 - 0.5)));
    if (k != 20 && k != 150 && k != 151) resolved.push_back(all.back());
  }
  EXPECT_NEAR(slip.values.at(0).estimate, quantile_bounds(all, 0, 0.5, 0.95).estimate, 1e-12);
  EXPECT_NEAR(slip.values[0].high.value(), quantile_bounds(resolved, 3, 0.5, 0.95).high.value(),
              1e-12);
  EXPECT_GT(slip.values[0].high.value(), quantile_bounds(all, 0, 0.5, 0.95).high.value());
  const Answer answer =
      to_answer(find_quantiles(*store_, campaign_, {.metrics = "F1.max_slip", .at = {0.5}}));
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_text(answer, 200),
              HasSubstr("In 3 cases the cells leave F1.max_slip undecided: the quantile takes them "
                        "as computed, bounds allow for any value."));
}

TEST_F(Undecided, QuantilesOfWhatIsAllUndecidedHaveNoBounds) {
  submit_forty();
  for (RunRecord& one : runs_) one.result->outcome = faultsim::Outcome::unresolved_event;
  record();
  const Quantiles found =
      find_quantiles(*store_, campaign_, {.metrics = "max_slip, F1.chi_bar", .at = {0.5}});
  EXPECT_EQ(found.metrics.at(0).n_unresolved, 40);
  EXPECT_FALSE(found.metrics[0].values.at(0).low);
  EXPECT_FALSE(found.metrics[0].values[0].high);
  EXPECT_EQ(found.metrics.at(1).n_unresolved, 0);
  EXPECT_THAT(render_text(to_answer(found), 200), HasSubstr("(open to open)"));
}

TEST_F(Undecided, QuantilesAreAsFarOffAsTheMeasuredErrorIs) {
  submit("monte-carlo", even(200));
  record();
  TradeRecord trade{1e9, "sweep.json", "tradeoff-sweep", "0", "{}", {}};
  trade.error_bars = {{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05}};
  store_->record_trade(trade);
  const Quantiles found =
      find_quantiles(*store_, campaign_, {.metrics = "F1.chi_bar", .at = {0.5}});
  EXPECT_NEAR(found.metrics.at(0).values.at(0).low.value(), 0.4275 - 0.05, 1e-12);
  EXPECT_NEAR(found.metrics[0].values[0].high.value(), 0.5725 + 0.05, 1e-12);
  EXPECT_NEAR(found.metrics[0].values[0].estimate, 0.5, 1e-9);
  EXPECT_THAT(
      render_text(to_answer(found), 200),
      HasSubstr("further away by its largest error, measured or stated by the tier, of 0.05."));
}

TEST_F(Undecided, SharesOfAGridAreWhatWasRun) {
  submit("grid", even(40));
  for (const std::size_t k : {5u, 30u}) leave_open(k);
  record();
  const Probability p = probability({.condition = "F1.slides"});
  EXPECT_EQ(p.shares.at(0).bounds.low, 19.0 / 40);
  EXPECT_EQ(p.shares.at(0).bounds.high, 21.0 / 40);
  EXPECT_TRUE(std::isnan(by_number(p.shares.at(0).counts, p.sampling, 0.95)));
  EXPECT_EQ(p.n_for_half, 0);
}

/// F1 of the k-th case begins within step k + 1, of a year.
TEST_F(Undecided, ACurveIsABandWhereAStepIsLongerThanItsTicks) {
  submit("monte-carlo", even(12));
  for (std::size_t k = 0; k < 12; ++k) {
    faultsim::CaseResult& result = *runs_[k].result;
    for (faultsim::StageMetrics* stage :
         {&result.whole, &result.stages[0], &result.stages[1], &result.stages[2]})
      for (faultsim::FaultStageMetrics& fault : stage->faults) fault.activation.reset();
    result.whole.faults[0].activation = result.stages[0].faults[0].activation =
        faultsim::FaultOnset{4, 2000,
                             testing::made_up_pressures(result.steps[4].pressure_change[0])};
    // The third year is a step of its own in the first case alone, whose steps are the axis.
    if (k > 0) result.steps[3].time = 2.5 * 3.15576e7;
  }
  record();
  const Curve curve = probability_curves(*store_, campaign_, {CurveAxis::time}).curves.at(0);
  const ShareCounts before = curve.points.at(3).counts, then = curve.points.at(4).counts;
  EXPECT_EQ(before.n_holds, 0);
  EXPECT_EQ(before.n_yes, 0);
  EXPECT_EQ(before.n_undecided, 11) << "they began after 2.5 years";
  EXPECT_EQ(then.n_yes, 12);
  EXPECT_EQ(then.n_undecided, 0);
  const Curve falling = probability_curves(*store_, campaign_, {CurveAxis::pressure}).curves.at(0);
  for (const CurvePoint& point : falling.points) {
    const double begin = runs_[0].result->steps[3].pressure_change[0];
    const double end = runs_[0].result->steps[4].pressure_change[0];
    const bool is_within = point.at < begin && point.at > end;
    EXPECT_EQ(point.counts.n_undecided, is_within ? 12 : 0) << point.at;
  }
}

TEST_F(Undecided, AFaultThatMayNotSlideIsOpenAlongItsCurve) {
  submit_forty();
  leave_open(30);
  leave_open(2);
  record();
  const Curves curves = probability_curves(*store_, campaign_, {CurveAxis::step});
  ASSERT_FALSE(curves.curves.at(0).points.empty());
  for (const CurvePoint& point : curves.curves[0].points) EXPECT_EQ(point.counts.n_undecided, 2);
}

TEST_F(Undecided, APosteriorAllowsForEither) {
  submit("monte-carlo", even(200));
  for (const std::size_t k : {20u, 150u, 151u}) leave_open(k);
  record();
  const auto posterior = [&](const std::string& seen) {
    return find_posterior(*store_, campaign_, {{seen}, {"F1.slides"}, "", 0.95});
  };
  const Posterior nothing = posterior("strength > -1, wrong 0.4999999999");
  const Share share = probability({.condition = "F1.slides"}).shares.at(0);
  EXPECT_NEAR(nothing.probabilities.at(0).after.bounds.low, share.bounds.low, 1e-8);
  EXPECT_NEAR(nothing.probabilities.at(0).after.bounds.high, share.bounds.high, 1e-8);
  EXPECT_NEAR(nothing.probabilities.at(0).after.value, 0.5, 1e-8);
  EXPECT_EQ(nothing.n_undecided, 3);
  // What slid may be of any of the three, and of those that do not slide one may have.
  const Posterior slid = posterior("F1 slid before 2 yr");
  EXPECT_EQ(slid.probabilities.at(0).after.value, 1);
  EXPECT_LT(slid.probabilities.at(0).after.bounds.low, proportion_bounds(100, 100, 0.95).low);
}

}  // namespace
}  // namespace faultsweep
