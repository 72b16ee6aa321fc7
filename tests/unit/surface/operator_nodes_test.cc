// Operators as vectors: what they are off by, how they lie to each other, and what is made of them.
#include "simulator/surface/operator_nodes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

/// Of any numbers; loads and observations in units far from those of H.
std::shared_ptr<FaultOperator> operator_of(unsigned seed, double unit = 1) {
  std::srand(seed);
  auto op = std::make_shared<FaultOperator>();
  op->geometry.n_dofs = 4;
  const Eigen::MatrixXd any = Eigen::MatrixXd::Random(4, 4);
  op->compliance = std::make_shared<DenseCompliance>(Eigen::MatrixXd(any + any.transpose()));
  op->loads.keys.resize(2);
  op->loads.traction = unit * 1e3 * Eigen::MatrixXd::Random(4, 2);
  op->observed.per_load = unit * 1e-6 * Eigen::MatrixXd::Random(3, 2);
  op->observed.per_jump = Eigen::MatrixXd::Random(3, 4);
  return op;
}

/// The lower triangle of H, each load, U and V, as vectors.
std::vector<Eigen::VectorXd> blocks_of(const FaultOperator& op) {
  std::vector<double> lower;
  for (int j = 0; j < 4; ++j)
    for (int i = j; i < 4; ++i) lower.push_back(op.h()(i, j));
  return {Eigen::Map<Eigen::VectorXd>(lower.data(), 10), op.loads.traction.col(0),
          op.loads.traction.col(1), op.observed.per_load.reshaped(),
          op.observed.per_jump.reshaped()};
}

OperatorNodes three_nodes(double unit = 1) {
  OperatorNodes nodes(operator_of(1, unit));
  nodes.add(operator_of(2, unit));
  nodes.add(operator_of(3, unit));
  return nodes;
}

TEST(OperatorNodes, ASurplusIsTheLargestBlockRelativeToTheCentre) {
  const OperatorNodes nodes = three_nodes();
  const auto off = operator_of(4);
  const Eigen::Vector3d w(0.2, 1.5, -0.7);
  const auto blocks = blocks_of(*off), a = blocks_of(*operator_of(1)),
             b = blocks_of(*operator_of(2)), c = blocks_of(*operator_of(3));
  double largest = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    largest = std::max(largest,
                       (blocks[k] - w[0] * a[k] - w[1] * b[k] - w[2] * c[k]).norm() / a[k].norm());
  }
  EXPECT_NEAR(nodes.surplus(*off, w, {}), largest, 1e-12 * largest);
  EXPECT_EQ(nodes.surplus(*operator_of(2), Eigen::Vector3d(0, 1, 0), {}), 0);
}

/// Of one block at a time: each is looked at, and whatever its size.
TEST(OperatorNodes, ASurplusSeesEveryBlock) {
  const OperatorNodes nodes{operator_of(1)};
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const auto with = [&](const auto& change) {
    auto op = operator_of(1);
    change(*op);
    return nodes.surplus(*op, one, {});
  };
  EXPECT_NEAR(with([](auto& op) { op.loads.traction.col(0) *= 1.01; }), 0.01, 1e-9);
  EXPECT_NEAR(with([](auto& op) { op.loads.traction.col(1) *= 1.02; }), 0.02, 1e-9);
  EXPECT_NEAR(with([](auto& op) { op.observed.per_load *= 1.03; }), 0.03, 1e-9);
  EXPECT_NEAR(with([](auto& op) { op.observed.per_jump *= 1.04; }), 0.04, 1e-9);
  EXPECT_NEAR(with([](auto& op) {
                op.compliance = std::make_shared<DenseCompliance>(Eigen::MatrixXd(1.05 * op.h()));
              }),
              0.05, 1e-9);
}

TEST(OperatorNodes, ASurplusHasNoUnits) {
  const Eigen::Vector3d w(0.2, 1.5, -0.7);
  EXPECT_NEAR(three_nodes().surplus(*operator_of(4), w, {}),
              three_nodes(1e9).surplus(*operator_of(4, 1e9), w, {}), 1e-9);
}

