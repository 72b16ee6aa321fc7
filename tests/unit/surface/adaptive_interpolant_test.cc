#include "simulator/surface/adaptive_interpolant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace faultsim {
namespace {

/// Smooth, stiff along the first axis, odd along the second (no surplus at −1 after 0 and 1),
/// nearly flat along the third, with a product of the first two.
Eigen::VectorXd smooth(const Eigen::VectorXd& x) {
  Eigen::VectorXd value(2);
  value << 1 / (1.5 + x[0]) + 0.1 * std::sin(x[1]) + 1e-6 * x[2], x[0] * x[1];
  return value;
}

using Values = std::vector<Eigen::VectorXd>;  // by node

AdaptiveInterpolant interpolant(Values& values) {
  values = {smooth(Eigen::VectorXd::Zero(3))};
  return {3, [&values](const Eigen::VectorXd& x, const Eigen::VectorXd& weights) {
            Eigen::VectorXd off = smooth(x);
            values.push_back(off);
            for (Eigen::Index k = 0; k < weights.size(); ++k)
              off -= weights[k] * values[static_cast<std::size_t>(k)];
            return off.norm();
          }};
}

TEST(AdaptiveInterpolant, IsAsGoodBetweenItsNodesAsItsSurplusesSay) {
  Values values;
  AdaptiveInterpolant f = interpolant(values);
  EXPECT_LE(f.grow(1e-6, 500), 1e-6);
  for (const auto& [a, b, c] : {std::array{0.3, -0.7, 0.2}, std::array{-0.93, 0.41, -0.9}}) {
    const Eigen::Vector3d x(a, b, c);
    const Eigen::VectorXd w = f.grid().weights(x);
    Eigen::VectorXd value = Eigen::VectorXd::Zero(2);
    for (int k = 0; k < f.grid().n_nodes(); ++k) value += w[k] * values[k];
    EXPECT_LT((value - smooth(x)).norm(), 2e-5);
  }
}

TEST(AdaptiveInterpolant, GrowsWhereTheFunctionBends) {
  Values values;
  AdaptiveInterpolant f = interpolant(values);
  f.grow(1e-5, 500);
  std::array<int, 3> most = {};
  for (const SparseGrid::Index& index : f.grid().indices()) {
    for (std::size_t j = 0; j < 3; ++j) most[j] = std::max(most[j], index[j]);
  }
  EXPECT_GT(most[0], most[1] + 2);
  EXPECT_LE(most[2], 2);  // looked at and left
}

TEST(AdaptiveInterpolant, AsksForEachNodeOnceAndGoesOnFromWhereItStopped) {
  Values asked, at_once;
  AdaptiveInterpolant slow = interpolant(asked), fast = interpolant(at_once);
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) slow.grow(tolerance, 500);
  fast.grow(1e-4, 500);
  EXPECT_EQ(asked.size(), static_cast<std::size_t>(slow.grid().n_nodes()));
  EXPECT_EQ(slow.grid().indices(), fast.grid().indices());
}

TEST(AdaptiveInterpolant, EndsAtTheMostNodesAndSaysWhatIsLeft) {
  for (int most = 1; most <= 12; ++most) {
    Values values;
    AdaptiveInterpolant f = interpolant(values);
    EXPECT_GT(f.grow(1e-12, most), 1e-12);
    EXPECT_EQ(f.grid().n_nodes(), most) << "also in the middle of an expansion";
    EXPECT_EQ(values.size(), static_cast<std::size_t>(most));
  }
}

/// Cut after the first axis, it looks at the others as soon as there is room.
TEST(AdaptiveInterpolant, GrowsOnFromTheMiddleOfAnExpansion) {
  Values values;
  AdaptiveInterpolant f = interpolant(values);
  EXPECT_TRUE(std::isinf(f.grow(1e-6, 2)));
  EXPECT_LE(f.grow(1e-6, 500), 1e-6);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(std::ranges::any_of(f.grid().indices(), [&](const SparseGrid::Index& index) {
      return index[axis] > 0;
    })) << axis;
  }
}

}  // namespace
}  // namespace faultsim
