// Load steps contain the turning points of everything that acts, and nothing else changes them.
#include "simulator/initial_state/load_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulator/initial_state/pressure_history.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

/// A box with the regions west and east, one stage of 6 years in yearly steps, and no loads yet.
JsonDocument six_years() {
  JsonDocument document = parse_json(starter_scene("box"), "box.json");
  document.value["stages"] = {{{"name", "all"}, {"duration", "6 year"}, {"steps", 6}}};
  document.value["geometry"]["regions"] = nlohmann::json::array();
  for (const char* name : {"west", "east"}) {
    document.value["geometry"]["regions"].push_back({{"name", name},
                                                     {"from", {"-100 m", "-100 m", "-2100 m"}},
                                                     {"to", {"100 m", "100 m", "-2000 m"}}});
  }
  document.value.erase("fault_pressure");
  document.value.erase("pressure_csv");
  document.value.erase("compartments");
  return document;
}

/// Ends of the steps of a scene with this history (years, bar) of west, years.
std::vector<double> step_years(Scene scene, const std::vector<double>& years,
                               const std::vector<double>& bars) {
  scene.pressure[0].time.clear();
  scene.pressure[0].pressure_change.clear();
  for (std::size_t i = 0; i < years.size(); ++i) {
    scene.pressure[0].time.push_back(years[i] * kYear);
    scene.pressure[0].pressure_change.push_back(bars[i] * 1e5);
  }
  std::vector<double> ends;
  for (const StepEnd& end : step_ends(scene)) ends.push_back(end.time / kYear);
  return ends;
}

TEST(StepEnds, AreThoseOfTheStagesWhereNothingTurnsBetweenThem) {
  const Scene scene = varied(six_years());
  const std::vector<double> yearly = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(step_years(scene, {}, {}), yearly);
  EXPECT_EQ(step_years(scene, {6}, {-100}), yearly);
  EXPECT_EQ(step_years(scene, {2.5, 6}, {-10, -100}), yearly) << "a kink is not a turning point";
  EXPECT_EQ(step_years(scene, {2.5, 3.5, 6}, {-100, -100, -100}), yearly);
  EXPECT_EQ(step_years(scene, {2, 6}, {-100, -50}), yearly) << "it turns where a step ends";
  EXPECT_EQ(step_years(scene, {1.9, 2.1, 6}, {-100, -100, -50}), yearly)
      << "a step lies on the plateau";
  EXPECT_EQ(step_years(scene, {2.004, 6}, {-100, -50}), yearly) << "a date a day off";
  EXPECT_EQ(step_years(scene, {1.996, 6}, {-100, -50}), yearly);
  EXPECT_EQ(step_years(scene, {6.5, 9}, {-100, -50}), yearly) << "beyond the stages";
}

