#include "simulator/reading/changed_scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace faultsim {
namespace {

nlohmann::json parsed(const char* text) { return nlohmann::json::parse(text); }

class ChangedSceneTest : public testing::TestWithParam<Relations> {
 protected:
  ChangedSceneTest() { changed_.document = base_; }
  /// Changes the scene at hand, and holds it against the whole document read anew.
  void change(const std::vector<PlacedValue>& values) {
    std::vector<Problem> problems;
    ASSERT_TRUE(change_scene(base_, values, GetParam(), changed_, problems).empty());
    JsonDocument document = base_;
    for (const PlacedValue& one : values)
      ASSERT_TRUE(put_value(document.value, one.pointer, one.value));
    std::vector<Problem> expected;
    const Scene scene = read_scene(document, expected);
    if (GetParam() == Relations::trusted && problems.empty() && !expected.empty()) return;
    ASSERT_EQ(problems.size(), expected.size()) << format_problems("", problems);
    for (std::size_t i = 0; i < problems.size(); ++i) EXPECT_EQ(problems[i].what, expected[i].what);
    EXPECT_EQ(changed_.is_of_base, expected.empty());
    if (expected.empty()) {
      EXPECT_EQ(changed_.document.value, document.value);
      EXPECT_EQ(changed_.canonical.text(), canonical_scene(scene));
    }
  }

  JsonDocument base_ = parse_json(starter_scene("field"), "field");
  ChangedScene changed_;
};

TEST_P(ChangedSceneTest, IsWhatTheWholeDocumentSays) {
  const std::string offset = "/geometry/blocks/1/offset", angle = "/friction/friction_angle";
  change({});
  change({{offset, "80 m"}, {angle, "25 deg"}});
  change({{offset, "80 m"}, {angle, "27 deg"}});
  change({{offset, "-40 m"}, {angle, "27 deg"}});
  change({{angle, "27 deg"}});
  change({{angle, "27 deg"}, {"/materials/salt/youngs_modulus", "31 GPa"}});
  change({{"/fault_pressure", parsed(R"({"rule": "max"})")}});
  change({{"/fault_pressure", parsed(R"({"rule": "min"})")}});
  change({{"/fault_pressure", parsed(R"({"rule": "prescribed", "prescribed": "-9 bar"})")}});
  change({{"/tier", "screening"}});
  change({});
}

TEST_P(ChangedSceneTest, LaterValuesWinWherePlacesMeet) {
  const std::string angle = "/friction/friction_angle";
  change({{angle, "25 deg"}, {angle, "30 deg"}});
  change({{angle, "20 deg"}, {angle, "30 deg"}});
  change(
      {{"/friction", parsed(R"({"friction_angle": "22 deg"})")}, {"/friction/cohesion", "1 MPa"}});
  change(
      {{"/friction", parsed(R"({"friction_angle": "23 deg"})")}, {"/friction/cohesion", "1 MPa"}});
}

TEST_P(ChangedSceneTest, WordsInPlaceOfWordsAreRead) {
  for (const char* rule : {"mean", "max", "min", "max"}) change({{"/fault_pressure/rule", rule}});
}

/// What a list was read as must not be taken for what the next one has in the memory that it left:
/// tables of up to six times, whose factors are numbers without a unit.
TEST_P(ChangedSceneTest, ListsInPlaceOfListsAreRead) {
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    nlohmann::json table;
    const auto last = static_cast<int>(random() % 6);
    for (int k = 0; k <= last; ++k) {
      table["time"].push_back(std::to_string(k + 1) + " year");
      table["factor"].push_back(0.001 * (n + k));
    }
    change({{"/fault_pressure",
             {{"rule", "prescribed"}, {"prescribed", "-9 bar"}, {"table", table}}}});
  }
}

TEST_P(ChangedSceneTest, AWrongValueIsSaidAndForgotten) {
  const std::string angle = "/friction/friction_angle";
  change({{angle, "25 deg"}});
  change({{angle, "25 m"}});
  change({{angle, "26 deg"}});
  change({{angle, "260 deg"}});
  change({{angle, 25}});
  change({{angle, "25 deg"}});
}

/// Pressures that are not given as changes are held against the initial ones.
TEST_P(ChangedSceneTest, TheInitialPressureMovesHistoriesOfAbsolutePressure) {
  auto& stage = base_.value["stages"][0];
  stage.erase("pressure_change");
  stage["pressure"] = "150 bar";
  changed_.document = base_;
  change({{"/initial_state/ratio_across", 0.7}});
  change({{"/initial_state/water_density", "1200 kg/m3"}});
  change({{"/initial_state/water_density", "1100 kg/m3"}});
  change({{"/geometry/blocks/1/offset", "60 m"}});
}

