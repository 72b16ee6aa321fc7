#include "campaign/statistics/pick_freeze.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "campaign/statistics/correlation_bounds.h"
#include "tests/unit/statistics/known_models.h"

namespace faultsweep {
namespace {

using testing::ishigami;
using testing::Model;
using testing::Point;

PickFreezeValues sobol_sample(const Model& model, std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  PickFreezeValues values;
  values.ab.resize(3);
  for (std::size_t k = 0; k < n; ++k) {
    Point a, b;
    for (double& one : a) one = uniform(random);
    for (double& one : b) one = uniform(random);
    values.a.push_back(model(a));
    values.b.push_back(model(b));
    for (std::size_t p = 0; p < 3; ++p) {
      Point mixed = a;
      mixed[p] = b[p];
      values.ab[p].push_back(model(mixed));
    }
  }
  return values;
}

struct KnownIndices {
  const char* name;
  Model model;
  std::array<double, 3> first, total;
};

const std::vector<KnownIndices>& known_indices() {
  static const std::vector<KnownIndices> all = {
      {"linear",
       [](const Point& p) { return 1000 + 2 * p[0] + p[1]; },
       {0.8, 0.2, 0},
       {0.8, 0.2, 0}},
      // (2x−1)(2y−1): nothing alone, everything together
      {"product",
       [](const Point& p) { return (2 * p[0] - 1) * (2 * p[1] - 1); },
       {0, 0, 0},
       {1, 1, 0}},
      // x + y > 1: Var E[flag | x] = Var x = 1/12 of 1/4
      {"a flag",
       [](const Point& p) { return p[0] + p[1] > 1 ? 1.0 : 0.0; },
       {1.0 / 3, 1.0 / 3, 0},
       {2.0 / 3, 2.0 / 3, 0}},
      {"Ishigami",
       ishigami(0, 1, 2),
       {0.31390519, 0.44241114, 0},
       {0.55758886, 0.44241114, 0.24368366}}};
  return all;
}

TEST(PickFreeze, MeetsKnownIndices) {
  std::mt19937_64 random(3);
  for (const KnownIndices& one : known_indices()) {
    const auto indices = indices_by_pick_freeze(sobol_sample(one.model, 20'000, random), 0.95);
    for (std::size_t p = 0; p < 3; ++p) {
      const auto& [first, total] = indices[p];
      EXPECT_NEAR(first.value, one.first[p], 4 * first.standard_error + 1e-12) << one.name << p;
      EXPECT_NEAR(total.value, one.total[p], 4 * total.standard_error + 1e-12) << one.name << p;
      EXPECT_LT(first.standard_error, 0.015) << one.name << p;
      EXPECT_LT(total.standard_error, 0.015) << one.name << p;
    }
  }
}

int holds(const Estimate& e, double value) {
  return e.bounds.low <= value && value <= e.bounds.high ? 1 : 0;
}

/// Of 1,000 intervals of 95 %, 93 to 98 % hold the index, where it is not a bound of all there is.
TEST(PickFreeze, ItsIntervalsCover) {
  for (const KnownIndices& one : known_indices()) {
    std::mt19937_64 random(11);
    std::array<int, 3> first{}, total{};
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const auto indices =
          indices_by_pick_freeze(sobol_sample(one.model, kFewestForPickFreeze, random), 0.95);
      for (std::size_t p = 0; p < 3; ++p) {
        first[p] += holds(indices[p].first, one.first[p]);
        total[p] += holds(indices[p].total, one.total[p]);
      }
    }
    for (std::size_t p = 0; p < 3; ++p) {
      const bool is_of_no_effect = one.total[p] == 0;  // its total is 0 in every sample
      EXPECT_GE(first[p], 925) << one.name << p;
      EXPECT_LE(first[p], 985) << one.name << p;
      EXPECT_GE(total[p], is_of_no_effect ? 1000 : 925) << one.name << p;
      EXPECT_LE(total[p], is_of_no_effect ? 1000 : 980) << one.name << p;
    }
  }
}

/// A flag of one row in ten, x + y > 2 − √(1/5) = 2 − w: E[flag | x] is w less 1 − x, so that
/// S = (w³ / 3 − p²) / (p (1 − p)), the same of both, and T = 1 − S of the other.
TEST(PickFreeze, ItsIntervalsCoverOfARareFlag) {
  const double width = std::sqrt(0.2), p = 0.1;
  const double first = (width * width * width / 3 - p * p) / (p * (1 - p));
  const Model flag = [=](const Point& at) { return at[0] + at[1] > 2 - width ? 1.0 : 0.0; };
  std::mt19937_64 random(12);
  int held_first = 0, held_total = 0, held_none = 0;
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const auto indices = indices_by_pick_freeze(sobol_sample(flag, 300, random), 0.95);
    held_first += holds(indices[0].first, first);
    held_total += holds(indices[1].total, 1 - first);
    held_none += holds(indices[2].first, 0);
  }
  for (const int held : {held_first, held_total, held_none}) {
    EXPECT_GE(held, 925);
    EXPECT_LE(held, 985);
  }
}

/// Each of two outputs counts as much as it varies; the same output twice says no more than once.
TEST(PickFreeze, OfOutputsTogetherCountsEachAsMuchAsItVaries) {
  std::mt19937_64 random(13);
  std::vector<PickFreezeValues> outputs = {
      sobol_sample([](const Point& p) { return 3 * p[0]; }, 20'000, random),
      sobol_sample([](const Point& p) { return 5 + p[1]; }, 20'000, random),
      sobol_sample([](const Point&) { return 7.0; }, 20'000, random)};
  const auto together = aggregated_by_pick_freeze(outputs, 0.95);
  EXPECT_NEAR(together[0].first.value, 0.9, 0.01);
  EXPECT_NEAR(together[1].total.value, 0.1, 0.01);
  const std::vector<PickFreezeValues> twice = {outputs[0], outputs[0]};
  const auto one = indices_by_pick_freeze(outputs[0], 0.95)[1].first;
  const auto same = aggregated_by_pick_freeze(twice, 0.95)[1].first;
  EXPECT_NEAR(one.value, same.value, 1e-9);
  EXPECT_NEAR(one.bounds.low, same.bounds.low, 1e-9);
  EXPECT_NEAR(one.bounds.high, same.bounds.high, 1e-9);
}

/// x t + y (1 − t) at t = 0.2 .. 1 with variances V_t = (t² + (1 − t)²) / 12: together x explains
/// Σ t² / Σ (t² + (1 − t)²) of them.
TEST(PickFreeze, ItsIntervalsCoverOfOutputsTogether) {
  double of_x = 0, all = 0;
  for (int k = 1; k <= 5; ++k) of_x += 0.04 * k * k, all += 0.04 * (k * k + (5 - k) * (5 - k));
  std::mt19937_64 random(14);
  int first = 0, total = 0;
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const auto seed = random();
    std::vector<PickFreezeValues> outputs;
    for (int k = 1; k <= 5; ++k) {
      std::mt19937_64 same(seed);
      outputs.push_back(
          sobol_sample([=](const Point& p) { return 0.2 * k * p[0] + (1 - 0.2 * k) * p[1]; },
                       kFewestForPickFreeze, same));
    }
    const auto indices = aggregated_by_pick_freeze(outputs, 0.95);
    first += holds(indices[0].first, of_x / all);
    total += holds(indices[0].total, of_x / all);
  }
  for (const int held : {first, total}) {
    EXPECT_GE(held, 925);
    EXPECT_LE(held, 975);
  }
}

/// r by its formula, its error by leaving out each point, its bounds from the rows of A and B that
/// carry the variance.
TEST(PickFreeze, ItsErrorAndBoundsAreTheirDefinitions) {
  std::mt19937_64 random(15);
  const PickFreezeValues values = sobol_sample(ishigami(0, 1, 2), 40, random);
  const auto r_without = [&](std::size_t left_out) {
    double n = 0, product = 0, squares = 0, both = 0;
    for (std::size_t k = 0; k < 40; ++k) {
      if (k == left_out) continue;
      const double u = values.b[k], v = values.ab[0][k];
      n += 1, product += u * v, squares += u * u + v * v, both += u + v;
    }
    const double m = both / (2 * n);
    return (product / n - m * m) / (squares / (2 * n) - m * m);
  };
  double sum = 0, changes = 0, mean = 0, squares = 0, fourths = 0;
  const double r = r_without(40);
  for (std::size_t k = 0; k < 40; ++k) {
    const double change = r_without(k) - r;
    sum += change, changes += change * change, mean += (values.a[k] + values.b[k]) / 80;
  }
  for (std::size_t k = 0; k < 40; ++k) {
    for (const double y : {values.a[k] - mean, values.b[k] - mean})
      squares += y * y, fourths += y * y * y * y;
  }
  const double variance = 39.0 / 40 * (changes - sum * sum / 40);
  const double effective = 0.5 * squares * squares / fourths;
  const Interval bounds = correlation_bounds(r, variance, 0.5 * effective, 0.95);
  const Estimate first = indices_by_pick_freeze(values, 0.95)[0].first;
  EXPECT_NEAR(first.value, r, 1e-12);
  EXPECT_NEAR(first.standard_error, std::sqrt(variance), 1e-9);
  EXPECT_NEAR(first.bounds.low, bounds.low, 1e-9);
  EXPECT_NEAR(first.bounds.high, bounds.high, 1e-9);
}

TEST(PickFreeze, IsZeroWhereNothingVaries) {
  const PickFreezeValues same = {{2, 2, 2, 2, 2}, {2, 2, 2, 2, 2}, {{2, 2, 2, 2, 2}}};
  const auto indices = indices_by_pick_freeze(same, 0.95);
  ASSERT_EQ(indices.size(), 1u);
  EXPECT_EQ(indices[0].first.value, 0);
  EXPECT_EQ(indices[0].total.value, 0);
}

}  // namespace
}  // namespace faultsweep