TEST(StepEnds, ContainEveryPeakAndTrough) {
  using ::testing::ElementsAre;
  const Scene scene = varied(six_years());
  EXPECT_THAT(step_years(scene, {2.5, 6}, {-100, -50}), ElementsAre(1, 2, 2.5, 3, 4, 5, 6));
  EXPECT_THAT(step_years(scene, {0.25, 0.5, 0.75, 6}, {-10, 0, -10, 50}),
              ElementsAre(0.25, 0.5, 0.75, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(step_years(scene, {2.25, 2.75, 6}, {-100, -100, -50}),
              ElementsAre(1, 2, 2.25, 3, 4, 5, 6))
      << "a plateau is cut where it begins";
}

TEST(StepEnds, FollowScaleAndLag) {
  Scene scene = varied(six_years());
  scene.pressure[0].lag = 0.25 * kYear;
  EXPECT_THAT(step_years(scene, {2, 6}, {-100, -50}),
              ::testing::ElementsAre(1, 2, 2.25, 3, 4, 5, 6));
  scene.pressure[0].scale = -1;
  EXPECT_EQ(step_years(scene, {2, 6}, {-100, -50}).size(), 7U);
  scene.pressure[0].scale = 0;
  EXPECT_EQ(step_years(scene, {2, 6}, {-100, -50}).size(), 6U) << "it does not act";
}

TEST(StepEnds, CutOnceWhereTwoLoadsTurnTogether) {
  Scene scene = varied(six_years());
  scene.pressure[1].time = {2.502 * kYear, 6 * kYear};
  scene.pressure[1].pressure_change = {-1e6, 0};
  EXPECT_EQ(step_years(scene, {2.5, 6}, {-100, -50}).size(), 7U);
  scene.pressure[1].time[0] = 2.6 * kYear;
  EXPECT_EQ(step_years(scene, {2.5, 6}, {-100, -50}).size(), 8U);
}

TEST(StepEnds, ContainTheTurnsOfTablesThatAct) {
  const std::string table = R"({"time": ["0 year", "1.5 year", "6 year"], "factor": [0, 1, 0]})";
  const auto steps = [&](const std::string& pointer,
                         const std::vector<std::pair<std::string, std::string>>& more) {
    auto changes = more;
    changes.emplace_back(pointer, table);
    return step_ends(varied(six_years(), changes)).size();
  };
  const std::pair<std::string, std::string> rule{"/fault_pressure/rule", "prescribed"};
  const std::pair<std::string, std::string> some{"/fault_pressure/prescribed", "-10 bar"};
  EXPECT_EQ(steps("/fault_pressure/table", {rule, some}), 7U);
  EXPECT_EQ(steps("/fault_pressure/table", {rule, {"/fault_pressure/prescribed", "0 bar"}}), 6U);
  const std::string moved =
      R"([{"sides": ["x-"], "kind": "displacement", "components": ["x"],
           "translation": ["1 m", "0 m", "0 m"], "table": )" +
      table + "}]";
  EXPECT_EQ(step_ends(varied(six_years(), {{"/geometry/boundary", moved}})).size(), 7U);
}

TEST(StepEnds, HaveTheLengthsOfTheirStagesToTheLastBitUnlessCut) {
  Scene scene = varied(six_years(), {{"/stages/0/steps", "7"}});
  scene.pressure[0].time = {2.5 * kYear, 6 * kYear};
  scene.pressure[0].pressure_change = {-1e6, 0};
  double before = 0;
  for (const StepEnd& end : step_ends(scene)) {
    EXPECT_NEAR(end.length, end.time - before, 1e-6);
    const bool cut = end.time > 2 * kYear && end.time < 2.6 * kYear;
    if (!cut) {
      EXPECT_EQ(end.length, 6 * kYear / 7);
    }
    before = end.time;
  }
  EXPECT_EQ(before, 6 * kYear);
}

TEST(TurningPoints, AreReportedInsteadWhenAskedTo) {
  JsonDocument document = six_years();
  document.value["stages"][0]["steps"] = 2;
  document.value["stages"][0]["cycles"] = 1;
  document.value["stages"][0]["pressure_between"] = {"-20 bar", "0 bar"};
  document.value["compartments"]["west"]["lag"] = "1.5 year";
  EXPECT_EQ(step_ends(varied(document)).size(), 3U);
  EXPECT_THAT(skipped_turning_points(varied(document)), ::testing::IsEmpty());
  const Scene scene = varied(document, {{"/numerics/turning_points", "report"}});
  EXPECT_EQ(step_ends(scene).size(), 2U);
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_EQ(remark_text(scene.remarks[0]),
            "load step 2 skips a turning point: the pressure of west reaches -20 bar at 4.5 year");
  EXPECT_NE(case_identity(scene), case_identity(varied(document)));
}

TEST(TurningPoints, AreRefusedBeyondTheirLimit) {
  JsonDocument document = six_years();
  document.value["stages"][0]["steps"] = 12;
  document.value["stages"][0]["cycles"] = 6;
  document.value["stages"][0]["pressure_between"] = {"-20 bar", "0 bar"};
  document.value["compartments"]["west"]["lag"] = "0.25 year";
  EXPECT_EQ(step_ends(varied(document)).size(), 12U + 11U);
  try {
    varied(document, {{"/numerics/max_added_steps", "10"}});
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("/numerics/max_added_steps: the loads turn at 11 times "
                                     "between load steps, first at 0.75 year; steps are added "
                                     "for at most 10"));
  }
  EXPECT_NO_THROW(varied(document, {{"/numerics/max_added_steps", "11"}}));
  EXPECT_NO_THROW(varied(
      document, {{"/numerics/max_added_steps", "10"}, {"/numerics/turning_points", "report"}}));
}

}  // namespace
}  // namespace faultsim
