#include "campaign/statistics/level_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace faultsweep {
namespace {

using Levels = std::vector<std::vector<std::uint32_t>>;
using Row = std::vector<std::uint32_t>;

/// All combinations, the last factor fastest.
Levels full(const std::vector<std::uint32_t>& counts) {
  std::size_t n = 1;
  for (const std::uint32_t count : counts) n *= count;
  Levels levels(counts.size(), Row(n));
  for (std::size_t row = 0; row < n; ++row) {
    std::size_t rest = row;
    for (std::size_t f = counts.size(); f-- > 0; rest /= counts[f])
      levels[f][row] = static_cast<std::uint32_t>(rest % counts[f]);
  }
  return levels;
}

Row row_of(const Levels& levels, std::size_t row) {
  Row one;
  for (const auto& factor : levels) one.push_back(factor[row]);
  return one;
}

std::vector<double> values_of(const Levels& levels,
                              const std::function<double(const Row&)>& function) {
  std::vector<double> values;
  for (std::size_t row = 0; row < levels[0].size(); ++row)
    values.push_back(function(row_of(levels, row)));
  return values;
}

double variance_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double one : values) squares += (one - mean) * (one - mean);
  return squares / n;
}

/// By the definitions: rows are grouped by comparing their levels, one by one.
ExactIndices by_definition(const Levels& levels, const std::vector<double>& values, std::size_t f) {
  const std::size_t n = values.size();
  std::vector<double> expected;  // E[y | x_f], per row
  double within = 0;             // E[Var(y | x_others)]
  for (std::size_t row = 0; row < n; ++row) {
    std::vector<double> same_level, same_others;
    Row here = row_of(levels, row);
    for (std::size_t other = 0; other < n; ++other) {
      Row there = row_of(levels, other);
      if (there[f] == here[f]) same_level.push_back(values[other]);
      there[f] = here[f];
      if (there == here) same_others.push_back(values[other]);
    }
    expected.push_back(std::accumulate(same_level.begin(), same_level.end(), 0.0) /
                       static_cast<double>(same_level.size()));
    within += variance_of(same_others) / static_cast<double>(n);
  }
  return {variance_of(expected) / variance_of(values), within / variance_of(values)};
}

GridIndices indices_of(const Levels& levels, const std::vector<double>& values) {
  const auto made = FullGrid::make(levels);
  EXPECT_TRUE(made.grid) << made.refusal;
  return made.grid.value().indices(values).value();
}

double wild(const Row& x) {
  return std::sin(3.0 * x[0] + 1) * (1 + x[1]) + std::exp(0.3 * x[2]) * x[0] - 20.0 * (x[1] == 4);
}

TEST(LevelMeans, AreWhatTheDefinitionsSay) {
  for (const auto& counts : {std::vector<std::uint32_t>{3, 5, 6}, {2, 2, 9}, {7, 1, 4}}) {
    const Levels levels = full(counts);
    const std::vector<double> values = values_of(levels, wild);
    const GridIndices found = indices_of(levels, values);
    EXPECT_NEAR(found.variance, variance_of(values), 1e-12 * found.variance);
    for (std::size_t f = 0; f < counts.size(); ++f) {
      const ExactIndices known = by_definition(levels, values, f);
      EXPECT_NEAR(found.factors[f].first, known.first, 1e-12) << counts[0] << ", factor " << f;
      EXPECT_NEAR(found.factors[f].total, known.total, 1e-12) << counts[0] << ", factor " << f;
    }
  }
}

/// A level of 0 .. L − 1 has the variance (L² − 1) / 12: 2/3, 2 and 35/12 of 3, 5 and 6 levels.
TEST(LevelMeans, OfASumAreTheVariancesOfItsTerms) {
  const Levels levels = full({3, 5, 6});
  const GridIndices found =
      indices_of(levels, values_of(levels, [](const Row& x) { return 3.0 * x[0] + x[1] - x[2]; }));
  const double terms[] = {9 * 2.0 / 3, 2, 35.0 / 12}, all = 6 + 2 + 35.0 / 12;
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_NEAR(found.factors[f].first, terms[f] / all, 1e-12) << f;
    EXPECT_NEAR(found.factors[f].total, terms[f] / all, 1e-12) << f;
  }
}

/// Of Π (1 + c_i z_i) with z of mean 0 and variance 1: Var = Π (1 + c_i²) − 1, and a factor takes
/// part in c_i² Π_others (1 + c²) of it.
TEST(LevelMeans, OfAProductHaveItsInteractions) {
  const std::vector<std::uint32_t> counts = {3, 5, 6};
  const double c[] = {0.5, 1.5, -0.8};
  const Levels levels = full(counts);
  const auto product = [&](const Row& x) {
    double value = 1;
    for (std::size_t f = 0; f < 3; ++f) {
      const double l = counts[f];
      value *= 1 + c[f] * (x[f] - (l - 1) / 2) / std::sqrt((l * l - 1) / 12);
    }
    return value;
  };
  const GridIndices found = indices_of(levels, values_of(levels, product));
  double all = 1;
  for (const double one : c) all *= 1 + one * one;
  EXPECT_NEAR(found.variance, all - 1, 1e-12);
  for (std::size_t f = 0; f < 3; ++f) {
    const double square = c[f] * c[f];
    EXPECT_NEAR(found.factors[f].first, square / (all - 1), 1e-12) << f;
    EXPECT_NEAR(found.factors[f].total, square * all / (1 + square) / (all - 1), 1e-12) << f;
  }
}

