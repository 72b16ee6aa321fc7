#include "campaign/statistics/calibrated_quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/statistics/tier_models.h"

namespace faultsweep {
namespace {

using testing::TierDraw;

CalibratedDistribution distribution_of(const TierDraw& draw) {
  return {draw.high, draw.standard()};
}

TEST(CalibratedQuantile, Covers) {
  std::mt19937_64 random(3);
  for (const auto& [q, truth] : {std::pair(0.5, 0.0), {0.8, 0.8416212}}) {
    int held = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
      const TierDraw draw({.correlation = 0.9}, 60, 300, random);
      const QuantileBounds b = distribution_of(draw).quantile(q, 0.95).bounds;
      held += b.low.value_or(-HUGE_VAL) <= truth && truth <= b.high.value_or(HUGE_VAL);
    }
    EXPECT_GE(held, 53) << q;
  }
}

/// The cheap model is 3 less throughout: the quantile is that of all, 3 more.
TEST(CalibratedQuantile, IsThatOfAllWhereTheModelsDifferByAConstant) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<std::vector<double>> low(1);
  std::vector<double> high;
  for (int i = 0; i < 2000; ++i) {
    low[0].push_back(normal(random));
    if (i < 60) high.push_back(low[0].back() + 3);
  }
  const CalibratedDistribution found(high, {low, 2000});
  std::ranges::sort(low[0]);
  for (const double q : {0.2, 0.5, 0.9}) {
    const double all = low[0][static_cast<std::size_t>(q * 2000)] + 3;
    const CalibratedQuantile one = found.quantile(q, 0.95);
    EXPECT_NEAR(one.bounds.estimate, all, 0.1) << q;
    EXPECT_LT(one.bounds.low.value(), all) << q;
    EXPECT_GT(one.bounds.high.value(), all) << q;
    EXPECT_NEAR(one.share_up_to_it.estimate(0.95).value, q, 0.01);
    const QuantileBounds alone = found.direct(q, 0.95);
    if (alone.high) {
      EXPECT_LT(*one.bounds.high - *one.bounds.low, 0.8 * (*alone.high - *alone.low)) << q;
    }
  }
}

TEST(CalibratedQuantile, IsInTheUnitsOfTheValues) {
  std::mt19937_64 random(5);
  TierDraw draw({.correlation = 0.9}, 80, 300, random);
  const CalibratedQuantile one = distribution_of(draw).quantile(0.3, 0.95);
  for (double& y : draw.high) y = 1e6 * y + 5e6;
  for (std::vector<double>& x : draw.features)
    for (double& value : x) value = 7 - 0.01 * value;
  const CalibratedQuantile same = distribution_of(draw).quantile(0.3, 0.95);
  EXPECT_NEAR(same.bounds.estimate, 1e6 * one.bounds.estimate + 5e6, 10);
  EXPECT_NEAR(same.bounds.low.value(), 1e6 * one.bounds.low.value() + 5e6, 10);
  EXPECT_NEAR(same.bounds.high.value(), 1e6 * one.bounds.high.value() + 5e6, 10);
}

/// Of 40 values none need be as small as a hundredth of all are.
TEST(CalibratedQuantile, LeavesAnEndOpenThatTheFewValuesDoNotClose) {
  std::mt19937_64 random(6);
  const TierDraw draw({}, 40, 1000, random);
  const CalibratedQuantile found = distribution_of(draw).quantile(0.01, 0.95);
  EXPECT_FALSE(found.bounds.low.has_value());
  EXPECT_TRUE(found.bounds.high.has_value());
  EXPECT_TRUE(std::isnan(found.half_width(100, 1000, 0.95)));
}

/// Where most values are the same, a quantile among them is that value.
TEST(CalibratedQuantile, StandsValuesThatAreTheSame) {
  std::mt19937_64 random(7);
  TierDraw draw({.correlation = 0.95}, 100, 1000, random);
  draw.features.resize(1);
  for (double& y : draw.high) y = std::max(0.0, y - 1);
  for (double& x : draw.features[0]) x = std::max(0.0, x - 1);
  const QuantileBounds found = distribution_of(draw).quantile(0.5, 0.95).bounds;
  EXPECT_NEAR(found.estimate, 0, 1e-9);
  EXPECT_NEAR(found.high.value(), 0, 1e-9);
}

TEST(CalibratedQuantile, ForeseesTheWidthOfOtherNumbers) {
  std::mt19937_64 random(8);
  double foreseen = 0, found = 0;
  for (int repeat = 0; repeat < 12; ++repeat) {
    const TierDraw some({.correlation = 0.9}, 100, 500, random),
        more({.correlation = 0.9}, 400, 2000, random);
    const auto of = [](const TierDraw& draw) { return distribution_of(draw).quantile(0.5, 0.95); };
    const auto half = [](const QuantileBounds& b) { return 0.5 * (*b.high - *b.low); };
    const CalibratedQuantile one = of(some);
    EXPECT_NEAR(one.half_width(100, 500, 0.95), half(one.bounds), 1e-12);
    foreseen += one.half_width(400, 2000, 0.95), found += half(of(more).bounds);
  }
  EXPECT_NEAR(foreseen / found, 1, 0.2) << "few members have somewhat wider bounds than they need";
}

}  // namespace
}  // namespace faultsweep
