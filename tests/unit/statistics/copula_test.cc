#include "campaign/statistics/copula.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace faultsweep {
namespace {

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) ranks[order[k]] = static_cast<double>(k);
  return ranks;
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> a = ranks_of(x), b = ranks_of(y);
  const auto n = static_cast<double>(x.size());
  double squares = 0;
  for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return 1 - 6 * squares / (n * (n * n - 1));
}

TEST(GaussianCopula, GivesTheRankCorrelationsAskedForAndStaysUniform) {
  const std::vector<std::vector<double>> wanted = {{1, -0.5, 0.3}, {-0.5, 1, 0.4}, {0.3, 0.4, 1}};
  const auto copula = GaussianCopula::make(wanted);
  ASSERT_TRUE(copula);
  constexpr std::size_t kSamples = 40'000;
  std::mt19937_64 random(7);
  std::array<std::vector<double>, 3> columns;
  for (std::size_t i = 0; i < kSamples; ++i) {
    std::array<double, 3> u;
    for (double& one : u) one = static_cast<double>(random() >> 11) * 0x1p-53;
    const double first = u[0];
    copula->correlate(u);
    EXPECT_EQ(u[0], first);
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(u[k]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NEAR(rank_correlation(columns[i], columns[j]), wanted[i][j], 0.015) << i << j;
    std::vector<double> sorted = columns[i];
    std::sort(sorted.begin(), sorted.end());
    double farthest = 0;  // Kolmogorov's distance: 1.63 / √n is exceeded once in a hundred times
    for (std::size_t k = 0; k < kSamples; ++k)
      farthest =
          std::max(farthest, std::abs(sorted[k] - (static_cast<double>(k) + 0.5) / kSamples));
    EXPECT_LT(farthest, 1.63 / 200);
    EXPECT_GT(sorted.front(), 0);
    EXPECT_LT(sorted.back(), 1);
  }
}

/// Of two numbers the second is Φ(r z₁ + √(1 − r²) z₂), with r = 2 sin(π ρ / 6) (Pearson 1907).
TEST(GaussianCopula, IsNormalWithPearsonsCorrelation) {
  const auto probability = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  for (const double rank : {-0.8, -0.3, 0.5, 0.95}) {
    const double r = 2 * std::sin(std::acos(-1.0) * rank / 6);
    const auto copula = GaussianCopula::make({{1, rank}, {rank, 1}});
    for (const auto& [a, b] : {std::pair(0.3, -1.2), {-2.0, 0.4}, {1.5, 1.5}}) {
      std::array<double, 2> u = {probability(a), probability(b)};
      copula->correlate(u);
      EXPECT_NEAR(u[1], probability(r * a + std::sqrt(1 - r * r) * b), 1e-9) << rank;
    }
  }
}

TEST(GaussianCopula, RefusesWhatNoNumbersCanHave) {
  EXPECT_FALSE(GaussianCopula::make({{1, 0.9, -0.9}, {0.9, 1, 0.9}, {-0.9, 0.9, 1}}));
  EXPECT_FALSE(GaussianCopula::make({{1, 1}, {1, 1}}));
  EXPECT_TRUE(GaussianCopula::make({{1, 0.999}, {0.999, 1}}));
}

TEST(GaussianCopula, KeepsTheEndsWithinTheUnitInterval) {
  const auto copula = GaussianCopula::make({{1, -0.9}, {-0.9, 1}});
  for (const double end : {0.0, 1 - 0x1p-53}) {
    std::array<double, 2> u = {end, end};
    copula->correlate(u);
    EXPECT_GT(u[1], 0);
    EXPECT_LT(u[1], 1);
  }
}

}  // namespace
}  // namespace faultsweep
