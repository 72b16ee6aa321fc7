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

/// Whether x happens, and y given x.
struct Flags {
  std::vector<double> high, low;
  Flags(std::size_t n, std::size_t all, double pi, double a, double b, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t i = 0; i < all; ++i) {
      const bool x = uniform(random) < pi;
      const bool y = uniform(random) < (x ? a : b);
      low.push_back(x ? 1 : 0);
      if (i < n) high.push_back(y ? 1 : 0);
    }
  }
  TieredSample sample() const { return {high, low}; }
};

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

TEST(TieredProbability, Covers) {
  std::mt19937_64 random(4);
  struct Truth {
    double pi, a, b;
  };
  for (const auto& [pi, a, b] : {Truth{0.3, 0.8, 0.05}, {0.5, 0.9, 0.1}, {0.1, 0.6, 0.2}}) {
    int held = 0;
    const double truth = pi * a + (1 - pi) * b;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const Flags flags(200, 3000, pi, a, b, random);
      const Interval bounds = tiered_probability(flags.sample(), 0.95).estimate.bounds;
      held += bounds.low <= truth && truth <= bounds.high;
    }
    EXPECT_GE(held, 930) << pi;
    EXPECT_LE(held, 970) << pi;
  }
}

/// As few pairs as are taken, which differ in five or so of them.
TEST(TieredProbability, CoversFromTheFewestPairs) {
  std::mt19937_64 random(14);
  struct Truth {
    double pi, a, b;
  };
  for (const auto& [pi, a, b] : {Truth{0.3, 0.8, 0.08}, {0.5, 0.85, 0.15}, {0.5, 0.5, 0.5}}) {
    int held = 0;
    const double truth = pi * a + (1 - pi) * b;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const Flags flags(kFewestPairsForTiers, 1000, pi, a, b, random);
      const Interval bounds = tiered_probability(flags.sample(), 0.95).estimate.bounds;
      held += bounds.low <= truth && truth <= bounds.high;
    }
    EXPECT_GE(held, 925) << a;
    EXPECT_LE(held, 980) << a;
  }
}

/// Where nothing ever happens, or always, the truth is inside and the bounds are no point.
TEST(TieredProbability, CoversAtZeroAndOne) {
  std::mt19937_64 random(5);
  for (const double p : {0.0, 1.0}) {
    for (const double pi : {0.0, 0.2, 1.0}) {
      const Flags flags(100, 3000, pi, p, p, random);
      const Interval bounds = tiered_probability(flags.sample(), 0.95).estimate.bounds;
      EXPECT_LE(bounds.low, p);
      EXPECT_GE(bounds.high, p);
      EXPECT_GT(bounds.high - bounds.low, 0.02);
      EXPECT_LT(bounds.high - bounds.low, 0.2);
    }
  }
}

/// What does not happen is bounded by what does; and a cheap flag may be turned round.
TEST(TieredProbability, OfTheOppositeIsTheRest) {
  std::mt19937_64 random(9);
  const auto turned = [](std::vector<double> flags) {
    for (double& one : flags) one = 1 - one;
    return flags;
  };
  for (const double pi : {0.05, 0.4, 0.95}) {
    const Flags flags(60, 200, pi, 0.9, 0.3, random);
    const Estimate one = tiered_probability(flags.sample(), 0.95).estimate;
    const Estimate rest = tiered_probability({turned(flags.high), flags.low}, 0.95).estimate;
    const Estimate other = tiered_probability({flags.high, turned(flags.low)}, 0.95).estimate;
    EXPECT_NEAR(rest.value, 1 - one.value, 1e-12) << pi;
    EXPECT_NEAR(rest.bounds.low, 1 - one.bounds.high, 1e-12) << pi;
    EXPECT_NEAR(rest.bounds.high, 1 - one.bounds.low, 1e-12) << pi;
    EXPECT_NEAR(other.value, one.value, 1e-12) << pi;
    EXPECT_NEAR(other.bounds.low, one.bounds.low, 1e-12) << pi;
    EXPECT_NEAR(other.bounds.high, one.bounds.high, 1e-12) << pi;
  }
}

/// 30 flags that agree with the cheap ones do not make these certain.
TEST(TieredProbability, IsWorthWhatItsIntervalIs) {
  std::mt19937_64 random(6);
  const Flags agree(30, 3000, 0.5, 1, 0, random);
  const TieredEstimate found = tiered_probability(agree.sample(), 0.95);
  EXPECT_EQ(found.correlation, 1);
  EXPECT_GT(found.n_equivalent, 40);
  EXPECT_LT(found.n_equivalent, 300) << "not 3000";
  const Flags alone(50, 3000, 0.5, 0.4, 0.4, random);
  EXPECT_LT(tiered_probability(alone.sample(), 0.95).n_equivalent, 70) << "they have no relation";
}

TEST(TieredProbability, KnowsNothingOfAStratumWithoutARun) {
  std::vector<double> low(1000, 0.0), high(50, 0.0);
  std::fill(low.end() - 300, low.end(), 1.0);
  const Interval bounds = tiered_probability({high, low}, 0.95).estimate.bounds;
  EXPECT_LE(bounds.low, 0.01);
  EXPECT_GE(bounds.high, 0.29);
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
