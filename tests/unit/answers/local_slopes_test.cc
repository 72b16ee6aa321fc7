// Nearest cases and the plane through them, on functions whose slopes are known.
#include "campaign/answers/local_slopes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// n cases of angles in rad, lengths in m and a rule of two words.
ParameterSpace drawn(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(0.2, 0.6), length(0, 300);
  ParameterSpace space;
  space.columns = {{"angle", {}}, {"length", {}}, {"rule", {}, true}};
  for (std::size_t k = 0; k < n; ++k) {
    space.columns[0].values.push_back(angle(random));
    space.columns[1].values.push_back(length(random));
    space.columns[2].values.push_back(static_cast<double>(k % 2));
  }
  return space;
}

std::vector<double> linear(const ParameterSpace& space) {
  std::vector<double> y;
  for (std::size_t k = 0; k < space.size(); ++k)
    y.push_back(0.3 - 2 * space.columns[0].values[k] + 4e-3 * space.columns[1].values[k]);
  return y;
}

TEST(Distances, AreInStandardDeviationsAndOneForOtherWords) {
  ParameterSpace space;
  space.columns = {
      {"a", {0, 0, 3, 6, kNone}}, {"rule", {1, 2, 1, 1, 1}, true}, {"c", {5, 5, 5, 5, 5}}};
  const double deviation = space.columns[0].standard_deviation();
  EXPECT_NEAR(deviation, std::sqrt(8.25), 1e-12) << "of 0, 0, 3, 6";
  EXPECT_EQ(space.columns[1].standard_deviation(), 0);
  const std::vector<double> distances = distances_from(space, 0);
  EXPECT_EQ(distances[0], 0);
  EXPECT_EQ(distances[1], 1) << "another word";
  EXPECT_NEAR(distances[2], 3 / deviation, 1e-12);
  EXPECT_EQ(distances[4], 1) << "only one has it";
  EXPECT_THAT(nearest(distances, 0, 3), ElementsAre(1, 4, 2));
  EXPECT_EQ(nearest(distances, 0, 99).size(), 4u);
}

TEST(LocalPlane, IsExactOnLinearFunctions) {
  const ParameterSpace space = drawn(100, 3);
  std::vector<double> y = linear(space);
  y[17] = kNone;  // left out
  for (const std::size_t here : {0u, 41u, 99u}) {
    const LocalPlane plane = local_plane(space, y, here);
    ASSERT_EQ(plane.reason, "");
    ASSERT_EQ(plane.slopes.size(), 2u) << "words have none";
    EXPECT_EQ(plane.n_cases, 20u);
    for (const Slope& one : plane.slopes) {
      const double expected = one.column == 0 ? -2 : 4e-3;
      EXPECT_NEAR(one.per_deviation / one.deviation, expected, 1e-10 * std::abs(expected));
      EXPECT_LT(one.error, 1e-12);
    }
  }
}

/// Of cases with other words a step says nothing of the numbers.
TEST(LocalPlane, TakesCasesWithTheSameWords) {
  const ParameterSpace space = drawn(100, 4);
  std::vector<double> y = linear(space);
  for (std::size_t k = 1; k < y.size(); k += 2) y[k] += 100;
  const LocalPlane plane = local_plane(space, y, 8);
  ASSERT_EQ(plane.slopes.size(), 2u);
  EXPECT_NEAR(plane.slopes[0].per_deviation / plane.slopes[0].deviation, -2, 1e-9);
}

/// Of 400 samples with noise about 68 % have the slope within one error, 95 % within two.
TEST(LocalPlane, ErrorsCoverNoise) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0, 0.05);
  int within_one = 0, within_two = 0, n = 0;
  double scatter = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const ParameterSpace space = drawn(60, 100 + seed);
    std::vector<double> y = linear(space);
    for (double& one : y) one += noise(random);
    const LocalPlane plane = local_plane(space, y, seed % 60);
    ASSERT_EQ(plane.reason, "");
    scatter += plane.scatter * plane.scatter / 400;
    for (const Slope& one : plane.slopes) {
      const double off = one.per_deviation - (one.column == 0 ? -2 : 4e-3) * one.deviation;
      within_one += std::abs(off) <= one.error ? 1 : 0;
      within_two += std::abs(off) <= 2 * one.error ? 1 : 0;
      ++n;
    }
  }
  EXPECT_NEAR(std::sqrt(scatter), 0.05, 0.003);
  EXPECT_NEAR(within_one, 0.66 * n, 0.06 * n);
  EXPECT_NEAR(within_two, 0.93 * n, 0.03 * n);
}

/// A slope is of the neighbourhood: of a parabola that at the case, not the campaign's mean.
TEST(LocalPlane, FollowsACurvedFunctionNearTheCase) {
  ParameterSpace space;
  space.columns = {{"x", {}}};
  std::vector<double> y;
  for (int k = 0; k < 201; ++k) {
    space.columns[0].values.push_back(0.01 * (k - 100));
    y.push_back(std::pow(space.columns[0].values.back(), 2));
  }
  const LocalPlane plane = local_plane(space, y, 150);
  ASSERT_EQ(plane.slopes.size(), 1u);
  EXPECT_NEAR(plane.slopes[0].per_deviation / plane.slopes[0].deviation, 1, 1e-9) << "2 x at 0.5";
}

TEST(LocalPlane, IsRefusedWhereItWouldSayTooMuch) {
  EXPECT_THAT(
      local_plane(drawn(30, 5), linear(drawn(30, 5)), 0).reason,
      HasSubstr("slopes of 2 parameters need 20 cases with the same words, and there are 14"));
  ParameterSpace together = drawn(100, 6);
  for (std::size_t k = 0; k < 100; ++k)
    together.columns[1].values[k] = 500 * together.columns[0].values[k];
  const LocalPlane plane = local_plane(together, linear(together), 0);
  EXPECT_THAT(plane.reason, HasSubstr("do not vary the parameters independently"));
  EXPECT_TRUE(plane.slopes.empty());
  ParameterSpace words;
  words.columns = {{"rule", {1, 2, 1}, true}};
  EXPECT_THAT(local_plane(words, {1, 2, 3}, 0).reason, HasSubstr("no parameter with numbers"));
}

}  // namespace
}  // namespace faultsweep
