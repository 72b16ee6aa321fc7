#include "campaign/pillars/pillar_table.h"

#include <gtest/gtest.h>

#include <fstream>

namespace faultsweep {
namespace {

using Role = PillarRole;

std::string file_of(const std::string& text) {
  const std::string file = ::testing::TempDir() +
                           ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

PillarTable read(const std::string& text, const ColumnNames& names = {}) {
  return read_pillar_table(file_of(text), names);
}

/// "line: what" of all problems.
std::vector<std::string> problems_of(const std::string& text, const ColumnNames& names = {}) {
  try {
    read(text, names);
  } catch (const faultsim::InputError& error) {
    std::vector<std::string> lines;
    for (const faultsim::Problem& one : error.problems())
      lines.push_back(std::to_string(one.line) + ": " + one.what);
    return lines;
  }
  return {};
}
using Lines = std::vector<std::string>;

TEST(PillarTable, ReadsColumnsInTheirUnits) {
  const PillarTable table = read(
      "\xEF\xBB\xBF# a comment\n"
      "id, fault, x [km], y [m], azimuth [rad], depth [ft], dip_from_horizontal [deg], biot\r\n"
      "A1, \"North\", 200, 5.8e5, 1.5707963267948966, 10000, 70, 0.9\r\n"
      "\n"
      "A2, North, 200.1, 580100, 0, 10010, 71, 1\n");
  ASSERT_EQ(table.n_pillars(), 2u);
  EXPECT_EQ(table.ids, (Lines{"A1", "A2"}));
  EXPECT_EQ(table.faults, (Lines{"North", "North"}));
  EXPECT_EQ(table.lines, (std::vector<long>{3, 5}));
  EXPECT_DOUBLE_EQ(*table.number(Role::x, 0), 200000);
  EXPECT_DOUBLE_EQ(*table.number(Role::azimuth, 0), 90);
  EXPECT_DOUBLE_EQ(*table.number(Role::depth, 0), 3048);
  EXPECT_EQ(table.number(Role::dip_from_horizontal, 1), 71);
  EXPECT_FALSE(table.number(Role::offset, 0));
  ASSERT_EQ(table.parameters.size(), 1u);
  EXPECT_EQ(table.parameters[0].name, "biot");
  EXPECT_EQ(table.parameters[0].values, (std::vector<double>{0.9, 1}));
}

TEST(PillarTable, NamesMapTheColumnsOfOthers) {
  const PillarTable table = read("X_RD,Y_RD,THROW,REMARK\n1,2,30,what ever\n",
                                 {{"x", "X_RD [m]"}, {"y", "Y_RD [m]"}, {"offset", "THROW [ft]"}});
  EXPECT_DOUBLE_EQ(*table.number(Role::offset, 0), 9.144);
  EXPECT_EQ(table.ids, (Lines{"2"}));  // of its line
  EXPECT_EQ(table.ignored, (Lines{"REMARK"}));
}

TEST(PillarTable, SaysAllThatIsWrongAtOnce) {
  EXPECT_EQ(problems_of("x [m], y [m], offset [m], id\n1, 2, deep, A\n1, 2\n1, 2, 3, A\n"),
            (Lines{"3: has 2 values for 4 columns"}));
  EXPECT_EQ(problems_of("x, y [m], y [m]\n"),
            (Lines{"1: column 1 \"x\" has no unit in brackets", "1: \"y\" has two columns"}));
  EXPECT_EQ(problems_of("y [m]\n"), (Lines{"1: there is no column \"x\""}));
  EXPECT_EQ(problems_of("x [m], y [m], thickness_foot [m]\n"),
            (Lines{"1: the thickness is given for one side only, or twice"}));
  EXPECT_EQ(problems_of("x [m], y [m], dip [deg], dip_from_horizontal [deg]\n"),
            (Lines{"1: there are two dips"}));
  EXPECT_EQ(problems_of("x [m], y [m]\n"), (Lines{"0: there are no values"}));
  EXPECT_EQ(problems_of(""), (Lines{"0: there are no values"}));
  EXPECT_EQ(problems_of("X,Y\n1,2\n", {{"x", "X [m]"}, {"y", "YY [m]"}}),
            (Lines{"1: there is no column \"YY\" for y", "1: there is no column \"y\""}));
  EXPECT_EQ(problems_of("x [m], y [m], offset [m] gauge\n"),
            (Lines{"1: column 3 \"offset [m] gauge\" ends with \"gauge\" after its unit"}));
}

TEST(PillarTable, RefusesAPillarWithoutANumberAlone) {
  const PillarTable table = read(
      "id, x [m], y [m], offset [m], biot, remark\n"
      "A, 1, 2, nan, 1, nan\nB, 1, 2, 30, 0.9, inf\nC, 1, 2, , x, \nD, 1e9, 2, 0x10, 1, \n",
      {{"id", "id"}, {"x", "x"}, {"y", "y"}, {"offset", "offset"}, {"biot", "biot"}});
  EXPECT_EQ(table.ids, Lines{"B"});
  EXPECT_EQ(*table.number(Role::offset, 0), 30);
  EXPECT_EQ(table.parameters[0].values, std::vector<double>{0.9});
  ASSERT_EQ(table.refused.size(), 3U);
  EXPECT_EQ(table.refused[0].id, "A");
  EXPECT_EQ(table.refused[0].line, 2);
  EXPECT_EQ(table.refused[0].numbers.at(Role::y), 2);
  EXPECT_FALSE(table.refused[0].numbers.contains(Role::offset));
  const auto whats = [&](std::size_t k) {
    Lines lines;
    for (const faultsim::Problem& one : table.refused[k].problems)
      lines.push_back(one.pointer + ": " + one.what);
    return lines;
  };
  // All that is wrong with a line.
  EXPECT_EQ(whats(0), Lines{"offset: \"nan\" in column 4 \"offset\" is not a number"});
  EXPECT_EQ(whats(1), (Lines{"offset: column 4 \"offset\" is empty",
                             "biot: \"x\" in column 5 \"biot\" is not a number"}));
  EXPECT_EQ(whats(2), (Lines{"x: \"1e9\" in column 2 \"x [m]\" is not within -10000 km to 10000 km",
                             "offset: \"0x10\" in column 4 \"offset\" is not a number"}));
}

TEST(PillarTable, RefusesTheSecondOfAnIdAndADateThatIsNoneAlone) {
  const PillarTable table = read(
      "id, x [m], y [m], last\nA, 1, 2, 1990-01-31\nA, 1, 2, 1991-01-31\nB, 1, 2, 31-01-1990\n"
      "C, 1, 2, 1992-02-29\n",
      {{"id", "id"}, {"x", "x [m]"}, {"y", "y [m]"}, {"until", "last"}});
  EXPECT_EQ(table.ids, (Lines{"A", "C"}));
  EXPECT_EQ(table.until, (Lines{"1990-01-31", "1992-02-29"}));
  EXPECT_EQ(table.heading(Role::until), "last");
  ASSERT_EQ(table.refused.size(), 2U);
  EXPECT_EQ(table.refused[0].line, 3);
  EXPECT_EQ(table.refused[0].problems.at(0).what, "pillar \"A\" is on an earlier line");
  EXPECT_EQ(table.refused[0].problems.at(0).pointer, "id");
  EXPECT_EQ(table.refused[1].problems.at(0).what,
            "\"31-01-1990\" in column 4 \"last\" is not a date");
}

TEST(PillarTable, TakesQuotedCellsWhole) {
  const PillarTable table =
      read("id; fault; x [m]; \"y [m]\"\n\"a;b\"; \"the \"\"new\"\" one\"; 1; \"2\"\n");
  EXPECT_EQ(table.ids, Lines{"a;b"});
  EXPECT_EQ(table.faults, Lines{"the \"new\" one"});
  for (const std::string& odd :
       {std::string(1, '\0'), std::string("\x1b"), std::string("\xE2\x80\xAE")})
    EXPECT_EQ(problems_of("id, x [m], y [m]\nA" + odd + ", 1, 2\n").size(), 1U);
}

TEST(PillarTable, CountsWhatItDoesNotSay) {
  std::string text = "x [m], y [m]\n";
  for (int i = 0; i < 30; ++i) text += "1\n";
  const Lines lines = problems_of(text);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "0: 10 more are wrong in the same way");
}

}  // namespace
}  // namespace faultsweep
