#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>

#include "campaign/pillars/fault_map.h"
#include "simulator/reading/fault_surface.h"

namespace faultsweep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Two pillars of a fault that strikes north and dips 45 degrees to the east, and one alone.
FaultMap small_map() {
  FaultMap map;
  map.places = {{.id = "a",
                 .fault = "F",
                 .x = 100,
                 .y = 0,
                 .azimuth = 0,
                 .dip = 45,
                 .top_depth = 2000,
                 .base_depth = 2300},
                {.id = "b",
                 .fault = "F",
                 .x = 100,
                 .y = 50,
                 .azimuth = 0,
                 .dip = 45,
                 .top_depth = 2010,
                 .base_depth = 2310},
                {.id = "c",
                 .fault = "",
                 .x = 7,
                 .y = 8,
                 .azimuth = 90,
                 .dip = 0,
                 .top_depth = 1000,
                 .base_depth = 1100}};
  map.outcomes = {"converged", "converged", "failed"};
  map.properties = {{"pressure", "bar", "", {90, kNone, kNone}},
                    {"moment", "N m/m", "", {1.5, 0, kNone}}};
  return map;
}

std::string bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t word = 0;
  int n_bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    n_bits += 6;
    if (n_bits < 8) continue;
    n_bits -= 8;
    bytes += static_cast<char>(word >> n_bits & 255);
  }
  return bytes;
}

/// Numbers of an array of a VTU text, by its name.
template <typename Number>
std::vector<Number> array_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("Name=\"" + name + "\"");
  EXPECT_NE(at, std::string::npos) << name;
  const std::size_t from = text.find('>', at) + 1;
  const std::string bytes = bytes_of(text.substr(from, text.find('<', from) - from));
  std::uint64_t count = 0;
  std::memcpy(&count, bytes.data(), sizeof count);
  EXPECT_EQ(count, bytes.size() - sizeof count);
  std::vector<Number> numbers(count / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data() + sizeof count, count);
  return numbers;
}

TEST(FaultMap, CsvHasALineForEachPillarAndNothingWhereThereIsNothing) {
  EXPECT_EQ(fault_map_to_csv(small_map()),
            "id,fault,x_m,y_m,azimuth_deg,dip_deg,top_depth_m,base_depth_m,outcome,pressure_bar,"
            "moment_N_m_per_m\n"
            "a,F,100,0,0,45,2000,2300,converged,90,1.5\n"
            "b,F,100,50,0,45,2010,2310,converged,,0\n"
            "c,,7,8,90,0,1000,1100,failed,,\n");
}

