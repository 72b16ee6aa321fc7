#include "simulator/contact/bordered_lu.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace faultsim {
namespace {

Eigen::MatrixXd unsymmetric(int n) {
  Eigen::MatrixXd m(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) m(i, j) = 1.0 / (1 + std::abs(i - j)) + (i > j ? 0.1 : -0.05);
  }
  m.diagonal().array() += 3;
  return m;
}

double append(BorderedLu& lu, const Eigen::MatrixXd& m) {
  const int n = lu.size();
  for (int j = 0; j < n; ++j) {
    lu.row()[j] = m(n, j);
    lu.column()[j] = m(j, n);
  }
  return lu.append(m(n, n));
}

TEST(BorderedLu, SolvesAtEachSize) {
  const Eigen::MatrixXd m = unsymmetric(23);
  BorderedLu lu;
  for (int n = 1; n <= 23; ++n) {
    append(lu, m);
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(n, 1, 2);
    Eigen::VectorXd x = m.topLeftCorner(n, n) * expected;
    lu.solve(x.data());
    EXPECT_LT((x - expected).norm(), 1e-12) << n;
  }
}

TEST(BorderedLu, ContinuesFromALeadingBlock) {
  const Eigen::MatrixXd m = unsymmetric(9);
  BorderedLu lu;
  for (int n = 0; n < 6; ++n) append(lu, 2 * m);
  lu.clear();
  for (int n = 0; n < 9; ++n) append(lu, m);
  lu.truncate(4);
  for (int n = 4; n < 9; ++n) append(lu, m);
  const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(9, -1, 3);
  Eigen::VectorXd x = m * expected;
  lu.solve(x.data());
  EXPECT_LT((x - expected).norm(), 1e-12);
}

TEST(BorderedLu, HasPivotsWhoseProductIsTheDeterminant) {
  const Eigen::MatrixXd m = unsymmetric(7);
  BorderedLu lu;
  double determinant = 1;
  for (int n = 0; n < 7; ++n) determinant *= append(lu, m);
  EXPECT_NEAR(determinant, m.determinant(), 1e-10 * std::abs(determinant));
}

TEST(BorderedLu, SaysThatAMatrixIsIndefiniteOrSingular) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Ones(2, 2);
  BorderedLu lu;
  EXPECT_EQ(append(lu, m), 1);
  EXPECT_EQ(append(lu, m), 0);
  EXPECT_EQ(lu.size(), 1);  // nothing appended
  m(0, 1) = m(1, 0) = 2;
  EXPECT_LT(append(lu, m), 0);
}

}  // namespace
}  // namespace faultsim
