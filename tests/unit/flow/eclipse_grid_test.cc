// Arrays of grid files, written here by the library that others write them with.
#include "simulator/flow/eclipse_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opm/io/eclipse/EclOutput.hpp>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;
using Opm::EclIO::EclOutput;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// 2 x 1 x 1 cells.
class EclipseGridFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "grid_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_grid(int n_systems = 1, bool has_refinement = false, bool is_radial = false,
                  int porosities = 0) const {
    EclOutput out((folder_ / "CASE.EGRID").string(), false);
    std::vector<int> filehead(100, 0), gridhead(100, 0);
    filehead[0] = 3;
    filehead[1] = 2007;
    filehead[5] = porosities;
    gridhead[0] = 1;
    gridhead[1] = 2;
    gridhead[2] = gridhead[3] = 1;
    gridhead[24] = n_systems;
    gridhead[26] = is_radial ? 1 : 0;
    out.write("FILEHEAD", filehead);
    out.write("MAPUNITS", std::vector<std::string>{"METRES"});
    out.write("MAPAXES", std::vector<float>{0, 1, 0, 0, 1, 0});
    out.write("GRIDUNIT", std::vector<std::string>{"FEET", "MAP"});
    out.write("GRIDHEAD", gridhead);
    std::vector<float> coord, zcorn;
    for (int n = 0; n < 36; ++n) coord.push_back(static_cast<float>(n));
    for (int n = 0; n < 16; ++n) zcorn.push_back(static_cast<float>(100 + n));
    out.write("COORD", coord);
    out.write("ZCORN", zcorn);
    out.write("ACTNUM", std::vector<int>{1, 0});
    out.write("ENDGRID", std::vector<int>{});
    if (has_refinement) {
      out.write("LGR", std::vector<std::string>{"FINE"});
      out.write("ENDLGR", std::vector<int>{});
    }
    out.write("NNCHEAD", std::vector<int>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    out.write("NNC1", std::vector<int>{1});
    out.write("NNC2", std::vector<int>{2});
  }
  void write_init() const {
    EclOutput out((folder_ / "CASE.INIT").string(), false);
    out.write("INTEHEAD", std::vector<int>{0, 200902, 2});
    out.write("DEPTH", std::vector<float>{104});
    out.write("EQLNUM", std::vector<int>{3});
    out.write("FIPNUM", std::vector<int>{7});
  }
  EclipseGrid read() const { return read_eclipse_grid(folder_ / "CASE.EGRID"); }
  void expect_refused(const std::string& what) const {
    // The name of the grid once, and no place in the sources of a library.
    const auto is_plain = Not(AnyOf(HasSubstr("CASE.EGRID: CASE.EGRID"), HasSubstr(".cpp")));
    EXPECT_THAT([&] { read(); }, ThrowsMessage<InputError>(AllOf(HasSubstr(what), is_plain)));
  }

  fs::path folder_;
};

TEST_F(EclipseGridFile, HasItsArrays) {
  write_grid();
  const EclipseGrid grid = read();
  EXPECT_THAT(grid.size, ElementsAre(2, 1, 1));
  ASSERT_EQ(grid.coord.size(), 36u);
  EXPECT_EQ(grid.coord[35], 35);
  ASSERT_EQ(grid.zcorn.size(), 16u);
  EXPECT_EQ(grid.zcorn[15], 115);
  EXPECT_THAT(grid.active, ElementsAre(1, 0));
  EXPECT_EQ(grid.length_unit, "FEET");
  EXPECT_TRUE(grid.is_on_map);
  EXPECT_EQ(grid.map_unit, "METRES");
  EXPECT_EQ(grid.map_axes.size(), 6u);
  ASSERT_EQ(grid.connections.size(), 1u);
  EXPECT_THAT(grid.connections[0], ElementsAre(0, 1));
  EXPECT_EQ(grid.unit_system, 0);
  EXPECT_TRUE(grid.fluid_region.empty());
}

