// Tables of the centres of a corner-point grid's cells: what is rebuilt from them beside the cells
// themselves.
#include "simulator/flow/cell_columns.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/flow/flow_csv.h"
#include "simulator/flow/flow_mapping.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Index = std::array<int, 3>;

/// Depth of the top of a column with index i, at x, y.
using Top = std::function<double(int i, double x, double y)>;

/// Cells of 100 x 80 m, whose layers are parallel, on pillars that lean.
struct Grid {
  Top top;
  Eigen::Vector2d lean = {0.6, -0.3};
  Index size = {8, 6, 4};
  std::vector<double> thickness = {12, 12, 12, 12};
  std::function<bool(const Index&)> is_active = [](const Index&) { return true; };
};

struct Cell {
  Index index;
  CellCorners corners;
  Eigen::Vector3d centre() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners) sum += corner / 8;
    return sum;
  }
};

std::vector<Cell> cells_of(const Grid& grid) {
  std::vector<Cell> cells;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (!grid.is_active({i, j, k})) continue;
        Cell cell{{i + 1, j + 1, k + 1}, {}};
        for (std::size_t c = 0; c < 8; ++c) {
          const int east = c % 4 == 1 || c % 4 == 2 ? 1 : 0, north = c % 4 >= 2 ? 1 : 0;
          const double x = 100 * (i + east), y = 80 * (j + north);
          double depth = grid.top(i, x, y);
          for (int layer = 0; layer < k + (c < 4 ? 1 : 0); ++layer) depth += grid.thickness[layer];
          const Eigen::Vector2d at = Eigen::Vector2d(x, y) + (depth - 2000) * grid.lean;
          cell.corners[c] = {at.x(), at.y(), -depth};
        }
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

/// What a table has of a cell.
using Row = std::function<std::string(const Cell&)>;

std::string place(const Cell& cell) {
  const Eigen::Vector3d at = cell.centre();
  return formatted("%.17g, %.17g, %.17g", at.x(), at.y(), -at.z());
}
std::string index_of(const Cell& cell) { return joined(cell.index, ", ") + ", " + place(cell); }

/// With the number of each cell as its pressure.
FlowField read(const std::vector<Cell>& cells, const std::string& header, const Row& row) {
  std::string table = header + ", 1990-01-01 [bar]\n";
  for (std::size_t c = 0; c < cells.size(); ++c) table += row(cells[c]) + concat(", ", c, "\n");
  return parse_flow_csv(table, "points.csv");
}
const std::string kPlace = "x [m], y [m], depth [m]", kIndexed = "i, j, k, " + kPlace;

/// How far a corner is from the nearest one of the other cell, at most.
double off(const FlowCell& rebuilt, const Cell& cell) {
  double most = 0;
  for (const Eigen::Vector3d& corner : cell.corners) {
    double least = HUGE_VAL;
    for (const Eigen::Vector3d& other : rebuilt.corners.value())
      least = std::min(least, (other - corner).norm());
    most = std::max(most, least);
  }
  return most;
}
double most_off(const FlowField& field, const std::vector<Cell>& cells) {
  EXPECT_EQ(field.cells.size(), cells.size());
  double most = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto number = static_cast<std::size_t>(std::lround(field.value(c, 0) / 1e5));
    most = std::max(most, off(field.cells[c], cells[number]));
  }
  return most;
}

double plane(int, double x, double y) { return 2000 + 0.08 * x - 0.05 * y; }
double dome(int, double x, double y) {
  return 2000 + 60 * (std::pow((x - 400) / 800, 2) + std::pow((y - 200) / 600, 2));
}
/// 40 m deeper from the fourth column on, where the dip is another one.
double faulted(int i, double x, double y) {
  return plane(i, x, y) + (i >= 3 ? 40 + 0.04 * (x - 300) : 0);
}

TEST(CellColumns, ArePlaneLayersOnLeaningPillarsAgain) {
  const std::vector<Cell> cells = cells_of({.top = plane});
  const FlowField field = read(cells, kIndexed, index_of);
  EXPECT_LT(most_off(field, cells), 1e-6);
  EXPECT_THAT(field.notes, ElementsAre(AllOf(HasSubstr("has i, j, k: 48 columns of cells"),
                                             HasSubstr("halfway between neighbouring centres"))));
}

