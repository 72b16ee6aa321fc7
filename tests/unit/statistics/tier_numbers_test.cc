#include "campaign/statistics/tier_numbers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsweep {
namespace {

/// √(a / n + b / N): with the prices c of both, n ∝ √(a / c_high) and N ∝ √(b / c_low).
TEST(CheapestNumbers, AreThoseOfTheClosedForm) {
  constexpr double kRest = 0.04, kExplained = 0.96, kWanted = 0.01;
  const TierPrices prices{.low_case = 0.01, .high_case = 1, .once = 50};
  const auto width = [](double n, double all) { return std::sqrt(kRest / n + kExplained / all); };
  const double n = (kRest + std::sqrt(kRest * kExplained * 0.01)) / (kWanted * kWanted);
  const double all = n * std::sqrt(kExplained / kRest / 0.01);
  const auto found = cheapest_numbers(width, kWanted, prices, 40);
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(found->half_width, kWanted);
  EXPECT_GT(width(static_cast<double>(found->n), static_cast<double>(found->all - 1)), kWanted);
  EXPECT_NEAR(static_cast<double>(found->n), n, 0.03 * n);
  EXPECT_NEAR(static_cast<double>(found->all), all, 0.03 * all);
  EXPECT_NEAR(found->cost, 50 + n + 0.01 * all, 0.001 * n);
  EXPECT_EQ(found->cost,
            50 + static_cast<double>(found->n) + 0.01 * static_cast<double>(found->all));
}

/// A cheap model that explains nothing is not run beyond the pairs, nor is one that costs as much.
TEST(CheapestNumbers, AreAsManyOfBothWhereTheCheapModelDoesNotHelp) {
  const TierPrices prices{.low_case = 0.5, .high_case = 1};
  const auto found =
      cheapest_numbers([](double n, double) { return 1 / std::sqrt(n); }, 0.1, prices, 40);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->n, 100);
  EXPECT_EQ(found->all, 100);
}

TEST(CheapestNumbers, AreNotLessThanTheFewest) {
  const TierPrices prices{.low_case = 0.01, .high_case = 1};
  const auto found =
      cheapest_numbers([](double n, double all) { return 1 / n + 1 / all; }, 10, prices, 40);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->n, 40);
  EXPECT_EQ(found->all, 40);
}

TEST(CheapestNumbers, AreNoneWhereNoNumberDoes) {
  const TierPrices prices{.low_case = 0.01, .high_case = 1};
  EXPECT_FALSE(cheapest_numbers([](double, double) { return 0.2; }, 0.1, prices, 40).has_value());
  EXPECT_FALSE(
      cheapest_numbers([](double, double) { return std::nan(""); }, 0.1, prices, 40).has_value());
}

}  // namespace
}  // namespace faultsweep
