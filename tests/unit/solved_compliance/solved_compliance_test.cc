// Columns that are solved for, against the H of the factor.

#include "simulator/solved_compliance/solved_compliance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/solved_compliance/examples.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

constexpr double kPlenty = 1e9;

Eigen::MatrixXd columns(const Compliance& compliance) {
  Eigen::MatrixXd h(compliance.size(), compliance.size());
  for (int j = 0; j < compliance.size(); ++j) h.col(j) = compliance.column(j);
  return h;
}

TEST(SolvedCompliance, IsTheHOfTheFactorWithinItsBound) {
  for (const BulkProblem& problem : test::all_problems()) {
    const auto bulk = test::stuck(problem);
    const SolvedCompliance solved(bulk, kPlenty);
    const Eigen::MatrixXd stored = test::condense(problem).h(), h = columns(solved);
    const Eigen::VectorXd root = bulk->jump_diagonal().cwiseSqrt();
    const Eigen::MatrixXd error =
        root.cwiseInverse().asDiagonal() * (h - stored) * root.cwiseInverse().asDiagonal();
    EXPECT_LE(error.cwiseAbs().maxCoeff(), solved.error_bound() + 1e-13);
    EXPECT_LT(solved.error_bound(), 3e-11);
    EXPECT_GT(solved.error_bound(), 1e-13) << "no bound that rounding made";
    for (int j = 0; j < solved.size(); ++j) {
      EXPECT_EQ(solved.diagonal(j), h(j, j));
      EXPECT_GE(solved.diagonal_bound(j), solved.diagonal(j));
    }
    EXPECT_EQ(solved.n_made(), solved.size());
    EXPECT_EQ(solved.matrix_entries(), nullptr);
  }
}

TEST(SolvedCompliance, MakesAColumnOnceAndWhenItIsAskedFor) {
  const auto bulk = test::stuck(test::mixed_problem());
  const SolvedCompliance solved(bulk, kPlenty);
  EXPECT_GT(solved.diagonal_bound(5), 0);
  EXPECT_EQ(bulk->work().n_solves, 0);
  const double* first = solved.column(5).data();
  EXPECT_EQ(solved.column(5).data(), first);
  EXPECT_EQ(bulk->work().n_solves, 1);
  Eigen::VectorXd jump = Eigen::VectorXd::Zero(solved.size()), traction = jump;
  jump[5] = jump[7] = 1e-2;
  const std::array<int, 2> active = {5, 7};
  const RowRange all{0, solved.size()};
  const Eigen::VectorXd unit = Eigen::VectorXd::Ones(solved.size());
  solved.subtract_product(active, jump, unit, {&all, 1}, traction);
  EXPECT_EQ(bulk->work().n_solves, 2);
  const SolvedCompliance::Product product = solved.product(jump);
  EXPECT_LT((traction + product.forces).norm(), 1e-10 * traction.norm());
  EXPECT_GT(traction.norm(), 1e6);
}

TEST(SolvedCompliance, ForgetsWhatHasWaitedLongestAndMakesItAgain) {
  const auto bulk = test::stuck(test::mixed_problem());
  SolvedCompliance solved(bulk, 3.5 * 8 * static_cast<double>(bulk->jump_diagonal().size()));
  const Eigen::VectorXd one = solved.column(1);
  solved.column(2);
  solved.column(3);
  EXPECT_EQ(solved.n_kept(), 3);
  solved.begin_step();
  solved.column(1);
  const double* kept = solved.column(3).data();
  solved.column(4);  // instead of 2
  EXPECT_EQ(solved.column(3).data(), kept);
  EXPECT_EQ(solved.n_kept(), 3);
  EXPECT_EQ(solved.n_made(), 4);
  EXPECT_EQ(Eigen::VectorXd(solved.column(1)), one);
  EXPECT_EQ(solved.n_made(), 4);
  try {
    solved.column(2);
    FAIL() << "all others were asked for in this step";
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("more than 3 of"));
    EXPECT_THAT(error.what(), HasSubstr("jumps move in one load step"));
  }
  solved.begin_step();
  solved.column(2);  // instead of 4, which has waited longest
  solved.column(1);
  solved.column(3);
  EXPECT_EQ(solved.n_made(), 5);
  for (const int j : {4, 2}) {  // instead of 2, then of 1
    solved.begin_step();
    solved.column(j);
  }
  solved.begin_step();
  EXPECT_EQ(Eigen::VectorXd(solved.column(1)), one) << "to the bit, in whatever order";
  EXPECT_EQ(solved.n_made(), 8);
}

}  // namespace
}  // namespace faultsim
