#include "campaign/statistics/weighted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

std::vector<std::size_t> order_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

std::vector<WeightRange> known(const std::vector<double>& weights) {
  std::vector<WeightRange> ranges;
  for (const double one : weights) ranges.push_back({one, one});
  return ranges;
}

Estimate probability_of(const std::vector<char>& holds, const std::vector<double>& weights) {
  std::vector<Holds> all;
  for (const char one : holds) all.push_back(one != 0 ? Holds::yes : Holds::no);
  return weighted_probability(all, known(weights), 0.95);
}

QuantileBounds quantile_of(const std::vector<double>& values, const std::vector<double>& weights,
                           double q) {
  return weighted_quantile(values, known(weights), order_of(values), q, 0.95);
}

TEST(Weighted, EqualWeightsAreNone) {
  std::vector<double> values(100), weights(100, 0.3);
  std::iota(values.begin(), values.end(), 1.0);
  std::vector<char> holds(100, 0);
  std::fill_n(holds.begin(), 20, char{1});
  EXPECT_NEAR(effective_sample_size(weights), 100, 1e-9);
  const Estimate p = probability_of(holds, weights);
  const Interval exact = proportion_bounds(20, 100, 0.95);
  EXPECT_NEAR(p.value, 0.2, 1e-12);
  EXPECT_NEAR(p.bounds.low, exact.low, 1e-9);
  EXPECT_NEAR(p.bounds.high, exact.high, 1e-9);
  const QuantileBounds median = quantile_of(values, weights, 0.5);
  const QuantileBounds plain = quantile_bounds(values, 0, 0.5, 0.95);
  EXPECT_EQ(median.estimate, 50);
  EXPECT_NEAR(median.low.value(), plain.low.value(), 1);
  EXPECT_NEAR(median.high.value(), plain.high.value(), 1);
}

TEST(Weighted, WhatWeighsNothingSaysNothing) {
  const std::vector<double> values = {1, 2, 3, 1e9}, weights = {1, 1, 1, 0};
  const std::vector<char> holds = {1, 1, 1, 0};
  EXPECT_NEAR(effective_sample_size(weights), 3, 1e-12);
  EXPECT_EQ(probability_of(holds, weights).value, 1);
  EXPECT_EQ(probability_of(holds, weights).bounds.high, 1);
  EXPECT_NEAR(probability_of(holds, weights).bounds.low, std::pow(0.025, 1.0 / 3), 1e-9);
  EXPECT_EQ(quantile_of(values, weights, 0.99).estimate, 3);
  EXPECT_FALSE(quantile_of(values, weights, 0.99).high);
}

TEST(Weighted, OfEqualWeightsTheUnknownMayBeEither) {
  std::vector<Holds> holds(80, Holds::no);
  std::fill_n(holds.begin(), 6, Holds::yes);
  std::fill_n(holds.begin() + 20, 7, Holds::unknown);
  std::vector<WeightRange> weights(80, {0.3, 0.3});
  const Interval exact = proportion_bounds(6, 7, 80, 0.95);
  for (int pass = 0; pass < 2; ++pass) {
    const Estimate p = weighted_probability(holds, weights, 0.95);
    EXPECT_NEAR(p.value, 6.0 / 73, 1e-12);
    EXPECT_NEAR(p.bounds.low, exact.low, 1e-9);
    EXPECT_NEAR(p.bounds.high, exact.high, 1e-9);
    std::fill_n(weights.begin() + 20, 7, WeightRange{0, 0.3});
  }
}

