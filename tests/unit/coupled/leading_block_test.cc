#include "simulator/coupled/leading_block.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "simulator/common/errors.h"
#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;
using test::matrix_of;

constexpr FsaiOptions kLeadingFsai{.steps = 6, .step_size = 2, .tolerance = 0.01};

/// A chain of springs, held at its ends.
SparseMatrix chain(int n) {
  std::vector<Eigen::Triplet<double, long>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.1 + 0.1 * (i % 4));
    if (i + 1 == n) continue;
    entries.emplace_back(i, i + 1, -1);
    entries.emplace_back(i + 1, i, -1);
  }
  SparseMatrix a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

SaddlePoint with_leading(const SparseMatrix& a) {
  SaddlePoint j;
  j.set_leading(a);
  j.constraint = j.coupling = SparseMatrix(a.rows(), 0);
  return j;
}

TEST(Fsai, RowsAreNormalisedAndOrthogonalOnTheirPattern) {
  const CoupledExample example;
  const SparseMatrix& k = example.stick.leading();
  const SparseMatrix g = fsai_factor(k, kLeadingFsai);
  const Eigen::SparseMatrix<double, Eigen::RowMajor, long> rows = g;
  long widest = 0;
  for (int i = 0; i < rows.rows(); ++i) {
    const Eigen::VectorXd gi = Eigen::VectorXd(rows.row(i));
    const Eigen::VectorXd kg = k * gi;
    EXPECT_NEAR(gi.dot(kg), 1, 1e-10) << "diag(G K Gᵀ), row " << i;
    long n = 0;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor, long>::InnerIterator it(rows, i); it; ++it) {
      ++n;
      ASSERT_LE(it.col(), i) << "lower triangular";
      // The minimum of |I − G L|_F on this pattern, L the Cholesky factor of K.
      if (it.col() != i) {
        EXPECT_NEAR(kg[it.col()] * gi[i], 0, 1e-9) << i << ' ' << it.col();
      }
    }
    widest = std::max(widest, n);
  }
  EXPECT_EQ(widest, 1 + kLeadingFsai.steps * kLeadingFsai.step_size);
}

TEST(Fsai, GrowsUntilTheToleranceIsMet) {
  const CoupledExample example;
  const auto entries = [&](double tolerance) {
    return fsai_factor(example.stick.leading(),
                       {.steps = 10, .step_size = 1, .tolerance = tolerance})
        .nonZeros();
  };
  EXPECT_EQ(entries(1), example.stick.n_displacements());
  EXPECT_LT(entries(0.9), entries(0.7));
  EXPECT_LT(entries(0.7), entries(0.5));
}

TEST(Fsai, IsTheInverseWhereThePatternMayGrowFull) {
  const SparseMatrix a = chain(12);
  const Eigen::MatrixXd g = fsai_factor(a, {.steps = 12, .step_size = 1, .tolerance = 1e-12});
  EXPECT_LT((g.transpose() * g - Eigen::MatrixXd(a).inverse()).norm(), 1e-8);
}

TEST(Fsai, TakesRowsFarLongerThanTheMean) {
  const int n = 200;
  SparseMatrix a = chain(n);
  for (int i = 0; i + 2 < n; ++i) a.coeffRef(n - 1, i) = a.coeffRef(i, n - 1) = -0.01;
  a.coeffRef(n - 1, n - 1) = 10;
  a.makeCompressed();
  const SparseMatrix g = fsai_factor(a, {.steps = 40, .step_size = 5, .tolerance = 1e-9});
  EXPECT_LT(Eigen::MatrixXd(g * a * SparseMatrix(g.transpose())).diagonal().maxCoeff(), 1 + 1e-10);
  const Eigen::MatrixXd product = Eigen::MatrixXd(g.transpose()) * g * a;
  EXPECT_LT((product - Eigen::MatrixXd::Identity(n, n)).norm(), 0.5);
}