TEST(CellColumns, KeepTheDepthsOfBothSidesOfAFault) {
  const std::vector<Cell> cells = cells_of({.top = faulted});
  EXPECT_LT(most_off(read(cells, kIndexed, index_of), cells), 1e-3);
}

/// A column between two faults has neighbours of its own depth along its row alone.
TEST(CellColumns, OfANarrowHorstKeepTheirDepth) {
  const std::vector<Cell> cells =
      cells_of({.top = [](int i, double x, double y) { return plane(i, x, y) - (i == 3) * 60; }});
  const FlowField field = read(cells, kIndexed, index_of);
  const FlowMapping mapping =
      map_flow(field, {{.corners = cells[3 + 2 * 8 + 48].corners, .region = 0}}, {"horst"},
               {.outside = OutsideRule::unchanged});
  EXPECT_GT(mapping.covered[0], 0.7);
}

/// A metre is what a surface of this curvature differs from its tangent over a cell's width: so
/// much are cells off at the edge of the grid, where all that is known lies on one side.
TEST(CellColumns, ShareTheirFacesWhereLayersAreCurved) {
  const std::vector<Cell> cells = cells_of({.top = dome});
  const FlowField field = read(cells, kIndexed, index_of);
  EXPECT_LT(most_off(field, cells), 1.5);
  double sum = 0, within = 0;
  for (const Cell& cell : cells) {
    const auto& [i, j, k] = cell.index;
    if (i == 1 || i == 8 || j == 1 || j == 6 || k == 1 || k == 4) continue;
    const FlowMapping mapping = map_flow(field, {{.corners = cell.corners, .region = 0}}, {"in"},
                                         {.outside = OutsideRule::unchanged});
    sum += cell_volume(cell.corners);
    within += mapping.coverage[0].covered;
  }
  EXPECT_NEAR(within, sum, 1e-4 * sum);
}

TEST(CellColumns, DoNotDependOnTheOrderOfRowsNorOnTheSenseOfIndices) {
  std::vector<Cell> cells = cells_of({.top = faulted});
  std::ranges::shuffle(cells, std::mt19937(3));
  const auto turned = [](const Cell& cell) {
    return concat(9 - cell.index[0], ", ", -cell.index[1], ", ", 5 - cell.index[2], ", ") +
           place(cell);
  };
  EXPECT_LT(most_off(read(cells, kIndexed, turned), cells), 1e-3);
}

TEST(CellColumns, AreAsThickAsTheTableSays) {
  const std::vector<Cell> cells =
      cells_of({.top = plane, .thickness = {30, 4, 17, 9}});  // not half way
  const auto with_dz = [](const Cell& cell) {
    return index_of(cell) + formatted(", %.17g", cell.corners[4].z() - cell.corners[0].z());
  };
  EXPECT_LT(most_off(read(cells, kIndexed + ", dz [m]", with_dz), cells), 1e-6);
}

TEST(CellColumns, OfOneLayerWantItsThickness) {
  const std::vector<Cell> cells = cells_of({.top = plane, .size = {8, 6, 1}});
  const auto with_dz = [](const Cell& cell) { return index_of(cell) + ", 12"; };
  const auto upright = [](Grid grid) {
    grid.lean = {0, 0};
    grid.size[2] = 1;
    return cells_of(grid);
  };
  const std::vector<Cell> straight = upright({.top = plane});
  EXPECT_LT(most_off(read(straight, kIndexed + ", dz [m]", with_dz), straight), 1e-6);
  EXPECT_THAT([&] { read(cells, kIndexed, index_of); },
              testing::ThrowsMessage<InputError>(HasSubstr(
                  "no two cells follow each other along k: their thickness is not known; add a "
                  "column dz [m]")));
}

/// A layer that is not there in some columns leaves the thickness of those above and below it.
TEST(CellColumns, HaveHolesWhereCellsAreNotActive) {
  const std::vector<Cell> cells = cells_of(
      {.top = plane, .is_active = [](const Index& at) { return at[2] != 1 || at[0] < 4; }});
  EXPECT_LT(most_off(read(cells, kIndexed, index_of), cells), 1e-6);
}

