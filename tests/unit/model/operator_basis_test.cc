// An operator that is summed up from a centre and directions, column by column.
#include "simulator/model/operator_basis.h"

#include <gtest/gtest.h>

namespace faultsim {
namespace {

constexpr Eigen::Index kN = 6, kK = 2, kNodes = 4, kLoads = 3;

Eigen::MatrixXd symmetric(unsigned seed) {
  std::srand(seed);
  const Eigen::MatrixXd any = Eigen::MatrixXd::Random(kN, kN);
  return any + any.transpose();
}

/// Directions of H that single precision holds exactly.
Eigen::MatrixXd direction(Eigen::Index k) {
  return symmetric(static_cast<unsigned>(k + 2)).cast<float>().cast<double>();
}

/// Two runs, of 2 and of 4 jumps, whose bases are those of all jumps.
DirectionBlocks blocks() {
  DirectionBlocks made;
  made.count = kK;
  made.begin = {0, 2, kN};
  made.ranks = {{2, 4}};
  std::vector<float> near, far;
  const auto append = [](const Eigen::MatrixXd& values, std::vector<float>& to) {
    to.insert(to.end(), values.data(), values.data() + values.size());
  };
  append(Eigen::MatrixXd::Identity(2, 2), far);
  append(Eigen::MatrixXd::Identity(4, 4), far);
  for (Eigen::Index k = 0; k < kK; ++k) append(direction(k).bottomLeftCorner(4, 2), far);
  for (Eigen::Index k = 0; k < kK; ++k) append(direction(k).topLeftCorner(2, 2), near);
  for (Eigen::Index k = 0; k < kK; ++k) append(direction(k).bottomRightCorner(4, 4), near);
  const auto stored = [](const std::vector<float>& values) {
    return StoredFloats(Eigen::Map<const Eigen::MatrixXf>(
        values.data(), static_cast<Eigen::Index>(values.size()), 1));
  };
  made.near = stored(near);
  made.far = stored(far);
  return made;
}

std::shared_ptr<const OperatorBasis> basis() {
  auto centre = std::make_shared<FaultOperator>();
  centre->compliance = std::make_shared<DenseCompliance>(symmetric(1));
  centre->loads.traction = Eigen::MatrixXd::Random(kN, kLoads);
  centre->observed.per_load = Eigen::MatrixXd::Random(2, kLoads);
  centre->observed.per_jump = Eigen::MatrixXd::Random(2, kN);
  auto made = std::make_shared<OperatorBasis>();
  made->centre = centre;
  made->weights = Eigen::MatrixXd::Random(kK, kNodes);
  made->stiffness = blocks();
  made->traction = Eigen::MatrixXd::Random(kN * kLoads, kNodes);
  made->per_load = Eigen::MatrixXd::Random(2 * kLoads, kNodes);
  made->per_jump = Eigen::MatrixXd::Random(2 * kN, kNodes);
  return made;
}

const Eigen::Vector2d kFactors(0.3, -1.7);

TEST(OperatorBasis, SumsUpTheRunsThatAreAskedFor) {
  const auto made = basis();
  const InterpolatedCompliance h(made, kFactors);
  const Eigen::MatrixXd exact =
      made->centre->h() + kFactors[0] * direction(0) + kFactors[1] * direction(1);
  EXPECT_EQ(h.n_made(), 0);
  EXPECT_LT((h.column(4) - exact.col(4)).norm(), 1e-14);
  EXPECT_EQ(h.column(4).data(), h.column(4).data());
  EXPECT_EQ(h.n_made(), 4) << "of its run";
  for (int j = 0; j < h.size(); ++j) EXPECT_NEAR(h.diagonal(j), exact(j, j), 1e-14);
  const Eigen::Map<const Eigen::MatrixXd> all(h.matrix_entries(), kN, kN);
  EXPECT_LT((all - exact).norm(), 1e-13);
  EXPECT_EQ(all, all.transpose()) << "to the last bit";
  EXPECT_EQ(h.n_made(), kN);
}

TEST(OperatorBasis, PutsLoadsAndObservationRowsInto) {
  const auto made = basis();
  FaultOperator op;
  const Eigen::Vector4d w(0.5, -0.2, 1.1, 0.4);
  OperatorBasis::put(made, w, op);
  const auto sum = [&](const Eigen::MatrixXd& mean, const Eigen::MatrixXd& differences) {
    const Eigen::VectorXd difference = differences * w;
    return Eigen::MatrixXd(mean + difference.reshaped(mean.rows(), mean.cols()));
  };
  EXPECT_LT((op.loads.traction - sum(made->centre->loads.traction, made->traction)).norm(), 1e-14);
  EXPECT_LT((op.observed.per_load - sum(made->centre->observed.per_load, made->per_load)).norm(),
            1e-14);
  EXPECT_LT((op.observed.per_jump - sum(made->centre->observed.per_jump, made->per_jump)).norm(),
            1e-14);
  const InterpolatedCompliance h(made, made->weights * w);
  ASSERT_EQ(op.compliance->size(), kN);
  for (int j = 0; j < kN; ++j) EXPECT_EQ(op.compliance->column(j), h.column(j));
}

}  // namespace
}  // namespace faultsim
