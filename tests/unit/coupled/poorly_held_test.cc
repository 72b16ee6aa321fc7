// Algebraic multigrid on a body whose rotations nothing but three nodes hold.
#include <gtest/gtest.h>

#include "simulator/coupled/box_study.h"
#include "simulator/coupled/kept_motions.h"
#include "simulator/coupled/solver_study.h"
#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

/// The cracked box without its base: its rigid motions are pinned at three nodes.
BulkProblem held_at_three_nodes(int cells_per_metre) {
  BulkProblem problem = box_study(cells_per_metre);
  problem.conditions.clear();
  return problem;
}

StudyRow row_of(const BulkProblem& problem, LeadingKind kind) {
  const TwoSidedBulk bulk(problem);
  return study(bulk, make_saddle_point(bulk), {kind, SchurKind::rac}, 100);
}

void expect_at_most_twice(int cells_per_metre, LeadingKind kind) {
  const StudyRow held = row_of(box_study(cells_per_metre), kind);
  const StudyRow poorly = row_of(held_at_three_nodes(cells_per_metre), kind);
  for (const auto& [count, reference] : {std::pair(poorly.random.to_1e6, held.random.to_1e6),
                                         std::pair(poorly.physical.to_1e6, held.physical.to_1e6)}) {
    EXPECT_GT(count, 0);
    EXPECT_LE(count, 2 * reference) << to_string(kind) << " 1/" << cells_per_metre;
  }
}

TEST(PoorlyHeld, BodiesTakeAtMostTwiceTheIterations) {
  for (const int cells_per_metre : {2, 4}) {
    expect_at_most_twice(cells_per_metre, LeadingKind::amg);
    expect_at_most_twice(cells_per_metre, LeadingKind::amg_by_component);
  }
}

TEST(PoorlyHeld, BodiesTakeAtMostTwiceTheIterationsAtAnEighthSlow) {
  expect_at_most_twice(8, LeadingKind::amg);
  expect_at_most_twice(8, LeadingKind::amg_by_component);
}

/// What one application finds of u, of its energy: 1 = all.
double found_of(const LinearMap& block, const SparseMatrix& k, const Eigen::VectorXd& u) {
  const Eigen::VectorXd f = k * u;
  Eigen::VectorXd found;
  block(f, found);
  return f.dot(found) / f.dot(u);
}

/// How the body moves under forces that are its rigid motions: about its three nodes.
TEST(PoorlyHeld, RotationsAreKeptByTheInterpolation) {
  const BulkProblem problem = held_at_three_nodes(4);
  const TwoSidedBulk bulk(problem);
  const SaddlePoint j = make_saddle_point(bulk);
  SaddlePoint without = j;
  const Eigen::MatrixXd motions = j.motions();
  Eigen::MatrixXd translations = Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
  for (int i = 0; i < j.n_displacements(); ++i) translations(i, i % 3) = 1;
  without.set_motions(translations);
  const LinearMap exact = leading_block(LeadingKind::exact, j, {}, {});
  const LinearMap kept = leading_block(LeadingKind::amg, j, {}, {});
  const LinearMap lost = leading_block(LeadingKind::amg, without, {}, {});
  double least_kept = 1, least_lost = 1;
  for (int k = 0; k < 6; ++k) {
    Eigen::VectorXd turned;
    exact(motions.col(k), turned);
    least_kept = std::min(least_kept, found_of(kept, j.leading(), turned));
    least_lost = std::min(least_lost, found_of(lost, j.leading(), turned));
  }
  EXPECT_GT(least_kept, 0.15);
  EXPECT_LT(least_lost, 0.02) << "or the test would say nothing";
}

/// What one application leaves of u: |u − B K u| / |u|, in energy.
double left_of(const LinearMap& block, const SparseMatrix& k, const Eigen::VectorXd& u) {
  Eigen::VectorXd found;
  block(k * u, found);
  const Eigen::VectorXd left = u - found;
  return std::sqrt(left.dot(k * left) / u.dot(k * u));
}

TEST(KeptMotions, AreSolvedExactlyAndTheMapStaysSymmetric) {
  const test::CoupledExample example;
  const SparseMatrix& k = example.stick.leading();
  const int n = static_cast<int>(k.rows());
  const Eigen::VectorXd inverse = k.diagonal().cwiseInverse() / 2;
  const auto jacobi = [&](const Eigen::VectorXd& f, Eigen::VectorXd& z) {
    z = inverse.cwiseProduct(f);
  };
  const auto multiply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = k * x; };
  const Eigen::MatrixXd motions = example.stick.motions();
  const LinearMap map = with_motions_kept(jacobi, multiply, motions);
  const Eigen::MatrixXd matrix = test::matrix_of(map, n);
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  const Eigen::MatrixXd smoothed = motions - inverse.asDiagonal() * Eigen::MatrixXd(k * motions);
  for (int c = 0; c < 6; ++c) EXPECT_LT(left_of(map, k, smoothed.col(c)), 1e-10) << c;
}

}  // namespace
}  // namespace faultsim
