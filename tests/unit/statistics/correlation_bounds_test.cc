#include "campaign/statistics/correlation_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace faultsweep {
namespace {

constexpr double kMany = std::numeric_limits<double>::infinity();

TEST(CorrelationBounds, AreFishersOfAKnownCase) {
  // r = 0.6 of 103 normal pairs: √variance = (1 − r²) / 10, so z = 0.6931 ± 0.196
  const Interval bounds = correlation_bounds(0.6, std::pow(0.064, 2), kMany, 0.95);
  EXPECT_NEAR(bounds.low, std::tanh(0.693147 - 0.1959964), 1e-6);
  EXPECT_NEAR(bounds.high, std::tanh(0.693147 + 0.1959964), 1e-6);
  EXPECT_LT(correlation_bounds(0.6, 0.004, 5, 0.95).low, bounds.low) << "fewer degrees of freedom";
}

TEST(CorrelationBounds, StayWithinWhatACorrelationCanBe) {
  for (const double r : {-1.0, -0.999, 0.3, 0.999, 1.0, 1.001}) {
    for (const double error : {1e-6, 0.01, 0.5, 3.0}) {
      const Interval bounds = correlation_bounds(r, error * error, 1, 0.95);
      EXPECT_GE(bounds.low, -1) << r;
      EXPECT_LE(bounds.high, 1) << r;
      EXPECT_LT(bounds.low, bounds.high) << r << ", " << error;
    }
  }
  EXPECT_GT(correlation_bounds(1, 1e-6, kMany, 0.95).low, 0.98) << "near 1 with a small error";
  EXPECT_EQ(correlation_bounds(1, 0, 10, 0.95).low, 1);
  EXPECT_EQ(correlation_bounds(1, 0, 10, 0.95).high, 1);
}

/// 20 of 1,000 have it, and no neighbour of theirs: q is at most z² / (20 + z²), however small the
/// variance that was seen.
TEST(FlagBounds, HoldWhereNoPairHasTheRarerValue) {
  const RareValue rare{20, 0.02};
  const double z = 1.959964, most = z * z / (20 + z * z);
  for (const double variance : {0.0, 1e-3, 1e-9}) {
    const Interval bounds = flag_correlation_bounds(-0.02 / 0.98, variance, rare, kMany, 0.95);
    EXPECT_NEAR(bounds.low, -0.02 / 0.98, 1e-9);
    EXPECT_NEAR(bounds.high, (most - 0.02) / 0.98, 1e-6);
  }
  const Interval of_one =
      flag_correlation_bounds((1.0 / 20 - 0.02) / 0.98, 0.05, rare, kMany, 0.95);
  EXPECT_LT(of_one.high, 0.3) << "not as if from less than one member: 0.05 · 0.95 / 0.048";
}

/// Of half and half, with q = 0.75 from 60 members: Wilson's 0.628 to 0.842, mapped to 2 q − 1.
TEST(FlagBounds, AreWilsonsShare) {
  const Interval bounds =
      flag_correlation_bounds(0.5, 0.75 * 0.25 / 60 / 0.25, {50, 0.5}, kMany, 0.95);
  EXPECT_NEAR(bounds.low, 2 * 0.62767 - 1, 1e-4);
  EXPECT_NEAR(bounds.high, 2 * 0.84225 - 1, 1e-4);
}

TEST(RarerOfTwo, IsCounted) {
  const std::vector<double> flags = {0, 1, 0, std::nan(""), 0, 1, 0, 0, 0};
  const auto rare = rarer_of_two(flags);
  ASSERT_TRUE(rare);
  EXPECT_EQ(rare->count, 2);
  EXPECT_EQ(rare->share, 0.25);
  EXPECT_FALSE(rarer_of_two(std::vector<double>{1, 1, 1})) << "one value";
  EXPECT_FALSE(rarer_of_two(std::vector<double>{1, 2, 3})) << "three";
  EXPECT_FALSE(rarer_of_two({}));
}

TEST(RareTogether, TakesTheFewestAndTheMeanShare) {
  RareTogether rare;
  EXPECT_FALSE(rare.found());
  rare.add(RareValue{10, 0.1});
  rare.add(RareValue{30, 0.3});
  ASSERT_TRUE(rare.found());
  EXPECT_EQ(rare.found()->count, 10);
  EXPECT_NEAR(rare.found()->share, (10 * 0.1 + 30 * 0.3) / 40, 1e-15);
  rare.add(std::nullopt);
  EXPECT_FALSE(rare.found()) << "one of them is no flag";
}

TEST(EffectiveRows, AreThoseThatCarryTheVariance) {
  EffectiveRows equal, few;
  for (int k = 0; k < 50; ++k) equal.add(4), few.add(k < 5 ? 1 : 0);
  EXPECT_NEAR(equal.count(), 50, 1e-12);
  EXPECT_NEAR(few.count(), 5, 1e-12);
  EXPECT_EQ(EffectiveRows().count(), 0);
}

}  // namespace
}  // namespace faultsweep