TEST(CellColumns, CloseOverLayersThatPinchOut) {
  const Grid grid{.top = plane, .thickness = {12, 1e-9, 12, 12}, .is_active = [](const Index& at) {
                    return at[2] != 1;
                  }};
  const std::vector<Cell> cells = cells_of(grid);
  const FlowField field = read(cells, kIndexed, index_of);
  EXPECT_LT(most_off(field, cells), 2);
  for (std::size_t c = 1; c < field.cells.size(); ++c) {
    if (c % 3 == 0) continue;
    EXPECT_EQ(field.cells[c].corners.value()[4], field.cells[c - 1].corners.value()[0]);
  }
}

/// Upright grids along x and y keep the lines that they have without i, j, k.
TEST(CellColumns, OfUnevenLinesHaveTheirBorders) {
  std::string table = kIndexed + ", 1990-01-01 [bar]\n";
  const std::vector<double> x = {50, 150, 250, 400, 600};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 2; ++k) {
        table += concat(i, ",", j, ",", k, ",", x[static_cast<std::size_t>(i)], ",", 60 * j, ",",
                        2000 + 10 * k, ",1\n");
      }
    }
  }
  const FlowField field = parse_flow_csv(table, "uneven");
  EXPECT_EQ(field.cells[3 * 6].low, Eigen::Vector3d(300, -30, -2005));
  EXPECT_EQ(field.cells[3 * 6].high, Eigen::Vector3d(500, 30, -1995));
  EXPECT_FALSE(field.cells[3 * 6].corners) << "a box";
}

/// What a field has of the cells away from the edge of the grid, which map_flow() refuses where two
/// of the field's lie over each other.
struct Share {
  double covered = 0;  ///< of their volume.
  double own = 0;      ///< of what is covered, by the cell itself.
};
Share share_of(const FlowField& field, const std::vector<Cell>& cells, const Index& size) {
  Share share;
  double n = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto& [i, j, k] = cells[c].index;
    if (i == 1 || i == size[0] || j == 1 || j == size[1]) continue;
    const FlowMapping mapping = map_flow(field, {{.corners = cells[c].corners, .region = 0}},
                                         {"in"}, {.outside = OutsideRule::unchanged});
    for (const auto& weight : mapping.weights[0]) {
      if (std::lround(field.value(weight.flow_cell, 0) / 1e5) == static_cast<long>(c))
        share.own += weight.value;
    }
    share.covered += mapping.covered[0];
    ++n;
  }
  return {share.covered / n, share.own / n};
}

/// Columns lie askew where layers dip: the areas nearest to them are nearly their cells.
TEST(CellColumns, AreFollowedWhereNobodySaysThem) {
  const Index size = {12, 10, 4};
  std::vector<Cell> cells = cells_of({.top = plane, .size = size});
  std::ranges::shuffle(cells, std::mt19937(5));
  const FlowField field = read(cells, kPlace, place);
  EXPECT_THAT(field.notes, ElementsAre(HasSubstr("120 columns of cells")));
  const Share share = share_of(field, cells, size);
  EXPECT_GT(share.covered, 0.999);
  EXPECT_GT(share.own, 0.99);
}

/// Down the slope of the pillars, both sides of this fault are half a cell farther apart.
TEST(CellColumns, AreFollowedOnBothSidesOfAFault) {
  const Index size = {12, 10, 4};
  const std::vector<Cell> cells =
      cells_of({.top = [](int i, double x, double y) { return plane(i, x, y) + (i >= 6) * 70; },
                .lean = {0.7, 0.1},
                .size = size});
  const FlowField field = read(cells, kPlace, place);
  EXPECT_THAT(field.notes, ElementsAre(HasSubstr("120 columns of cells")));
  const Share share = share_of(field, cells, size);
  EXPECT_GT(share.covered, 0.99);
  EXPECT_GT(share.own, 0.95);
}

/// Sizes along i and j of sloping cells are no boxes.
TEST(CellColumns, TakeThePlaceOfBoxesThatLieOverEachOther) {
  const auto boxed = [](const Cell& cell) {
    return place(cell) + formatted(", 100, 80, %.17g", cell.corners[4].z() - cell.corners[0].z());
  };
  const std::string header = kPlace + ", dx [m], dy [m], dz [m]";
  const std::vector<Cell> sloping = cells_of({.top = faulted});
  const FlowField field = read(sloping, header, boxed);
  EXPECT_THAT(field.notes, testing::Contains(HasSubstr("dx and dy that are not used")));
  const auto indexed = [&](const Cell& cell) {
    return joined(cell.index, ", ") + ", " + boxed(cell);
  };
  EXPECT_LT(most_off(read(sloping, "i, j, k, " + header, indexed), sloping), 1e-3);
  const auto level = [](int, double, double) { return 2000.0; };
  const std::vector<Cell> upright = cells_of({.top = level, .lean = {0, 0}});
  EXPECT_THAT(read(upright, header, boxed).notes, IsEmpty());
}

