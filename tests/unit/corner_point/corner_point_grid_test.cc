// Arrays of a file as a grid in metres on the map, and what is refused.
#include "simulator/corner_point/corner_point_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "made_grid.h"
#include "simulator/common/errors.h"
#include "simulator/corner_point/structure_finder.h"

namespace faultsim::corner_point {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kFoot = 0.3048;

MadeGrid small() {
  return {.size = {6, 5, 3},
          .lean = {0.5, -0.2},
          .faults = {{{300, 0}, {300, 400}, [](double) { return 30.0; }}},
          .inactive = {{1, 2, -1}, {4, 4, 1}}};
}

/// Every corner from COORD and ZCORN, written down here once more.
Eigen::Vector3d corner_of(const EclipseGrid& file, int i, int j, int k, int right, int back,
                          int bottom) {
  const int n_i = file.size[0], n_j = file.size[1];
  const auto z = static_cast<std::size_t>(2 * i + right +
                                          2 * n_i * (2 * j + back + 2 * n_j * (2 * k + bottom)));
  const auto p = static_cast<std::size_t>(6 * (i + right + (n_i + 1) * (j + back)));
  const double depth = file.zcorn[z];
  const double s = (depth - file.coord[p + 2]) / (file.coord[p + 5] - file.coord[p + 2]);
  return {file.coord[p] + s * (file.coord[p + 3] - file.coord[p]),
          file.coord[p + 1] + s * (file.coord[p + 4] - file.coord[p + 1]), -depth};
}

TEST(CornerPointGrid, HasItsCornersWhereTheFileHasThem) {
  const EclipseGrid file = as_file(made(small()), 1);
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  EXPECT_EQ(grid.n_cells(), 90);
  for (int cell = 0; cell < grid.n_cells(); ++cell) {
    const int column = cell % grid.n_columns(), k = cell / grid.n_columns();
    const auto [i, j] = grid.place(column);
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d at = grid.corner(column, k, {c % 2 == 1, c / 2 % 2 == 1, c > 3});
      EXPECT_LT((at - corner_of(file, i, j, k, c % 2, c / 2 % 2, c / 4)).norm(), 1e-6) << cell;
    }
  }
  EXPECT_EQ(grid.is_active[1 + 6 * 2], 0);
  EXPECT_FALSE(grid.has_active_cell(grid.column(1, 2)));
  EXPECT_TRUE(grid.has_active_cell(grid.column(4, 4)));
  EXPECT_NEAR(grid.thickness(0, 1), 20, 1e-3);
}

TEST(CornerPointGrid, IsTheSameInFeetAndCentimetres) {
  const CornerPointGrid own = made(small());
  struct Unit {
    double metre;
    const char* name;
    int system;
  };
  for (const Unit& unit : {Unit{1, "METRES", 1}, {kFoot, "FEET", 2}, {0.01, "CM", 3}}) {
    for (const int with : {1, 2, 3}) {  // GRIDUNIT, INTEHEAD or both say it
      EclipseGrid file = as_file(own, unit.metre);
      if (with != 2) file.length_unit = unit.name;
      if (with != 1) file.unit_system = unit.system;
      const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
      EXPECT_TRUE(grid.remarks.empty());
      for (int column = 0; column < grid.n_columns(); ++column) {
        for (int c = 0; c < 8; ++c) {
          const CornerPlace corner{c % 2 == 1, c / 2 % 2 == 1, c > 3};
          EXPECT_LT((grid.corner(column, 1, corner) - own.corner(column, 1, corner)).norm(), 2e-3);
        }
      }
    }
  }
}

TEST(CornerPointGrid, TrustsIntehead) {
  EclipseGrid file = as_file(made(small()), kFoot);
  file.length_unit = "METRES";
  file.unit_system = 2;
  file.unit_file = "CASE.INIT";
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  EXPECT_NEAR(grid.z(0, 0, {}), made_top({0, 0}), 1e-3);
  EXPECT_THAT(grid.remarks, testing::ElementsAre(
                                "GRIDUNIT says METRES, INTEHEAD of CASE.INIT FIELD: lengths were "
                                "taken as feet"));
  // A recognised fault has its throw in metres.
  const GridStructure found = recognise_structure(grid, {});
  ASSERT_EQ(found.faults.size(), 1u);
  EXPECT_NEAR(found.faults[0].largest_offset, 30, 2e-3);
  EXPECT_EQ(found.report[0].text, grid.remarks[0]);
}

