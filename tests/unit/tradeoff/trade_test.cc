#include "campaign/tradeoff/trade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/tradeoff/trade_report.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using ::testing::HasSubstr;

TEST(LimitOf, IsThatOfAPowerOfTheSize) {
  for (const double order : {0.7, 1.0, 2.0, 3.5}) {
    const auto at = [order](double h) { return 0.6 - 0.3 * std::pow(h, order); };
    const Limit limit = limit_of(at(1), at(0.5), at(0.25));
    EXPECT_TRUE(limit.extrapolated);
    EXPECT_NEAR(limit.order, order, 1e-12);
    EXPECT_NEAR(limit.value, 0.6, 1e-12);
    EXPECT_NEAR(limit.uncertainty, 0.3 * std::pow(0.25, order), 1e-12);
  }
}

TEST(LimitOf, IsTheFinestWhereOrdersDoNotHold) {
  for (const auto& [coarse, middle, fine] : {std::tuple{0.1, 0.3, 0.2},     // not monotone
                                             std::tuple{0.5, 0.4, 0.29},    // differences grow
                                             std::tuple{0.5, 0.5, 0.5}}) {  // nothing changes
    const Limit limit = limit_of(coarse, middle, fine);
    EXPECT_FALSE(limit.extrapolated);
    EXPECT_EQ(limit.value, fine);
    EXPECT_EQ(limit.uncertainty, std::abs(fine - middle));
  }
  EXPECT_FALSE(limit_of(1, 0.9, 0.9 - 1e-7).extrapolated);  // order 20 is an accident
}

TEST(LimitOf, AHistoryHasOneOrder) {
  std::vector<double> f[3];
  for (int level = 0; level < 3; ++level) {
    const double h = std::exp2(-level);
    f[level] = {0.5 + 0.1 * h * h, 0.7 - 0.2 * h * h, 1};
  }
  const HistoryLimit limit = limit_of(f[0], f[1], f[2]);
  EXPECT_TRUE(limit.extrapolated);
  EXPECT_NEAR(limit.order, 2, 1e-12);
  EXPECT_NEAR(limit.chi[0], 0.5, 1e-12);
  EXPECT_NEAR(limit.chi[1], 0.7, 1e-12);
  EXPECT_EQ(limit.chi[2], 1);
  EXPECT_NEAR(limit.uncertainty, 0.2 / 16, 1e-12);
}

/// Two faults and three load steps; χ̄ of F2 at step 1 as given, 0.5 elsewhere.
CaseResult made_up(double chi, bool plane_strain, std::optional<double> activation_pressure) {
  CaseResult result;
  result.outcome = faultsim::Outcome::converged;
  result.plane_strain = plane_strain;
  result.fault_names = {"F1", "F2"};
  for (int step = 0; step < 3; ++step) {
    faultsim::StepResult one;
    one.step = step;
    one.stage = step == 0 ? "initial" : "production";
    one.time = 1e7 * step;
    one.outcome = faultsim::Outcome::converged;
    one.faults.resize(2);
    one.faults[0].chi_bar = 0.5;
    one.faults[1].chi_bar = step == 1 ? chi : 0.5;
    result.steps.push_back(one);
  }
  result.whole.activated = activation_pressure.has_value();
  if (activation_pressure) {
    result.whole.activated_fault = "F1";
    result.whole.faults.resize(1);
    result.whole.faults[0].fault = "F1";
    result.whole.faults[0].activation.emplace();
    result.whole.faults[0].activation->pressures.change_minus = activation_pressure;
  }
  result.whole.max_slip = 0.1 * chi;
  return result;
}

struct MadeUpAxis {
  TradeAxis axis;
  std::vector<TradeRun> runs;
  void add(const std::string& name, double size, double seconds, double chi, bool plane_strain,
           std::optional<double> activation_pressure = -1e7) {
    TradeChoice choice;
    choice.name = name;
    choice.size = size;
    axis.choices.push_back(choice);
    TradeRun run;
    run.result = made_up(chi, plane_strain, activation_pressure);
    run.operator_seconds = 0.75 * seconds;
    run.case_seconds = 0.25 * seconds;
    runs.push_back(run);
  }
};