/// However what is not known turns out, what would then be said lies within what was said before.
TEST(Weighted, BoundsHoldHoweverTheUnknownTurnsOut) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform;
  const auto may = [&](double share) { return uniform(random) < share; };
  for (int repeat = 0; repeat < 300; ++repeat) {
    const double share = uniform(random), unknown = 0.3 * uniform(random);
    const double spread = 3 * uniform(random);
    std::vector<Holds> holds;
    std::vector<WeightRange> weights;
    std::vector<double> values;
    for (int i = 0; i < 200; ++i) {
      const double w = std::exp(-spread * uniform(random));
      const bool known = !may(unknown);
      holds.push_back(!known ? Holds::unknown : may(share) ? Holds::yes : Holds::no);
      weights.push_back(known ? WeightRange{w, w} : WeightRange{w * uniform(random), w});
      values.push_back(uniform(random));
    }
    const Interval said = weighted_probability(holds, weights, 0.95).bounds;
    const QuantileBounds median = weighted_quantile(values, weights, order_of(values), 0.5, 0.95);
    for (int resolution = 0; resolution < 30; ++resolution) {
      const double side = resolution == 0 ? 0 : resolution == 1 ? 1 : uniform(random);
      std::vector<char> holds_then;
      std::vector<double> weights_then;
      for (std::size_t i = 0; i < holds.size(); ++i) {
        const auto [least, most] = weights[i];
        const bool extreme = may(0.5);
        weights_then.push_back(extreme ? (may(0.5) ? least : most)
                                       : std::lerp(least, most, uniform(random)));
        holds_then.push_back(
            holds[i] == Holds::yes || (holds[i] == Holds::unknown && may(side)) ? 1 : 0);
      }
      const Interval then = probability_of(holds_then, weights_then).bounds;
      EXPECT_GE(then.low, said.low - 1e-9);
      EXPECT_LE(then.high, said.high + 1e-9);
      const double estimate = quantile_of(values, weights_then, 0.5).estimate;
      EXPECT_TRUE(median.low.value() <= estimate && estimate <= median.high.value());
    }
  }
}

/// Fifty members weigh nine times as much as the other fifty, which alone have the property: its
/// share is sure, but of a hundred members no more is known than of a hundred equal ones.
TEST(Weighted, WeightsMakeNoMoreOfTheMembersThanThereAre) {
  std::vector<double> weights(100, 9);
  std::vector<char> holds(100, 0);
  for (std::size_t i = 0; i < 50; ++i) weights[i] = 1, holds[i] = 1;
  const Estimate p = probability_of(holds, weights);
  const Interval exact = proportion_bounds(10, 100, 0.95);
  EXPECT_NEAR(p.value, 0.1, 1e-12);
  EXPECT_LE(p.bounds.low, exact.low + 1e-9);
  EXPECT_GE(p.bounds.high, exact.high - 1e-9);
}

/// A common factor of the weights says nothing, nor does the order of the members.
TEST(Weighted, OnlyRatiosOfWeightsCount) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values(40), weights(40);
  std::vector<char> holds(40);
  for (std::size_t i = 0; i < 40; ++i)
    values[i] = uniform(random), weights[i] = uniform(random), holds[i] = values[i] > 0.6 ? 1 : 0;
  std::vector<double> back(values.rbegin(), values.rend()), other(weights.rbegin(), weights.rend());
  const std::vector<char> held(holds.rbegin(), holds.rend());
  for (double& one : other) one *= 1e-7;
  const auto expect_same = [](const Estimate& a, const Estimate& b) {
    EXPECT_NEAR(a.value, b.value, 1e-9);
    EXPECT_NEAR(a.standard_error, b.standard_error, 1e-9);
    EXPECT_NEAR(a.bounds.low, b.bounds.low, 1e-7);
    EXPECT_NEAR(a.bounds.high, b.bounds.high, 1e-7);
  };
  expect_same(probability_of(holds, weights), probability_of(held, other));
  for (const double q : {0.1, 0.5, 0.9}) {
    const QuantileBounds a = quantile_of(values, weights, q);
    const QuantileBounds b = quantile_of(back, other, q);
    EXPECT_EQ(a.estimate, b.estimate) << q;
    EXPECT_EQ(a.low, b.low) << q;
    EXPECT_EQ(a.high, b.high) << q;
  }
}