/// Pressures are given by the names of regions, and held by their numbers.
TEST_P(ChangedSceneTest, RegionsOfOtherNamesHaveTheirPressuresAgain) {
  base_.value["stages"][0]["pressure_change"] = {{"west", "-100 bar"}, {"east", "-200 bar"}};
  changed_.document = base_;
  const std::string west = "/geometry/blocks/0/name", east = "/geometry/blocks/1/name";
  change({});
  change({{west, "east"}, {east, "west"}});
  change({{west, "west"}, {east, "east"}});
  change({{west, "east"}, {east, "west"}, {"/friction/friction_angle", "27 deg"}});
}

TEST_P(ChangedSceneTest, MoreRegionsHavePressuresToo) {
  nlohmann::json blocks = base_.value["geometry"]["blocks"], faults = base_.value["faults"];
  blocks.push_back({{"name", "far east"}, {"from", "2000 m"}, {"to", "4000 m"}});
  faults.push_back({{"name", "F4"}});
  change({});
  change({{"/geometry/blocks", blocks}, {"/faults", faults}});
  change({});
}

/// Whether creep may be left out depends on the rules of faults and on the initial state too.
TEST_P(ChangedSceneTest, WhatMayKeepCreepIsSaidAgain) {
  base_ = parse_json(starter_scene("box"), "box");
  base_.value["materials"]["rock"]["viscosity"] = "1e17 Pa s";
  base_.value["tables"]["p.csv"] = std::vector<std::string>{
      "depth [m], 0 year [bar], 10 year [bar]", "1000, 0, 9", "3000, 0, 9"};
  changed_.document = base_;
  change({});
  change({{"/fault_pressure", {{"rule", "table"}, {"csv", "p.csv"}}}});
  change({{"/fault_pressure/rule", "max"}});
  change({{"/initial_state/pressure", "600 bar"}});
  change({{"/initial_state/pressure", "0 bar"}});
}

TEST_P(ChangedSceneTest, ABoxHasItsPatchesAgain) {
  base_ = parse_json(starter_scene("box"), "box");
  changed_.document = base_;
  change({{"/faults/0/length", "900 m"}});
  change({{"/faults/0/length", "800 m"}});
  change({{"/geometry/from", parsed(R"(["-2000 m", "-2000 m", "-4000 m"])")}});
}

/// The geometry says how far faults reach.
TEST_P(ChangedSceneTest, AFieldHasTheExtentsOfItsFaultsAgain) {
  change({{"/faults/0/length", "2 km"}});
  change({{"/faults/0/length", "1 km"}});
  change({{"/faults/1/overshoot", "200 m"}});
  change({{"/geometry/fault_length", "3 km"}, {"/faults/1/y_to", "1500 m"}});
  change({{"/geometry/fault_length", "2 km"}, {"/faults/1/y_to", "1500 m"}});
  change({{"/friction/friction_angle", "27 deg"}});
  change({{"/faults/0/length", "2 km"}});
  change({});
}

/// How far faults reach decides the intervals of a surface over an offset.
TEST_P(ChangedSceneTest, ASurfaceHasItsIntervalsAgain) {
  base_.value["geometry"]["blocks"][1]["offset"] = "62 m";
  base_.value["numerics"]["surface"] = {
      {"over", {{{"parameter", "/geometry/blocks/1/offset"}, {"from", "60 m"}, {"to", "120 m"}}}}};
  changed_.document = base_;
  change({{"/faults/1/overshoot", "190 m"}});
  change({{"/faults/1/overshoot", "170 m"}});
  change({{"/faults/1/overshoot", "170 m"}, {"/geometry/blocks/1/offset", "90 m"}});
}

TEST(ChangedScene, SaysWhatHasNoPlace) {
  const JsonDocument base = parse_json(starter_scene("field"), "field");
  ChangedScene changed;
  changed.document = base;
  std::vector<Problem> problems;
  EXPECT_EQ(change_scene(base, {{"/faults/99/name", "x"}}, Relations::checked, changed, problems),
            std::vector<std::string>{"/faults/99/name"});
  EXPECT_FALSE(changed.is_of_base);
  EXPECT_TRUE(change_scene(base, {}, Relations::checked, changed, problems).empty());
  EXPECT_TRUE(changed.is_of_base);
}

INSTANTIATE_TEST_SUITE_P(Relations, ChangedSceneTest,
                         testing::Values(Relations::checked, Relations::trusted));

}  // namespace
}  // namespace faultsim