std::string metres(double size) { return std::to_string(std::lround(size)) + " m"; }

/// Plane strain converges to 0.7 with order 1, 3D to 0.65 with order 2.
std::vector<MadeUpAxis> made_up_axes() {
  MadeUpAxis plane, space;
  plane.axis = {"cells, plane strain", "?", true, true, "", {}};
  space.axis = {"cells, 3D", "?", true, true, "", {}};
  for (const double size : {40.0, 20.0, 10.0}) {
    plane.add(metres(size), size, 10 / size, 0.7 + 0.004 * size, true);
  }
  for (const double size : {80.0, 40.0, 20.0}) {
    space.add(metres(size), size, 1000 / size, 0.65 + 1e-5 * size * size, false);
  }
  return {plane, space};
}

Trade made_up_trade(const std::vector<MadeUpAxis>& all) {
  std::vector<TradeAxis> axes;
  std::vector<std::vector<TradeRun>> runs;
  for (const MadeUpAxis& one : all) {
    axes.push_back(one.axis);
    runs.push_back(one.runs);
  }
  return make_trade(axes, runs);
}

TEST(Trade, MeasuresEachAxisAgainstItsLimitAndMeshesAgainst3D) {
  const Trade trade = made_up_trade(made_up_axes());
  const auto& tables = trade.tables;
  const TradeTable& plane = tables.at(0);
  EXPECT_NEAR(plane.chi.order, 1, 1e-9);
  EXPECT_NEAR(plane.rows[0].error.chi, 0.16, 1e-9);
  EXPECT_EQ(plane.rows[0].error.where, "F2, production, step 1");
  EXPECT_NEAR(plane.rows[2].error.slip, 0.04 / 0.7, 1e-9);
  EXPECT_NEAR(tables.at(1).rows[0].error.chi, 0.064, 1e-9);
  EXPECT_NEAR(plane.rows[2].total_chi, 0.74 - 0.65, 1e-9);
  EXPECT_NEAR(trade.reference.uncertainty, 0.004, 1e-9);
}

TEST(Trade, TooLittleIsAsMuchOfAnErrorAsTooMuch) {
  std::vector<MadeUpAxis> axes = made_up_axes();
  MadeUpAxis below;
  below.axis = {"cells, plane strain", "?", true, true, "", {}};
  for (const double size : {40.0, 20.0, 10.0}) {
    below.add(metres(size), size, 10 / size, 0.7 - 0.004 * size, true);
  }
  axes[0] = below;
  EXPECT_NEAR(made_up_trade(axes).tables.at(0).rows[0].error.chi, 0.16, 1e-9);
}

TEST(Trade, ComparesPlaneStrainWith3DAtEqualCells) {
  const Trade trade = made_up_trade(made_up_axes());
  ASSERT_TRUE(trade.plane_strain);
  EXPECT_EQ(trade.plane_strain->cells, 20);
  EXPECT_NEAR(trade.plane_strain->chi(), 0.78 - 0.654, 1e-9);
  EXPECT_NEAR(trade.plane_strain->uncertainty, (0.86 - 0.666) - (0.78 - 0.654), 1e-9);
}

/// 3D that does not converge yet, and differs from plane strain by 0.1 at any cells.
TEST(Trade, TakesPlaneStrainPlusADifferenceWhereThatIsMoreCertain) {
  MadeUpAxis plane = made_up_axes()[0], space;
  space.axis = {"cells, 3D", "?", true, true, "", {}};
  for (const double size : {40.0, 20.0}) {
    space.add(metres(size), size, 1000 / size, 0.6 + 0.004 * size, false);
  }
  const Trade trade = made_up_trade({plane, space});
  EXPECT_NEAR(trade.reference.uncertainty, 0.04, 1e-9);  // of plane strain's own limit
  EXPECT_NEAR(trade.tables[1].rows[1].total_chi, 0.08, 1e-9);
  EXPECT_NEAR(trade.tables[0].rows[2].total_chi, 0.74 - 0.6, 1e-9);
  EXPECT_THAT(trade.reference.text, HasSubstr("plus the difference of 3D at cells of 20 m"));
}

