#include "campaign/statistics/marginal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace faultsweep {
namespace {

constexpr long double kInfinity = std::numeric_limits<long double>::infinity();
constexpr int kParts = 200'000;

struct Moments {
  double mean = 0, deviation = 0;
};

/// Of equally likely values in the middle of many parts of the unit interval.
Moments moments_of(const Marginal& m, bool logarithms = false, int parts = kParts) {
  double sum = 0, squares = 0;
  for (int k = 0; k < parts; ++k) {
    auto x = static_cast<double>(m.quantile((k + 0.5L) / parts));
    if (logarithms) x = std::log(x);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / parts;
  return {mean, std::sqrt(squares / parts - mean * mean)};
}

TEST(Marginal, RangesAreUniformInTheValueOrItsLogarithm) {
  const Marginal uniform{Distribution::uniform, 2, 6};
  EXPECT_EQ(uniform.quantile(0), 2);
  EXPECT_EQ(uniform.quantile(0.25), 3);
  EXPECT_EQ(uniform.quantile(1), 6);
  const Marginal down{Distribution::uniform, 6, 2};
  EXPECT_EQ(down.quantile(0), 6);
  EXPECT_EQ(down.quantile(0.25), 5);
  const Marginal log{Distribution::log_uniform, 1, 100};
  EXPECT_NEAR(static_cast<double>(log.quantile(0.5)), 10, 1e-12);
}

TEST(Marginal, AnUncutNormalHasItsMeanAndDeviation) {
  const Marginal m{Distribution::normal, -kInfinity, kInfinity, 25, 3};
  const Moments moments = moments_of(m);
  EXPECT_NEAR(moments.mean, 25, 1e-9);
  EXPECT_NEAR(moments.deviation, 3, 1e-3);
  EXPECT_NEAR(static_cast<double>(m.quantile(0.975L)), 25 + 3 * 1.959963984540054, 1e-12);
  // Its ends are as far as a sample may reach, and alike.
  EXPECT_NEAR(static_cast<double>(m.quantile(0)), 25 - 3 * 8.29236, 1e-4);
  EXPECT_EQ(m.quantile(0) + m.quantile(1), 50);
}

/// Mean of the standard normal distribution between a and b: (φ(a) − φ(b)) / (Φ(b) − Φ(a)).
TEST(Marginal, ACutNormalHasTheMeanOfTheFormula) {
  const auto density = [](double x) {
    return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
  };
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  for (const auto& [a, b] : {std::pair(-1.0, 2.0), std::pair(1.0, 3.0), std::pair(-4.0, -2.0)}) {
    const Marginal m{Distribution::normal, 10 + 2 * a, 10 + 2 * b, 10, 2};
    const double mean = 10 + 2 * (density(a) - density(b)) / (below(b) - below(a));
    EXPECT_NEAR(moments_of(m).mean, mean, 1e-4) << a << " " << b;
    EXPECT_EQ(m.quantile(0), 10 + 2 * a);
    EXPECT_EQ(m.quantile(1), 10 + 2 * b);
  }
}

TEST(Marginal, FarTailsAreNotLost) {
  // Beyond 7 deviations the excess is exponential with rate 7 to first order: mean 1/7.
  const Marginal right{Distribution::normal, 7, kInfinity, 0, 1};
  const Marginal left{Distribution::normal, -kInfinity, -7, 0, 1};
  EXPECT_NEAR(moments_of(right).mean, 7 + 0.1376, 2e-3);
  for (const long double u : {0.1L, 0.5L, 0.9L})
    EXPECT_NEAR(static_cast<double>(right.quantile(u) + left.quantile(1 - u)), 0, 1e-9);
}

/// Whatever the deviation: of one that is large the cut is uniform, of one that is small against
/// the distance to the centre exponential, from the nearer end on.
TEST(Marginal, ACutNormalIsRightForEveryDeviation) {
  for (int exponent = -300; exponent <= 300; exponent += 20) {
    const long double deviation = std::pow(10.0L, exponent);
    for (const long double centre : {15.0L, 100.0L, -1e12L}) {
      const Marginal m{Distribution::normal, 1, 30, centre, deviation};
      const Moments moments = moments_of(m, false, 2000);
      // Seen from the nearest place of the cut, x there, the density falls like exp(−slope |x|).
      const long double slope = (centre > 30  ? centre - 30
                                 : centre < 1 ? 1 - centre
                                              : 0) /
                                deviation / deviation;
      const std::string what = std::to_string(exponent) + ", " + std::to_string(double(centre));
      if (exponent >= 20) {
        EXPECT_NEAR(moments.mean, 15.5, 1e-9) << what;
        EXPECT_NEAR(moments.deviation, 29 / std::sqrt(12.0), 1e-5) << what;
      } else if (exponent < 0) {
        const auto expected = static_cast<double>(centre > 30  ? 30 - 1 / slope
                                                  : centre < 1 ? 1 + 1 / slope
                                                               : centre);
        EXPECT_NEAR(moments.mean, expected, 1e-3 * std::pow(10.0, exponent) + 1e-13) << what;
      }
      double before = 1;
      for (const long double u : {0.0L, 1e-9L, 0.2L, 0.5L, 0.9L, 1.0L}) {
        const auto x = static_cast<double>(m.quantile(u));
        EXPECT_TRUE(before <= x && x <= 30) << what << ": " << x;
        before = x;
      }
    }
  }
}

/// Where the two ways to a quantile meet, they agree.
TEST(Marginal, ANarrowOrFarCutGoesOnFromAWiderOne) {
  for (const long double z : {0.0L, -0.3L, 2.5L, 7.0L}) {
    const Marginal narrow{Distribution::normal, z, z + 0.999e-3L, 0, 1};
    const Marginal wide{Distribution::normal, z, z + 1.001e-3L, 0, 1};
    for (const long double u : {0.1L, 0.5L, 0.8L}) {
      const auto share = [&](const Marginal& m) {
        return static_cast<double>((m.quantile(u) - m.from) / (m.to - m.from));
      };
      EXPECT_NEAR(share(narrow), share(wide), 5e-6) << static_cast<double>(z);
    }
  }
  const Marginal near{Distribution::normal, 29.999L, 40, 0, 1};
  const Marginal far{Distribution::normal, 30.001L, 40, 0, 1};
  for (const long double u : {0.1L, 0.5L, 0.999L})
    EXPECT_NEAR(static_cast<double>((near.quantile(u) - near.from) / (far.quantile(u) - far.from)),
                1, 1e-4);
}

TEST(Marginal, ACutLogNormalOfAnyFactorIsRight) {
  constexpr int kSome = 2000;
  for (const double factor : {1 + 1e-12, 1.01, 1e10, 1e300, 1e308}) {
    const Marginal m{Distribution::log_normal, 1e-8L, 1.00001e-8L, 1e-8L, factor};
    double mean = 0;  // of the logarithm of x / from
    for (int k = 0; k < kSome; ++k)
      mean += static_cast<double>(std::log(m.quantile((k + 0.5L) / kSome) / m.from)) / kSome;
    const double width = std::log(1.00001), scale = std::log(factor);
    if (width < 0.1 * scale) {  // uniform
      EXPECT_NEAR(mean, width / 2, 1e-3 * width) << factor;
    } else {  // half a normal distribution
      EXPECT_NEAR(mean, scale * std::sqrt(2 / std::numbers::pi), 1e-3 * scale) << factor;
    }
  }
}

TEST(Marginal, ATriangleOfAnySizeHasItsMean) {
  for (const long double size : {1e-300L, 1e-30L, 1.0L, 1e30L, 1e300L}) {
    const Marginal m{Distribution::triangular, -size, 2 * size, size};
    double sum = 0;
    for (int k = 0; k < kParts; ++k)
      sum += static_cast<double>(m.quantile((k + 0.5L) / kParts) / size);
    EXPECT_NEAR(sum / kParts, 2.0 / 3, 1e-6);
  }
}

TEST(Marginal, ALogNormalHasItsMedianAndFactor) {
  const Marginal m{Distribution::log_normal, 0, kInfinity, 1e17L, 3};
  EXPECT_NEAR(static_cast<double>(m.quantile(0.5) / 1e17L), 1, 1e-12);
  const Moments moments = moments_of(m, true);
  EXPECT_NEAR(moments.mean, std::log(1e17), 1e-9);
  EXPECT_NEAR(moments.deviation, std::log(3.0), 1e-3);
  EXPECT_GT(m.quantile(0), 0);
  const Marginal cut{Distribution::log_normal, 0.5L, 4, 1, 2};
  EXPECT_EQ(cut.quantile(0), 0.5L);
  EXPECT_EQ(cut.quantile(1), 4);
}

/// Also where it is cut: the logarithm of a log-normal number is a normal one between the
/// logarithms of its ends.
TEST(Marginal, ALogNormalIsTheExponentialOfANormal) {
  for (const auto& [from, to] : {std::pair(0.5L, 4.0L), {2.0L, 3.0L}, {0.1L, 1.1L}}) {
    const Marginal log{Distribution::log_normal, from, to, 1.5L, 2.5L};
    const Marginal normal{Distribution::normal, std::log(from), std::log(to), std::log(1.5L),
                          std::log(2.5L)};
    for (const long double u : {0.01L, 0.3L, 0.5L, 0.8L, 0.99L}) {
      EXPECT_NEAR(static_cast<double>(std::log(log.quantile(u)) - normal.quantile(u)), 0, 1e-12)
          << static_cast<double>(u);
    }
  }
}

TEST(Marginal, ATriangleHasItsMomentsAndMayLean) {
  for (const double mode : {0.0, 1.0, 4.0}) {
    const Marginal m{Distribution::triangular, 0, 4, mode};
    const Moments moments = moments_of(m);
    EXPECT_NEAR(moments.mean, (0 + 4 + mode) / 3, 1e-6);
    EXPECT_NEAR(moments.deviation, std::sqrt((16 + mode * mode - 4 * mode) / 18), 1e-5);
    EXPECT_EQ(m.quantile(0), 0);
    EXPECT_EQ(m.quantile(1), 4);
  }
}

}  // namespace
}  // namespace faultsweep
