#include "campaign/statistics/pick_freeze.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

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

/// Of 1,000 intervals of 95 %, 95 ± 2 % hold the index, where it is not a bound of all there is.
TEST(PickFreeze, ItsIntervalsCover) {
  for (const KnownIndices& one : known_indices()) {
    std::mt19937_64 random(11);
    std::array<int, 3> first{}, total{};
    for (int repeat = 0; repeat < 1000; ++repeat) {
      const auto indices = indices_by_pick_freeze(sobol_sample(one.model, 500, random), 0.95);
      const auto holds = [](const Estimate& e, double value) {
        return e.bounds.low <= value && value <= e.bounds.high ? 1 : 0;
      };
      for (std::size_t p = 0; p < 3; ++p) {
        first[p] += holds(indices[p].first, one.first[p]);
        total[p] += holds(indices[p].total, one.total[p]);
      }
    }
    for (std::size_t p = 0; p < 3; ++p) {
      const bool is_of_no_effect = one.total[p] == 0;  // its total is 0 in every sample
      EXPECT_GE(first[p], 930) << one.name << p;
      EXPECT_LE(first[p], 970) << one.name << p;
      EXPECT_GE(total[p], is_of_no_effect ? 1000 : 930) << one.name << p;
      EXPECT_LE(total[p], is_of_no_effect ? 1000 : 970) << one.name << p;
    }
  }
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