TEST(LevelMeans, DoNotDependOnTheOrderOfRows) {
  const Levels levels = full({4, 3, 5});
  const std::vector<double> values = values_of(levels, wild);
  const GridIndices one = indices_of(levels, values);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 random(4);
  for (int repeat = 0; repeat < 5; ++repeat) {
    std::shuffle(order.begin(), order.end(), random);
    Levels mixed(3);
    std::vector<double> mixed_values;
    for (const std::size_t row : order) {
      for (std::size_t f = 0; f < 3; ++f) mixed[f].push_back(levels[f][row]);
      mixed_values.push_back(values[row]);
    }
    const GridIndices other = indices_of(mixed, mixed_values);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_NEAR(one.factors[f].first, other.factors[f].first, 1e-13);
      EXPECT_NEAR(one.factors[f].total, other.factors[f].total, 1e-13);
    }
  }
}

/// Far from 0 sums of squares would lose all their digits.
TEST(LevelMeans, AreTheSameInOtherUnits) {
  const Levels levels = full({3, 5, 6});
  const std::vector<double> values = values_of(levels, wild);
  std::vector<double> other = values;
  for (double& one : other) one = 1e9 - 1000 * one;
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_NEAR(indices_of(levels, values).factors[f].first,
                indices_of(levels, other).factors[f].first, 1e-9);
  }
}

TEST(LevelMeans, AreZeroWhereTheOutputIsTheSame) {
  const Levels levels = full({3, 4});
  const GridIndices found = indices_of(levels, std::vector<double>(12, 0.1));
  EXPECT_EQ(found.variance, 0);
  EXPECT_NEAR(found.mean, 0.1, 1e-15);
  for (const ExactIndices& one : found.factors) {
    EXPECT_EQ(one.first, 0);
    EXPECT_EQ(one.total, 0);
  }
}

TEST(LevelMeans, RefuseWhatIsNoFullGrid) {
  const Levels whole = full({3, 5, 6});
  Levels missing = whole;
  for (auto& factor : missing) factor.erase(factor.begin() + 40);
  EXPECT_FALSE(FullGrid::make(missing).grid);
  EXPECT_EQ(FullGrid::make(missing).refusal, "only 89 of all combinations of levels are present");
  Levels doubled = whole;
  for (auto& factor : doubled) factor[41] = factor[40];
  EXPECT_EQ(FullGrid::make(doubled).refusal, "row 42 repeats the levels of an earlier row");
  Levels longer = whole;
  for (auto& factor : longer) factor.push_back(factor[0]);
  EXPECT_EQ(FullGrid::make(longer).refusal, "row 91 repeats the levels of an earlier row");
  EXPECT_EQ(FullGrid::make({}).refusal, "there are no rows");
  EXPECT_EQ(FullGrid::make(Levels{{}}).refusal, "there are no rows");
  const Levels sparse = {{4000000000u, 0}, {4000000000u, 1}, {4000000000u, 2}};
  EXPECT_EQ(FullGrid::make(sparse).refusal, "only 2 of all combinations of levels are present");
}

TEST(LevelMeans, RefuseAnOutputWithoutAValue) {
  const Levels levels = full({3, 4, 2});
  const FullGrid grid = FullGrid::make(levels).grid.value();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<double> values = values_of(levels, wild);
    EXPECT_TRUE(grid.indices(values));
    values[5] = bad;
    EXPECT_FALSE(grid.indices(values));
  }
}

/// Outputs beside each other are one output of a longer vector: its variance is the sum of theirs.
TEST(LevelMeans, TogetherCountAsMuchAsTheyVary) {
  const Levels levels = full({3, 5});
  const auto sum = [](double a, double b) {
    return [=](const Row& x) { return a * x[0] + b * x[1]; };
  };
  const std::vector<GridIndices> outputs = {indices_of(levels, values_of(levels, sum(3, 0))),
                                            indices_of(levels, values_of(levels, sum(0, 2))),
                                            indices_of(levels, values_of(levels, sum(0, 0)))};
  const std::vector<ExactIndices> together = aggregated(outputs);  // variances 9 · 2/3 and 4 · 2
  EXPECT_NEAR(together[0].first, 6.0 / 14, 1e-12);
  EXPECT_NEAR(together[1].first, 8.0 / 14, 1e-12);
  EXPECT_NEAR(together[0].total, 6.0 / 14, 1e-12);
  EXPECT_EQ(aggregated(std::span(outputs).last(1))[0].first, 0);
}

}  // namespace
}  // namespace faultsweep