/// What a terminal would obey and a spreadsheet would compute is text; sums of tenths are rounded.
TEST(FaultMap, NamesAreSafeAndNumbersRounded) {
  FaultMap map = small_map();
  map.places[0].id = "=cmd|' /C calc'!A0";
  map.places[1].id = std::string("\x1b[31m\0", 6) + "\xE2\x80\xAE\xff";
  map.places[0].fault = map.places[1].fault = "F\n\x1b]0;x\a";
  map.places[0].base_depth = 2394.7999999999997;
  map.properties[0].values[0] = 0.1 + 0.2;
  const std::string csv = fault_map_to_csv(map), surface = fault_map_to_tsurf(map);
  EXPECT_NE(csv.find("\n'=cmd|' /C calc'!A0,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n\\u001b[31m\\u0000\\u202e\\xff,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",2394.8,converged,0.3,"), std::string::npos) << csv;
  EXPECT_NE(surface.find("\nname:F\\u000a\\u001b]0;x\\u0007\n}"), std::string::npos) << surface;
  EXPECT_NE(surface.find(" 2394.8 "), std::string::npos) << surface;
}

/// Refused pillars are said in tables; in space only where their panel is known.
TEST(FaultMap, ShowsRefusedPillarsAndDates) {
  FaultMap map = small_map();
  map.places[1].dip = map.places[1].top_depth = kNone;
  map.outcomes[1] = "refused";
  map.first_dates = {"1994-06-30", "", ""};
  const std::string csv = fault_map_to_csv(map);
  EXPECT_NE(csv.find(",moment_N_m_per_m,first_sliding_date\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\na,F,100,0,0,45,2000,2300,converged,90,1.5,1994-06-30\n"), std::string::npos)
      << csv;
  EXPECT_NE(csv.find("\nb,F,100,50,0,,,2310,refused,,0,\n"), std::string::npos) << csv;
  const std::string vtu = fault_map_to_vtu(map);
  EXPECT_EQ(array_of<double>(vtu, "Points").size(), 12u);
  EXPECT_EQ(array_of<double>(vtu, "moment [N m/m]").size(), 4u);
  EXPECT_EQ(array_of<std::int64_t>(vtu, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(array_of<std::uint8_t>(vtu, "types"), (std::vector<std::uint8_t>{3, 3}));
  EXPECT_EQ(fault_map_to_tsurf(map), "") << "one pillar of F is left";
  // Cells go by the panels that are there: with a place without one before the pillars of F.
  map = small_map();
  map.places.insert(map.places.begin(), map.places[2]);
  map.places[0].x = kNone;
  map.outcomes.insert(map.outcomes.begin(), "refused");
  for (FaultMap::Property& one : map.properties) one.values.insert(one.values.begin(), kNone);
  EXPECT_EQ(array_of<std::int64_t>(fault_map_to_vtu(map), "connectivity"),
            (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 0, 2, 3, 1}));
}

TEST(FaultMap, VtuHasPanelsThatDipToTheRightOfTheirStrike) {
  const std::string text = fault_map_to_vtu(small_map());
  const auto points = array_of<double>(text, "Points");
  ASSERT_EQ(points.size(), 18u);
  EXPECT_EQ(points[0], 100);
  EXPECT_EQ(points[2], -2000);
  EXPECT_NEAR(points[3], 400, 1e-9);  // 300 m deeper and as far east
  EXPECT_NEAR(points[4], 0, 1e-9);
  EXPECT_EQ(points[5], -2300);
  EXPECT_EQ(array_of<std::int64_t>(text, "connectivity"),
            (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 0, 2, 3, 1}));
  EXPECT_EQ(array_of<std::int64_t>(text, "offsets"), (std::vector<std::int64_t>{2, 4, 6, 10}));
  EXPECT_EQ(array_of<std::uint8_t>(text, "types"), (std::vector<std::uint8_t>{3, 3, 3, 9}));
  const auto pressure = array_of<double>(text, "pressure [bar]");
  ASSERT_EQ(pressure.size(), 6u);
  EXPECT_EQ(pressure[0], 90);
  EXPECT_EQ(pressure[1], 90);
  EXPECT_TRUE(std::isnan(pressure[2]));
}

TEST(FaultMap, TsurfHasTrianglesBetweenThePillarsOfAFault) {
  const std::string text = fault_map_to_tsurf(small_map());
  std::istringstream stream(text);
  std::vector<std::vector<double>> vertices;
  std::vector<std::vector<int>> triangles;
  int n_surfaces = 0;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    n_surfaces += key == "GOCAD" ? 1 : 0;
    std::vector<double> numbers;
    for (double one = 0; words >> one;) numbers.push_back(one);
    if (key == "PVRTX") vertices.push_back(numbers);
    if (key == "TRGL") triangles.emplace_back(numbers.begin(), numbers.end());
    if (key == "NO_DATA_VALUES") {
      EXPECT_EQ(numbers, (std::vector<double>{-99999, -99999}));
    }
  }
  EXPECT_EQ(n_surfaces, 1);  // a pillar alone is not a surface
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices[0], (std::vector<double>{1, 100, 0, 2000, 90, 1.5}));
  EXPECT_EQ(vertices[2][4], -99999);
  EXPECT_EQ(triangles, (std::vector<std::vector<int>>{{1, 3, 4}, {1, 4, 2}}));
  EXPECT_NE(text.find("ZPOSITIVE Depth"), std::string::npos);
  // A scene of horizons takes it as the surface of a fault.
  const auto read = faultsim::parse_fault_surface(text, "map.ts", "F");
  ASSERT_EQ(read.points.size(), 4u);
  EXPECT_EQ(read.points[0], Eigen::Vector3d(100, 0, -2000));
  EXPECT_LT((read.points[3] - Eigen::Vector3d(400, 50, -2310)).norm(), 1e-9);
  ASSERT_EQ(read.triangles.size(), 2u);
  EXPECT_EQ(read.triangles[1], (std::array<int, 3>{0, 3, 1}));
  FaultMap alone = small_map();
  for (auto& place : alone.places) place.fault.clear();
  EXPECT_EQ(fault_map_to_tsurf(alone), "");
}

}  // namespace
}  // namespace faultsweep
