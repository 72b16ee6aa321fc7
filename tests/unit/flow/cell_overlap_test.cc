// Overlaps of hexahedra and boxes against closed forms and against each other.
#include "simulator/flow/cell_overlap.h"

#include <gtest/gtest.h>

namespace faultsim {
namespace {

/// 2 x 3 x 4 m from `low` on; `shear` m in x per m of height, as cells beside a dipping fault.
CellCorners sheared(const Eigen::Vector3d& low, double shear) {
  CellCorners c;
  const double x[8] = {0, 2, 2, 0, 0, 2, 2, 0};
  const double y[8] = {0, 0, 3, 3, 0, 0, 3, 3};
  for (int k = 0; k < 8; ++k) {
    const double z = k < 4 ? 0 : 4;
    c[k] = low + Eigen::Vector3d(x[k] + shear * z, y[k], z);
  }
  return c;
}

TEST(CellOverlap, OfBoxesIsTheProductOfTheOverlapsOfTheirSides) {
  const CellCorners cell = sheared({1, 1, -10}, 0);
  EXPECT_NEAR(cell_volume(cell), 24, 1e-13);
  EXPECT_NEAR(overlap_volume(cell, {{0, 0, -9}, {2.5, 2, 0}}), 1.5 * 1 * 3, 1e-13);
  EXPECT_NEAR(overlap_volume(cell, {{-9, -9, -99}, {9, 9, 0}}), 24, 1e-13);
  EXPECT_EQ(overlap_volume(cell, {{3, 0, -20}, {9, 9, 0}}), 0);  // touches
}

TEST(CellOverlap, OfASlopingFaceIsATriangle) {
  // x runs from z/4 on: below x = 0.5 lies a triangle of 0.5 m by 2 m, 3 m long.
  EXPECT_NEAR(overlap_volume(sheared({0, 0, 0}, 0.25), {{-1, 0, 0}, {0.5, 3, 4}}), 1.5, 1e-13);
}

TEST(CellOverlap, OfBoxesThatTileTheCellAddsUp) {
  const CellCorners cell = sheared({0.1, -0.2, -3}, -0.7);
  double sum = 0;
  for (int i = -20; i < 20; ++i) {
    for (int j = -5; j < 10; ++j) {
      for (int k = -10; k < 10; ++k) {
        const Eigen::Vector3d low(0.37 * i, 0.53 * j, 0.41 * k);
        sum += overlap_volume(cell, FlowCell{low, low + Eigen::Vector3d(0.37, 0.53, 0.41)});
      }
    }
  }
  EXPECT_NEAR(sum, 24, 24e-13);
}

}  // namespace
}  // namespace faultsim
