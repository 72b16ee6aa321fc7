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

std::string refusal(const std::string& text) {
  try {
    parse_flow_csv(text, "flow.csv");
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
  EXPECT_THAT(text, HasSubstr("flow.csv:2: \"NaN\" in column 8 is not a number"));
  EXPECT_THAT(text, HasSubstr("flow.csv:3: dx is 0"));
  EXPECT_THAT(text, HasSubstr("flow.csv:4: has 2 values for 8 columns"));
  EXPECT_THAT(text, HasSubstr("flow.csv:5: the pressure -1 is below zero"));
}

TEST(FlowCsv, RefusesTimeThatGoesBackwardsAndCellsThatAreMissing) {
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1995-01-01 [bar], 1990-01-01 [bar]\n"),
              HasSubstr("1990-01-01 does not come after the one before"));
  const std::string first = "1990-01-01, 0, 0, 3000, 50, 50, 10, 350\n";
  const std::string other = "1990-01-01, 50, 0, 3000, 50, 50, 10, 350\n";
  const std::string later = "1991-01-01, 0, 0, 3000, 50, 50, 10, 350\n";
  EXPECT_THAT(refusal(long_form(first + later + other)), HasSubstr("flow.csv:4: the date"));
  EXPECT_THAT(refusal(long_form(first + other + later)),
              HasSubstr("1 of 2 cells are missing at 1991-01-01"));
  EXPECT_THAT(refusal(long_form(first + first)), HasSubstr("flow.csv:3: the cell is there twice"));
}

TEST(FlowCsv, RefusesHeadersThatDoNotSayWhatIsThere) {
  EXPECT_THAT(refusal(""), HasSubstr("there are no values"));
  EXPECT_THAT(refusal("x, y\n"), HasSubstr("has 2 columns"));
  EXPECT_THAT(refusal("x [m], y [m], z [m], dx [m], dy [m], dz [m], 1990-01-01 [bar]\n"),
              HasSubstr("column 3 is \"z\" and not depth"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1990-01-01\n"), HasSubstr("has no unit"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", 1990-01-01 [m]\n"),
              HasSubstr("does not hold a pressure"));
  EXPECT_THAT(refusal(std::string(kPlaceColumns) + ", soon [bar]\n"), HasSubstr("is not a date"));
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
