// Results in Eclipse's formats, written here by the library that others write them with.
#include "simulator/flow/eclipse_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <opm/io/eclipse/EclOutput.hpp>

#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/eclipse_files.h"
#include "simulator/flow/field_file.h"
#include "simulator/flow/flow_mapping.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// 3 x 2 x 2 cells of 100 x 200 x 10 units that dip along x, with a throw of 5 before the last
/// column; the cell (1, 0, 0) is not active.
struct Deck {
  std::string unit = "METRES";
  int unit_number = 1;     ///< of INTEHEAD: METRIC.
  double to_length = 1;    ///< m in units.
  double to_pressure = 1;  ///< bar in units.
  std::vector<int> active = {1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  std::vector<std::array<int, 3>> dates = {{1, 1, 1990}, {1, 7, 1991}};  ///< day, month, year
  bool has_refinement = false;
  std::vector<float> map_axes = {};  ///< none: MAPAXES is not there.
  std::string map_unit = "";
  std::string relative_to = "";                ///< "MAP": coordinates are on the map.
  double foot_of_pillars = 2200;               ///< m; their heads lie at 1900.
  std::array<int, 3> time_of_day = {0, 0, 0};  ///< hours, minutes, microseconds; of all reports.
};

class EclipseResult : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "eclipse_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  static double top(int i, double x) { return 2000 + 0.1 * x + (i == 2 ? 5 : 0); }

  void write_grid(const Deck& deck, const std::string& name = "CASE.EGRID") const {
    Opm::EclIO::EclOutput out((folder_ / name).string(), false);
    std::vector<int> filehead(100, 0), gridhead(100, 0);
    filehead[0] = 3;
    filehead[1] = 2007;
    gridhead[0] = 1;
    gridhead[1] = 3;
    gridhead[2] = 2;
    gridhead[3] = 2;
    gridhead[24] = 1;
    out.write("FILEHEAD", filehead);
    if (!deck.map_unit.empty()) out.write("MAPUNITS", std::vector<std::string>{deck.map_unit});
    if (!deck.map_axes.empty()) out.write("MAPAXES", deck.map_axes);
    out.write("GRIDUNIT", std::vector<std::string>{deck.unit, deck.relative_to});
    out.write("GRIDHEAD", gridhead);
    std::vector<float> coord, zcorn;
    const auto put = [&](std::vector<float>& list, double metres) {
      list.push_back(static_cast<float>(metres * deck.to_length));
    };
    for (int j = 0; j <= 2; ++j) {
      for (int i = 0; i <= 3; ++i) {
        for (const double depth : {1900.0, deck.foot_of_pillars}) {
          put(coord, 100 * i);
          put(coord, 200 * j);
          put(coord, depth);
        }
      }
    }
    for (int k = 0; k < 2; ++k) {
      for (const int bottom : {0, 1}) {
        for (int row = 0; row < 4; ++row) {
          for (int i = 0; i < 3; ++i) {
            for (const int right : {0, 1})
              put(zcorn, top(i, 100 * (i + right)) + 10 * (k + bottom));
          }
        }
      }
    }
    out.write("COORD", coord);
    out.write("ZCORN", zcorn);
    out.write("ACTNUM", deck.active);
    out.write("ENDGRID", std::vector<int>{});
    if (!deck.has_refinement) return;
    out.write("LGR", std::vector<std::string>{"FINE"});
    out.write("ENDLGR", std::vector<int>{});
  }

  static float pressure(const Deck& deck, int cell, int report) {
    return static_cast<float>((200 + 3 * cell - 20 * report) * deck.to_pressure);
  }

  void write_report(Opm::EclIO::EclOutput& out, const Deck& deck, int report, int n_values) const {
    std::vector<int> head(411, 0);
    head[2] = deck.unit_number;
    const auto& [day, month, year] = deck.dates[static_cast<std::size_t>(report)];
    head[64] = day;
    head[65] = month;
    head[66] = year;
    head[206] = deck.time_of_day[0];
    head[207] = deck.time_of_day[1];
    head[410] = deck.time_of_day[2];
    out.write("SEQNUM", std::vector<int>{report});
    out.write("INTEHEAD", head);
    std::vector<float> values;
    for (int c = 0; c < n_values; ++c) values.push_back(pressure(deck, c, report));
    out.write("PRESSURE", values);
  }
  void write_restart(const Deck& deck, int n_values = 11) const {
    Opm::EclIO::EclOutput out((folder_ / "CASE.UNRST").string(), false);
    for (int t = 0; t < static_cast<int>(deck.dates.size()); ++t)
      write_report(out, deck, t, n_values);
  }
  FlowField read() const { return read_eclipse(folder_ / "CASE.EGRID", FlowQuantity::pressure); }

