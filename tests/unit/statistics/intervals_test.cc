#include "campaign/statistics/intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// Of 200 samples up to 30 % are not decided: whichever way an adversary decides them who knows the
/// truth, the bounds hold it.
TEST(ProportionBounds, CoverHoweverTheUndecidedTurnOut) {
  constexpr long kSamples = 200;
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double p : {0.0, 0.01, 0.1, 0.5, 0.9, 1.0}) {
    for (const double undecided : {0.0, 0.1, 0.3}) {
      int hides_yes = 0, hides_no = 0;
      for (int repeat = 0; repeat < 1000; ++repeat) {
        // The first to be undecided are those that have the property, or those that do not.
        const auto k = std::binomial_distribution<long>(kSamples, p)(random);
        const auto u = static_cast<long>(undecided * kSamples);
        const Interval with_yes = proportion_bounds(std::max(0L, k - u), u, kSamples, 0.95);
        const Interval with_no = proportion_bounds(std::min(k, kSamples - u), u, kSamples, 0.95);
        hides_yes += with_yes.low <= p && p <= with_yes.high;
        hides_no += with_no.low <= p && p <= with_no.high;
      }
      EXPECT_GE(hides_yes, 935) << p << ", " << undecided;
      EXPECT_GE(hides_no, 935) << p << ", " << undecided;
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
  const QuantileBounds median = quantile_bounds(values, 0, 0.5, 0.95);
  EXPECT_EQ(median.estimate, 50.5);
  EXPECT_EQ(median.low, 40);  // Conover's table: r = 40, s = 61
  EXPECT_EQ(median.high, 61);
  const QuantileBounds far = quantile_bounds(values, 0, 0.995, 0.95);
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
      const QuantileBounds bounds = quantile_bounds(values, 0, q, 0.95);
      const double truth = -std::log1p(-q);
      held += bounds.low.value() <= truth && truth <= bounds.high.value();
    }
    EXPECT_GE(held, 930) << q;
    EXPECT_LE(held, 970) << q;
  }
}

/// The undecided are the largest of a sample, the smallest, or any.
TEST(QuantileBounds, CoverHoweverTheUnknownTurnOut) {
  std::mt19937_64 random(32);
  std::exponential_distribution<double> draw(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr long kSamples = 120;
  for (const double q : {0.1, 0.5, 0.9}) {
    for (const long unknown : {0L, 12L, 36L}) {
      std::array<int, 3> held{};
      for (int repeat = 0; repeat < 1000; ++repeat) {
        std::vector<double> values(kSamples);
        for (double& value : values) value = draw(random);
        const auto n_known = static_cast<std::size_t>(kSamples - unknown);
        const std::vector<double> any(values.begin(),
                                      values.begin() + static_cast<std::ptrdiff_t>(n_known));
        std::sort(values.begin(), values.end());
        std::vector<std::vector<double>> known = {any,
                                                  {values.begin(), values.end() - unknown},
                                                  {values.begin() + unknown, values.end()}};
        std::sort(known[0].begin(), known[0].end());
        for (std::size_t who = 0; who < 3; ++who) {
          const QuantileBounds bounds = quantile_bounds(known[who], unknown, q, 0.95);
          const double truth = -std::log1p(-q);
          held[who] +=
              bounds.low.value_or(-kInfinity) <= truth && truth <= bounds.high.value_or(kInfinity);
        }
      }
      for (const int one : held) EXPECT_GE(one, 935) << q << ", " << unknown;
    }
  }
}

/// As if those that are unknown were smaller than all others, or larger.
TEST(QuantileBounds, TakeTheUnknownAsFarOut) {
  std::mt19937_64 random(33);
  std::normal_distribution<double> draw;
  std::vector<double> values(80);
  for (double& value : values) value = draw(random);
  std::sort(values.begin(), values.end());
  std::vector<double> below(10, -1e9), above = values;
  below.insert(below.end(), values.begin(), values.end());
  above.insert(above.end(), 10, 1e9);
  const QuantileBounds found = quantile_bounds(values, 10, 0.5, 0.95);
  EXPECT_EQ(found.low, quantile_bounds(below, 0, 0.5, 0.95).low);
  EXPECT_EQ(found.high, quantile_bounds(above, 0, 0.5, 0.95).high);
  EXPECT_EQ(found.estimate, quantile_bounds(values, 0, 0.5, 0.95).estimate);
  EXPECT_FALSE(quantile_bounds(values, 30, 0.1, 0.95).low);
  EXPECT_FALSE(quantile_bounds(values, 30, 0.9, 0.95).high);
}

/// Of a flag, where values are equal: bounds may lie on them.
TEST(QuantileBounds, CoverWhereValuesAreEqual) {
  std::mt19937_64 random(34);
  for (const double p : {0.3, 0.49, 0.7}) {
    std::bernoulli_distribution draw(p);
    int held = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      std::vector<double> values(50);
      for (double& value : values) value = draw(random) ? 1 : 0;
      std::sort(values.begin(), values.end());
      const QuantileBounds bounds = quantile_bounds(values, 0, 0.5, 0.95);
      const double truth = p > 0.5 ? 1 : 0;
      held += bounds.low.value() <= truth && truth <= bounds.high.value();
    }
    EXPECT_GE(held, 935) << p;
  }
}

TEST(StudentReach, IsThatOfTheTables) {
  EXPECT_NEAR(student_reach(0.95, 4), 2.776445, 1e-6);
  EXPECT_NEAR(student_reach(0.9, 30), 1.697261, 1e-6);
  EXPECT_NEAR(student_reach(0.95, std::numeric_limits<double>::infinity()), 1.959964, 1e-6);
  const Estimate e = student_estimate(2, 0.5, 4, 0.95);
  EXPECT_NEAR(e.bounds.low, 2 - 0.5 * 2.776445, 1e-6);
  EXPECT_NEAR(e.bounds.high, 2 + 0.5 * 2.776445, 1e-6);
}

/// Beta(1, ½) has the distribution function 1 − √(1 − x).
TEST(Jeffreys, HasTheQuantilesOfABetaDistribution) {
  const Interval bounds = jeffreys_bounds(0.5, 0.5, 0.9);
  EXPECT_NEAR(bounds.low, 1 - 0.95 * 0.95, 1e-12);
  EXPECT_EQ(bounds.high, 1) << "all have it";
  EXPECT_EQ(jeffreys_bounds(0, 30, 0.95).low, 0);
  EXPECT_NEAR(jeffreys_bounds(0, 1e6, 0.95).high * 1e6, 2.512, 1e-3) << "half of χ² of 1 at 97.5 %";
  EXPECT_EQ(jeffreys_bounds(0, 0, 0.95).high, 1);
}

TEST(Jeffreys, MembersForAHalfWidthHaveIt) {
  const double n = members_for_half_width(0.3, 0.02, 10, 0.95);
  const Interval bounds = jeffreys_bounds(0.3 * n, n, 0.95);
  EXPECT_NEAR(0.5 * (bounds.high - bounds.low), 0.02, 1e-6);
  EXPECT_EQ(members_for_half_width(0.3, 0.4, 100, 0.95), 100) << "there are as many already";
}

}  // namespace
}  // namespace faultsweep
