// What contact is given beside H, against the operator of the factor.

#include "simulator/solved_compliance/solved_operator.h"

#include <gtest/gtest.h>

#include "tests/unit/solved_compliance/examples.h"

namespace faultsim {
namespace {

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  EXPECT_EQ(a.size(), b.size());
  return b.size() == 0 ? 0 : (a - b).norm() / (b.norm() + 1e-300);
}

TEST(SolvedOperator, IsThatOfTheFactor) {
  for (const BulkProblem& problem : test::all_problems()) {
    const auto bulk = test::stuck(problem);
    const auto compliance = std::make_shared<const SolvedCompliance>(bulk, 1e9);
    const FaultOperator a = solved_operator(*bulk, compliance), b = test::condense(problem);
    EXPECT_EQ(a.compliance, compliance);
    EXPECT_EQ(compliance->n_made(), 0) << "no load needs a column";
    EXPECT_LT(relative(a.loads.traction, b.loads.traction), 1e-9);
    EXPECT_EQ(a.loads.keys, b.loads.keys);
    EXPECT_LT(relative(a.observed.per_load, b.observed.per_load), 1e-9);
    EXPECT_LT(relative(a.observed.per_jump, b.observed.per_jump), 1e-9);
    ASSERT_EQ(a.observed.rows.size(), b.observed.rows.size());
    for (std::size_t k = 0; k < a.observed.rows.size(); ++k)
      EXPECT_EQ(a.observed.rows[k].name, b.observed.rows[k].name);
    EXPECT_EQ(a.geometry.dof_area, b.geometry.dof_area);
    EXPECT_EQ(a.geometry.nodes.size(), b.geometry.nodes.size());
    EXPECT_EQ(a.n_unknowns, b.n_unknowns);
  }
}

TEST(SolvedOperator, HasTheDisplacementOfLoadsAndJumps) {
  const BulkProblem problem = test::mixed_problem();
  const auto bulk = test::stuck(problem);
  SilentMonitor monitor;
  CondensedBulk condensed(problem, monitor);
  condensed.condense();
  const std::vector<double> factors = {2e6, 0.5, 3, -1e6};
  Eigen::VectorXd jump(bulk->dofs().n_jump());
  for (int j = 0; j < jump.size(); ++j) jump[j] = 1e-3 * std::sin(j);
  const Eigen::Matrix3Xd u = condensed.displacement(factors, jump);
  EXPECT_LT((solved_displacement(*bulk, factors, jump) - u).norm(), 1e-9 * u.norm());
  EXPECT_GT(u.norm(), 1e-3);
}

}  // namespace
}  // namespace faultsim
