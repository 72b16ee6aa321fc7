#include "campaign/statistics/morris.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace faultsweep {
namespace {

constexpr int kLevels = 4;
constexpr double kStep = kLevels / 2.0 / (kLevels - 1);  // 2/3 of the range
using Point = std::array<double, 3>;

/// Sobol's G function; the first parameter matters most.
double g_function(const Point& x) {
  constexpr double kA[] = {0, 1, 9};
  double product = 1;
  for (std::size_t i = 0; i < 3; ++i) product *= (std::abs(4 * x[i] - 2) + kA[i]) / (1 + kA[i]);
  return product;
}

/// As a campaign draws them: a random point, then each parameter once, in random order.
struct Drawn {
  std::vector<std::vector<double>> x{3};
  std::vector<double> y;
  template <typename Model>
  Drawn(int trajectories, const Model& model, std::mt19937_64& random) {
    for (int t = 0; t < trajectories; ++t) {
      std::array<int, 3> levels{}, order = {0, 1, 2};
      for (int& level : levels) level = static_cast<int>(random() % kLevels);
      std::shuffle(order.begin(), order.end(), random);
      const auto add = [&] {
        Point at{};
        for (std::size_t k = 0; k < 3; ++k) {
          at[k] = levels[k] / (kLevels - 1.0);
          x[k].push_back(at[k]);
        }
        y.push_back(model(at));
      };
      add();
      for (const int k : order) {
        int& level = levels[static_cast<std::size_t>(k)];
        level += level < kLevels / 2 ? kLevels / 2 : -kLevels / 2;
        add();
      }
    }
  }
  std::vector<ElementaryEffects> effects() const {
    const auto made = MorrisDesign::make(x, kStep);
    EXPECT_TRUE(made.design) << made.refusal;
    return made.design.value().effects(y, 0.95);
  }
};

/// μ, μ* and σ over the whole grid: every point is as likely to be where a parameter moves from.
struct Known {
  double mean = 0, magnitude = 0, deviation = 0;
};
Known known_of(std::size_t parameter) {
  Known known;
  double squares = 0;
  constexpr int kPoints = kLevels * kLevels * kLevels;
  for (int point = 0; point < kPoints; ++point) {
    std::array<int, 3> levels = {point % kLevels, point / kLevels % kLevels,
                                 point / kLevels / kLevels};
    const auto value = [&] {
      Point at{};
      for (std::size_t k = 0; k < 3; ++k) at[k] = levels[k] / (kLevels - 1.0);
      return g_function(at);
    };
    const double before = value();
    const bool is_up = levels[parameter] < kLevels / 2;
    levels[parameter] += is_up ? kLevels / 2 : -kLevels / 2;
    const double effect = (value() - before) / (is_up ? kStep : -kStep);
    known.mean += effect / kPoints, known.magnitude += std::abs(effect) / kPoints;
    squares += effect * effect / kPoints;
  }
  known.deviation = std::sqrt(squares - known.mean * known.mean);
  return known;
}

TEST(Morris, MeetsTheWholeGridOfTheGFunction) {
  std::mt19937_64 random(2);
  const Drawn drawn(20'000, g_function, random);
  const auto found = drawn.effects();
  for (std::size_t k = 0; k < 3; ++k) {
    const Known known = known_of(k);
    EXPECT_NEAR(found[k].mean.value, known.mean, 4 * found[k].mean.standard_error) << k;
    EXPECT_NEAR(found[k].mean_magnitude.value, known.magnitude,
                4 * found[k].mean_magnitude.standard_error)
        << k;
    EXPECT_NEAR(found[k].deviation.value, known.deviation, 4 * found[k].deviation.standard_error)
        << k;
    EXPECT_LT(found[k].mean_magnitude.standard_error, 0.01 * known.magnitude) << k;
    EXPECT_EQ(found[k].n, 20'000) << k;
  }
}

TEST(Morris, OrdersParametersByHowMuchTheyMatter) {
  std::mt19937_64 random(3);
  const auto found = Drawn(kFewestTrajectories, g_function, random).effects();
  EXPECT_GT(found[0].mean_magnitude.bounds.low, found[1].mean_magnitude.bounds.high * 0.9);
  EXPECT_GT(found[0].mean_magnitude.value, found[1].mean_magnitude.value);
  EXPECT_GT(found[1].mean_magnitude.bounds.low, found[2].mean_magnitude.bounds.high);
}

TEST(Morris, ItsIntervalsCover) {
  constexpr int kRepeats = 1000;
  std::mt19937_64 random(4);
  std::array<Known, 3> known;
  for (std::size_t k = 0; k < 3; ++k) known[k] = known_of(k);
  std::array<std::array<int, 3>, 3> held{};
  const auto in = [](const Estimate& e, double truth) {
    return e.bounds.low <= truth && truth <= e.bounds.high ? 1 : 0;
  };
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const auto found = Drawn(kFewestTrajectories, g_function, random).effects();
    for (std::size_t k = 0; k < 3; ++k) {
      held[k][0] += in(found[k].mean, known[k].mean);
      held[k][1] += in(found[k].mean_magnitude, known[k].magnitude);
      held[k][2] += in(found[k].deviation, known[k].deviation);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t which = 0; which < 3; ++which) {
      EXPECT_GE(held[k][which], 925) << k << ", measure " << which;
      EXPECT_LE(held[k][which], which == 2 ? 1000 : 970) << k << ", measure " << which;
    }
  }
}

/// y = 3 a − 2 b + c: each effect is the slope, whatever the way it was walked.
TEST(Morris, OfAPlaneIsItsSlopesExactly) {
  std::mt19937_64 random(5);
  const Drawn drawn(
      5, [](const Point& x) { return 3 * x[0] - 2 * x[1] + x[2]; }, random);
  const auto found = drawn.effects();
  const double slopes[] = {3, -2, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found[k].mean.value, slopes[k], 1e-12);
    EXPECT_NEAR(found[k].mean_magnitude.value, std::abs(slopes[k]), 1e-12);
    EXPECT_EQ(found[k].deviation.value, 0);
    EXPECT_EQ(found[k].deviation.bounds.high, 0);
  }
}

/// Two trajectories by hand, D = 1 and Δ = ½: effects (3 − 1) / ½ = 4 and, downwards,
/// (4 − 3) / −½ = −2. σ² = (3² + 3²) / 1.
TEST(Morris, IsItsDefinitionOnTwoTrajectories) {
  const std::vector<std::vector<double>> x = {{0, 5, 5, 0}};
  const auto made = MorrisDesign::make(x, 0.5);
  ASSERT_TRUE(made.design);
  EXPECT_EQ(made.design->n_trajectories(), 2);
  const std::vector<double> y = {1, 3, 3, 4};
  const ElementaryEffects found = made.design->effects(y, 0.95)[0];
  EXPECT_NEAR(found.mean.value, 1, 1e-12);
  EXPECT_NEAR(found.mean_magnitude.value, 3, 1e-12);
  EXPECT_NEAR(found.deviation.value, std::sqrt(18.0), 1e-12);
  EXPECT_NEAR(found.mean.standard_error, 3, 1e-12);
  EXPECT_NEAR(found.mean.bounds.high, 1 + 12.7062047 * 3, 1e-5);  // t of one degree of freedom
  EXPECT_EQ(found.mean_magnitude.bounds.low, 0) << "3 − 12.7 is below what it can be";
}

/// Twelve effects of one parameter, 0 to 11: their variance is 13, their kurtosis 1.78322, and
/// √(κ − 9 / 12) / √11 / 2 = 0.15323 the error of ln σ, with three degrees of freedom.
TEST(Morris, BoundsOfADeviationAreThoseOfItsLogarithm) {
  std::vector<std::vector<double>> x(1);
  std::vector<double> y;
  for (int effect = 0; effect < 12; ++effect) {
    x[0].insert(x[0].end(), {0, 1});
    y.insert(y.end(), {0, 0.5 * effect});
  }
  const Estimate deviation = MorrisDesign::make(x, 0.5).design->effects(y, 0.95)[0].deviation;
  EXPECT_NEAR(deviation.value, std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(deviation.standard_error / deviation.value, 0.15323, 1e-4);
  EXPECT_NEAR(std::log(deviation.bounds.high / deviation.value), 3.182446 * 0.15323, 1e-3);
  EXPECT_NEAR(std::log(deviation.bounds.low / deviation.value), -3.182446 * 0.15323, 1e-3);
}

/// Row 2 of the first trajectory is missing: the moves to it and from it are not known.
TEST(Morris, ATrajectoryWithAMissingValueGivesTheEffectsThatAreKnown) {
  std::mt19937_64 random(6);
  Drawn drawn(10, g_function, random);
  const auto whole = drawn.effects();
  drawn.y[1] = std::nan("");
  const auto found = drawn.effects();
  long n = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    n += found[k].n;
    EXPECT_EQ(whole[k].n, 10);
    EXPECT_TRUE(std::isfinite(found[k].mean.value));
  }
  EXPECT_EQ(n, 28);
  for (double& value : drawn.y) value = std::nan("");
  EXPECT_EQ(drawn.effects()[0].n, 0);
  EXPECT_TRUE(std::isnan(drawn.effects()[0].mean_magnitude.value));
}

TEST(Morris, OneEffectIsNotBounded) {
  std::mt19937_64 random(7);
  const auto found = Drawn(1, g_function, random).effects();
  EXPECT_TRUE(std::isfinite(found[0].mean.value));
  EXPECT_TRUE(std::isinf(found[0].mean.bounds.high));
  EXPECT_TRUE(std::isinf(found[0].deviation.bounds.high));
}

TEST(Morris, RefusesRowsThatAreNoTrajectories) {
  const auto refusal = [](const std::vector<std::vector<double>>& x) {
    return MorrisDesign::make(x, 0.5).refusal;
  };
  const auto text = [](int row) {
    return "row " + std::to_string(row) +
           " does not differ from the one before in exactly one parameter that its trajectory has "
           "not moved yet";
  };
  EXPECT_EQ(refusal({{0, 1, 1}, {0, 0, 1}}), "");
  EXPECT_EQ(refusal({{0, 1, 1, 0}, {0, 0, 1, 1}}),
            "4 rows do not divide into trajectories of 3 rows");
  EXPECT_EQ(refusal({}), "0 rows do not divide into trajectories of 1 rows");
  EXPECT_EQ(refusal({{0, 1, 1}, {0, 1, 0}}), text(2)) << "two moved";
  EXPECT_EQ(refusal({{0, 0, 1}, {0, 0, 1}}), text(2)) << "none moved";
  EXPECT_EQ(refusal({{0, 1, 0}, {0, 0, 0}}), text(3)) << "the same moved twice";
  EXPECT_EQ(refusal({{0, 1, 1, 0, 0, 0}, {0, 0, 1, 0, 1, 0}}), text(6)) << "the second trajectory";
}

}  // namespace
}  // namespace faultsweep
