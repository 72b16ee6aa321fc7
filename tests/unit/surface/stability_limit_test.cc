#include "simulator/surface/stability_limit.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace faultsim {
namespace {

/// Two faults of a few nodes, whose jumps are numbered in turn.
FaultGeometry two_faults(int n_nodes) {
  FaultGeometry faults;
  faults.n_dofs = 3 * n_nodes;
  faults.dof_area = Eigen::VectorXd::LinSpaced(faults.n_dofs, 1, 4);
  for (int k = 0; k < n_nodes; ++k) {
    OperatorNode node;
    node.dof = {3 * k, 3 * k + 1, 3 * k + 2};
    faults.nodes.push_back(node);
  }
  faults.faults.resize(2);
  faults.faults[0].n_nodes = faults.faults[1].first_node = n_nodes / 2;
  faults.faults[1].n_nodes = n_nodes - n_nodes / 2;
  return faults;
}

TEST(StabilityLimit, IsTheLeastEigenvalueOverTheSlipsOfAFault) {
  const FaultGeometry faults = two_faults(7);
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(21, 21);
  const Eigen::MatrixXd h = root * root.transpose() + 3 * Eigen::MatrixXd::Identity(21, 21);
  const std::vector<double> limits = stability_limits(faults, h);
  ASSERT_EQ(limits.size(), 2U);
  const std::vector<std::vector<int>> slips = {{1, 2, 4, 5, 7, 8},
                                               {10, 11, 13, 14, 16, 17, 19, 20}};
  for (std::size_t f = 0; f < 2; ++f) {
    const Eigen::MatrixXd block = h(slips[f], slips[f]);
    const Eigen::MatrixXd area = faults.dof_area(slips[f]).asDiagonal();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> exact(block, area);
    EXPECT_NEAR(limits[f], exact.eigenvalues().minCoeff(), 1e-8 * limits[f]);
  }
}

TEST(StabilityLimit, IsNoneWhereHIsNotPositiveDefinite) {
  const FaultGeometry faults = two_faults(2);
  const std::vector<double> limits = stability_limits(faults, -Eigen::MatrixXd::Identity(6, 6));
  EXPECT_TRUE(std::isnan(limits[0]) && std::isnan(limits[1]));
}

}  // namespace
}  // namespace faultsim
