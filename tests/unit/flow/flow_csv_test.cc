// Tables of flow cells: both forms, both systems of units, and what is wrong with bad ones.
#include "simulator/flow/flow_csv.h"

#include <gmock/gmock.h>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

const char* const kPlaceColumns = "x [m], y [m], depth [m], dx [m], dy [m], dz [m]";

std::string wide(const std::string& rows) {
  return std::string(kPlaceColumns) + ", 1990-01-01 [bar], 1995-01-01 [bar]\n" + rows;
}
std::string long_form(const std::string& rows) {
  return "date, " + std::string(kPlaceColumns) + ", pressure [bar]\n" + rows;
}

std::string refusal(const std::string& text, FlowQuantity quantity = FlowQuantity::pressure) {
  try {
    parse_flow_csv(text, "flow.csv", quantity);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FlowCsv, SaysTheSameInBothForms) {
  const FlowField a = parse_flow_csv(
      wide("# two cells\n100, 200, 3000, 50, 60, 10, 350, 300\n\n150, 200, 3000, 50, 60, 10, 351, "
           "299\n"),
      "a");
  const FlowField b = parse_flow_csv(long_form("1990-01-01, 100, 200, 3000, 50, 60, 10, 350\n"
                                               "1990-01-01, 150, 200, 3000, 50, 60, 10, 351\n"
                                               "1995-01-01, 150, 200, 3000, 50, 60, 10, 299\n"
                                               "1995-01-01, 100, 200, 3000, 50, 60, 10, 300\n"),
                                     "b");
  EXPECT_EQ(a.cells[1].low, Eigen::Vector3d(125, 170, -3005));
  EXPECT_EQ(a.cells[1].high, Eigen::Vector3d(175, 230, -2995));
  EXPECT_EQ(a.value(1, 1), 299e5);
  EXPECT_EQ(a.date[1] - a.date[0], 1826 * 86400.0);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.date, b.date);
  EXPECT_EQ(a.cells[0].high, b.cells[0].high);
}

TEST(FlowCsv, ReadsFieldUnits) {
  const FlowField field = parse_flow_csv(
      "x [ft], y [ft], depth [ft], dx [ft], dy [ft], dz [ft], 1990-01-01 [psi]\n"
      "0, 0, 10000, 10, 10, 10, 5000\n",
      "field units");
  EXPECT_NEAR(field.cells[0].low.z(), -10005 * 0.3048, 1e-9);
  EXPECT_NEAR(field.value(0, 0), 5000 * 6894.757293168, 1e-2);
}

TEST(FlowCsv, NamesEveryProblemWithItsLine) {
  const std::string text =
      refusal(wide("0, 0, 3000, 50, 50, 10, 350, NaN\n0, 0, 3000, 0, 50, 10, 350, 340\n1, 2\n"
                   "9, 9, 3000, 50, 50, 10, -1, 340\n"));
  EXPECT_THAT(text, HasSubstr("flow.csv:2: \"NaN\" in column 8 \"1995-01-01\" is not a number"));
  EXPECT_THAT(text, HasSubstr("flow.csv:3: \"0\" in column 4 \"dx [m]\" is not within 1 mm to"));
  EXPECT_THAT(text, HasSubstr("flow.csv:4: has 2 values for 8 columns"));
  EXPECT_THAT(
      text,
      HasSubstr("flow.csv:5: \"-1\" in column 7 \"1990-01-01 [bar]\" is not within 0 to 10 GPa"));
}

TEST(FlowCsv, RefusesTimeThatGoesBackwardsAndCellsThatAreMissing) {
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1995-01-01 [bar], 1990-01-01 [bar]\n"),
              HasSubstr("1990-01-01 does not come after the one before"));
  const std::string first = "1990-01-01, 0, 0, 3000, 50, 50, 10, 350\n";
  const std::string other = "1990-01-01, 50, 0, 3000, 50, 50, 10, 350\n";
  const std::string later = "1991-01-01, 0, 0, 3000, 50, 50, 10, 350\n";
  EXPECT_THAT(refusal(long_form(first + later + other)),
              HasSubstr("1 of 2 cells are missing at 1991-01-01"));
  EXPECT_THAT(refusal(long_form(first + other + later)),
              HasSubstr("1 of 2 cells are missing at 1991-01-01"));
  EXPECT_THAT(refusal(long_form(first + first)), HasSubstr("flow.csv:3: the cell is given twice"));
}

TEST(FlowCsv, RefusesHeadersThatDoNotSayWhatIsThere) {
  EXPECT_THAT(refusal(""), HasSubstr("there are no values"));
  EXPECT_THAT(refusal("x, y\n"), HasSubstr("has 0 columns of values"));
  EXPECT_THAT(refusal("x [m], y [m], w [m], dx [m], dy [m], dz [m], 1990-01-01 [bar]\n"),
              HasSubstr("\"w\" is neither a date nor x, y, depth"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1990-01-01\n"), HasSubstr("has no unit"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1990-01-01 [m]\n"),
              HasSubstr("does not hold a pressure"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", soon [bar]\n"),
              HasSubstr("\"soon\" is neither a date nor"));
}

