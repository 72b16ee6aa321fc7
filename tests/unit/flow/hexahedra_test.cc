// Corner-point cells: dipping, faulted, twisted and pinched ones fill what they fill, once.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/flow_cell_search.h"
#include "simulator/flow/flow_mapping.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Layers of a corner-point grid of n x n columns over [0, 100]² between the depths 1000 and 1100
/// of a box that the layers cross: `height` of a corner (u, v, w in [0, 1]), and a throw in m east
/// of the middle. Twisted faces where height is not linear.
template <typename Height>
std::vector<FlowCell> layers(int n, int n_layers, double throw_, const Height& height) {
  std::vector<FlowCell> cells;
  for (int c = 0; c < n * n * n_layers; ++c) {
    const int i = c % n, j = c / n % n, k = c / n / n;
    const double offset = 2 * i >= n ? -throw_ : 0;
    CellCorners corners;
    for (int q = 0; q < 8; ++q) {
      const double u = double(i + (q % 4 == 1 || q % 4 == 2)) / n;
      const double v = double(j + (q % 4 >= 2)) / n;
      const double w = double(k + (q >= 4)) / n_layers;
      corners[q] = {100 * u, 100 * v, height(u, v, w) + offset};
    }
    cells.push_back(flow_cell_around(corners));
  }
  return cells;
}

double dipping(double u, double v, double w) { return -1400 + 800 * w + 150 * u - 60 * v; }
double domed(double u, double v, double w) {
  return -1400 + 800 * w - 90 * (u - 0.4) * (u - 0.4) + 70 * u * v;
}

/// The box [0, 100]² x [-1100, -1000] in m³ boxes; sheared by `shear` m per m where it is not 0.
std::vector<MappedCell> inner_cells(int m, double shear) {
  std::vector<MappedCell> cells;
  for (int c = 0; c < m * m * m; ++c) {
    CellCorners corners;
    for (int q = 0; q < 8; ++q) {
      const double u = double(c % m + (q % 4 == 1 || q % 4 == 2)) / m;
      const double v = double(c / m % m + (q % 4 >= 2)) / m;
      const double w = double(c / m / m + (q >= 4)) / m;
      const double bend = u * (1 - u) * 4 * shear * 100 * (w - 0.5);
      corners[q] = {100 * u + bend, 100 * v, -1100 + 100 * w};
    }
    cells.push_back({.corners = corners, .region = 0});
  }
  return cells;
}

void expect_covered_once(const std::vector<FlowCell>& flow, const std::vector<MappedCell>& cells) {
  double sum = 0, size = 0;
  for (const MappedCell& cell : cells) {
    double own = 0;
    for (const FlowCell& other : flow) own += overlap_volume(cell.corners, other);
    EXPECT_NEAR(own, cell_volume(cell.corners), 1e-10 * cell_volume(cell.corners));
    sum += own;
    size += cell_volume(cell.corners);
  }
  EXPECT_NEAR(sum, size, 1e-11 * size);
}

TEST(FlowHexahedra, OfDippingLayersCoverBoxesOnce) {
  expect_covered_once(layers(4, 6, 0, dipping), inner_cells(3, 0));
}

TEST(FlowHexahedra, OfDippingLayersCoverBentCellsOnce) {
  expect_covered_once(layers(3, 5, 0, dipping), inner_cells(2, 0.2));
}

TEST(FlowHexahedra, OfTwistedAndFaultedLayersCoverOnce) {
  for (const double throw_ : {0.0, 17.0}) {
    expect_covered_once(layers(4, 6, throw_, domed), inner_cells(3, 0));
    expect_covered_once(layers(4, 6, throw_, domed), inner_cells(2, 0.2));
  }
}

TEST(FlowHexahedra, FarFromTheOriginLoseNoDigits) {
  const Eigen::Vector3d far(5.4e5, 6.1e6, 0);
  std::vector<FlowCell> flow = layers(3, 5, 17, domed);
  std::vector<MappedCell> cells = inner_cells(2, 0.2);
  for (FlowCell& cell : flow) {
    for (Eigen::Vector3d& corner : *cell.corners) corner += far;
    cell = flow_cell_around(*cell.corners);
  }
  for (MappedCell& cell : cells) {
    for (Eigen::Vector3d& corner : cell.corners) corner += far;
    double own = 0;
    for (const FlowCell& other : flow) own += overlap_volume(cell.corners, other);
    EXPECT_NEAR(own, cell_volume(cell.corners), 1e-9 * cell_volume(cell.corners));
  }
}

TEST(FlowHexahedra, OfEitherHandednessAreTheSame) {
  const std::vector<FlowCell> flow = layers(3, 3, 9, domed);
  const CellCorners cell = inner_cells(2, 0.3)[1].corners;
  for (const FlowCell& other : flow) {
    // Mirrored in x together with our cell: the order of corners is that of a left-handed cell.
    CellCorners mirrored_flow = *other.corners, mirrored = cell;
    for (Eigen::Vector3d& corner : mirrored_flow) corner.x() = -corner.x();
    for (Eigen::Vector3d& corner : mirrored) corner.x() = -corner.x();
    EXPECT_NEAR(overlap_volume(mirrored, flow_cell_around(mirrored_flow)),
                overlap_volume(cell, other), 1e-9);
  }
}

