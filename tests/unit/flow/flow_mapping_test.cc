// Means over our cells: what they conserve, what they cover, and what they refuse.
#include "simulator/flow/flow_mapping.h"

#include <gmock/gmock.h>

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// n³ boxes over [0, 100]³ below depth 1000, pressures without pattern at two reports.
FlowField cube(int n) {
  FlowField field;
  field.date = {0, 1e8};
  const double h = 100.0 / n;
  for (int i = 0; i < n * n * n; ++i) {
    const Eigen::Vector3d low(h * (i % n), h * (i / n % n), -1100 + h * (i / n / n));
    field.cells.push_back({low, low + Eigen::Vector3d::Constant(h)});
  }
  field.value.resize(n * n * n, 2);
  for (int i = 0; i < n * n * n; ++i) {
    field.value(i, 0) = 2e7 + 1e5 * std::sin(3.0 * i);
    field.value(i, 1) = 1e7 + 5e6 * std::sin(7.0 * i * i);
  }
  return field;
}

/// Two compartments beside a fault that dips through the cube, in m x m x m cells each.
std::vector<MappedCell> two_sides(int m, double stretch) {
  const auto at = [&](double u, double v, double w, int side) {
    const double z = -1100 + 100 * stretch * w;
    const double fault = 40 + 0.2 * (z + 1100);
    const double x = side == 0 ? fault * u : fault + (100 - fault) * u;
    return Eigen::Vector3d(x, 100 * v, z);
  };
  const double h = 1.0 / m;
  std::vector<MappedCell> cells;
  for (int i = 0; i < 2 * m * m * m; ++i) {
    const int side = i / (m * m * m);
    const double u = h * (i % m), v = h * (i / m % m), w = h * (i / m / m % m);
    const double e = h;
    cells.push_back(
        {.corners = {at(u, v, w, side), at(u + e, v, w, side), at(u + e, v + e, w, side),
                     at(u, v + e, w, side), at(u, v, w + e, side), at(u + e, v, w + e, side),
                     at(u + e, v + e, w + e, side), at(u, v + e, w + e, side)},
         .region = side});
  }
  return cells;
}

const std::vector<std::string> kNames{"west", "east"};

TEST(FlowMapping, ConservesWhatBothGridsCover) {
  const FlowField field = cube(7);
  const std::vector<MappedCell> cells = two_sides(4, 1);
  const FlowMapping mapping = map_flow(field, cells, kNames, OutsideRule::nearest);
  const Eigen::MatrixXd change = mapped_change(mapping, field, 0);
  double mapped = 0, given = 0, size = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    mapped += cell_volume(cells[c].corners) * change(static_cast<Eigen::Index>(c), 1);
  for (Eigen::Index f = 0; f < field.value.rows(); ++f) {
    const double part = std::pow(100.0 / 7, 3) * (field.value(f, 1) - field.value(f, 0));
    given += part;
    size += std::abs(part);
  }
  EXPECT_NEAR(mapped, given, 1e-12 * size);
  EXPECT_EQ(change.col(0).cwiseAbs().maxCoeff(), 0);
  for (const RegionCoverage& region : mapping.coverage)
    EXPECT_NEAR(region.covered, region.volume, 1e-12 * region.volume);
  // Per compartment: one cell as wide as the compartment has its mean.
  const FlowMapping whole = map_flow(field, two_sides(1, 1), kNames, OutsideRule::nearest);
  for (int side = 0; side < 2; ++side) {
    double integral = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (cells[c].region == side)
        integral += cell_volume(cells[c].corners) * change(static_cast<Eigen::Index>(c), 1);
    }
    const double mean = mapped_change(whole, field, 0)(side, 1);
    EXPECT_NEAR(integral, mean * whole.coverage[side].volume, 1e-12 * size);
  }
}

TEST(FlowMapping, OfAUniformFieldIsUniform) {
  FlowField field = cube(5);
  field.value.col(0).setConstant(3e7);
  field.value.col(1).setConstant(1e7);
  const FlowMapping mapping = map_flow(field, two_sides(3, 1.4), kNames, OutsideRule::nearest);
  const Eigen::VectorXd change = mapped_change(mapping, field, 0).col(1);
  EXPECT_LT((change.array() + 2e7).abs().maxCoeff(), 1e-14 * 2e7);
}

TEST(FlowMapping, SaysWhatIsNotCovered) {
  const FlowField field = cube(5);
  // Three layers of 50 m from the bottom up, of which the grid has two.
  const std::vector<MappedCell> cells = two_sides(3, 1.5);
  const FlowMapping near = map_flow(field, cells, kNames, OutsideRule::nearest);
  const FlowMapping held = map_flow(field, cells, kNames, OutsideRule::unchanged);
  for (const RegionCoverage& region : near.coverage) {
    EXPECT_EQ(region.n_outside, 9);
    EXPECT_EQ(region.n_partly, 0);
    EXPECT_LT(region.covered, region.volume);
  }
  EXPECT_EQ(near.weights[26].size(), 1u);
  EXPECT_TRUE(held.weights[26].empty());
  EXPECT_EQ(mapped_change(held, field, 0)(26, 1), 0);
  EXPECT_NE(mapped_change(near, field, 0)(26, 1), 0);
  EXPECT_THAT(coverage_text(near.coverage[0], OutsideRule::nearest),
              HasSubstr("9 of 27 cells outside take the nearest flow cell's pressure"));
  EXPECT_THAT(coverage_text(held.coverage[0], OutsideRule::unchanged),
              HasSubstr("9 of 27 cells outside keep their pressure"));
}

TEST(FlowMapping, RefusesCellsOverEachOtherAndAGridElsewhere) {
  FlowField field = cube(2);
  field.cells.push_back({{10, 10, -1090}, {20, 20, -1080}});
  field.value.conservativeResize(9, 2);
  EXPECT_THAT(([&] { map_flow(field, two_sides(2, 1), kNames, OutsideRule::nearest); }),
              ThrowsMessage<InputError>(HasSubstr("flow cells lie over each other at x = ")));
  FlowField far = cube(2);
  for (FlowCell& cell : far.cells) {
    cell.low.x() += 5e5;
    cell.high.x() += 5e5;
  }
  EXPECT_THAT(([&] { map_flow(far, two_sides(2, 1), kNames, OutsideRule::nearest); }),
              ThrowsMessage<InputError>(HasSubstr("no flow cell lies in compartment east")));
}

}  // namespace
}  // namespace faultsim