  fs::path folder_;
};

TEST_F(EclipseResult, HasItsActiveCellsWhereTheyAre) {
  write_grid({});
  write_restart({});
  const FlowField field = read();
  ASSERT_EQ(field.cells.size(), 11u);
  EXPECT_EQ(field.date[0], parse_date("1990-01-01"));
  EXPECT_EQ(field.date[1], parse_date("1991-07-01"));
  EXPECT_NEAR(field.value(1, 1), (200 + 3 - 20) * 1e5, 1);
  for (const FlowCell& cell : field.cells) EXPECT_NEAR(flow_cell_volume(cell), 2e5, 1);
  // The second active cell is the third of its row, below the throw.
  EXPECT_NEAR(field.cells[1].low.x(), 200, 1e-3);
  EXPECT_NEAR(field.cells[1].high.z(), -2025, 1e-3);
  EXPECT_NEAR(field.cells[1].low.z(), -2045, 1e-3);
}

/// As some programs write vertical pillars: both points are one.
TEST_F(EclipseResult, APillarOfOnePointStandsUpright) {
  write_restart({});
  write_grid({});
  const FlowField field = read();
  write_grid({.foot_of_pillars = 1900});
  const FlowField same = read();
  ASSERT_EQ(same.cells.size(), field.cells.size());
  for (std::size_t c = 0; c < field.cells.size(); ++c) {
    EXPECT_LT((same.cells[c].low - field.cells[c].low).norm(), 1e-3);
    EXPECT_LT((same.cells[c].high - field.cells[c].high).norm(), 1e-3);
  }
}

TEST_F(EclipseResult, ReportsHaveATimeOfDay) {
  write_grid({});
  write_restart({.time_of_day = {5, 42, 12'500'000}});
  EXPECT_DOUBLE_EQ(read().date[1], *parse_date("1991-07-01") + 5 * 3600 + 42 * 60 + 12.5);
}

TEST_F(EclipseResult, IsTheSameInOtherUnits) {
  write_grid({});
  write_restart({});
  const FlowField metric = read();
  for (const Deck& deck :
       {Deck{.unit = "FEET",
       .unit_number = 2,
       .to_length = 1 / 0.3048,
       .to_pressure = 1e5 / 6894.757293168361},
        Deck{.unit = "CM", .unit_number = 3, .to_length = 100, .to_pressure = 1 / 1.01325}}) {
    write_grid(deck);
    write_restart(deck);
    const FlowField other = read();
    EXPECT_LT((other.value - metric.value).norm(), 1e-7 * metric.value.norm()) << deck.unit;
    for (std::size_t f = 0; f < metric.cells.size(); ++f) {
      EXPECT_NEAR(other.cells[f].low.z(), metric.cells[f].low.z(), 1e-3);
      EXPECT_NEAR(other.cells[f].high.x(), metric.cells[f].high.x(), 1e-3);
    }
  }
}

/// Grids that were exported in feet under the name of metres, as programs do.
TEST_F(EclipseResult, HasLengthsInTheUnitOfItsRestartsWhereTheGridContradictsThem) {
  write_grid({});
  write_restart({});
  const FlowField metric = read();
  EXPECT_THAT(metric.notes, IsEmpty());
  Deck feet{.unit_number = 2, .to_length = 1 / 0.3048, .to_pressure = 1e5 / 6894.757293168361};
  write_grid(feet);
  write_restart(feet);
  const FlowField other = read();
  EXPECT_NEAR(other.cells[3].low.z(), metric.cells[3].low.z(), 1e-3);
  EXPECT_NEAR(other.cells[3].high.x(), metric.cells[3].high.x(), 1e-3);
  EXPECT_THAT(other.notes, ElementsAre(HasSubstr("GRIDUNIT says METRES, INTEHEAD of CASE.UNRST "
                                                 "FIELD: lengths were taken as feet")));
  feet.unit = "YARDS";
  write_grid(feet);
  EXPECT_THAT([&] { read(); }, ThrowsMessage<InputError>(HasSubstr("GRIDUNIT says \"YARDS\"")));
}

