#include "simulator/linalg/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace faultsim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points on a line, held at both ends by springs that stiffen by 1e4 along it, and a right-hand
/// side of all wave lengths.
struct Line {
  explicit Line(int n) : a(MatrixXd::Zero(n, n)), b(n) {
    const auto spring = [n](int i) { return std::pow(1e4, static_cast<double>(i) / n); };
    for (int i = 0; i < n; ++i) {
      a(i, i) = spring(i) + spring(i + 1);
      if (i + 1 < n) a(i, i + 1) = a(i + 1, i) = -spring(i + 1);
      b[i] = std::sin(7.3 * i * i);
    }
  }
  LinearMap times() const {
    return [this](const VectorXd& x, VectorXd& y) { y.noalias() = a * x; };
  }
  LinearMap by_diagonal(double factor = 1) const {
    return [this, factor](const VectorXd& x, VectorXd& y) {
      y = factor * x.cwiseQuotient(a.diagonal());
    };
  }
  double energy_error(const VectorXd& x) const {
    const VectorXd e = x - a.llt().solve(b);
    return std::sqrt(e.dot(a * e));
  }
  double energy() const { return std::sqrt(b.dot(a.llt().solve(b))); }
  MatrixXd a;
  VectorXd b;
};

TEST(ConjugateGradients, BoundTheErrorOfWhatTheyReturn) {
  const Line line(80);
  for (const double tolerance : {1e-2, 1e-5, 1e-8, 1e-11}) {
    VectorXd x;
    const CgReport report =
        conjugate_gradients(line.times(), line.by_diagonal(), line.b, tolerance, 1000, x);
    ASSERT_TRUE(report.converged) << tolerance;
    const double error = line.energy_error(x);
    EXPECT_LE(error, report.energy_error + 1e-13 * line.energy()) << tolerance;
    EXPECT_LE(report.energy_error, 2 * tolerance * line.energy());
    EXPECT_GT(error, 1e-5 * report.energy_error) << "no bound without end";
  }
}

TEST(ConjugateGradients, FindTheSmallestEigenvalueOfThePreconditionedMatrix) {
  const Line line(60);
  VectorXd x;
  const CgReport report =
      conjugate_gradients(line.times(), line.by_diagonal(), line.b, 1e-10, 1000, x);
  const VectorXd root = line.a.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = root.asDiagonal() * line.a * root.asDiagonal();
  const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(scaled).eigenvalues()[0];
  EXPECT_NEAR(report.least_ritz, least, 1e-3 * least);
  EXPECT_LT(least, 0.01) << "residuals alone would be off by ten";
}

TEST(ConjugateGradients, TakeOneStepWithTheInverseItself) {
  const Line line(50);
  const Eigen::LLT<MatrixXd> inverse(line.a);
  VectorXd x;
  const CgReport report = conjugate_gradients(
      line.times(), [&](const VectorXd& v, VectorXd& w) { w = inverse.solve(v); }, line.b, 1e-11,
      10, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_LT(line.energy_error(x), 1e-11 * line.energy());
}

TEST(ConjugateGradients, SayWhenTheyDoNotArrive) {
  const Line line(80);
  VectorXd x;
  const CgReport few = conjugate_gradients(line.times(), line.by_diagonal(), line.b, 1e-8, 5, x);
  EXPECT_FALSE(few.converged);
  EXPECT_EQ(few.iterations, 5);
  EXPECT_TRUE(
      conjugate_gradients(line.times(), line.by_diagonal(), line.b, 1e-3, 1000, x).converged);
  const CgReport beyond =
      conjugate_gradients(line.times(), line.by_diagonal(), line.b, 1e-30, 1000, x);
  EXPECT_FALSE(beyond.converged) << "beyond rounding, whatever the recurrence says";
  const CgReport indefinite =
      conjugate_gradients(line.times(), line.by_diagonal(-1), line.b, 1e-3, 100, x);
  EXPECT_FALSE(indefinite.converged);
  const CgReport nothing =
      conjugate_gradients(line.times(), line.by_diagonal(), VectorXd::Zero(80), 1e-3, 100, x);
  EXPECT_TRUE(nothing.converged && nothing.iterations == 0 && x.isZero(0));
}

}  // namespace
}  // namespace faultsim
