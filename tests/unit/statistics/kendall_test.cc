#include "campaign/statistics/kendall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace faultsweep {
namespace {

/// τ-b by its definition: all pairs of pairs.
double tau_b_of_all_pairs(const std::vector<long>& a, const std::vector<long>& b) {
  double difference = 0, untied_a = 0, untied_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int sign_a = (a[i] > a[j]) - (a[i] < a[j]), sign_b = (b[i] > b[j]) - (b[i] < b[j]);
      difference += sign_a * sign_b;
      untied_a += sign_a * sign_a;
      untied_b += sign_b * sign_b;
    }
  }
  return difference / std::sqrt(untied_a * untied_b);
}

TEST(Kendall, IsOneForTheSameOrderAndMinusOneForTheReverse) {
  EXPECT_EQ(kendall_tau_b({1, 2, 3, 4}, {10, 20, 30, 40}), 1.0);
  EXPECT_EQ(kendall_tau_b({1, 2, 3, 4}, {4, 3, 2, 1}), -1.0);
  EXPECT_FALSE(kendall_tau_b({1, 1, 1}, {1, 2, 3}).has_value());
  EXPECT_FALSE(kendall_tau_b({1}, {1}).has_value());
  EXPECT_FALSE(kendall_tau_b({}, {}).has_value());
}

TEST(Kendall, AgreesWithItsDefinitionUnderTies) {
  std::mt19937 random(5);
  for (int n = 3; n < 60; ++n) {
    std::vector<long> a, b;
    for (int k = 0; k < n; ++k) {
      a.push_back(static_cast<long>(random() % 7));
      b.push_back((a.back() + static_cast<long>(random() % 5)) / 2);
    }
    const auto tau = kendall_tau_b(a, b);
    ASSERT_TRUE(tau.has_value());
    EXPECT_NEAR(*tau, tau_b_of_all_pairs(a, b), 1e-14) << n;
  }
}

}  // namespace
}  // namespace faultsweep
