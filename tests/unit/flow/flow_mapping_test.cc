// Means over our cells: what they conserve, what they cover, and what they refuse.
#include "simulator/flow/flow_mapping.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
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

/// Volume of a box of cube() west of the fault of two_sides(): ∫ of the width there, which is
/// linear in z but for where the fault enters and leaves the box.
double volume_west_of_fault(const FlowCell& box) {
  const double dx = box.high.x() - box.low.x(), dy = box.high.y() - box.low.y();
  const auto width_integral = [&](double x) {  // ∫ from x = −∞ of the width, over x
    const double u = std::clamp(x - box.low.x(), 0.0, dx);
    return 0.5 * u * u + dx * std::max(0.0, x - box.high.x());
  };
  const auto fault = [](double z) { return 40 + 0.2 * (z + 1100); };
  return dy / 0.2 * (width_integral(fault(box.high.z())) - width_integral(fault(box.low.z())));
}

TEST(FlowMapping, ConservesWhatBothGridsCover) {
  const FlowField field = cube(7);
  const std::vector<MappedCell> cells = two_sides(4, 1);
  const FlowMapping mapping = map_flow(field, cells, kNames, {.outside = OutsideRule::nearest});
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
  // Of the western compartment, whose part of a flow cell is a prism between two planes of x.
  double west = 0, west_given = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (cells[c].region == 0)
      west += cell_volume(cells[c].corners) * change(static_cast<Eigen::Index>(c), 1);
  }
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const auto row = static_cast<Eigen::Index>(f);
    west_given +=
        volume_west_of_fault(field.cells[f]) * (field.value(row, 1) - field.value(row, 0));
  }
  EXPECT_NEAR(west, west_given, 1e-12 * size);
  EXPECT_GT(std::abs(west_given - 0.5 * given), 1e-3 * size);
}

TEST(FlowMapping, TakesASectionFromBothSidesOfItsY) {
  CellCorners cell = two_sides(1, 1)[0].corners;
  for (Eigen::Vector3d& corner : cell) corner.y() /= 100;  // from 0 to 1, as plane strain has it
  FlowField field;
  field.date = {0, 1};
  field.cells = {{{0, -50, -1100}, {100, 0, -1000}}, {{0, 0, -1100}, {100, 50, -1000}}};
  field.value = Eigen::Matrix2d{{0, 1e7}, {0, 3e7}};
  const auto at = [&](double y) {
    const std::vector<MappedCell> section{{.corners = at_section(cell, y), .region = 0}};
    const FlowMapping mapping =
        map_flow(field, section, {"west"}, {.outside = OutsideRule::nearest});
    return mapped_change(mapping, field, 0)(0, 1);
  };
  EXPECT_NEAR(at(0), 2e7, 1e-5);
  EXPECT_NEAR(at(-20), 1e7, 1e-5);
  EXPECT_NEAR(at(20), 3e7, 1e-5);
  EXPECT_NEAR(at(0.25), 2.5e7, 1e-5);
}

TEST(FlowMapping, OfAUniformFieldIsUniform) {
  FlowField field = cube(5);
  field.value.col(0).setConstant(3e7);
  field.value.col(1).setConstant(1e7);
  const FlowMapping mapping =
      map_flow(field, two_sides(3, 1.4), kNames, {.outside = OutsideRule::nearest});
  const Eigen::VectorXd change = mapped_change(mapping, field, 0).col(1);
  EXPECT_LT((change.array() + 2e7).abs().maxCoeff(), 1e-14 * 2e7);
}

/// Of a cell a third of which lies in the compartment a third counts, covered or not.
TEST(FlowMapping, CoversTheSharesOfCellsThatLieInTheirCompartment) {
  const FlowField field = cube(5);
  for (const double stretch : {1.0, 1.5}) {
    std::vector<MappedCell> cells = two_sides(3, stretch);
    std::array<double, 2> volume{}, covered{};
    for (std::size_t c = 0; c < cells.size(); ++c) {
      cells[c].fraction = 0.1 + 0.05 * static_cast<double>(c % 7);
      const double part = cells[c].fraction * cell_volume(cells[c].corners);
      volume[cells[c].region] += part;
      const double top = cells[c].corners[4].z(), base = cells[c].corners[0].z();
      covered[cells[c].region] += std::clamp((-1000 - base) / (top - base), 0.0, 1.0) * part;
    }
    const FlowMapping mapping = map_flow(field, cells, kNames, {.outside = OutsideRule::nearest});
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR(mapping.coverage[side].volume, volume[side], 1e-9 * volume[side]);
      EXPECT_NEAR(mapping.coverage[side].covered, covered[side], 1e-9 * volume[side]);
    }
  }
}

TEST(FlowMapping, SaysWhatIsNotCovered) {
  const FlowField field = cube(5);
  // Three layers of 50 m from the bottom up, of which the grid has two.
  const std::vector<MappedCell> cells = two_sides(3, 1.5);
  const FlowMapping near = map_flow(field, cells, kNames, {.outside = OutsideRule::nearest});
  const FlowMapping held = map_flow(field, cells, kNames, {.outside = OutsideRule::unchanged});
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
              HasSubstr("9 of 27 cells outside take what the nearest flow cell has"));
  EXPECT_THAT(coverage_text(held.coverage[0], OutsideRule::unchanged),
              HasSubstr("9 of 27 cells outside do not change"));
}

TEST(FlowMapping, RefusesCellsOverEachOther) {
  FlowField field = cube(2);
  field.cells.push_back({{10, 10, -1090}, {20, 20, -1080}});
  field.value.conservativeResize(9, 2);
  EXPECT_THAT(
      ([&] { map_flow(field, two_sides(2, 1), kNames, {.outside = OutsideRule::nearest}); }),
      ThrowsMessage<InputError>(HasSubstr("flow cells overlap at x = ")));
}

TEST(FlowMapping, SaysTheSharesThatAreCovered) {
  const FlowField field = cube(5);
  const std::vector<MappedCell> cells = two_sides(1, 1.6);
  const FlowMapping mapping = map_flow(field, cells, kNames, {.outside = OutsideRule::nearest});
  EXPECT_NEAR(mapping.covered[0], mapping.coverage[0].covered / cell_volume(cells[0].corners),
              1e-12);
  EXPECT_NEAR(mapping.covered[0] * cell_volume(cells[0].corners), 100 * 100 * 50.0, 1e-6);
  EXPECT_EQ(mapping.coverage[0].n_partly, 1);
}

}  // namespace
}  // namespace faultsim