/// A grid whose x points north and y west, with its origin at 10 km, 20 km.
TEST_F(EclipseResult, LiesOnTheMapWhereItsAxesSay) {
  write_grid({});
  write_restart({});
  const FlowField own = read();
  const std::vector<float> turned = {9000, 20000, 10000, 20000, 10000, 25000};
  const Deck metres{.map_axes = turned, .map_unit = "METRES"};
  std::vector<float> feet;
  for (const float value : turned) feet.push_back(value / 0.3048F);
  for (const Deck& deck : {metres, Deck{.map_axes = feet, .map_unit = "FEET"}}) {
    write_grid(deck);
    const FlowField there = read();
    ASSERT_EQ(there.cells.size(), own.cells.size());
    EXPECT_THAT(there.notes,
                ElementsAre("was placed on the map by the MAPAXES of its grid: its x = y = 0 at "
                            "10000 m, 20000 m, its y along the azimuth -90 deg"));
    for (std::size_t f = 0; f < own.cells.size(); ++f) {
      EXPECT_NEAR(there.cells[f].low.x(), 10000 - own.cells[f].high.y(), 0.01);
      EXPECT_NEAR(there.cells[f].low.y(), 20000 + own.cells[f].low.x(), 0.01);
      EXPECT_EQ(there.cells[f].low.z(), own.cells[f].low.z());
      EXPECT_NEAR(flow_cell_volume(there.cells[f]), flow_cell_volume(own.cells[f]), 1);
    }
  }
  write_grid({.map_axes = turned, .map_unit = "METRES", .relative_to = "MAP"});
  EXPECT_EQ(read().cells[3].low, own.cells[3].low);
  EXPECT_THAT(read().notes, ElementsAre(HasSubstr("already has map coordinates")));
  write_grid({.map_axes = {0, 1, 0, 0, 1, 0}, .map_unit = "METRES"});
  EXPECT_EQ(read().cells[3].low, own.cells[3].low);
  EXPECT_THAT(read().notes, IsEmpty());
  write_grid({.map_axes = {-7, 0, -7, 5, 4, 5}, .map_unit = "METRES"});  // y points south
  EXPECT_THAT(read().notes, ElementsAre(HasSubstr("180 deg, its x to the left of that")));
  write_grid({.map_axes = {0, 0, 0, 0, 0, 0}});
  EXPECT_EQ(read().cells[3].low, own.cells[3].low);
  EXPECT_THAT(read().notes, ElementsAre(HasSubstr("MAPAXES of zeros, which say nothing")));
  write_grid({.map_axes = {0, 0, 0, 0, 1, 0}});
  EXPECT_THAT([&] { read(); }, ThrowsMessage<InputError>(
                                   HasSubstr("axes on the map (MAPAXES) that have no length")));
}