/// DEPTH of the INIT file is in the units of INTEHEAD, whatever those of the grid file are.
TEST(CornerPointGrid, AsksTheDepthsOfCellsWhereUnitsContradictEachOther) {
  const CornerPointGrid own = made(small());
  std::vector<float> feet;
  for (int cell = 0; cell < own.n_cells(); ++cell) {
    if (own.is_active[static_cast<std::size_t>(cell)] == 0) continue;
    double depth = 0;
    for (int c = 0; c < 8; ++c)
      depth -= own.z(cell % 30, cell / 30, {c % 2 == 1, c / 2 % 2 == 1, c > 3}) / 8;
    feet.push_back(static_cast<float>(depth / kFoot));
  }
  for (const double metre : {1.0, kFoot}) {
    EclipseGrid file = as_file(own, metre);
    file.length_unit = "METRES";
    file.unit_system = 2;
    file.cell_depth = feet;
    const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
    EXPECT_NEAR(grid.z(0, 0, {}), made_top({0, 0}), 1e-3);
    EXPECT_THAT(grid.remarks[0], HasSubstr(metre == 1 ? "taken as metres, with which"
                                                      : "taken as feet, with which"));
  }
}

TEST(CornerPointGrid, LiesOnTheMapWhereItsAxesSay) {
  const CornerPointGrid own = made(small());
  EclipseGrid file = as_file(own, 1);
  file.map_axes = {9000, 20000, 10000, 20000, 10000, 25000};  // x points north, y west
  file.map_unit = file.length_unit = "METRES";
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  for (int column = 0; column < grid.n_columns(); ++column) {
    const Eigen::Vector3d at = grid.corner(column, 0, {}), was = own.corner(column, 0, {});
    EXPECT_NEAR(at.x(), 10000 - was.y(), 1e-2);
    EXPECT_NEAR(at.y(), 20000 + was.x(), 1e-2);
  }
  EXPECT_THAT(grid.remarks, testing::ElementsAre("coordinates were put on the map by MAPAXES"));
  const GridStructure here = recognise_structure(own, {}), there = recognise_structure(grid, {});
  EXPECT_NEAR(here.faults[0].dip.median, there.faults[0].dip.median, 1e-5);
  EXPECT_NEAR(std::abs(there.faults[0].offset[2]), 30, 1e-3);
  file.is_on_map = true;
  const CornerPointGrid on_map = corner_point_grid(file, "CASE.EGRID");
  EXPECT_LT((on_map.corner(0, 0, {}) - own.corner(0, 0, {})).norm(), 1e-3);
  EXPECT_THAT(on_map.remarks[0], HasSubstr("MAPAXES not applied"));
  file.is_on_map = false;
  file.map_axes.assign(6, 0);
  const CornerPointGrid placed_nowhere = corner_point_grid(file, "CASE.EGRID");
  EXPECT_EQ(placed_nowhere.corner(0, 0, {}), on_map.corner(0, 0, {}));
  EXPECT_THAT(placed_nowhere.remarks, testing::ElementsAre(HasSubstr("MAPAXES are zeros")));
}

TEST(CornerPointGrid, HasRegionsOfItsActiveCells) {
  EclipseGrid file = as_file(made(small()), 1);
  for (int cell = 0; cell < 90 - 4; ++cell) file.fluid_region.push_back(cell + 1);
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  EXPECT_TRUE(grid.equilibrium_region.empty());
  EXPECT_EQ(grid.fluid_region[12], 13);
  EXPECT_EQ(grid.fluid_region[13], 0);
  EXPECT_EQ(grid.fluid_region[14], 14);
  EXPECT_EQ(grid.fluid_region[89], 86);
}

/// Regions of an INIT file of another run are refused to who asks for them, and to nobody else.
TEST(CornerPointGrid, LeavesRegionsOfAnotherGridOut) {
  EclipseGrid file = as_file(made(small()), 1);
  file.length_unit = "METRES";
  file.equilibrium_region = {1, 2};
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  EXPECT_TRUE(grid.equilibrium_region.empty());
  const std::string misfit =
      "EQLNUM of the INIT file has 2 numbers, but the grid has 86 active cells";
  EXPECT_THAT(grid.remarks, testing::ElementsAre(misfit + ": it is left out"));
  EXPECT_EQ(recognise_structure(grid, {}).faults.size(), 1u);
  const auto with = [&](CompartmentRule rule) {
    recognise_structure(grid, {.compartments = rule});
  };
  EXPECT_THAT(
      [&] { with(CompartmentRule::equilibrium_regions); },
      ThrowsMessage<InputError>(HasSubstr(misfit + "; keep the files of one run together")));
  EXPECT_THAT([&] { with(CompartmentRule::fluid_regions); },
              ThrowsMessage<InputError>(HasSubstr("FIPNUM is missing; put the INIT file")));
}

