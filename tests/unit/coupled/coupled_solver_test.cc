#include "simulator/coupled/coupled_solver.h"

#include <gtest/gtest.h>

#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;

struct Solved {
  CoupledReport report;
  Eigen::VectorXd u, lambda;
  double true_residual = 1;  ///< |b − J x| / |b|, computed.
};

Solved solve(const SaddlePoint& j, const SolverChoice& choice, const Eigen::VectorXd& f,
             const Eigen::VectorXd& g, double tolerance, int max_iterations = 400) {
  Solved solved;
  CoupledSolver solver(j, choice);
  solved.report = solver.solve(f, g, tolerance, max_iterations, solved.u, solved.lambda);
  const double scale = solver.multiplier_scale();
  const Eigen::VectorXd r_u = f - j.leading() * solved.u - j.coupling * solved.lambda;
  const Eigen::VectorXd r_l = scale * (g - j.constraint.transpose() * solved.u);
  solved.true_residual =
      std::hypot(r_u.norm(), r_l.norm()) / std::hypot(f.norm(), scale * g.norm());
  return solved;
}

TEST(CoupledSolver, WithBothBlocksExactTakesOneIterationOrTwo) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    for (const BlockForm form : {BlockForm::full, BlockForm::upper}) {
      const SolverChoice choice{LeadingKind::exact, SchurKind::exact, form};
      const Solved solved = solve(j, choice, Eigen::VectorXd::Random(j.n_displacements()) * 1e6,
                                  Eigen::VectorXd::Random(j.n_multipliers()) * 1e-3, 1e-9);
      EXPECT_TRUE(solved.report.converged);
      EXPECT_EQ(solved.report.iterations_to(1e-9), form == BlockForm::full ? 1 : 2);
      EXPECT_LT(solved.true_residual, 1e-8);
    }
  }
}

TEST(CoupledSolver, EveryCombinationFindsTheSameSolution) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const Eigen::VectorXd u = Eigen::VectorXd::Random(j.n_displacements()) * 1e-2;
    const Eigen::VectorXd lambda = Eigen::VectorXd::Random(j.n_multipliers()) * 1e6;
    const Eigen::VectorXd f = j.leading() * u + j.coupling * lambda;
    const Eigen::VectorXd g = j.constraint.transpose() * u;
    for (const LeadingKind leading : enumerators<LeadingKind>()) {
      for (const SchurKind schur : enumerators<SchurKind>()) {
        for (const BlockForm form : {BlockForm::full, BlockForm::upper}) {
          const Solved solved = solve(j, {leading, schur, form}, f, g, 1e-10);
          const std::string name = std::string(to_string(leading)) + " " + to_string(schur);
          EXPECT_TRUE(solved.report.converged) << name;
          EXPECT_LT(solved.true_residual, 1e-9) << name;
          EXPECT_LT((solved.u - u).norm(), 1e-5 * u.norm()) << name;
          EXPECT_LT((solved.lambda - lambda).norm(), 1e-5 * lambda.norm()) << name;
        }
      }
    }
  }
}

TEST(CoupledSolver, ResidualsFallAndEndWhereToldTo) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Solved solved =
      solve(j, {}, example.bulk.load(1), Eigen::VectorXd::Zero(j.n_multipliers()), 1e-8);
  const std::vector<double>& residuals = solved.report.residuals;
  ASSERT_GT(residuals.size(), 3u);
  EXPECT_EQ(residuals.front(), 1);
  EXPECT_LE(residuals.back(), 1e-8);
  EXPECT_GT(residuals[residuals.size() - 2], 1e-8);
  EXPECT_TRUE(std::is_sorted(residuals.rbegin(), residuals.rend()));
  EXPECT_EQ(solved.report.iterations_to(1e-8), static_cast<int>(residuals.size()) - 1);
  EXPECT_EQ(solved.report.iterations_to(1e-12), -1);
  EXPECT_NEAR(solved.true_residual / residuals.back(), 1, 1e-3);
}

TEST(CoupledSolver, SaysWhenItDoesNotGetThere) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Solved solved = solve(j, {LeadingKind::fsai, SchurKind::bds}, example.bulk.load(1),
                              Eigen::VectorXd::Zero(j.n_multipliers()), 1e-10, 5);
  EXPECT_FALSE(solved.report.converged);
  EXPECT_EQ(solved.report.iterations_to(1e-10), -1);
  EXPECT_GT(solved.true_residual, 1e-10);
}

TEST(CoupledSolver, CountsDoNotDependOnTheUnits) {
  const CoupledExample example;
  BulkProblem soft = example.problem;
  for (ElasticMaterial& material : soft.materials) material.youngs_modulus *= 1e-9;
  const TwoSidedBulk bulk(soft);
  const SaddlePoint j = make_saddle_point(bulk);
  const Eigen::VectorXd g = Eigen::VectorXd::Zero(j.n_multipliers());
  const Solved hard = solve(example.stick, {}, example.bulk.load(1), g, 1e-8);
  const Solved scaled = solve(j, {}, bulk.load(1), g, 1e-8);
  EXPECT_EQ(hard.report.residuals.size(), scaled.report.residuals.size());
}

TEST(CoupledSolver, NothingToDoIsDoneAtOnce) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Solved solved = solve(j, {}, Eigen::VectorXd::Zero(j.n_displacements()),
                              Eigen::VectorXd::Zero(j.n_multipliers()), 1e-8);
  EXPECT_TRUE(solved.report.converged);
  EXPECT_EQ(solved.u.norm() + solved.lambda.norm(), 0);
}

}  // namespace
}  // namespace faultsim