/// 5 GB with a hole between two reports: offsets do not fit into 32 bits, and nothing of what is
/// not asked for is read.
TEST_F(EclipseResult, MayBeLargerThanTheMemoryOfItsValues) {
  write_grid({});
  write_restart({});
  const FieldFile small = read_field_file(folder_ / "CASE.EGRID", FlowQuantity::pressure);
  const std::string part = (folder_ / "PART").string(), whole = (folder_ / "CASE.UNRST").string();
  const auto bytes_of = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  {
    Opm::EclIO::EclOutput out(part, false);
    write_report(out, {}, 0, 11);
  }
  const std::string first = bytes_of(part);
  {
    Opm::EclIO::EclOutput out(part, false);
    write_report(out, {}, 1, 11);
  }
  const std::string second = bytes_of(part);
  std::ofstream file(whole, std::ios::binary);
  file << first;
  // The head of an array, and where its blocks of 1000 numbers, each between its length, would end.
  constexpr std::uint32_t kNumbers = 1'250'000'000, kBlock = 1000;
  const auto put = [&](std::uint32_t n) {
    for (int shift = 24; shift >= 0; shift -= 8)
      file.put(static_cast<char>(static_cast<unsigned char>(n >> shift)));
  };
  put(16);
  file << "SWAT    ";
  put(kNumbers);
  file << "REAL";
  put(16);
  file.seekp(4LL * kNumbers + 8LL * (kNumbers / kBlock), std::ios::cur);
  file << second;
  file.close();
  ASSERT_GT(fs::file_size(whole), 5'000'000'000U);
  const FlowField large = read();
  EXPECT_EQ(large.value, small.field->value);
  EXPECT_EQ(large.date, small.field->date);
}

TEST_F(EclipseResult, MayHaveAFilePerReport) {
  write_grid({});
  for (int t = 0; t < 2; ++t) {
    Opm::EclIO::EclOutput out((folder_ / ("CASE.X000" + std::to_string(t))).string(), false);
    write_report(out, {}, t, 11);
  }
  EXPECT_EQ(read().date.size(), 2u);
  EXPECT_EQ(read_eclipse(folder_ / "CASE", FlowQuantity::pressure).date.size(), 2u);
  EXPECT_EQ(read_eclipse(folder_ / "CASE.X0001", FlowQuantity::pressure).date.size(), 1u);
  const FieldFile file = read_field_file(folder_ / "CASE", FlowQuantity::pressure);
  EXPECT_EQ(file.fingerprint.size(), 32u);
  write_restart({});  // goes before them
  EXPECT_EQ(eclipse_files(folder_ / "CASE").restarts.size(), 1u);
  EXPECT_NE(read_field_file(folder_ / "CASE", FlowQuantity::pressure).fingerprint,
            file.fingerprint);
}

TEST_F(EclipseResult, MayHaveEndingsInSmallLetters) {
  write_grid({});
  write_restart({});
  const fs::path grid = folder_ / "CASE.egrid", restart = folder_ / "CASE.unrst";
  const FlowField own = read();
  EXPECT_EQ(eclipse_files(restart).grid, folder_ / "CASE.EGRID");
  fs::rename(folder_ / "CASE.EGRID", grid);
  fs::rename(folder_ / "CASE.UNRST", restart);
  for (const fs::path& path : {grid, restart, folder_ / "CASE", folder_ / "CASE.EGRID"}) {
    EXPECT_TRUE(is_eclipse_name(path)) << path;
    EXPECT_EQ(read_field_file(path, FlowQuantity::pressure).field->value, own.value) << path;
  }
  EXPECT_EQ(eclipse_files(grid).init, folder_ / "CASE.init");
  EXPECT_EQ(eclipse_files(folder_ / "CASE").init, folder_ / "CASE.INIT");
  EXPECT_FALSE(is_eclipse_name(folder_ / "CASE.csv"));
  fs::rename(restart, folder_ / "CASE.x0001");
  EXPECT_THAT([&] { read(); }, ThrowsMessage<InputError>(HasSubstr("rename it to CASE.X0001")));
}

TEST_F(EclipseResult, IsRefusedWithWhatIsWrong) {
  const auto refused = [&](const std::string& what) {
    EXPECT_THAT([&] { read(); }, ThrowsMessage<InputError>(HasSubstr(what)));
  };
  refused("there is no such grid");
  write_grid({});
  refused("there is no restart file");
  write_restart({}, 12);
  refused("is from another grid: it has 12 values, but CASE.EGRID has 11 active cells");
  write_restart({.dates = {{1, 1, 1991}, {1, 1, 1990}}});
  refused("report 1 of 1990-01-01 does not come after the one before, of 1991-01-01");
  write_restart({.to_pressure = -1});
  refused("has the value -200 in active cell 1");
  write_restart({.to_pressure = std::numeric_limits<double>::quiet_NaN()});
  refused("has the value nan");
  EXPECT_THAT([&] { read_eclipse(folder_ / "CASE", FlowQuantity::temperature); },
              ThrowsMessage<InputError>(HasSubstr("report 0 has no TEMP")));
  write_restart({});
  fs::resize_file(folder_ / "CASE.UNRST", fs::file_size(folder_ / "CASE.UNRST") - 30);
  EXPECT_THROW(read(), InputError);
  write_restart({});
  write_grid({.active = std::vector<int>(12, 0)});
  refused("has no active cell");
  write_grid({.has_refinement = true});
  refused("local grid refinements");
  write_grid({});
  fs::resize_file(folder_ / "CASE.EGRID", 700);
  EXPECT_THROW(read(), InputError);
}

/// Boxes of our own over a grid with a dip and a throw, within it.
TEST_F(EclipseResult, IsMappedByTheVolumeOfOverlap) {
  write_grid({.active = std::vector<int>(12, 1)});
  write_restart({}, 12);
  const FlowField field = read();
  std::vector<MappedCell> cells;
  for (int i = 0; i < 6; ++i) {
    const double x = 50 * i, z = -top(i / 2, x) - 5;
    CellCorners box;
    for (std::size_t c = 0; c < 8; ++c) {
      const double right = c % 4 == 1 || c % 4 == 2 ? 30 : 0, back = c % 4 >= 2 ? 250 : 0;
      box[c] = {x + right, 50 + back, z + (c < 4 ? -10 : -5)};
    }
    cells.push_back({box, 0, 1});
  }
  const FlowMapping mapping = map_flow(field, cells, {"all"}, {.outside = OutsideRule::nearest});
  for (std::size_t c = 0; c < cells.size(); ++c) {
    double overlap = 0;
    for (const FlowCell& cell : field.cells) overlap += overlap_volume(cells[c].corners, cell);
    EXPECT_NEAR(overlap, cell_volume(cells[c].corners), 1e-9 * overlap) << c;
    EXPECT_GE(mapping.weights[c].size(), 2u);
  }
  EXPECT_EQ(mapping.coverage[0].n_partly, 0);
}

}  // namespace
}  // namespace faultsim