TEST(CornerPointGrid, IsRefusedWithAllThatIsWrong) {
  EclipseGrid file = as_file(made(small()), 1);
  file.coord[7] = std::numeric_limits<float>::quiet_NaN();
  file.zcorn[5] = std::numeric_limits<float>::infinity();
  file.length_unit = "YARDS";
  file.map_axes = {1, 1, 0, 0, 1, 0};
  file.connections = {{0, 90}};
  try {
    corner_point_grid(file, "CASE.EGRID");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 5u);
    EXPECT_THAT(error.what(), HasSubstr("GRIDUNIT says \"YARDS\"; METRES, FEET and CM are known"));
    EXPECT_THAT(error.what(), HasSubstr("1 pillar has a coordinate that is not a number, the first "
                                        "at i = 2, j = 1"));
    EXPECT_THAT(error.what(), HasSubstr("connect cells 1 and 91 of 90"));
    EXPECT_THAT(error.what(), HasSubstr("ZCORN: 1 depth is not a number"));
    EXPECT_THAT(error.what(), HasSubstr("not at right angles"));
  }
}

TEST(CornerPointGrid, IsRefusedWhereSizesDoNotFit) {
  EclipseGrid file = as_file(made(small()), 1);
  file.zcorn.pop_back();
  file.active.pop_back();
  try {
    corner_point_grid(file, "CASE.EGRID");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2u);
    EXPECT_THAT(error.what(), HasSubstr("ZCORN has 719 numbers, but a grid of this size has 720"));
  }
  EXPECT_THAT([] { corner_point_grid({}, "CASE.EGRID"); },
              ThrowsMessage<InputError>(HasSubstr("has 0 x 0 x 0 cells")));
  EclipseGrid none = as_file(made(small()), 1);
  none.active.assign(90, 0);
  EXPECT_THAT([&] { corner_point_grid(none, "CASE.EGRID"); },
              ThrowsMessage<InputError>(HasSubstr("has no active cell")));
}

TEST(CornerPointGrid, IsRefusedWhereCellsAreInsideOut) {
  EclipseGrid file = as_file(made(small()), 1);
  for (float& depth : file.zcorn) depth = -depth;  // heights for depths: layers upside down
  EXPECT_THAT(
      [&] { corner_point_grid(file, "CASE.EGRID"); },
      ThrowsMessage<InputError>(HasSubstr(
          "86 cells have their bottoms above their tops, the first at i = 1, j = 1, k = 1")));
}

/// Cells that are no rock, as some programs export them.
TEST(CornerPointGrid, FlattensInactiveCellsThatAreInsideOut) {
  const CornerPointGrid own = made(small());  // cell 4, 4, 1 is inactive
  const int column = own.column(4, 4), active = own.column(3, 3);
  EclipseGrid file = as_file(own, 1);
  file.length_unit = "METRES";
  const CornerPlace top{true, false, false}, bottom{true, false, true};
  file.zcorn[own.corner_index(column, 1, bottom)] =
      file.zcorn[own.corner_index(column, 1, top)] - 0.5F;
  const CornerPointGrid grid = corner_point_grid(file, "CASE.EGRID");
  EXPECT_EQ(grid.z(column, 1, bottom), grid.z(column, 1, top));
  EXPECT_NEAR(grid.z(column, 1, {false, false, true}), own.z(column, 1, {false, false, true}),
              1e-3);
  EXPECT_THAT(grid.remarks,
              testing::ElementsAre("1 inactive cell has its bottom above its top, by up to 0.5 m: "
                                   "the bottom was taken to lie at the top there"));
  file.zcorn[own.corner_index(active, 1, bottom)] =
      file.zcorn[own.corner_index(active, 1, top)] - 0.5F;
  EXPECT_THAT([&] { corner_point_grid(file, "CASE.EGRID"); },
              ThrowsMessage<InputError>(HasSubstr("1 cell has its bottom above its top, the first "
                                                  "at i = 4, j = 4, k = 2")));
}

}  // namespace
}  // namespace faultsim::corner_point