/// With the unit directions a node is its own direction; with others H is the sum of them.
TEST(OperatorNodes, ABasisOfAllDirectionsRepeatsTheNodes) {
  const OperatorNodes nodes = three_nodes();
  for (const double angle : {0.0, 0.6}) {
    Eigen::Matrix2d turned;
    turned << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    const auto basis = std::make_shared<OperatorBasis>(nodes.basis(turned, 1e-9, {}));
    for (unsigned k = 0; k < 2; ++k) {
      FaultOperator op;
      OperatorBasis::put(basis, Eigen::Vector2d::Unit(k), op);
      const auto node = operator_of(k + 2);
      EXPECT_LT((op.h() - node->h()).norm(), 1e-6 * node->h().norm()) << "in single precision";
      for (int j = 0; j < 4; ++j) EXPECT_NEAR(op.compliance->diagonal(j), op.h()(j, j), 1e-14);
      EXPECT_LT((op.loads.traction - node->loads.traction).norm(),
                1e-12 * node->loads.traction.norm());
      EXPECT_LT((op.observed.per_load - node->observed.per_load).norm(),
                1e-12 * node->observed.per_load.norm());
      EXPECT_LT((op.observed.per_jump - node->observed.per_jump).norm(),
                1e-12 * node->observed.per_jump.norm());
    }
  }
}

/// Jumps down a line, and a kernel that is smooth away from its diagonal and stretched by θ.
std::shared_ptr<FaultOperator> down_a_line(double theta) {
  constexpr int kJumps = 500;
  auto op = std::make_shared<FaultOperator>();
  op->geometry.n_dofs = kJumps;
  Eigen::MatrixXd h(kJumps, kJumps);
  for (int j = 0; j < kJumps; ++j)
    for (int i = 0; i < kJumps; ++i)
      h(i, j) = (i == j ? 3 : -0.5) / (1 + theta * std::pow(i - j, 2));
  op->compliance = std::make_shared<DenseCompliance>(h);
  op->loads.traction.resize(kJumps, 0);
  op->observed.per_load.resize(0, 0);
  op->observed.per_jump.resize(0, kJumps);
  return op;
}

/// Off by no more than asked for, and a part of the memory.
TEST(OperatorNodes, TwoRunsOfJumpsHaveFewColumnsInCommon) {
  OperatorNodes nodes(down_a_line(1));
  const double thetas[] = {1.2, 0.8, 1.1};
  for (const double theta : thetas) nodes.add(down_a_line(theta));
  for (const double left_out : {1e-3, 1e-6}) {
    const auto basis =
        std::make_shared<OperatorBasis>(nodes.basis(Eigen::Matrix3d::Identity(), left_out, {}));
    EXPECT_EQ(basis->stiffness.n_runs(), 3);
    EXPECT_LT(basis->stiffness.far_size(), 500 * 500 / 10);
    double most = 0;
    for (int k = 0; k < 3; ++k) {
      FaultOperator op;
      OperatorBasis::put(basis, Eigen::Vector3d::Unit(k), op);
      const Eigen::MatrixXd exact = down_a_line(thetas[k])->h();
      most = std::max(most, (op.h() - exact).norm() / nodes.centre()->h().norm());
    }
    EXPECT_LT(most,
              std::sqrt(2) * left_out);  // a block counts twice in H, and once in its triangle
    EXPECT_GT(most, 1e-4 * left_out);
  }
}

/// Products of the lower triangles of H, less the centre's, over the square of the centre's norm.
TEST(OperatorNodes, AGramIsOfTheDifferencesToTheCentre) {
  const Eigen::MatrixXd gram = three_nodes().stiffness_gram({});
  const Eigen::VectorXd a = blocks_of(*operator_of(1))[0], b = blocks_of(*operator_of(2))[0] - a,
                        c = blocks_of(*operator_of(3))[0] - a;
  Eigen::Matrix2d expected;
  expected << b.dot(b), b.dot(c), b.dot(c), c.dot(c);
  EXPECT_LT((gram - expected / a.squaredNorm()).norm(), 1e-12 * gram.norm());
}

}  // namespace
}  // namespace faultsim
