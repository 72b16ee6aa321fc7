#include "campaign/statistics/predicted_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

const double kNormalReach = student_reach(0.95, HUGE_VAL);

std::vector<double> repeated(std::vector<double> first, std::size_t n, double rest) {
  first.resize(n, rest);
  return first;
}

/// Predictions that are all the same say nothing: the flags' own interval, but for t / z.
TEST(PredictedShare, WithoutPredictionsIsTheShareOfTheFlags) {
  std::vector<double> flags(50, 0.0);
  for (std::size_t i = 0; i < 50; i += 5) flags[i] = 1;
  const PredictedShare share(flags, std::vector<double>(900, 0.3));
  const Estimate found = share.estimate(0.95), alone = share.direct(0.95);
  const Interval jeffreys = jeffreys_bounds(10, 50, 0.95);
  const double stretch = student_reach(0.95, 48) / kNormalReach;
  EXPECT_NEAR(found.value, 0.2, 1e-12);
  EXPECT_NEAR(found.bounds.low, 0.2 - stretch * (0.2 - jeffreys.low), 1e-12);
  EXPECT_NEAR(found.bounds.high, 0.2 + stretch * (jeffreys.high - 0.2), 1e-12);
  EXPECT_EQ(alone.bounds.low, jeffreys.low);
  EXPECT_EQ(alone.bounds.high, jeffreys.high);
  EXPECT_EQ(share.correlation(), 0);
  EXPECT_NEAR(share.n_equivalent(0.95), 50, 1);
}

/// One class. Flags 0 0 1 1 with q .1 .2 .3 .4: the slope would be 4, at most 1 counts; q of all
/// has the mean .26, that of the four is .25. What it leaves: Σ (y − mean y − (q − mean q))² of the
/// deviations −.35, −.45, .45, .35.
TEST(PredictedShare, ByHandInOneClass) {
  const std::vector<double> flags = {0, 0, 1, 1};
  const std::vector<double> predictions = {0.1, 0.2, 0.3, 0.4, 0.3};
  const Estimate found = PredictedShare(flags, predictions).estimate(0.95);
  EXPECT_NEAR(found.value, 0.51, 1e-12);
  const double left = (2 * (0.35 * 0.35 + 0.45 * 0.45) + 1) / (1 + 1), n = 4 / left;
  const Interval of_class = jeffreys_bounds(0.51 * n, n, 0.95);
  const double between = 0.052 / 4;  // Σ (q − .26)² / 4
  const double members = 5 * 0.51 * 0.49 / between;
  const Interval of_all = jeffreys_bounds(0.51 * members, members, 0.95);
  const double stretch = student_reach(0.95, 2) / kNormalReach;
  const double down = std::hypot(0.51 - of_class.low, 0.51 - of_all.low),
               up = std::hypot(of_class.high - 0.51, of_all.high - 0.51);
  EXPECT_NEAR(found.bounds.low, std::max(0.0, 0.51 - stretch * down), 1e-12);
  EXPECT_NEAR(found.bounds.high, std::min(1.0, 0.51 + stretch * up), 1e-12);
}

/// Predictions that are flags make two classes with P = π a + (1 − π) b.
TEST(PredictedShare, ByHandInTwoClasses) {
  std::vector<double> flags = {1, 1, 1, 0, 0, 0, 0, 0, 1, 0}, predictions = {1, 1, 1, 1};
  predictions = repeated(predictions, 10, 0);
  predictions.insert(predictions.end(), 20, 1.0);
  predictions = repeated(predictions, 60, 0);
  const PredictedShare share(flags, predictions);
  const double pi = 24 / 60.0, a = 3 / 4.0, b = 1 / 6.0, value = pi * a + (1 - pi) * b;
  const Estimate found = share.estimate(0.95);
  EXPECT_NEAR(found.value, value, 1e-12);
  const Interval as = jeffreys_bounds(3, 4, 0.95), bs = jeffreys_bounds(1, 6, 0.95);
  const double between = pi * (1 - pi) * (a - b) * (a - b) * 60 / 59;
  const double members = 60 * value * (1 - value) / between;
  const Interval of_all = jeffreys_bounds(value * members, members, 0.95);
  const double up =
      std::sqrt(std::pow(pi * (as.high - a), 2) + std::pow((1 - pi) * (bs.high - b), 2) +
                std::pow(of_all.high - value, 2));
  EXPECT_NEAR(found.bounds.high, value + up * student_reach(0.95, 8) / kNormalReach, 1e-12);
  // Over the ten: 4 ones of y and 4 of q, of which 3 are the same.
  EXPECT_NEAR(share.correlation(), (3 - 1.6) / 2.4, 1e-12);
}

