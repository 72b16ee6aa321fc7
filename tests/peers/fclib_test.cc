// Our FCLib files as FCLib's own library reads them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "simulator/common/errors.h"
#include "tests/peers/fclib_reader.h"
#include "tests/unit/contact/cone_fixture.h"

namespace faultsim {
namespace {

/// Tests run side by side.
std::string scratch_file(const std::string& name) {
  return testing::TempDir() + name + "_" + std::to_string(getpid()) + ".hdf5";
}

/// W of n contacts: symmetric, positive definite, no two entries equal.
FrictionalContactProblem example(int dimension, int n_contacts) {
  FrictionalContactProblem problem;
  problem.dimension = dimension;
  const Eigen::Index n = dimension * n_contacts;
  problem.w.resize(n, n);
  problem.q.resize(n);
  problem.friction.resize(n_contacts);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      problem.w(i, j) = problem.w(j, i) =
          (i == j ? 1 : 0) + 0.1 / static_cast<double>(1 + i + 3 * j);
    }
    problem.q[i] = i % dimension == 0 ? -1 : 0.3 * static_cast<double>(i);
  }
  for (int k = 0; k < n_contacts; ++k) problem.friction[k] = 0.2 + 0.1 * k;
  return problem;
}

FrictionalContactSolution solve(const FrictionalContactProblem& problem) {
  const ConeStep given = cone_step(problem);
  ContactState end = given.step.start;
  EXPECT_EQ(ContactSolver(given.op, given.laws, {})
                .solve_step(given.step.before, given.step.after, end)
                .outcome,
            Outcome::converged);
  return cone_solution(end);
}

class Fclib : public testing::TestWithParam<int> {};

TEST_P(Fclib, ReadsBackEveryNumberAndText) {
  const std::string path = scratch_file("fclib_test");
  const FrictionalContactProblem problem = example(GetParam(), 4);
  const FrictionalContactSolution solution = solve(problem);
  write_fclib(path, problem, {"the title", "the description", "the mathematics"}, &solution);
  const FclibFile file = read_with_fclib(path);
  EXPECT_EQ(file.problem.dimension, problem.dimension);
  EXPECT_EQ(file.problem.w, problem.w);
  EXPECT_EQ(file.problem.q, problem.q);
  EXPECT_EQ(file.problem.friction, problem.friction);
  EXPECT_EQ(file.info.title, "the title");
  EXPECT_EQ(file.info.description, "the description");
  EXPECT_EQ(file.info.math_info, "the mathematics");
  ASSERT_TRUE(file.solution);
  EXPECT_EQ(file.solution->u, solution.u);
  EXPECT_EQ(file.solution->r, solution.r);
}
INSTANTIATE_TEST_SUITE_P(TwoAndThreeDimensions, Fclib, testing::Values(2, 3));

TEST(Fclib, MeasuresOurSolutionAsWeDo) {
  const std::string path = scratch_file("fclib_merit_test");
  const FrictionalContactProblem problem = example(3, 4);
  FrictionalContactSolution solution = solve(problem);
  write_fclib(path, problem, {"exact", "", ""}, &solution);
  EXPECT_LT(read_with_fclib(path).merit, 1e-8);  // the tolerance of our solver
  // A wrong one. FCLib takes u from r, and divides by 1 + √|q|.
  solution.r[4] += 0.05;
  solution.u = problem.w * solution.r + problem.q;
  write_fclib(path, problem, {"wrong", "", ""}, &solution);
  const double ours = natural_map_error(problem, solution);
  ASSERT_GT(ours, 0.01);
  EXPECT_NEAR(read_with_fclib(path).merit, ours / (1 + std::sqrt(problem.q.norm())), 1e-14);
}

TEST(Fclib, ReadsAFileWithoutSolution) {
  const std::string path = scratch_file("fclib_bare_test");
  write_fclib(path, example(3, 2), {"bare", "", ""}, nullptr);
  const FclibFile file = read_with_fclib(path);
  EXPECT_EQ(file.problem.q, example(3, 2).q);
  EXPECT_FALSE(file.solution);
}

}  // namespace
}  // namespace faultsim
