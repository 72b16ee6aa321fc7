#include "simulator/solved_compliance/stuck_bulk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/unit/solved_compliance/examples.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

/// K as a dense matrix, and a force of all wave lengths.
struct Dense {
  explicit Dense(const StuckBulk& bulk)
      : n_r(bulk.dofs().n_bulk()), n_g(bulk.dofs().n_jump()), force(n_r + n_g) {
    const BulkProblem& problem = bulk.problem();
    k = Eigen::MatrixXd(assemble_stiffness(problem.mesh, problem.materials, bulk.dofs(),
                                           problem.mean_dilatation))
            .selfadjointView<Eigen::Lower>();
    for (int i = 0; i < force.size(); ++i) force[i] = 1e6 * std::sin(1.7 * i * i);
  }
  int n_r, n_g;
  Eigen::MatrixXd k;
  Eigen::VectorXd force;
};

TEST(StuckBulk, RespondsAsTheMatrixSaysWhateverPreconditions) {
  for (const BulkProblem& problem : test::all_problems()) {
    for (const LeadingKind leading :
         {LeadingKind::exact, LeadingKind::amg, LeadingKind::amg_by_component, LeadingKind::fsai,
          LeadingKind::incomplete_cholesky}) {
      SCOPED_TRACE(to_string(leading));
      const auto bulk = test::stuck(problem, leading);
      const Dense dense(*bulk);
      const auto k_rr = dense.k.topLeftCorner(dense.n_r, dense.n_r);
      const auto k_gr = dense.k.bottomLeftCorner(dense.n_g, dense.n_r);
      const Eigen::VectorXd r = k_rr.llt().solve(dense.force.head(dense.n_r));
      const Eigen::VectorXd jumps = dense.force.tail(dense.n_g) - k_gr * r;
      const StuckBulk::Response response = bulk->respond(dense.force);
      const Eigen::VectorXd error = response.r - r;
      const double energy = std::sqrt(error.dot(k_rr * error)), all = std::sqrt(r.dot(k_rr * r));
      EXPECT_LE(energy, response.report.energy_error + 1e-13 * all);
      EXPECT_LE(response.report.energy_error, 2e-11 * all);
      const Eigen::VectorXd allowed =
          dense.k.diagonal().tail(dense.n_g).cwiseSqrt() * response.report.energy_error;
      EXPECT_TRUE(
          ((response.jumps - jumps).cwiseAbs().array() <= allowed.array() + 1e-13 * jumps.norm())
              .all());
    }
  }
}

TEST(StuckBulk, HasTheForcesOfJumps) {
  const auto bulk = test::stuck(test::mixed_problem());
  const Dense dense(*bulk);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(dense.n_r + dense.n_g);
  for (int j = 0; j < dense.n_g; ++j) x[dense.n_r + j] = std::cos(j);
  const Eigen::VectorXd force = dense.k * x;
  EXPECT_LT((bulk->jump_forces(x.tail(dense.n_g)) - force).norm(), 1e-14 * force.norm());
  EXPECT_LT((bulk->jump_diagonal() - dense.k.diagonal().tail(dense.n_g)).norm(), 1e-3);
}

TEST(StuckBulk, CountsItsWork) {
  const auto bulk = test::stuck(test::mixed_problem());
  const Dense dense(*bulk);
  EXPECT_EQ(bulk->work().n_solves, 0);
  const StuckBulk::Response one = bulk->respond(dense.force), same = bulk->respond(dense.force);
  EXPECT_EQ(one.r, same.r) << "to the bit";
  EXPECT_EQ(bulk->work().iterations, std::vector<int>(2, one.report.iterations));
  EXPECT_LE(one.report.iterations, 30);
  EXPECT_GE(one.report.iterations, 5);
}

TEST(StuckBulk, RefusesWhatItCannotDo) {
  try {
    test::stuck(test::mixed_problem(), LeadingKind::ilu);
    FAIL() << "ilu is not symmetric";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ilu cannot precondition"));
  }
  BulkProblem loose = test::loose_problem();
  loose.conditions = test::rollers({Side::y_min, Side::y_max, Side::z_min});
  EXPECT_THROW(test::stuck(loose), InputError) << "all of it moves along x";
  const StuckBulk poor(std::make_shared<const BulkProblem>(test::mixed_problem()),
                       {.leading = LeadingKind::fsai, .max_iterations = 3});
  try {
    poor.respond(Dense(poor).force);
    FAIL() << "three iterations of fsai";
  } catch (const Unsolved& error) {
    EXPECT_THAT(error.what(), HasSubstr("conjugate gradients (fsai) do not reach"));
  }
}

}  // namespace
}  // namespace faultsim
