// Levels of a case by what is known of their conditions, and tables of levels.
#include "campaign/answers/escalation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "campaign/common/names.h"

namespace faultsweep {
namespace {

using enum Held;
using ::testing::HasSubstr;

/// Of green (always), amber and red.
std::vector<Held> levels_of(Held amber, Held red) { return levels_held({yes, amber, red}); }

TEST(Levels, ACaseIsAtTheMostSevereOneWhoseConditionHolds) {
  EXPECT_EQ(levels_of(no, no), (std::vector{yes, no, no}));
  EXPECT_EQ(levels_of(yes, no), (std::vector{no, yes, no}));
  EXPECT_EQ(levels_of(yes, yes), (std::vector{no, no, yes}));
  EXPECT_EQ(levels_of(no, yes), (std::vector{no, no, yes}));
}

TEST(Levels, WhatIsUndecidedMayBeAtEveryPossibleLevel) {
  EXPECT_EQ(levels_of(yes, undecided_no), (std::vector{no, undecided_yes, undecided_no}));
  EXPECT_EQ(levels_of(yes, undecided_yes), (std::vector{no, undecided_no, undecided_yes}));
  EXPECT_EQ(levels_of(undecided_yes, no), (std::vector{undecided_no, undecided_yes, no}));
  EXPECT_EQ(levels_of(undecided_no, no), (std::vector{undecided_yes, undecided_no, no}));
  EXPECT_EQ(levels_of(undecided_no, undecided_no),
            (std::vector{undecided_yes, undecided_no, undecided_no}));
  EXPECT_EQ(levels_of(undecided_yes, yes), (std::vector{no, no, yes})) << "red for certain";
}

TEST(Levels, AHistoryThatEndsEarlyMayBeAtEachThatIsNotExcluded) {
  EXPECT_EQ(levels_of(unknown, unknown), (std::vector{unknown, unknown, unknown}));
  EXPECT_EQ(levels_of(yes, unknown), (std::vector{no, unknown, unknown}));
  EXPECT_EQ(levels_of(unknown, yes), (std::vector{no, no, yes})) << "it had slid before";
}

class LevelTables : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "levels_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  EscalationTable read(const std::string& text) {
    std::ofstream(folder_ / "levels.json") << text;
    return read_levels((folder_ / "levels.json").string());
  }
  std::string problem_of(const std::string& levels) {
    try {
      read("{\"format\": 1, \"levels\": " + levels + "}");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::filesystem::path folder_;
};

TEST_F(LevelTables, AreReadWithTheirColours) {
  const EscalationTable table = read(R"({"format": 1, "title": "plan", "levels": [
    {"name": "green", "words": "go on"},
    {"name": "watch", "words": "look", "condition": "chi_bar > 0.8", "colour": "amber"},
    {"name": "stop", "words": "stop", "condition": "slides"}]})");
  ASSERT_EQ(table.levels.size(), 3U);
  EXPECT_EQ(table.title, "plan");
  EXPECT_EQ(table.source, "levels.json");
  EXPECT_EQ(table.levels[0].colour, LevelColour::green);
  EXPECT_EQ(table.levels[1].colour, LevelColour::amber);
  EXPECT_EQ(table.levels[2].colour, LevelColour::grey) << "its name is no colour";
  EXPECT_EQ(table.levels[2].condition, "slides");
}

TEST_F(LevelTables, WithoutALevelForAllOthersHaveOneOfNoLevel) {
  const EscalationTable table = read(R"({"format": 1, "levels": [
    {"name": "amber", "words": "look", "condition": "chi_bar > 0.8"},
    {"name": "red", "words": "stop", "condition": "slides"}]})");
  ASSERT_EQ(table.levels.size(), 3U);
  EXPECT_EQ(table.levels[0].name, "no level");
  EXPECT_EQ(table.levels[0].condition, "");
}

TEST_F(LevelTables, SayWhatIsWrongAndWhere) {
  EXPECT_THAT(problem_of(R"([{"name": "a", "words": "x"}, {"name": "b", "words": "y"}])"),
              HasSubstr("level \"b\" has no condition"));
  EXPECT_THAT(
      problem_of(
          R"([{"name": "a", "words": "x"}, {"name": "a", "words": "y", "condition": "slides"}])"),
      HasSubstr("two levels \"a\""));
  EXPECT_THAT(problem_of(R"([{"name": "a", "words": "x"}, {"name": "b", "word": "y"}])"),
              HasSubstr("word"));
  EXPECT_THAT(problem_of(R"([{"name": "a", "words": "x"}])"), HasSubstr("/levels"));
}

TEST_F(LevelTables, TheExampleIsOne) {
  const EscalationTable table = read_levels(FAULTSIM_SOURCE_DIR "/docs/examples/sheet/levels.json");
  EXPECT_EQ(table.levels.size(), 4U);
  EXPECT_EQ(table.levels.back().colour, LevelColour::red);
}

}  // namespace
}  // namespace faultsweep
