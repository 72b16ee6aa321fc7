#include "simulator/linalg/dense_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

namespace faultsim {
namespace {

TEST(SpdCondition, IsExactForADiagonal) {
  const Eigen::Vector3d d(2, 1e-7, 5);
  EXPECT_NEAR(*spd_condition(d.asDiagonal().toDenseMatrix()), 5e7, 1);
}

TEST(SpdCondition, EstimatesTheHilbertMatrixWithinAFactorOfThree) {
  const auto hilbert = Eigen::MatrixXd::NullaryExpr(
      7, 7, [](Eigen::Index i, Eigen::Index j) { return 1.0 / static_cast<double>(i + j + 1); });
  const Eigen::MatrixXd m = hilbert;
  const double exact =
      m.cwiseAbs().colwise().sum().maxCoeff() * m.inverse().cwiseAbs().colwise().sum().maxCoeff();
  const double estimate = *spd_condition(m);
  EXPECT_LE(estimate, 1.01 * exact);
  EXPECT_GE(estimate, exact / 3);
}

TEST(SpdCondition, ReadsTheLowerTriangleOnly) {
  Eigen::MatrixXd m = 4 * Eigen::MatrixXd::Identity(2, 2);
  m(0, 1) = std::numeric_limits<double>::max();
  EXPECT_DOUBLE_EQ(*spd_condition(m), 1);
}

TEST(SpdCondition, SaysThatAMatrixIsNotPositiveDefinite) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Identity(3, 3);
  m(2, 1) = m(1, 2) = 1.5;
  EXPECT_FALSE(spd_condition(m));
  m(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(spd_condition(m));
}

TEST(SpdCondition, OfNothingIsOne) { EXPECT_EQ(*spd_condition(Eigen::MatrixXd(0, 0)), 1); }

}  // namespace
}  // namespace faultsim