TEST(Trade, TheFrontHasWhatNothingBeats) {
  auto axes = made_up_axes();
  axes[1].add("wasteful", 0, 60, 0.65 + 0.05, false);  // dearer and worse than 20 m
  const Trade trade = made_up_trade(axes);
  const auto& tables = trade.tables;
  EXPECT_FALSE(tables[1].rows[3].on_front);
  EXPECT_TRUE(tables[1].rows[2].on_front);
  EXPECT_TRUE(tables[0].rows[0].on_front);  // the cheapest
  const TradeRow* best = recommended(trade, 0.02);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->choice.name, "40 m");
  EXPECT_FALSE(best->run.result->plane_strain);
  EXPECT_EQ(recommended(trade, 1e-9), nullptr);
}

TEST(Trade, SaysWhereActivationFlips) {
  auto axes = made_up_axes();
  axes[0].runs[0].result = made_up(0.86, true, std::nullopt);
  const Trade trade = made_up_trade(axes);
  const auto& tables = trade.tables;
  EXPECT_TRUE(tables[0].rows[0].error.activation_flips);
  EXPECT_FALSE(tables[0].rows[1].error.activation_flips);
  TradeReport report;
  report.trade = trade;
  EXPECT_THAT(trade_to_text(report, 200), HasSubstr("ACTIVATION FLIPS"));
}

TEST(Trade, RecommendsOnlyWhatWasMeasured) {
  auto axes = made_up_axes();
  const auto answer = [&] {
    TradeReport report;
    report.trade = made_up_trade(axes);
    return trade_answers(report).back();
  };
  EXPECT_THAT(answer(), HasSubstr("For χ̄ within 0.02: 40 m, 3D"));
  for (TradeRun& run : axes[1].runs) run = TradeRun();
  EXPECT_THAT(answer(), HasSubstr("uncertain by 0.04"));
  axes[0].add("5 m", 5, 20, 0.72, true);
  axes[0].add("2 m", 2.5, 20, 0.71, true);
  EXPECT_THAT(answer(), HasSubstr("3D was not run"));
  for (TradeRun& run : axes[0].runs) {
    for (auto& step : run.result->steps) step.faults = {{}, {}};
  }
  EXPECT_THAT(answer(), HasSubstr("judge by slip"));
}

TEST(Trade, DrawsErrorsOfMeshesAgainstTheirCost) {
  TradeReport report;
  report.trade = made_up_trade(made_up_axes());
  const TradeFigures figures = trade_figures(trade_to_json(report));
  ASSERT_FALSE(figures.pareto.series.empty());
  const auto& drawn = figures.pareto.series[0];
  const TradeRow& row = report.trade.tables[0].rows[0];
  EXPECT_EQ(drawn.name, report.trade.tables[0].axis.name);
  EXPECT_EQ(drawn.points.at(0).name, row.choice.name);
  EXPECT_EQ(drawn.points.at(0).x, row.seconds());
  EXPECT_EQ(drawn.points.at(0).y, row.total_chi);
  EXPECT_FALSE(figures.convergence.series.empty());
}

TEST(Trade, SurvivesChoicesWithoutResult) {
  auto axes = made_up_axes();
  axes[1].runs[2] = TradeRun();
  axes[1].runs[2].trouble = "memory: killed";
  const Trade trade = made_up_trade(axes);
  const auto& tables = trade.tables;
  EXPECT_EQ(tables[1].reference, "40 m");  // two are left: nothing to extrapolate from
  TradeReport report;
  report.trade = trade;
  EXPECT_THAT(trade_to_text(report, 200), HasSubstr("memory: killed"));
  EXPECT_THAT(trade_to_markdown(report), HasSubstr("No mesh can be recommended"));
  for (MadeUpAxis& axis : axes) {
    for (TradeRun& run : axis.runs) run = TradeRun();
  }
  report.trade = made_up_trade(axes);
  EXPECT_THAT(trade_to_text(report, 200), HasSubstr("nothing to compare with"));
  EXPECT_TRUE(trade_to_json(report).at("axes").at(0).at("choices").at(0).at("error_chi").is_null());
}

}  // namespace
}  // namespace faultsweep
