#include <gtest/gtest.h>

#include <cmath>

#include "simulator/coupled/hypre_blocks.h"
#include "tests/unit/elasticity/test_box.h"

namespace faultsim {
namespace {

/// Stiffness of a component along the axes, relative to the stiffest.
Eigen::Vector3d stiffness_along(const Eigen::Vector3d& sides, int component, double nu) {
  Eigen::Vector3d stiffness = sides.array().square().inverse();
  stiffness[component] *= 2 * (1 - nu) / (1 - 2 * nu);
  return stiffness / stiffness.maxCoeff();
}

/// The largest entry that leads along an axis at most a third as stiff as the stiffest, as a share
/// of the largest of its row, of the node amid eight cells of these sides.
double largest_across(const Eigen::Vector3d& sides, double nu) {
  const Mesh mesh = test::make_box({2, 2, 2}, 2 * sides, {});
  const DofMap dofs(mesh, test::rollers({Side::z_min}), 0);
  const SparseMatrix lower = assemble_stiffness(mesh, {{1e9, nu}}, dofs, true);
  const SparseMatrix k = lower.selfadjointView<Eigen::Lower>();
  int centre = 0;
  const Eigen::Vector3d middle(sides.x(), sides.y(), -sides.z());
  while ((mesh.nodes[centre] - middle).norm() > 1e-9 * sides.norm()) ++centre;
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d stiffness = stiffness_along(sides, c, nu);
    double row_largest = 0, across = 0;
    for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
      if (node == centre || dofs.terms(node, c).empty()) continue;
      const double entry =
          -k.coeff(dofs.terms(node, c)[0].unknown, dofs.terms(centre, c)[0].unknown);
      row_largest = std::max(row_largest, entry);
      const Eigen::Vector3d way = mesh.nodes[node] - middle;
      for (int d = 0; d < 3; ++d) {
        const bool leads = std::abs(way[d]) > 0.5 * sides[d];
        if (leads && stiffness[d] < 1.001 / 3) across = std::max(across, entry);
      }
    }
    largest = std::max(largest, across / row_largest);
  }
  return largest;
}

TEST(StrongByComponent, IsAboveWhatLeadsAlongWeakerAxesWhateverTheShapeOfCells) {
  double largest = 0;
  for (const double nu : {0.1, 0.25, 0.4}) {
    for (double a = 1; a < 101; a *= 1.21) {
      for (double b = a; b < 101; b *= 1.21) {
        largest = std::max(largest, largest_across({1, a, b}, nu));
      }
    }
  }
  EXPECT_LT(largest, kStrongByComponent - 0.05);
  EXPECT_GT(largest, 0.75) << "or a lower threshold would do";
}

TEST(StrongByComponent, OfCubesIsAboveTheirDiagonals) {
  EXPECT_NEAR(largest_across({1, 1, 1}, 0.25), 0.73, 0.005);
}

}  // namespace
}  // namespace faultsim
