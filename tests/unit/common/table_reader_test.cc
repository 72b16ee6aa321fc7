// The one reader of tables with units: what cells are, and what is never taken for a number.
#include "simulator/common/table_reader.h"

#include <gmock/gmock.h>

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Rows = std::vector<std::vector<std::string>>;

std::string all_of(const TableReader& reader) {
  try {
    reader.require_sound();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The header and the rows of a table that is sound.
Rows cells_of(const std::string& text) {
  TableReader reader(text, "t.csv");
  Rows rows(1);
  for (const TableColumn& column : reader.columns()) rows[0].push_back(column.text);
  while (reader.next_row()) {
    rows.emplace_back();
    for (std::size_t i = 0; i < rows[0].size(); ++i) rows.back().emplace_back(reader.cell(i));
  }
  EXPECT_EQ(all_of(reader), "");
  return rows;
}

/// What is said of a table whose columns are lengths.
std::string refusal(const std::string& text, const std::vector<std::string>& words = {}) {
  TableReader reader(text, "t.csv");
  for (std::size_t i = 0; i < reader.columns().size(); ++i)
    reader.set_unit(i, Dimension::length, kLengthRange, "head it x [m]", words);
  while (reader.next_row()) {
    for (std::size_t i = 0; i < reader.columns().size(); ++i) reader.value(i);
  }
  return all_of(reader);
}

TEST(TableReader, TakesLinesAndSeparatorsAsProgramsWriteThem) {
  const Rows expected = {{"a", "b"}, {"1", "2"}, {"3", "4"}};
  for (const char* text :
       {"a,b\n1,2\n3,4\n", "a, b\n1,\t2\n 3 ,4",
        "\xEF\xBB\xBF"
        "a,b\r\n1,2\r\n3,4\r\n",
        "a,b\r1,2\r3,4\r", "# of a;\ta, \"b\n\n a;b\n1;2\n   \n#,\n3;4\n", "a\tb\n1\t2\n3\t4\n",
        "a,\t b\n1,2\n3,4\n", "\"a\",\"b\"\n\"1\" , 2\n3,\"4\"\n", "# \xFF\na,b\n1,2\n3,4\n"})
    EXPECT_EQ(cells_of(text), expected) << text;
  EXPECT_EQ(cells_of("a;\"b;,\"\n\"1;\"\"2\"\"\";\"\"\n"), (Rows{{"a", "b;,"}, {"1;\"2\"", ""}}));
  EXPECT_EQ(cells_of("a,,b\n,,\n"), (Rows{{"a", "", "b"}, {"", "", ""}}));
  EXPECT_EQ(cells_of(""), Rows(1));
  EXPECT_EQ(cells_of("\xEF\xBB\xBF"), Rows(1));
}

TEST(TableReader, CountsLinesWhateverEndsThem) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "# one" + end + end + "a,b" + end + "1,2" + end + end + "1" + end;
    TableReader reader(text, "t.csv");
    EXPECT_EQ(reader.line(), 3);
    ASSERT_TRUE(reader.next_row());
    EXPECT_EQ(reader.line(), 4);
    EXPECT_FALSE(reader.next_row());
    EXPECT_THAT(all_of(reader), HasSubstr("t.csv:6: has 1 value for 2 columns"));
  }
}

TEST(TableReader, SplitsHeadingsIntoNameUnitAndWords) {
  const auto expect = [](const char* text, const char* name, std::optional<std::string> unit,
                         const char* words) {
    const TableColumn column = table_column(text);
    EXPECT_EQ(column.name, name);
    EXPECT_EQ(column.unit, unit);
    EXPECT_EQ(column.words, words);
  };
  expect(" west [ bar ] absolute ", "west", "bar", "absolute");
  expect("west[bar]", "west", "bar", "");
  expect("west", "west", std::nullopt, "");
  expect("w[1] [m]", "w[1]", "m", "");
  expect("w ]m[", "w ]m[", std::nullopt, "");
  expect("[m]", "", "m", "");
}

TEST(TableReader, ReadsNumbersInTheirUnits) {
  TableReader reader("x [km], p [bar], t [degC], f [degF], n\n+1.5, .5, 10, 50, 1e-320\n", "t.csv");
  EXPECT_TRUE(reader.set_unit(0, Dimension::length, kLengthRange, "cure"));
  EXPECT_TRUE(reader.set_unit(1, Dimension::pressure, kPressureRange, "cure"));
  EXPECT_TRUE(reader.set_unit(2, Dimension::temperature, kTemperatureRange, "cure"));
  EXPECT_TRUE(reader.set_unit(3, Dimension::temperature, kTemperatureRange, "cure"));
  ASSERT_TRUE(reader.next_row());
  EXPECT_EQ(reader.number(0), 1.5);
  EXPECT_EQ(reader.value(0), 1500);
  EXPECT_EQ(reader.value(1), 5e4);
  EXPECT_EQ(reader.value(2), 283.15);
  EXPECT_NEAR(*reader.value(3), 283.15, 1e-9);
  EXPECT_EQ(reader.value(4), 1e-320);
}

