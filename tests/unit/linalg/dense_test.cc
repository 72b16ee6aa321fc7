#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/linalg/gmres.h"
#include "simulator/linalg/growing_lu.h"

namespace faultsim {
namespace {

Eigen::MatrixXd random_matrix(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(generator); });
}

TEST(GrowingLu, SolvesWhateverWasFactoredBefore) {
  GrowingLu<double> lu;
  for (const int n : {5, 80, 1, 33, 200}) {
    const Eigen::MatrixXd m = random_matrix(n, 7);
    const Eigen::VectorXd expected = random_matrix(n, 8).col(0);
    ASSERT_TRUE(lu.factor(m));
    EXPECT_EQ(lu.size(), n);
    Eigen::VectorXd x = m * expected;
    lu.solve(x);
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << n;
  }
}

TEST(GrowingLu, SaysThatAMatrixIsSingularAndKeepsNoFactor) {
  GrowingLu<double> lu;
  Eigen::MatrixXd m = random_matrix(6, 3);
  m.row(2).setZero();
  EXPECT_FALSE(lu.factor(m));
  EXPECT_EQ(lu.size(), 0);
}

/// Grows the factor to the leading n x n block of m.
bool grow_to(GrowingLu<float>& lu, const Eigen::MatrixXf& m, int n) {
  const int old = lu.size();
  GrowingLu<float>::Block block = lu.border(n - old);
  block.rightCols(n - old) = m.topLeftCorner(n, n).rightCols(n - old);
  block.bottomLeftCorner(n - old, old) = m.block(old, 0, n - old, old);
  return lu.grow(n - old);
}

// Not diagonally dominant, so that rows are exchanged within each part.
TEST(GrowingLu, SolvesAtEachOfItsSizes) {
  const Eigen::MatrixXf m =
      (random_matrix(150, 4) + 8 * Eigen::MatrixXd::Identity(150, 150)).cast<float>();
  GrowingLu<float> lu;
  for (const int n : {3, 4, 70, 70, 150}) {
    ASSERT_TRUE(grow_to(lu, m, n));
    EXPECT_EQ(lu.size(), n);
    const Eigen::VectorXf expected = random_matrix(n, 8).col(0).cast<float>();
    Eigen::VectorXf x = m.topLeftCorner(n, n) * expected;
    lu.solve(x);
    EXPECT_LT((x - expected).norm(), 1e-3 * expected.norm()) << n;
  }
  lu.clear();
  ASSERT_TRUE(grow_to(lu, m.bottomRightCorner(20, 20), 20));
  EXPECT_EQ(lu.size(), 20);
}

TEST(GrowingLu, SaysThatWhatJoinedIsSingularAndKeepsNoFactor) {
  Eigen::MatrixXf m = Eigen::MatrixXf::Identity(6, 6);
  GrowingLu<float> lu;
  ASSERT_TRUE(grow_to(lu, m, 4));
  m(5, 5) = 0;
  EXPECT_FALSE(grow_to(lu, m, 6));
  EXPECT_EQ(lu.size(), 0);
}

struct Maps {
  Eigen::MatrixXd matrix, inverse;
  LinearMap multiply = [this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = matrix * x; };
  LinearMap precondition = [this](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    y = inverse * x;
  };
};

TEST(Gmres, NeedsAsManyIterationsAsTheDifferenceToThePreconditionerHasRank) {
  const int n = 40;
  Maps maps;
  maps.matrix = random_matrix(n, 1) + 20 * Eigen::MatrixXd::Identity(n, n);
  maps.inverse = maps.matrix.inverse();
  const Eigen::VectorXd expected = random_matrix(n, 2).col(0);
  for (const int rank : {0, 1, 3}) {
    Maps changed{maps.matrix, maps.inverse};
    changed.matrix +=
        random_matrix(n, 5).leftCols(rank) * random_matrix(n, 6).leftCols(rank).transpose();
    Eigen::VectorXd x;
    const GmresReport report =
        gmres(changed.multiply, changed.precondition, changed.matrix * expected, 1e-12, 20, x);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, rank + 1);
    EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
  }
}

/// A chain of springs: every iteration reaches one further, so the vectors fill more than a block.
TEST(Gmres, KeepsAsManyVectorsAsItTakes) {
  const int n = 300;
  Maps maps{2.01 * Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Identity(n, n)};
  for (int i = 0; i + 1 < n; ++i) maps.matrix(i, i + 1) = maps.matrix(i + 1, i) = -1;
  const Eigen::VectorXd b = Eigen::VectorXd::Unit(n, 0);
  Eigen::VectorXd x;
  const GmresReport report = gmres(maps.multiply, maps.precondition, b, 1e-9, n, x);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.iterations, 140);
  EXPECT_EQ(std::ssize(report.residuals), report.iterations + 1);
  EXPECT_EQ(report.residuals.back(), report.relative_residual);
  EXPECT_LT((maps.matrix * x - b).norm(), 2e-9);
}

TEST(Gmres, MayBeEndedBeforeEachIteration) {
  const int n = 40;
  Maps maps{random_matrix(n, 1), Eigen::MatrixXd::Identity(n, n)};
  Eigen::VectorXd x;
  int n_asked = 0;
  EXPECT_THROW(
      gmres(maps.multiply, maps.precondition, Eigen::VectorXd::Ones(n), 1e-12, n, x, nullptr,
            [&] {
              if (++n_asked == 4) throw Interrupted("enough");
            }),
      Interrupted);
  EXPECT_EQ(n_asked, 4);
}

TEST(Gmres, SaysWhenItsIterationsDoNotSuffice) {
  const int n = 40;
  Maps maps{random_matrix(n, 1), Eigen::MatrixXd::Identity(n, n)};
  Eigen::VectorXd x;
  const GmresReport report =
      gmres(maps.multiply, maps.precondition, Eigen::VectorXd::Ones(n), 1e-12, 5, x);
  EXPECT_FALSE(report.converged);
  EXPECT_GT(report.relative_residual, 1e-12);
}

}  // namespace
}  // namespace faultsim
