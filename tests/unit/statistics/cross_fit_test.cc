#include "campaign/statistics/cross_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(StandardFeatures, HaveMeanZeroAndDeviationOne) {
  const std::vector<std::vector<double>> columns = {{1, 3, 1, 3}, {0, 0, 0, 40}};
  const StandardFeatures x(columns, 4);
  ASSERT_EQ(x.n_coefficients(), 3u);
  EXPECT_THAT(x.row(0), ::testing::ElementsAre(1, -1, ::testing::DoubleEq(-1 / std::sqrt(3.0))));
  EXPECT_THAT(x.row(3), ::testing::ElementsAre(1, 1, ::testing::DoubleEq(std::sqrt(3.0))));
}

TEST(StandardFeatures, LeaveOutWhatDoesNotVaryOrIsNotFinite) {
  const std::vector<std::vector<double>> columns = {
      {7, 7, 7}, {1, kNaN, 2}, {1, 2, 3}, {0, 1, HUGE_VAL}, {1e9, 1e9 + 1e-7, 1e9}};
  const StandardFeatures x(columns, 3);
  EXPECT_THAT(x.left_out(), ::testing::ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(x.n_coefficients(), 2u);
  EXPECT_EQ(StandardFeatures({}, 3).n_coefficients(), 1u);
}

/// With one feature of mean 0: b_0 = mean y, b_1 = Σ x y / (Σ x² + 1 / 25).
TEST(Fit, OfALineIsThatOfItsNormalEquations) {
  const std::vector<std::vector<double>> columns = {{-1, 1, -1, 1}};
  const StandardFeatures x(columns, 4);
  const std::vector<double> y = {10, 13, 12, 17};
  const std::vector<double> b = fit(x, y, Dependence::line, kFolds);
  EXPECT_NEAR(b[0], 13, 1e-10);
  EXPECT_NEAR(b[1], (-10 + 13 - 12 + 17) / (4 + 0.04), 1e-10);
}

/// 3 of 12 flags: Σ (P − y) + b_0 / 100 = 0.
TEST(Fit, OfFlagsWithoutAFeatureIsTheirShare) {
  const std::vector<double> y = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const std::vector<double> b = fit({{}, 12}, y, Dependence::logistic, kFolds);
  EXPECT_NEAR(12 / (1 + std::exp(-b[0])) - 3 + b[0] / 100, 0, 1e-9);
  EXPECT_NEAR(b[0], std::log(0.25 / 0.75), 0.02);
}

/// What is made greatest has no slope there, by differences.
TEST(Fit, OfFlagsIsWhereThePosteriorIsGreatest) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<std::vector<double>> columns(2);
  std::vector<double> y;
  for (int i = 0; i < 60; ++i) {
    columns[0].push_back(normal(random)), columns[1].push_back(normal(random));
    y.push_back(columns[0].back() + normal(random) > 0.5 ? 1 : 0);
  }
  const StandardFeatures x(columns, 60);
  const std::vector<double> b = fit(x, y, Dependence::logistic, kFolds);
  const auto log_posterior = [&](const std::vector<double>& at) {
    double sum = -0.5 * at[0] * at[0] / 100;
    for (std::size_t j = 1; j < at.size(); ++j) sum -= 0.5 * at[j] * at[j] / 25;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double p = predicted(at, x.row(i), Dependence::logistic);
      sum += std::log(y[i] > 0 ? p : 1 - p);
    }
    return sum;
  };
  EXPECT_GT(b[1], 1) << "it depends on the first";
  for (std::size_t j = 0; j < b.size(); ++j) {
    std::vector<double> more = b, less = b;
    more[j] += 1e-4, less[j] -= 1e-4;
    EXPECT_NEAR((log_posterior(more) - log_posterior(less)) / 2e-4, 0, 1e-5) << j;
    EXPECT_LT(log_posterior(more), log_posterior(b));
  }
}

/// Where flags are separated by a feature, given twice, the likelihood alone has no greatest value.
TEST(Fit, OfSeparatedFlagsIsFinite) {
  std::vector<std::vector<double>> columns(2);
  std::vector<double> y;
  for (int i = 0; i < 50; ++i) {
    columns[0].push_back(i), columns[1].push_back(2 * i);
    y.push_back(i < 30 ? 0 : 1);
  }
  const StandardFeatures x(columns, 50);
  const std::vector<double> b = fit(x, y, Dependence::logistic, kFolds);
  EXPECT_GT(b[1], 3);
  EXPECT_LT(b[1], 50);
  EXPECT_NEAR(b[1], b[2], 1e-6) << "they share what one would have";
  for (std::size_t i = 0; i < y.size(); ++i)
    EXPECT_EQ(predicted(b, x.row(i), Dependence::logistic) > 0.5, y[i] > 0) << i;
  const std::vector<double> none(50, 0.0);
  EXPECT_LT(predicted(fit(x, none, Dependence::logistic, kFolds), x.row(7), Dependence::logistic),
            0.02);
}

/// However it is changed, a member's own value, and those of its fold, are not in its prediction.
TEST(CrossFitted, HasNotSeenTheValueThatItPredicts) {
  std::vector<std::vector<double>> columns(1);
  std::vector<double> y;
  for (int i = 0; i < 40; ++i) {
    columns[0].push_back(std::sin(i));
    if (i < 30) y.push_back(std::sin(i) > 0.2 ? 1 : 0);
  }
  const StandardFeatures x(columns, 40);
  for (const Dependence dependence : {Dependence::line, Dependence::logistic}) {
    const std::vector<double> before = cross_fitted(x, y, dependence);
    std::vector<double> turned = y;
    for (const std::size_t i : {3, 13, 23}) turned[i] = 1 - y[i];
    const std::vector<double> after = cross_fitted(x, turned, dependence);
    EXPECT_EQ(before[3], after[3]);
    EXPECT_EQ(before[23], after[23]);
    EXPECT_NE(before[4], after[4]);
    EXPECT_NE(before[35], after[35]);
    double mean = 0;
    for (std::size_t fold = 0; fold < kFolds; ++fold)
      mean += predicted(fit(x, y, dependence, fold), x.row(35), dependence) / kFolds;
    EXPECT_NEAR(before[35], mean, 1e-15);
    EXPECT_EQ(before[13], predicted(fit(x, y, dependence, 3), x.row(13), dependence));
  }
}

}  // namespace
}  // namespace faultsweep