TEST_F(EclipseGridFile, HasUnitsAndRegionsOfTheFilesBesideIt) {
  write_grid();
  {
    EclOutput out((folder_ / "CASE.X0000").string(), false);
    out.write("INTEHEAD", std::vector<int>{0, 200902, 1});
  }
  EXPECT_EQ(read().unit_system, 1);
  EXPECT_EQ(read().unit_file, "CASE.X0000");
  write_init();  // goes before the restarts
  const EclipseGrid grid = read_eclipse_grid(folder_ / "CASE");
  EXPECT_EQ(grid.unit_system, 2);
  EXPECT_EQ(grid.unit_file, "CASE.INIT");
  EXPECT_THAT(grid.equilibrium_region, ElementsAre(3));
  EXPECT_THAT(grid.fluid_region, ElementsAre(7));
  EXPECT_THAT(grid.cell_depth, ElementsAre(104));
  // Corners 0, 1, 4, 5, 8, 9, 12, 13 of ZCORN are those of the active cell.
  EXPECT_DOUBLE_EQ(*depth_ratio(grid), 104 / 106.5);
  EclipseGrid other = grid;
  other.active = {0, 1};
  EXPECT_DOUBLE_EQ(*depth_ratio(other), 104 / 108.5);
  other.active.clear();
  EXPECT_FALSE(depth_ratio(other)) << "a depth too few";
  other = grid;
  other.zcorn.pop_back();
  EXPECT_FALSE(depth_ratio(other));
}

TEST_F(EclipseGridFile, IsRefusedWithAllThatIsWrong) {
  expect_refused("there is no such grid");
  write_grid(2, true);
  expect_refused("has local grid refinements (FINE)");
  expect_refused("has several coordinate systems");
  write_grid(1, false, true);
  expect_refused("is a radial grid");
  write_grid(1, false, false, 1);
  expect_refused("CASE.EGRID: is a dual porosity grid; write the grid from a model");
  write_grid(1, false, false, 2);
  expect_refused("is a dual permeability grid");
  write_grid();
  write_init();
  fs::resize_file(folder_ / "CASE.EGRID", 700);
  fs::resize_file(folder_ / "CASE.INIT", 60);
  expect_refused("CASE.EGRID: cannot be read");
  expect_refused("CASE.INIT: cannot be read");
}

TEST(EclipseAxes, AreAtRightAnglesAndHaveALength) {
  EXPECT_TRUE(are_no_axes({0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(are_no_axes({0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(axes_misfit({-7, 0, -7, 5, 4, 5}), "");
  EXPECT_EQ(axes_misfit({2e6F, 2e7F + 2000, 2e6F, 2e7F, 2e6F + 2000, 2e7F}), "");
  EXPECT_THAT(axes_misfit({1, 1, 0, 0, 1, 0}), HasSubstr("are not at right angles"));
  // A foot further north is the same number.
  EXPECT_THAT(axes_misfit({2e6F, 2e7F + 1, 2e6F, 2e7F, 2e6F + 1, 2e7F}), HasSubstr("no length"));
  EXPECT_THAT(axes_misfit({0, 1, 0, 0, 0, 0}), HasSubstr("no length"));
}

TEST(EclipseLength, IsThatOfGridunitAndInteheadWhereTheyAgree) {
  EXPECT_EQ(eclipse_length({.length_unit = "FEET"}, {}).metre, 0.3048);
  EXPECT_EQ(eclipse_length({.length_unit = "CM", .unit_system = 3}, {}).metre, 0.01);
  EXPECT_EQ(eclipse_length({.unit_system = 2}, 1).metre, 0.3048);
  EXPECT_EQ(eclipse_length({.length_unit = "FEET", .unit_system = 2}, 1).remark, "");
  EXPECT_THAT(eclipse_length({}, {}).remark, HasSubstr("metres were assumed"));
}

TEST(EclipseLength, IsThatOfInteheadWhereTheyContradictEachOther) {
  const EclipseGrid grid{.length_unit = "METRES", .unit_system = 2, .unit_file = "CASE.INIT"};
  EXPECT_EQ(eclipse_length(grid, {}).metre, 0.3048);
  EXPECT_EQ(eclipse_length(grid, {}).remark,
            "GRIDUNIT says METRES, INTEHEAD of CASE.INIT FIELD: lengths were taken as feet");
  EXPECT_EQ(eclipse_length(grid, 1.002).metre, 0.3048);
  EXPECT_THAT(eclipse_length(grid, 1.002).remark, HasSubstr("cells' depths (DEPTH) agree"));
  // Depths in feet beside a grid in metres: then GRIDUNIT is right.
  EXPECT_EQ(eclipse_length(grid, 3.2808).metre, 1);
  EXPECT_EQ(eclipse_length(grid, 2).metre, 0.3048);
}

}  // namespace
}  // namespace faultsim
