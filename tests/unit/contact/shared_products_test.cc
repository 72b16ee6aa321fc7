// Products by a team of threads have the bits of one thread, which are those of the definition
// written out below.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "simulator/common/thread_team.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/moving_block.h"
#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

FaultOperator random_operator(int n_nodes) {
  FaultOperator op = make_operator(n_nodes, 2, Eigen::VectorXd::LinSpaced(n_nodes, 1, 3));
  set_h(op, 1e8 * Eigen::MatrixXd::Random(op.geometry.n_dofs, op.geometry.n_dofs));
  return op;
}

/// The block's product by one thread and without ranges of rows.
Eigen::VectorXf product_of(const MovingBlock& block, const std::vector<int>& places,
                           const Eigen::VectorXf& x) {
  Eigen::VectorXf z = Eigen::VectorXf::Zero(block.n_vector());
  for (const int place : places) {
    const Eigen::Vector3f own = x.segment<3>(3 * place);
    const auto others = block.before(place).multiply({own[0], own[1], own[2]}, x.data(), z.data());
    z.segment<3>(3 * place) +=
        block.own(place) * own + Eigen::Vector3f(others[0], others[1], others[2]);
  }
  return z;
}

/// Nodes that joined the block in an order of their own, and the places of those that do not rest.
struct Movers {
  Movers(const FaultOperator& op, int n_nodes, int resting, ThreadTeam* team)
      : problem(op, same_law(op, {}), team), block(problem) {
    std::vector<int> nodes(static_cast<std::size_t>(n_nodes));
    std::iota(nodes.begin(), nodes.end(), 0);
    std::shuffle(nodes.begin(), nodes.end(), std::mt19937(7));
    const auto middle = nodes.begin() + n_nodes / 3;
    block.add({nodes.begin(), middle});
    block.add({middle, nodes.end()});
    for (int k = 0; k < n_nodes; ++k)
      if (resting == 0 || k % resting != 1) places.push_back(block.place(k));
    x.setZero(block.n_vector());
    for (const int place : places) x.segment<3>(3 * place).setRandom();
  }
  ContactProblem problem;
  MovingBlock block;
  std::vector<int> places;
  Eigen::VectorXf x;
};

TEST(SharedProducts, OfTheBlockHaveTheBitsOfOneThread) {
  constexpr int n_shared = static_cast<int>(MovingBlock::kShared);
  const FaultOperator op = random_operator(n_shared * 5 / 4);
  for (const int n_nodes :
       {1, 21, 22, 64, 65, n_shared - 1, n_shared, n_shared + 1, n_shared * 5 / 4}) {
    for (const int resting : {0, 5}) {
      std::srand(5);
      const Movers alone(op, n_nodes, resting, nullptr);
      const Eigen::VectorXf expected = product_of(alone.block, alone.places, alone.x);
      for (const int n_threads : {1, 2, 3}) {
        ThreadTeam team(n_threads);
        std::srand(5);
        const Movers shared(op, n_nodes, resting, &team);
        for (int k = 0; k < 10; ++k) {
          Eigen::VectorXf z;
          shared.block.multiply(shared.places, shared.x, z);
          EXPECT_EQ(z, expected) << n_nodes << " nodes, resting each " << resting << ", "
                                 << n_threads;
        }
        const bool is_worth_it = shared.places.size() >= MovingBlock::kShared && n_threads > 1;
        EXPECT_EQ(team.n_works() >= 10, is_worth_it) << n_nodes << ", " << n_threads;
      }
    }
  }
}

/// As often as it takes until others have had their part.
TEST(SharedProducts, AreReallyShared) {
  ThreadTeam team(2);
  const FaultOperator op = random_operator(1100);
  const Movers movers(op, 1100, 0, &team);
  const Eigen::VectorXf expected = product_of(movers.block, movers.places, movers.x);
  const long before = team.n_taken_by_others();
  for (int k = 0; k < 100'000 && team.n_taken_by_others() < before + 200; ++k) {
    Eigen::VectorXf z;
    movers.block.multiply(movers.places, movers.x, z);
    ASSERT_EQ(z, expected) << k;
  }
  EXPECT_GE(team.n_taken_by_others(), before + 200);
}

TEST(SharedProducts, OfHHaveTheBitsOfOneThread) {
  constexpr int n_nodes = 301;
  const FaultOperator op = random_operator(n_nodes);
  const int n = op.geometry.n_dofs;
  const ContactLaws laws = same_law(op, {});
  const std::vector<std::vector<RowRange>> wanted = {
      {{0, n}}, {{0, 1}, {7, 300}, {310, 2}, {400, n - 400}}, {{n - 1, 1}}, {{5, 3}, {100, 0}}, {}};
  for (const int n_moving : {0, 1, 13, 500, n}) {
    Eigen::VectorXd jump = Eigen::VectorXd::Zero(n);
    jump.tail(n_moving).setRandom();
    const Eigen::VectorXd start = Eigen::VectorXd::Random(n);
    ContactProblem alone(op, laws);
    Eigen::VectorXd all = start;
    alone.subtract_product(jump, all);
    for (const int n_threads : {1, 2, 3}) {
      ThreadTeam team(n_threads);
      ContactProblem shared(op, laws, &team);
      for (const std::vector<RowRange>& rows : wanted) {
        Eigen::VectorXd expected = start, got = start;
        for (const RowRange& part : rows)
          expected.segment(part.first, part.n) = all.segment(part.first, part.n);
        shared.subtract_product(jump, rows, got);
        EXPECT_EQ(got, expected) << n_moving << " moving, " << n_threads << " threads";
      }
      EXPECT_EQ(team.n_works(), n_threads > 1 && n_moving >= 500 ? 2 : 0);
    }
  }
}

}  // namespace
}  // namespace faultsim
