#include "campaign/statistics/intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

/// P(B ≤ k) of a binomial, summed term by term.
double share_up_to(long most, long samples, double p) {
  const auto n = static_cast<double>(samples), last = static_cast<double>(most);
  double sum = 0;
  for (double i = 0; i <= last; ++i) {
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) +
                    i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return sum;
}

TEST(ProportionBounds, LeaveHalfOfTheRestOnEitherSide) {
  for (const auto& [k, n] : {std::pair{3L, 20L}, {412L, 1440L}, {19L, 20L}}) {
    const Interval bounds = proportion_bounds(k, n, 0.95);
    EXPECT_NEAR(1 - share_up_to(k - 1, n, bounds.low), 0.025, 1e-9);
    EXPECT_NEAR(share_up_to(k, n, bounds.high), 0.025, 1e-9);
  }
  const Interval published = proportion_bounds(10, 100, 0.95);  // Newcombe 1998: 0.0490 to 0.1762
  EXPECT_NEAR(published.low, 0.0490, 5e-5);
  EXPECT_NEAR(published.high, 0.1762, 5e-5);
}

TEST(ProportionBounds, AreOpenWhereNoneOrAllHaveIt) {
  EXPECT_EQ(proportion_bounds(0, 50, 0.95).low, 0);
  EXPECT_NEAR(proportion_bounds(0, 50, 0.95).high, 1 - std::pow(0.025, 1.0 / 50), 1e-12);
  EXPECT_NEAR(proportion_bounds(50, 50, 0.95).low, std::pow(0.025, 1.0 / 50), 1e-12);
  EXPECT_EQ(proportion_bounds(50, 50, 0.95).high, 1);
  EXPECT_EQ(proportion_bounds(0, 0, 0.95).low, 0);
  EXPECT_EQ(proportion_bounds(0, 0, 0.95).high, 1);
}

/// Exact at any p, so never below; with 5,000 samples hardly above.
TEST(ProportionBounds, Cover) {
  std::mt19937_64 random(3);
  for (const double p : {0.0, 0.02, 0.3, 0.5, 0.97, 1.0}) {
    std::binomial_distribution<long> draw(5000, p);
    int held = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const Interval bounds = proportion_bounds(draw(random), 5000, 0.95);
      held += bounds.low <= p && p <= bounds.high;
    }
    EXPECT_GE(held, 935) << p;
    if (p > 0 && p < 1) {
      EXPECT_LE(held, 970) << p;
    }
  }
}

TEST(SamplesForHalfWidth, AreTheFewestThatAreEnough) {
  for (const double p : {0.0, 0.1, 0.5}) {
    const long n = samples_for_half_width(p, 0.02, 0.95);
    const auto width = [&](long samples) {
      const Interval b =
          proportion_bounds(std::lround(p * static_cast<double>(samples)), samples, 0.95);
      return b.high - b.low;
    };
    EXPECT_LE(width(n), 0.04);
    EXPECT_GT(width(n - 1), 0.04 * 0.999) << p;  // rounding of k makes the width jump a little
  }
}

TEST(QuantileBounds, AreThoseOfTheOrderStatistics) {
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i + 1);
  const QuantileBounds median = quantile_bounds(values, 0.5, 0.95);
  EXPECT_EQ(median.estimate, 50.5);
  EXPECT_EQ(median.low, 40);  // Conover's table: r = 40, s = 61
  EXPECT_EQ(median.high, 61);
  const QuantileBounds far = quantile_bounds(values, 0.995, 0.95);
  EXPECT_TRUE(far.low);
  EXPECT_FALSE(far.high) << "100 values do not bound it from above";
}

TEST(QuantileBounds, Cover) {
  std::mt19937_64 random(5);
  std::exponential_distribution<double> draw(1);
  for (const double q : {0.1, 0.5, 0.9}) {
    int held = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      std::vector<double> values(2000);
      for (double& value : values) value = draw(random);
      std::sort(values.begin(), values.end());
      const QuantileBounds bounds = quantile_bounds(values, q, 0.95);
      const double truth = -std::log1p(-q);
      held += bounds.low.value() <= truth && truth <= bounds.high.value();
    }
    EXPECT_GE(held, 930) << q;
    EXPECT_LE(held, 970) << q;
  }
}

}  // namespace
}  // namespace faultsweep