TEST(FlowCsv, BoundsPressuresAndTemperatures) {
  for (const char* value : {"1e9", "1e300", "1e308", "100001", "-0.1"})
    EXPECT_THAT(refusal(wide("0, 0, 3000, 50, 50, 10, 350, " + std::string(value) + "\n")),
                HasSubstr("flow.csv:2: \"" + std::string(value) +
                          "\" in column 8 \"1995-01-01 [bar]\" is not within 0 to 10 GPa"));
  const std::string header = std::string(kPlaceColumns) + ", 1990-01-01 [degC]\n";
  EXPECT_EQ(refusal(header + "0, 0, 3000, 50, 50, 10, -273\n", FlowQuantity::temperature), "");
  for (const char* value : {"1e300", "1727", "-274"})
    EXPECT_THAT(
        refusal(header + "0, 0, 3000, 50, 50, 10, " + value + "\n", FlowQuantity::temperature),
        HasSubstr("is not within 0 K to 2000 K"));
}

TEST(FlowCsv, SaysAWrongUnitOnceAndHowTheQuantityIsHeaded) {
  const std::string places = kPlaceColumns;
  const std::string said =
      refusal(places + ", 1990-01-01 [bar], 1991-01-01 [bar]\n", FlowQuantity::temperature);
  EXPECT_THAT(said, HasSubstr("\"1990-01-01 [bar]\" does not hold a temperature;"));
  EXPECT_THAT(said, HasSubstr("1990-01-01 [degC]"));
  EXPECT_THAT(said, testing::Not(HasSubstr("1991")));
  EXPECT_THAT(refusal(places + ", 1990-01-01 [bar] change\n"),
              HasSubstr("ends with \"change\" after its unit"));
}

TEST(FlowCsv, TellsTheSizesOfARegularGrid) {
  const FlowField all = parse_flow_csv(
      "x [m], y [m], depth [m], 1990-01-01 [bar]\n"
      "0, 0, 3000, 300\n100, 0, 3000, 301\n0, 60, 3000, 302\n100, 60, 3000, 303\n"
      "0, 0, 3010, 304\n100, 0, 3010, 305\n0, 60, 3010, 306\n",
      "points");
  ASSERT_EQ(all.cells.size(), 7U);
  EXPECT_EQ(all.cells[0].low, Eigen::Vector3d(-50, -30, -3005));
  EXPECT_EQ(all.cells[0].high, Eigen::Vector3d(50, 30, -2995));
  EXPECT_EQ(all.cells[3].low, Eigen::Vector3d(50, 30, -3005)) << "alone in its column";
  EXPECT_EQ(all.cells[6].high, Eigen::Vector3d(50, 90, -3005));
  const FlowField some = parse_flow_csv(
      "dx [m]; y [km]; x [km]; 1990-01-01 [bar]\n70; 0; 0; 300\n50; 0.06; 1; 301\n", "sections");
  EXPECT_EQ(some.cells[0].low.head<2>(), Eigen::Vector2d(-35, -30));
  EXPECT_EQ(some.cells[1].high.head<2>(), Eigen::Vector2d(1025, 90));
  EXPECT_LT(some.cells[0].low.z(), -20e3) << "at all depths";
  EXPECT_GT(some.cells[0].high.z(), 20e3);
  EXPECT_EQ(pressure_doubt(some), "");
}

TEST(FlowCsv, LaysRoundedCentresSideBySide) {
  const FlowField field = parse_flow_csv(
      "date, x [m], y [m], dy [m], pressure [bar]\n1990-01-01, 0, 0, 9, 300\n"
      "1990-01-01, 66.7, 0, 9, 301\n1990-01-01, 133.3, 0, 9, 302\n",
      "thirds");
  EXPECT_EQ(field.cells[0].high.x(), field.cells[1].low.x());
  EXPECT_EQ(field.cells[1].high.x(), field.cells[2].low.x());
}

TEST(FlowCsv, RefusesPointsWhoseSizesItCannotTell) {
  const std::string header = "x [m], y [m], depth [m], dx [m], 1990-01-01 [bar]\n";
  const std::string single = refusal(header + "0, 5, 3000, 9, 300\n");
  EXPECT_THAT(single, HasSubstr("flow.csv:2: y has a single value, 5 m, and no neighbour"));
  EXPECT_THAT(single, HasSubstr("flow.csv:2: depth has a single value"));
  EXPECT_THAT(single, HasSubstr("add a column dz [m], or leave depth out"));
  EXPECT_THAT(refusal("x [m], y [m], dz [m], 1990-01-01 [bar]\n"), HasSubstr("none of depth"));
  EXPECT_THAT(refusal("x [m], x [m], 1990-01-01 [bar]\n"), HasSubstr("two columns x"));
  EXPECT_THAT(refusal("x [m], 1990-01-01 [bar]\n"), HasSubstr("no column y"));
  EXPECT_THAT(refusal("x [m], y [m], 1990-01-01 [bar], depth [m]\n"),
              HasSubstr("\"depth\" is neither a date nor"));
}

TEST(PressureDoubt, TellsPsiReadAsBar) {
  FlowField field = parse_flow_csv(wide("0, 0, 3000, 50, 50, 10, 350, 340\n"), "good");
  EXPECT_EQ(pressure_doubt(field), "");
  field.value *= 14.5038;
  EXPECT_THAT(pressure_doubt(field), HasSubstr("16.9 times hydrostatic"));
  field.value /= 14.5038 * 14.5038;
  EXPECT_THAT(pressure_doubt(field), HasSubstr("bar read as psi"));
}

}  // namespace
}  // namespace faultsim