TEST(Fsai, RefusesAMatrixThatIsNotPositiveDefinite) {
  SparseMatrix a = chain(9);
  a.coeffRef(4, 4) = -3;
  EXPECT_THROW(fsai_factor(a, {}), ResourceError);
}

TEST(Fsai, BlockAppliesItsFactors) {
  const CoupledExample example;
  const auto block = leading_block(LeadingKind::fsai, example.stick, kLeadingFsai, {});
  const SparseMatrix g = fsai_factor(example.stick.leading(), kLeadingFsai);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(g.rows());
  Eigen::VectorXd z;
  block(r, z);
  EXPECT_LT((z - g.transpose() * (g * r)).norm(), 1e-12 * z.norm());
}

TEST(ExactBlock, SolvesWithAndWithoutSymmetry) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const auto block = leading_block(LeadingKind::exact, j, {}, {});
    const Eigen::VectorXd u = Eigen::VectorXd::Random(j.n_displacements());
    Eigen::VectorXd z;
    block(j.leading() * u, z);
    EXPECT_LT((z - u).norm(), 1e-9 * u.norm());
  }
}

TEST(ExactBlock, TakesAMatrixThatIsNotPositiveDefinite) {
  SparseMatrix a = chain(9);
  a.coeffRef(4, 4) = -3;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(9, 1, 2);
  Eigen::VectorXd found;
  direct_solver(a, true)(a * x, found);
  EXPECT_LT((found - x).norm(), 1e-12);
  a.coeffRef(0, 0) = a.coeffRef(0, 1) = a.coeffRef(1, 0) = 0;
  EXPECT_THROW(direct_solver(a, true), ResourceError);
}

TEST(IncompleteBlocks, AreExactWhereNothingIsDropped) {
  const SaddlePoint j = with_leading(chain(30));
  for (const LeadingKind kind : {LeadingKind::incomplete_cholesky, LeadingKind::ilu}) {
    const auto block = leading_block(kind, j, {}, {.drop_tolerance = 0, .max_row = 30});
    EXPECT_LT(
        (matrix_of(block, 30) * Eigen::MatrixXd(j.leading()) - Eigen::MatrixXd::Identity(30, 30))
            .norm(),
        1e-9)
        << static_cast<int>(kind);
  }
}

/// Largest and smallest eigenvalue of M⁻¹ K, M⁻¹ made symmetric; both after checking how symmetric
/// it was.
Eigen::Vector2d spectrum(LeadingKind kind, const SaddlePoint& j, double symmetry) {
  const auto block = leading_block(kind, j, kLeadingFsai, {});
  const Eigen::MatrixXd inverse = matrix_of(block, j.n_displacements());
  EXPECT_LT((inverse - inverse.transpose()).norm(), symmetry * inverse.norm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      (inverse + inverse.transpose()) / 2, Eigen::MatrixXd(j.leading()).inverse());
  return {eigen.eigenvalues().minCoeff(), eigen.eigenvalues().maxCoeff()};
}

TEST(LeadingBlocks, ArePositiveDefiniteAndBetterThanTheDiagonal) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Eigen::VectorXd root = j.leading().diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi(
      root.asDiagonal() * Eigen::MatrixXd(j.leading()) * root.asDiagonal());
  const double plain = jacobi.eigenvalues().maxCoeff() / jacobi.eigenvalues().minCoeff();
  for (const LeadingKind kind : {LeadingKind::fsai, LeadingKind::incomplete_cholesky,
                                 LeadingKind::amg, LeadingKind::amg_by_component}) {
    const Eigen::Vector2d range = spectrum(kind, j, 1e-10);
    EXPECT_GT(range[0], 0) << static_cast<int>(kind);
    EXPECT_LT(range[1] / range[0], plain / 2) << static_cast<int>(kind);
  }
  const Eigen::Vector2d ilu = spectrum(LeadingKind::ilu, j, 0.1);
  EXPECT_LT(ilu[1] / ilu[0], plain / 2);
}

}  // namespace
}  // namespace faultsim
