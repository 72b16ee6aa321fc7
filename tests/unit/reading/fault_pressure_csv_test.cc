// Tables of fault pressure over place and time.
#include "simulator/reading/fault_pressure_csv.h"

#include <gmock/gmock.h>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kYear = 365.25 * 86400;

FaultPressureCsv parse(const std::string& text) {
  return parse_fault_pressure_csv(text, "pf.csv", std::nullopt);
}

/// What is said of it; "" = it is read.
std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FaultPressureCsv, HoldsChangesSinceItsFirstColumn) {
  const FaultPressureCsv csv = parse(
      "# of a flow simulator\n"
      "depth [km], 0 year [bar], 1 year [bar], 2 year [bar], 4 year [bar]\n"
      "3.1, 310, 300, 290, 290\n\n"
      "3, 300, 280, 260, 200\n");
  EXPECT_EQ(csv.table.place, FaultPressureTable::Place::depth);
  EXPECT_THAT(csv.table.dip, ElementsAre(3000, 3100));
  EXPECT_TRUE(csv.table.strike.empty());
  EXPECT_THAT(csv.table.time, ElementsAre(0, kYear, 2 * kYear, 4 * kYear));
  EXPECT_THAT(csv.table.change, ElementsAre(0, -2e6, -4e6, -10e6, 0, -1e6, -2e6, -2e6));
  EXPECT_THAT(csv.table.turns, ElementsAre(0, 2 * kYear, 4 * kYear));
}

TEST(FaultPressureCsv, MayVaryAlongStrikeAndHaveDates) {
  const FaultPressureCsv csv = parse(
      "along_dip [m], along_strike [m], 1990-01-01 [MPa], 1990-01-03 [MPa]\n"
      "-10, 5, 0, 3\n-10, -5, 0, 1\n10, -5, 0, 2\n10, 5, 0, 4\n");
  EXPECT_TRUE(csv.has_dates);
  EXPECT_EQ(csv.table.place, FaultPressureTable::Place::along_dip);
  EXPECT_THAT(csv.table.strike, ElementsAre(-5, 5));
  EXPECT_THAT(csv.table.time, ElementsAre(0, 2 * 86400));
  EXPECT_THAT(csv.table.change, ElementsAre(0, 1e6, 0, 3e6, 0, 2e6, 0, 4e6));
}

TEST(FaultPressureCsv, IsRefusedWithItsLine) {
  const std::string header = "depth [m], 0 year [bar], 1 year [bar]\n";
  EXPECT_THAT(refusal(""), HasSubstr("there are no values"));
  EXPECT_THAT(refusal("z [m], 0 year [bar], 1 year [bar]\n"), HasSubstr("first column is \"z\""));
  EXPECT_THAT(refusal("depth [bar], 0 year [bar], 1 year [bar]\n"), HasSubstr("a length"));
  EXPECT_THAT(refusal("depth [m], 0 year [m], 1 year [bar]\n"), HasSubstr("a pressure"));
  EXPECT_THAT(refusal("depth [m], 1 year [bar], 2 year [bar]\n"), HasSubstr("not at time 0"));
  EXPECT_THAT(refusal("depth [m], 0 year [bar], 2 year [bar], 1 year [bar]\n"),
              HasSubstr("the time 1 year does not come after"));
  EXPECT_THAT(refusal("depth [m], 0 year [bar], 1990-01-01 [bar]\n"), HasSubstr("dates"));
  EXPECT_THAT(refusal("depth [m], 0 year [bar], 1 year [bar] gauge\n"),
              HasSubstr("ends with \"gauge\" after its unit"));
  EXPECT_THAT(refusal("depth [m], 0 year [bar], 1e300 year [bar]\n"),
              HasSubstr("neither a time nor a date"));
  EXPECT_THAT(refusal(header + "3000, 1, 1e9\n"),
              HasSubstr("pf.csv:2: \"1e9\" in column 3 \"1 year [bar]\" is not within -10 GPa to"));
  EXPECT_THAT(refusal(header + "3000, 0x10, 1\n3e9, 0, 0\n"),
              AllOf(HasSubstr("pf.csv:2: \"0x10\""), HasSubstr("pf.csv:3: \"3e9\"")));
  EXPECT_THAT(refusal(header + "3000, 1\n"), HasSubstr("pf.csv:2: has 2 values for 3"));
  EXPECT_THAT(refusal(header + "3000, 1, nan\n"),
              HasSubstr("\"nan\" in column 3 \"1 year\" is not a number"));
  EXPECT_THAT(refusal(header + "3000, 1, 2\n3000, 1, 3\n"), HasSubstr("the place is given twice"));
  EXPECT_THAT(refusal("depth [m], along_strike [m], 0 year [bar], 1 year [bar]\n"
                      "1, 1, 0, 0\n1, 2, 0, 0\n2, 1, 0, 0\n"),
              HasSubstr("3 places for 2 values of depth and 2"));
}

}  // namespace
}  // namespace faultsim
