#include "simulator/surface/sparse_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Function = std::function<double(const Eigen::VectorXd&)>;

double interpolated(const SparseGrid& grid, const Function& f, const Eigen::VectorXd& x) {
  const Eigen::VectorXd w = grid.weights(x);
  double sum = 0;
  for (int k = 0; k < grid.n_nodes(); ++k) sum += w[k] * f(grid.node(k));
  return sum;
}

/// All indices of total degree up to `degree`, level by level.
SparseGrid total_degree(int n_axes, int degree) {
  SparseGrid grid(n_axes);
  for (int k = 0; k < grid.n_nodes(); ++k) {
    const SparseGrid::Index index = grid.indices()[static_cast<std::size_t>(k)];
    int sum = 0;
    for (const int level : index) sum += level;
    if (sum == degree) continue;
    for (const SparseGrid::Index& next : grid.successors(index)) grid.add(next);
  }
  return grid;
}

Eigen::VectorXd random_place(int n_axes, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd x(n_axes);
  for (double& value : x) value = uniform(random);
  return x;
}

TEST(LejaPoint, MaximisesTheProductOfDistances) {
  EXPECT_EQ(leja_point(0), 0);
  EXPECT_EQ(leja_point(1), 1);
  EXPECT_EQ(leja_point(2), -1);
  EXPECT_NEAR(leja_point(3), -1 / std::sqrt(3.0), 1e-12);  // of |x (x² − 1)|
  const auto product = [](double x) {
    double value = 1;
    for (int i = 0; i < 7; ++i) value *= std::abs(x - leja_point(i));
    return value;
  };
  for (int i = -1000; i <= 1000; ++i) EXPECT_LE(product(i / 1000.0), product(leja_point(7)) + 1e-9);
}

TEST(SparseGrid, RepeatsPolynomialsOfItsDegree) {
  const SparseGrid grid = total_degree(3, 4);
  EXPECT_EQ(grid.n_nodes(), 35);  // binomial(7, 3)
  const Function f = [](const Eigen::VectorXd& x) {
    return 1 + x[0] * x[1] * x[2] - 3 * std::pow(x[1], 4) + x[0] * std::pow(x[2], 3);
  };
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd x = random_place(3, random);
    EXPECT_NEAR(interpolated(grid, f, x), f(x), 1e-12);
  }
}

TEST(SparseGrid, ConvergesGeometricallyOnAnalyticFunctions) {
  const Function f = [](const Eigen::VectorXd& x) { return 1 / (4 + x[0] + 0.5 * x[1]); };
  std::mt19937 random(5);
  double before = 1;
  for (const int degree : {2, 4, 6, 8}) {
    const SparseGrid grid = total_degree(2, degree);
    double worst = 0;
    for (int i = 0; i < 50; ++i) {
      const Eigen::VectorXd x = random_place(2, random);
      worst = std::max(worst, std::abs(interpolated(grid, f, x) - f(x)));
    }
    EXPECT_LT(worst, 0.1 * before) << degree;
    before = worst;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(SparseGrid, ItsWeightsAreUnitVectorsAtNodesAndSumToOne) {
  const SparseGrid grid = total_degree(2, 5);
  for (int k = 0; k < grid.n_nodes(); ++k) {
    EXPECT_LT((grid.weights(grid.node(k)) - Eigen::VectorXd::Unit(grid.n_nodes(), k)).norm(),
              1e-13);
  }
  EXPECT_NEAR(grid.weights(Eigen::Vector2d(0.3, -0.7)).sum(), 1, 1e-13);
}

TEST(SparseGrid, AdmitsOnlyWhatFollows) {
  SparseGrid grid(2);
  EXPECT_TRUE(grid.admits({1, 0}));
  EXPECT_FALSE(grid.admits({0, 0}));
  EXPECT_FALSE(grid.admits({1, 1}));
  EXPECT_FALSE(grid.admits({2, 0}));
  EXPECT_FALSE(grid.admits({0, -1}));
  grid.add({1, 0});
  EXPECT_EQ(grid.successors({1, 0}), (std::vector<SparseGrid::Index>{{2, 0}}));
  grid.add({0, 1});
  EXPECT_EQ(grid.successors({1, 0}), (std::vector<SparseGrid::Index>{{2, 0}, {1, 1}}));
  EXPECT_THROW(grid.add({2, 2}), InternalError);
}

}  // namespace
}  // namespace faultsim