/// θ ~ N(0, 1)², y = 2 θ1 + θ2 seen as 3 ± 0.5. Then θ1 is normal with mean 2·3 / 5.25 and
/// variance 1 − 4 / 5.25, and y itself with mean 5·3 / 5.25.
class LinearGaussian : public ::testing::Test {
 protected:
  static constexpr double kMean = 6 / 5.25, kMeanY = 15 / 5.25;
  const double deviation_ = std::sqrt(1 - 4 / 5.25);

  void draw(std::size_t n, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    theta_.resize(n), y_.resize(n), weights_.resize(n), holds_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      theta_[i] = normal(random);
      y_[i] = 2 * theta_[i] + normal(random);
      weights_[i] = std::exp(-0.5 * (y_[i] - 3) * (y_[i] - 3) / 0.25);
      holds_[i] = y_[i] > kMeanY ? 1 : 0;
    }
  }
  std::vector<double> theta_, y_, weights_;
  std::vector<char> holds_;
};

TEST_F(LinearGaussian, IsMetToOnePercent) {
  std::mt19937_64 random(11);
  draw(400000, random);
  EXPECT_NEAR(probability_of(holds_, weights_).value, 0.5, 0.005);
  for (const auto& [q, z] : {std::pair(0.05, -1.644854), {0.5, 0.0}, {0.95, 1.644854}}) {
    const double truth = kMean + z * deviation_;
    EXPECT_NEAR(quantile_of(theta_, weights_, q).estimate, truth, 0.01 * deviation_) << q;
  }
}

TEST_F(LinearGaussian, IntervalsCover) {
  std::mt19937_64 random(12);
  int probability = 0, median = 0, tail = 0;
  constexpr int kRepeats = 1000;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    draw(2000, random);
    const auto in = [](const Interval& bounds, double truth) {
      return bounds.low <= truth && truth <= bounds.high ? 1 : 0;
    };
    const auto quantile_in = [&](double q, double truth) {
      const QuantileBounds b = quantile_of(theta_, weights_, q);
      return in({b.low.value(), b.high.value()}, truth);
    };
    probability += in(probability_of(holds_, weights_).bounds, 0.5);
    median += quantile_in(0.5, kMean);
    tail += quantile_in(0.9, kMean + 1.281552 * deviation_);
  }
  for (const int held : {probability, median, tail}) {
    EXPECT_GE(held, 930);
    EXPECT_LE(held, 970);
  }
}

/// 1150 draws of which about as many are effective as the fewest that are taken.
TEST_F(LinearGaussian, IntervalsCoverFromTheFewestEffectiveMembers) {
  std::mt19937_64 random(15);
  int probability = 0, rare = 0, median = 0, repeats = 0;
  double effective = 0;
  for (int repeat = 0; repeat < 1000; ++repeat) {
    draw(1150, random);
    const double size = effective_sample_size(weights_);
    if (size < kFewestEffectiveMembers * 0.9) continue;
    ++repeats, effective += size;
    const auto in = [](const Interval& bounds, double truth) {
      return bounds.low <= truth && truth <= bounds.high ? 1 : 0;
    };
    probability += in(probability_of(holds_, weights_).bounds, 0.5);
    std::vector<char> far(1150);
    for (std::size_t i = 0; i < 1150; ++i) far[i] = theta_[i] > kMean + 1.644854 * deviation_;
    rare += in(probability_of(far, weights_).bounds, 0.05);
    const QuantileBounds b = quantile_of(theta_, weights_, 0.5);
    median += in({b.low.value(), b.high.value()}, kMean);
  }
  EXPECT_GT(repeats, 800);
  EXPECT_LT(effective / repeats, 1.2 * kFewestEffectiveMembers);
  for (const int held : {probability, rare, median}) {
    EXPECT_GE(held, 0.925 * repeats);
    EXPECT_LE(held, 0.98 * repeats);
  }
}

}  // namespace
}  // namespace faultsweep