TEST(TableReader, TakesNothingElseForANumber) {
  for (const std::string cell : {"0x10",
                                 "0X1p3",
                                 "inf",
                                 "-inf",
                                 "nan",
                                 "-nan",
                                 "NaN",
                                 "Infinity",
                                 "1e999",
                                 "-1e999",
                                 "6 bar",
                                 "1.2.3",
                                 "1 2",
                                 "--1",
                                 "+-1",
                                 "1e",
                                 "e5",
                                 "-",
                                 "1_000",
                                 "1'000",
                                 "0b1",
                                 "1d5",
                                 "\xC2\xA0"
                                 "1"})
    EXPECT_THAT(refusal("x [m]\n1\n" + cell + "\n"), HasSubstr("t.csv:3: ")) << cell;
  EXPECT_THAT(
      refusal("x [m]; y [m]\n1; 2,5\n"),
      HasSubstr("t.csv:2: \"2,5\" in column 2 \"y\" has a decimal comma; write decimal points"));
  EXPECT_THAT(refusal("x [m], y [m]\n1, \n"), HasSubstr("t.csv:2: column 2 \"y\" is empty"));
}

TEST(TableReader, RefusesWhatIsOutOfRange) {
  EXPECT_EQ(refusal("x [km]\n-10000\n10000\n"), "");
  EXPECT_THAT(
      refusal("x [km]\n10001\n"),
      HasSubstr("t.csv:2: \"10001\" in column 1 \"x [km]\" is not within -10000 km to 10000 "
                "km; write values of -10000 km to 10000 km"));
  EXPECT_THAT(refusal("x [km]\n1e308\n"), HasSubstr("is not within"));
}

TEST(TableReader, RefusesCharactersThatAreNoneAndQuotesThatDoNotClose) {
  using namespace std::string_literals;
  EXPECT_THAT(refusal("x [m]\n19\0"
                      "136.2\n"s),
              HasSubstr("t.csv:2: contains \"\\u0000\""));
  EXPECT_THAT(refusal("x\x1b [m]\n1\n"), HasSubstr("t.csv:1: contains \"\\u001b\""));
  EXPECT_THAT(refusal("x [m]\n1\xFF\n"), HasSubstr("t.csv:2: contains \"\\xff\""));
  EXPECT_THAT(refusal("x [m]\n1\xE2\x80\xAE\n"), HasSubstr("t.csv:2: contains \"\\u202e\""));
  EXPECT_THAT(refusal("\xFF\xFEx\0 \0"s), HasSubstr("t.csv:1: contains \"\\xff\""));
  for (const char* row : {"\"1", "\"1\"\"", "\"", "1\"", "\"1\"2", "1\"\"", "\"1\" \"2\""})
    EXPECT_THAT(refusal("x [m]\n" + std::string(row) + "\n3\n"), HasSubstr("t.csv:2: has a quote"))
        << row;
}

TEST(TableReader, RefusesWordsBehindAUnitThatMeanNothing) {
  EXPECT_THAT(refusal("x [m] gauge\n1\n"),
              HasSubstr("t.csv:1: column 1 \"x [m] gauge\" ends with \"gauge\" after its unit; "
                        "head it x [m]"));
  EXPECT_EQ(refusal("x [m] below\n1\n", {"below"}), "");
  EXPECT_THAT(refusal("x\n1\n"), HasSubstr("has no unit in brackets"));
  EXPECT_THAT(refusal("x [bar]\n1\n"), HasSubstr("does not hold a length"));
  EXPECT_THAT(refusal("x [degC]\n1\n"), HasSubstr("does not hold a length"));
  EXPECT_THAT(refusal("x []\n1\n"), HasSubstr("does not hold a length"));
}

TEST(TableReader, ShortensWhatIsLongAndCountsWhatIsMuch) {
  std::string text = "x [m]\n";
  for (int i = 0; i < 1000; ++i) text += "a\n";
  const std::string said = refusal(text);
  EXPECT_THAT(said, HasSubstr("980 more are wrong in the same way"));
  EXPECT_LT(said.size(), 6000U);
  EXPECT_LT(refusal(std::string(10'000'000, 'x') + "\n1\n").size(), 500U);
  EXPECT_THAT(refusal(std::string(10'000'000, ',') + "\n1\n"), HasSubstr("has 10000001 columns"));
}

}  // namespace
}  // namespace faultsim
