// Several matrices in bases that they share.
#include "simulator/linalg/shared_bases.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

constexpr Eigen::Index kRows = 12, kColumns = 9, kCount = 4;

Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::srand(seed);
  return Eigen::MatrixXd::Random(rows, columns);
}

/// The squares of what is left out of all matrices.
double left_out(const Eigen::MatrixXd& side_by_side, const SharedBases& bases) {
  double sum = 0;
  const Eigen::Index r = bases.u.cols();
  for (Eigen::Index k = 0; k < kCount; ++k) {
    const Eigen::MatrixXd core = bases.cores.middleCols(k * r, r).transpose();
    sum += (side_by_side.middleCols(k * kColumns, kColumns) - bases.u * core * bases.v.transpose())
               .squaredNorm();
  }
  return sum;
}

/// A_k = P X_k Qᵀ with P of 3 columns and Q of 2.
TEST(SharedBases, FindTheColumnsAndTheRowsThatAllHaveInCommon) {
  set_blas_threads(1);
  const Eigen::MatrixXd p = random(kRows, 3, 1), q = random(kColumns, 2, 2);
  Eigen::MatrixXd all(kRows, kColumns * kCount);
  for (unsigned k = 0; k < kCount; ++k)
    all.middleCols(k * kColumns, kColumns) = p * random(3, 2, 3 + k) * q.transpose();
  const SharedBases bases = shared_bases(all, kColumns, 1e-14 * all.squaredNorm());
  EXPECT_EQ(bases.u.cols(), 3);
  EXPECT_EQ(bases.v.cols(), 2);
  EXPECT_LT((bases.u.transpose() * bases.u - Eigen::Matrix3d::Identity()).norm(), 1e-13);
  EXPECT_LT((bases.v.transpose() * bases.v - Eigen::Matrix2d::Identity()).norm(), 1e-13);
  EXPECT_LT(left_out(all, bases), 1e-14 * all.squaredNorm());
}

/// Values of a smooth kernel: what is left out is below what may be, and not by leaving out
/// nothing.
TEST(SharedBases, LeaveOutAsMuchAsTheyMay) {
  set_blas_threads(1);
  Eigen::MatrixXd all(kRows, kColumns * kCount);
  for (Eigen::Index k = 0; k < kCount; ++k)
    for (Eigen::Index j = 0; j < kColumns; ++j)
      for (Eigen::Index i = 0; i < kRows; ++i)
        all(i, k * kColumns + j) =
            1 / (2 + static_cast<double>(k) + std::hypot(i, 1.3 * static_cast<double>(j)));
  Eigen::Index last = kRows + kColumns + 1;
  for (const double share : {1e-12, 1e-8, 1e-4}) {
    const double most = share * all.squaredNorm();
    const SharedBases bases = shared_bases(all, kColumns, most);
    EXPECT_LE(left_out(all, bases), most);
    EXPECT_GT(left_out(all, bases), 1e-5 * most) << "ranks are no larger than need be";
    EXPECT_LT(bases.u.cols() + bases.v.cols(), last);
    last = bases.u.cols() + bases.v.cols();
  }
}

/// Of twelve directions of the same size the columns may leave out half of what may be left out,
/// and the rows the other half.
TEST(SharedBases, ColumnsAndRowsLeaveOutHalfEach) {
  set_blas_threads(1);
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(kRows, kRows);
  const SharedBases bases = shared_bases(all, kRows, 6.5);
  EXPECT_EQ(bases.u.cols(), 9);
  EXPECT_EQ(bases.v.cols(), 6);
  const Eigen::MatrixXd kept = bases.u * bases.cores.transpose() * bases.v.transpose();
  EXPECT_NEAR((all - kept).squaredNorm(), 6, 1e-12);
}

TEST(SharedBases, AreEmptyWhereNothingIsLeft) {
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(kRows, kColumns * kCount);
  const SharedBases bases = shared_bases(nothing, kColumns, 0);
  EXPECT_EQ(bases.u.cols(), 0);
  EXPECT_EQ(bases.v.cols(), 0);
  EXPECT_EQ(bases.cores.size(), 0);
  EXPECT_EQ(times_transpose(bases.u, Eigen::MatrixXd(kColumns, 0)),
            Eigen::MatrixXd::Zero(kRows, kColumns));
}

}  // namespace
}  // namespace faultsim