/// A corner is pushed in so far that a tetrahedron is turned inside out: it counts against the
/// cell, whatever the cell is cut with.
TEST(FlowHexahedra, CountWhatIsTurnedInsideOutAgainstThem) {
  CellCorners corners = inner_cells(5, 0)[62].corners;  // 20 m, in the middle
  corners[6].z() = corners[2].z() - 6;
  const FlowCell twisted = flow_cell_around(corners);
  const double inside_out = 20 * 20 * 6 / 6.0;  // of each of the two tetrahedra below corner 6
  EXPECT_LT(flow_cell_volume(twisted), 8000 - 2 * inside_out);
  for (const double shear : {0.0, 0.2}) {
    CellCorners around = inner_cells(1, 0)[0].corners;
    for (Eigen::Vector3d& corner : around) corner.x() += shear * (corner.z() + 1050);
    EXPECT_EQ(flow_cell_around(around).corners.has_value(), shear > 0);
    EXPECT_NEAR(overlap_volume(around, twisted), flow_cell_volume(twisted), 1e-8) << shear;
  }
}

TEST(FlowHexahedra, ThatAreBoxesAreBoxes) {
  const MappedCell box = inner_cells(2, 0)[3];
  const FlowCell cell = flow_cell_around(box.corners);
  EXPECT_FALSE(cell.corners);
  EXPECT_NEAR(flow_cell_volume(cell), 125000, 1e-9);
  // A box told as corners that are moved by nothing is cut as tetrahedra: the same volume.
  FlowCell told = cell;
  told.corners = box.corners;
  EXPECT_NEAR(flow_cell_volume(told), 125000, 1e-9);
  const CellCorners bent = inner_cells(2, 0.2)[3].corners;
  EXPECT_NEAR(overlap_volume(bent, told), overlap_volume(bent, cell), 1e-9);
}

TEST(FlowHexahedra, PinchedOnOneSideAreWedges) {
  CellCorners wedge = inner_cells(1, 0)[0].corners;
  wedge[5].z() = wedge[6].z() = wedge[1].z();  // no thickness at x = 100
  const FlowCell cell = flow_cell_around(wedge);
  EXPECT_NEAR(flow_cell_volume(cell), 5e5, 1e-7);
  EXPECT_NEAR(overlap_volume(inner_cells(1, 0)[0].corners, cell), 5e5, 1e-7);
  // Beyond x = 50 a quarter of the wedge is left.
  EXPECT_NEAR(overlap_volume(inner_cells(2, 0)[1].corners, cell) +
                  overlap_volume(inner_cells(2, 0)[3].corners, cell) +
                  overlap_volume(inner_cells(2, 0)[5].corners, cell) +
                  overlap_volume(inner_cells(2, 0)[7].corners, cell),
              1.25e5, 1e-7);
}

TEST(FlowHexahedra, AreMappedAndRefusedWhereTheyLieOverEachOther) {
  FlowField field{.cells = layers(4, 6, 17, domed), .date = {0}, .value = {}};
  field.value = Eigen::MatrixXd::Constant(std::ssize(field.cells), 1, 2e7);
  const FlowMapping mapping =
      map_flow(field, inner_cells(3, 0.1), {"west"}, {.outside = OutsideRule::nearest});
  EXPECT_NEAR(mapping.coverage[0].covered, mapping.coverage[0].volume, 1e-3);
  EXPECT_EQ(mapping.coverage[0].n_partly, 0);
  for (const auto& weights : mapping.weights) {
    double sum = 0;
    for (const FlowMapping::Weight& weight : weights) sum += weight.value;
    EXPECT_NEAR(sum, 1, 1e-14);
  }
  for (Eigen::Vector3d& corner : *field.cells[40].corners) corner.z() += 20;
  field.cells[40] = flow_cell_around(*field.cells[40].corners);
  EXPECT_THAT(
      ([&] { map_flow(field, inner_cells(3, 0.1), {"west"}, {.outside = OutsideRule::nearest}); }),
      ThrowsMessage<InputError>(HasSubstr("flow cells overlap at x = ")));
}

TEST(FlowCellSearch, FindsWhatLookingAtAllFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-50, 150), size(0.5, 20);
  std::vector<FlowCell> cells;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d low(place(random), place(random), std::round(place(random)));
    cells.push_back({low, low + Eigen::Vector3d(size(random), size(random), size(random))});
    if (i % 5 == 0) cells.push_back(cells.back());  // equals: the first is the nearest
  }
  const FlowCellSearch search(cells);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d low(place(random), place(random), place(random));
    const Eigen::Vector3d high = low + Eigen::Vector3d(size(random), size(random), size(random));
    std::vector<int> all;
    int nearest = 0;
    const auto distance = [&](int c) {
      return (0.5 * (cells[c].low + cells[c].high) - 3 * low).squaredNorm();
    };
    for (int c = 0; c < std::ssize(cells); ++c) {
      if ((cells[c].low.array() < high.array()).all() &&
          (cells[c].high.array() > low.array()).all())
        all.push_back(c);
      if (distance(c) < distance(nearest)) nearest = c;
    }
    EXPECT_EQ(search.overlapping(low, high), all);
    EXPECT_EQ(search.nearest(3 * low), nearest);
  }
}

}  // namespace
}  // namespace faultsim