/// A turned grid of upright pillars: sizes along i and j are none along x and y.
TEST(CellColumns, MayBeTurned) {
  std::vector<Cell> cells = cells_of({.top = faulted, .lean = {0, 0}});
  for (Cell& cell : cells) {
    for (Eigen::Vector3d& at : cell.corners)
      at = {0.8 * at.x() - 0.6 * at.y(), 0.6 * at.x() + 0.8 * at.y(), at.z()};
  }
  const auto boxed = [](const Cell& cell) { return index_of(cell) + ", 100, 80, 12"; };
  EXPECT_LT(most_off(read(cells, kIndexed + ", dx [m], dy [m], dz [m]", boxed), cells), 1e-6);
}

/// The one row of a section is as wide as the table says.
TEST(CellColumns, OfOneRowWantItsWidth) {
  const std::vector<Cell> cells =
      cells_of({.top = [](int, double x, double) { return 2000 + 0.08 * x; },
                .lean = {0.6, 0},
                .size = {8, 1, 4}});
  const auto with_dy = [](const Cell& cell) { return index_of(cell) + ", 80"; };
  EXPECT_LT(most_off(read(cells, kIndexed + ", dy [m]", with_dy), cells), 1e-6);
  EXPECT_THAT([&] { read(cells, kIndexed, index_of); },
              testing::ThrowsMessage<InputError>(HasSubstr("add columns dx [m] and dy [m]")));
}

std::string why_refused(const std::string& text) {
  try {
    parse_flow_csv(text, "points.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CellColumns, AreRefusedWhereIndicesCannotBeMeant) {
  const std::string values = ", 1990-01-01 [bar]\n";
  EXPECT_THAT(why_refused("i, k, " + kPlace + values + "1, 1, 0, 0, 2000, 9\n"),
              HasSubstr("points.csv:1: has i and k but no j; give all of i, j and k"));
  EXPECT_THAT(why_refused("i, I, j, k, " + kPlace + values), HasSubstr("two columns i"));
  EXPECT_THAT(why_refused(kIndexed + values + "1, 1, 1, 0, 0, 2000, 9\n1, 1, 1.5, 0, 0, 2010, 9\n" +
                          "1, one, 3, 0, 0, 2010, 9\n"),
              AllOf(HasSubstr("points.csv:3: k is 1.5; write i, j and k as whole numbers"),
                    HasSubstr("points.csv:4:")));
  EXPECT_THAT(why_refused(kIndexed + values + "1, 1, 1, 0, 0, 2000, 9\n1, 1, 1, 0, 0, 2010, 9\n"),
              HasSubstr("points.csv:3: the cell i = 1, j = 1, k = 1 is given at two places"));
  EXPECT_THAT(
      why_refused("date, " + kIndexed +
                  ", pressure [bar]\n"
                  "1990-01-01, 1, 1, 1, 0, 0, 2000, 9\n"
                  "1991-01-01, 1, 1, 2, 0, 0, 2000, 9\n"),
      HasSubstr("points.csv:3: the cell has i = 1, j = 1, k = 2, but others in an earlier line"));
  EXPECT_THAT(why_refused(kIndexed + values + "1, 1, 1, 0, 0, 2000, 9\n1, 1, 2, 0, 0, 2010, 9\n"),
              HasSubstr("is not known"));
}

TEST(CellColumns, NeedDepths) {
  const FlowField field = parse_flow_csv(
      "i, j, k, x [m], y [m], 1990-01-01 [bar]\n1, 1, 1, 0, 0, 9\n1, 2, 1, 0, 90, 9\n"
      "2, 1, 1, 90, 0, 9\n2, 2, 1, 90, 90, 9\n",
      "map");
  EXPECT_THAT(field.notes, ElementsAre(HasSubstr("has no depth"),
                                       "has columns that are not used: \"i\", \"j\", \"k\""));
}

}  // namespace
}  // namespace faultsim
