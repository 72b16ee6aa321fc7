#include "campaign/statistics/control_variate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

/// An expensive model and a cheap one that errs by a curved bias and some scatter.
struct Tiers {
  std::vector<double> high, low;
  Tiers(std::size_t n, std::size_t all, double scatter, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < all; ++i) {
      const double u = normal(random);
      const double y = u + 0.1 * u * u;
      if (i < n) high.push_back(y);
      low.push_back(0.8 * u + 3 + scatter * normal(random));
    }
  }
  TieredSample sample() const { return {high, low}; }
};
constexpr double kTrueMean = 0.1;

TEST(TieredMean, IsExactWhereTheCheapModelIs) {
  std::mt19937_64 random(1);
  const Tiers tiers(20, 2000, 0, random);
  std::vector<double> high;
  for (std::size_t i = 0; i < 20; ++i) high.push_back(2 * tiers.low[i] - 1);
  double mean = 0;
  for (const double x : tiers.low) mean += (2 * x - 1) / 2000;
  const TieredEstimate found = tiered_mean({high, tiers.low}, 0.95);
  EXPECT_NEAR(found.estimate.value, mean, 1e-9);
  EXPECT_NEAR(found.weight, 2, 1e-9);
  EXPECT_NEAR(found.correlation, 1, 1e-9);
  EXPECT_NEAR(found.n_equivalent, 2000, 400) << "as good as all of them";
}

/// A line through the pairs, looked at where all cheap runs have their mean: its variance there by
/// the normal equations, and what the mean of the cheap runs adds.
TEST(TieredMean, HasTheStandardErrorOfARegressionAtTheMeanOfAll) {
  const std::vector<double> high = {1, 3, 2, 5, 4, 8};
  std::vector<double> low = {0, 1, 2, 3, 4, 7};
  low.insert(low.end(), {9, 12, 10, 11, 14, 8, 13, 10});
  double s1 = 0, sx = 0, sxx = 0, sy = 0, sxy = 0, mean = 0;
  for (std::size_t i = 0; i < high.size(); ++i)
    s1 += 1, sx += low[i], sxx += low[i] * low[i], sy += high[i], sxy += low[i] * high[i];
  for (const double x : low) mean += x / 14;
  const double determinant = s1 * sxx - sx * sx;
  const double slope = (s1 * sxy - sx * sy) / determinant;
  const double level = (sxx * sy - sx * sxy) / determinant;
  double residual = 0, scatter = 0;
  for (std::size_t i = 0; i < high.size(); ++i)
    residual += std::pow(high[i] - level - slope * low[i], 2) / 4;  // of 6 points, 2 are used up
  for (const double x : low) scatter += (x - mean) * (x - mean) / 13;
  const double of_line = residual * (sxx - 2 * mean * sx + mean * mean * s1) / determinant;
  const TieredEstimate found = tiered_mean({high, low}, 0.95);
  EXPECT_NEAR(found.estimate.value, level + slope * mean, 1e-12);
  EXPECT_NEAR(found.estimate.standard_error, std::sqrt(of_line + slope * slope * scatter / 14),
              1e-12);
  EXPECT_NEAR(mean_half_width(found, 60, 140, 0.95),
              student_reach(0.95, 58) * std::sqrt(residual / 60 + slope * slope * scatter / 140),
              1e-12);
}

/// In other units, or with its sign changed, the cheap model says the same.
TEST(TieredMean, DoesNotDependOnTheUnitsOfTheCheapModel) {
  std::mt19937_64 random(8);
  const Tiers tiers(12, 60, 0.3, random);
  std::vector<double> other;
  for (const double x : tiers.low) other.push_back(5 - 1000 * x);
  const TieredEstimate one = tiered_mean(tiers.sample(), 0.9);
  const TieredEstimate same = tiered_mean({tiers.high, other}, 0.9);
  EXPECT_NEAR(one.estimate.value, same.estimate.value, 1e-10);
  EXPECT_NEAR(one.estimate.standard_error, same.estimate.standard_error, 1e-10);
  EXPECT_NEAR(one.weight, -1000 * same.weight, 1e-9);
  EXPECT_NEAR(one.n_equivalent, same.n_equivalent, 1e-6);
}

TEST(TieredMean, LeavesOutACheapModelThatSaysNothing) {
  const std::vector<double> high = {1, 2, 3, 4, 5}, low(50, 7.0);
  const TieredEstimate found = tiered_mean({high, low}, 0.95);
  EXPECT_EQ(found.estimate.value, 3);
  EXPECT_EQ(found.weight, 0);
  EXPECT_EQ(found.n_equivalent, 5);
}

/// The mean of 45 ones, summed as 45 parts, is not 1 to the last bit, nor are their deviations 0.
TEST(TieredMean, LeavesOutWhatDiffersByRoundingOnly) {
  for (const std::size_t n : {40u, 45u, 50u, 60u, 64u, 100u}) {
    std::vector<double> low(n, 1.0), high;
    low.resize(4 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) high.push_back(0.1 * static_cast<double>(i % 7));
    const TieredEstimate found = tiered_mean({high, low}, 0.95);
    EXPECT_EQ(found.weight, 0) << n;
    EXPECT_EQ(found.correlation, 0) << n;
    EXPECT_EQ(found.estimate.value, found.direct.value) << n;
    EXPECT_EQ(found.estimate.standard_error, found.direct.standard_error) << n;
  }
  std::vector<double> low, high(45, 0.3);
  for (int i = 0; i < 90; ++i) low.push_back(i);
  const TieredEstimate equal = tiered_mean({high, low}, 0.95);
  EXPECT_EQ(equal.correlation, 0);
  EXPECT_EQ(equal.n_equivalent, 45);
}

TEST(TieredMean, IsSurerThanTheDearRunsAlone) {
  std::mt19937_64 random(2);
  const Tiers tiers(100, 10000, 0.05, random);
  const TieredEstimate found = tiered_mean(tiers.sample(), 0.95);
  EXPECT_LT(found.estimate.standard_error, 0.3 * found.direct.standard_error);
  EXPECT_GT(found.n_equivalent, 1000);
}

TEST(TieredMean, Covers) {
  std::mt19937_64 random(3);
  for (const auto& [n, scatter] : {std::pair(20, 0.3), {40, 0.3}, {100, 0.05}, {100, 2.0}}) {
    int held = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const Tiers tiers(static_cast<std::size_t>(n), 1000, scatter, random);
      const Interval bounds = tiered_mean(tiers.sample(), 0.95).estimate.bounds;
      held += bounds.low <= kTrueMean && kTrueMean <= bounds.high;
    }
    EXPECT_GE(held, 930) << n << ", scatter " << scatter;
    EXPECT_LE(held, 970) << n << ", scatter " << scatter;
  }
}

TEST(BestRatio, GivesTheSmallestVarianceForItsPrice) {
  constexpr double kCorrelation = 0.95, kCost = 0.05, kBudget = 100;
  const auto variance = [&](double ratio) {  // n + c N = budget
    const double n = kBudget / (1 + kCost * ratio);
    return (1 - kCorrelation * kCorrelation) / n + kCorrelation * kCorrelation / (n * ratio);
  };
  const double best = best_ratio(kCorrelation, kCost);
  EXPECT_LT(variance(best), variance(0.9 * best));
  EXPECT_LT(variance(best), variance(1.1 * best));
  EXPECT_EQ(best_ratio(0, 0.1), 1);
}

}  // namespace
}  // namespace faultsweep