/// 40 flags that are all as predicted do not make it certain.
TEST(PredictedShare, IsNoPointWhereNothingDiffers) {
  std::vector<double> flags, predictions;
  for (int i = 0; i < 100'000; ++i) {
    const bool holds = i % 2 == 0;
    predictions.push_back(holds ? 0.999 : 0.001);
    if (i < 40) flags.push_back(holds ? 1 : 0);
  }
  const Estimate found = PredictedShare(flags, predictions).estimate(0.95);
  EXPECT_NEAR(found.value, 0.5, 1e-3);
  // Of 20 in each class, none: half of what the bound of such a class is.
  const double unseen = 0.5 * jeffreys_bounds(0, 20, 0.95).high;
  EXPECT_NEAR(found.bounds.high - 0.5, unseen, 0.1 * unseen);
  EXPECT_NEAR(0.5 - found.bounds.low, unseen, 0.1 * unseen);
}

TEST(PredictedShare, OfTheOppositeIsTheRest) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> flags, not_flags, predictions, opposite;
  for (int i = 0; i < 300; ++i) {
    predictions.push_back(uniform(random)), opposite.push_back(1 - predictions.back());
    if (i >= 60) continue;
    flags.push_back(uniform(random) < predictions.back() ? 1 : 0);
    not_flags.push_back(1 - flags.back());
  }
  const Estimate one = PredictedShare(flags, predictions).estimate(0.95);
  const Estimate rest = PredictedShare(not_flags, opposite).estimate(0.95);
  EXPECT_NEAR(rest.value, 1 - one.value, 1e-12);
  EXPECT_NEAR(rest.bounds.low, 1 - one.bounds.high, 1e-12);
  EXPECT_NEAR(rest.bounds.high, 1 - one.bounds.low, 1e-12);
}

/// Predictions are not to be believed: shifted as a whole, they say the same.
TEST(PredictedShare, DoesNotTakeOverTheBiasOfPredictions) {
  std::vector<double> flags, right, wrong;
  for (int i = 0; i < 400; ++i) {
    right.push_back(0.05 + 0.3 * (i % 7) / 6.0), wrong.push_back(right.back() + 0.1);
    if (i < 80) flags.push_back(i % 7 > 4 && i % 3 > 0 ? 1 : 0);
  }
  const Estimate one = PredictedShare(flags, right).estimate(0.95);
  const Estimate same = PredictedShare(flags, wrong).estimate(0.95);
  EXPECT_NEAR(one.value, same.value, 1e-12);
  EXPECT_NEAR(one.bounds.high, same.bounds.high, 1e-12);
}

TEST(PredictedShare, KnowsNothingOfAClassWithoutAFlag) {
  std::vector<double> predictions(1000, 0.01);
  std::fill(predictions.end() - 300, predictions.end(), 0.9);
  const PredictedShare share(std::vector<double>(50, 0.0), predictions);
  const Interval bounds = share.estimate(0.95).bounds;
  EXPECT_LE(bounds.low, 0.01);
  EXPECT_GE(bounds.high, 0.29);
  EXPECT_LT(share.half_width(500, 5000, 0.95), 0.05) << "some of more would be in it";
}

/// What it says of other numbers is what a sample with these has.
TEST(PredictedShare, ForeseesTheWidthOfOtherNumbers) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto draw = [&](std::size_t n, std::size_t all) {
    std::vector<double> flags, predictions;
    for (std::size_t i = 0; i < all; ++i) {
      predictions.push_back(std::pow(uniform(random), 3));
      if (i < n) flags.push_back(uniform(random) < predictions.back() ? 1 : 0);
    }
    return PredictedShare(flags, predictions);
  };
  const PredictedShare some = draw(200, 2000);
  EXPECT_EQ(some.half_width(200, 2000, 0.95), half_width(some.estimate(0.95)));
  for (const auto& [n, all] : {std::pair(100, 1000), {800, 2000}, {200, 20'000}, {1600, 16'000}}) {
    const auto other = draw(static_cast<std::size_t>(n), static_cast<std::size_t>(all));
    EXPECT_NEAR(some.half_width(n, all, 0.95) / half_width(other.estimate(0.95)), 1, 0.1)
        << n << " of " << all;
  }
}

}  // namespace
}  // namespace faultsweep
