// Directions of H by blocks: sizes, sums, and the same bits from both sides of the diagonal.
#include "simulator/model/direction_blocks.h"

#include <gtest/gtest.h>

#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

constexpr int kJumps = 7, kDirections = 3;

/// Numbers that single precision holds exactly.
Eigen::MatrixXf numbers(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXf::Random(rows, columns);
}

/// Three runs, of 2, 3 and 2 jumps, with bases of different ranks, and B_1, …, B_K as matrices.
struct Made {
  DirectionBlocks blocks;
  std::vector<Eigen::MatrixXd> b;
};

void append(const Eigen::MatrixXf& values, std::vector<float>& to) {
  to.insert(to.end(), values.data(), values.data() + values.size());
}

StoredFloats stored(const std::vector<float>& values) {
  return StoredFloats(Eigen::Map<const Eigen::MatrixXf>(
      values.data(), static_cast<Eigen::Index>(values.size()), 1));
}

Made three_runs() {
  std::srand(5);
  set_blas_threads(1);
  Made all;
  DirectionBlocks& blocks = all.blocks;
  blocks.count = kDirections;
  blocks.begin = {0, 2, 5, kJumps};
  blocks.ranks = {{1, 2}, {2, 1}, {3, 2}};
  all.b.assign(kDirections, Eigen::MatrixXd::Zero(kJumps, kJumps));
  std::vector<float> near, far;
  for (int s = 0; s < 3; ++s) {
    for (int k = 0; k < kDirections; ++k) {
      const Eigen::MatrixXf any = numbers(blocks.n_in(s), blocks.n_in(s));
      const Eigen::MatrixXf block = any + any.transpose();
      append(block, near);
      all.b[k].block(blocks.begin[s], blocks.begin[s], blocks.n_in(s), blocks.n_in(s)) =
          block.cast<double>();
    }
    for (int t = 0; t < s; ++t) {
      const auto [r, q] = blocks.ranks[DirectionBlocks::pair(t, s)];
      const Eigen::MatrixXf u = numbers(blocks.n_in(t), r), v = numbers(blocks.n_in(s), q);
      append(u, far);
      append(v, far);
      for (int k = 0; k < kDirections; ++k) {
        const Eigen::MatrixXf core = numbers(q, r);
        append(core, far);
        const Eigen::MatrixXd block =
            u.cast<double>() * core.cast<double>().transpose() * v.cast<double>().transpose();
        all.b[k].block(blocks.begin[t], blocks.begin[s], blocks.n_in(t), blocks.n_in(s)) = block;
        all.b[k].block(blocks.begin[s], blocks.begin[t], blocks.n_in(s), blocks.n_in(t)) =
            block.transpose();
      }
    }
  }
  blocks.near = stored(near);
  blocks.far = stored(far);
  return all;
}

const Eigen::Vector3d kWeights(0.3, -1.7, 0.9);

Eigen::MatrixXd all_columns(const DirectionBlocks& blocks, const std::vector<int>& order) {
  const DirectionSum sum(blocks, kWeights);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(kJumps, kJumps);
  for (const int run : order)
    sum.add_columns(run, columns.middleCols(blocks.begin[run], blocks.n_in(run)));
  return columns;
}

TEST(DirectionBlocks, AddUpToTheMatricesThatTheyStandFor) {
  const auto [blocks, b] = three_runs();
  const Eigen::MatrixXd exact = kWeights[0] * b[0] + kWeights[1] * b[1] + kWeights[2] * b[2];
  const Eigen::MatrixXd sum = all_columns(blocks, {0, 1, 2});
  EXPECT_LT((sum - exact).norm(), 1e-14 * exact.norm());
  EXPECT_EQ(sum, sum.transpose()) << "to the last bit";
  EXPECT_EQ(all_columns(blocks, {2, 0, 1}), sum) << "whichever run came first";
  EXPECT_EQ(DirectionSum(blocks, kWeights).diagonal(), sum.diagonal());
}

TEST(DirectionBlocks, AddToWhatIsThere) {
  const Made all = three_runs();
  const DirectionSum sum(all.blocks, kWeights);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(kJumps, 3, 10), from_zero(kJumps, 3);
  from_zero.setZero();
  sum.add_columns(1, columns);
  sum.add_columns(1, from_zero);
  EXPECT_LT((columns - from_zero - Eigen::MatrixXd::Constant(kJumps, 3, 10)).norm(), 1e-13);
}

TEST(DirectionBlocks, KnowTheirSizes) {
  const DirectionBlocks blocks = three_runs().blocks;
  EXPECT_EQ(blocks.near_size(), blocks.near.view().size());
  EXPECT_EQ(blocks.far_size(), blocks.far.view().size());
  EXPECT_EQ(blocks.run_of(0), 0);
  EXPECT_EQ(blocks.run_of(2), 1);
  EXPECT_EQ(blocks.run_of(4), 1);
  EXPECT_EQ(blocks.run_of(6), 2);
  EXPECT_TRUE(blocks.is_partition_of(kJumps));
  EXPECT_FALSE(blocks.is_partition_of(kJumps + 1));
  DirectionBlocks short_of_a_pair = blocks;
  short_of_a_pair.ranks.pop_back();
  EXPECT_FALSE(short_of_a_pair.is_partition_of(kJumps));
}

TEST(DirectionBlocks, RunsAreOfEqualLength) {
  for (const int n : {1, 100, 192, 193, 1000, 9275}) {
    const std::vector<int> begin = jump_runs(n);
    ASSERT_GE(begin.size(), 2U);
    EXPECT_EQ(begin.front(), 0);
    EXPECT_EQ(begin.back(), n);
    int least = n, most = 0;
    for (std::size_t i = 1; i < begin.size(); ++i) {
      least = std::min(least, begin[i] - begin[i - 1]);
      most = std::max(most, begin[i] - begin[i - 1]);
    }
    EXPECT_LE(most, 192);
    EXPECT_LE(most - least, 1);
  }
}

}  // namespace
}  // namespace faultsim
