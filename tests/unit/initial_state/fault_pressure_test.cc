// What the scene alone says of the pressure in faults: where a given one falls below zero, and
// tables that miss their fault or end before the history does.
#include "simulator/initial_state/fault_pressure.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box from 0 to 3000 m depth with a fault down to 700 m and p0 = 10 kPa/m · depth.
json shallow_box() {
  json scene = json::parse(starter_scene("box"));
  scene["geometry"]["to"][2] = "0 m";
  scene["geometry"]["regions"][0]["from"][2] = "-400 m";
  scene["geometry"]["regions"][0]["to"][2] = "-187 m";
  scene["faults"][0]["center"][2] = "-400 m";
  scene["stages"][0].erase("pressure_change");
  return scene;
}

json prescribed(const std::string& change) {
  return {{"rule", "prescribed"}, {"prescribed", change}};
}

/// With a table of the fault's pressure: its lines.
json tabled(json scene, const std::vector<std::string>& lines) {
  scene["fault_pressure"] = {{"rule", "table"}, {"csv", "inj.csv"}};
  scene["tables"]["inj.csv"] = lines;
  return scene;
}

/// The same box with nothing but the fault's own pressure.
json bare_box() {
  json scene = shallow_box();
  scene["geometry"].erase("regions");
  return scene;
}

std::string problems_of(const json& scene) {
  try {
    read_scene(parse_json(scene.dump(), "test"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> remarks_of(const json& scene) {
  std::vector<std::string> texts;
  for (const Remark& remark : read_scene(parse_json(scene.dump(), "test")).remarks)
    texts.push_back(remark_text(remark));
  return texts;
}

TEST(GivenFaultPressure, BelowZeroBesideARegionOfABoxIsRefused) {
  json scene = shallow_box();
  scene["fault_pressure"] = prescribed("-100 bar");
  // Reached linearly over ten steps: −20 bar in the second are below 18.7.
  EXPECT_THAT(problems_of(scene),
              HasSubstr("the pressure in fault \"F1\" falls to -1.3 bar at 187 m depth in step 2"));
  scene["fault_pressure"] = prescribed("-18.7 bar");
  EXPECT_EQ(problems_of(scene), "");
}

TEST(GivenFaultPressure, CountsRegionsThatTouchTheFaultAlone) {
  json scene = shallow_box();
  scene["fault_pressure"] = prescribed("-30 bar");
  EXPECT_NE(problems_of(scene), "");
  scene["geometry"]["regions"][0]["to"][0] = "-400 m";
  EXPECT_EQ(problems_of(scene), "");
}

TEST(GivenFaultPressure, CountsAWindowOnTheFaultAlone) {
  json scene = json::parse(starter_scene("field"));
  scene["fault_pressure"] = prescribed("-100 bar");
  scene["fault_pressure"]["depth_window"] = {"0 m", "3000 m"};
  EXPECT_EQ(problems_of(scene), "") << "the faults begin at 1850 m";
  scene["fault_pressure"]["prescribed"] = "-190 bar";
  EXPECT_THAT(problems_of(scene), HasSubstr("at 1850 m depth in step 10"));
}

TEST(GivenFaultPressure, LooksBelowAnOverpressuredLayerToo) {
  json scene = json::parse(starter_scene("field"));
  scene["initial_state"]["overpressure"] = "200 bar";
  scene["stages"] = {{{"name", "only"}, {"duration", "1 year"}, {"steps", 1}}};
  // The east block lies 100 m lower: below 2200 m it has no overpressure.
  scene["fault_pressure"] = prescribed("-230 bar");
  EXPECT_THAT(problems_of(scene), HasSubstr("falls to -14.18 bar at 2200 m depth in step 1"));
}

TEST(GivenFaultPressure, OfATableBelowZeroIsRefused) {
  const auto with_fall = [](const std::string& fall) {
    return tabled(json::parse(starter_scene("field")),
                  {"depth [m], 0 year [bar], 18 year [bar]", "1800, 0, -50", "2100, 0, " + fall,
                   "2500, 0, -50"});
  };
  EXPECT_EQ(problems_of(with_fall("-200")), "");
  // 2100 m: 206 bar and 25 of overpressure.
  EXPECT_THAT(problems_of(with_fall("-240")), HasSubstr("/fault_pressure/csv: the pressure in "
                                                        "fault \"F1\" falls to"));
  EXPECT_THAT(problems_of(with_fall("-240")), HasSubstr("at 2100 m depth in step 23"));
}

/// Where one rule takes the overpressure of one block and the fall of the other.
TEST(GivenFaultPressure, OfTwoBlocksBelowZeroIsRefused) {
  json scene = json::parse(starter_scene("field"));
  scene["geometry"]["blocks"][0]["overpressure"] = "100 bar";
  scene["stages"] = {{{"name", "only"},
                      {"duration", "1 year"},
                      {"steps", 1},
                      {"pressure_change", {{"west", "-250 bar"}, {"east", "0 bar"}}}}};
  scene.erase("compartments");
  EXPECT_EQ(problems_of(scene), "") << "mean";
  scene["fault_pressure"]["rule"] = "min";
  EXPECT_THAT(problems_of(scene), HasSubstr("/fault_pressure/rule: the pressure in fault"));
}

TEST(FaultPressureTable, ThatMissesItsFaultIsRefused) {
  const std::string text =
      problems_of(tabled(json::parse(starter_scene("field")),
                         {"depth [m], 0 year [bar], 20 year [bar]", "100, 0, 20", "200, 0, 20"}));
  EXPECT_THAT(text, HasSubstr("/fault_pressure/csv: inj.csv has pressures at 100 m to 200 m "
                              "(depth), but fault \"F1\" reaches from 1850 m to 2350 m"));
  json box = tabled(bare_box(),
                    {"along_dip [m], along_strike [m], 0 year [bar], 10 year [bar]",
                     "-300, 700, 0, 1", "300, 700, 0, 1", "-300, 800, 0, 1", "300, 800, 0, 1"});
  EXPECT_THAT(
      problems_of(box),
      HasSubstr("700 m to 800 m (along strike), but fault \"F1\" reaches from -300 m to 300 m"));
}

TEST(FaultPressureTable, ThatLeavesOutAPartOfItsFaultIsSaid) {
  const auto box = [](const std::string& upper) {
    return tabled(bare_box(),
                  {"depth [m], 0 year [bar], 10 year [bar]", "300, 0, " + upper, "800, 0, 2"});
  };
  EXPECT_THAT(remarks_of(box("3")),
              ElementsAre(HasSubstr("/fault_pressure/csv does not cover all of fault F1: from "
                                    "100 m to 300 m (depth) the pressures at its ends are held")));
  EXPECT_THAT(remarks_of(box("0")), IsEmpty()) << "nothing is made up";
  EXPECT_THAT(
      remarks_of(tabled(bare_box(), {"depth [m], 0 year [bar], 10 year [bar]", "400, 0, 3"})),
      IsEmpty())
      << "one place is the same everywhere";
}

TEST(FaultPressureTable, ThatEndsBeforeTheHistoryIsSaid) {
  json scene = tabled(bare_box(), {"depth [m], 0 year [bar], 4 year [bar]", "400, 0, 3"});
  EXPECT_THAT(remarks_of(scene), ElementsAre(HasSubstr("ends at 4 year and the stages of the scene "
                                                       "at 10 year: the last pressures of fault F1 "
                                                       "are held")));
  scene["start_date"] = "1990-01-01";
  scene["tables"]["inj.csv"] = {"depth [m], 1990-01-01 [bar], 1994-01-01 [bar]", "400, 0, 3"};
  EXPECT_THAT(remarks_of(scene), ElementsAre(HasSubstr("ends at 1994-01-01 and the stages of the "
                                                       "scene at 2000-01-01")));
}

TEST(FaultPressureTable, ThatMakesMostOfTheLoadStepsIsSaid) {
  std::string header = "depth [m], 0 year [bar]", row = "400, 0";
  for (int i = 1; i <= 100; ++i) {
    header += ", " + std::to_string(36 * i) + " day [bar]";
    row += i % 2 == 0 ? ", 0" : ", 3";
  }
  json scene = tabled(bare_box(), {header + ", 10 year [bar]", row + ", 0"});
  EXPECT_THAT(remarks_of(scene), ElementsAre(HasSubstr("/fault_pressure/csv adds 99 load steps to "
                                                       "the 10 of the stages")));
  scene["numerics"]["turning_points"] = "report";
  for (const std::string& text : remarks_of(scene)) EXPECT_THAT(text, HasSubstr("skip"));
}

}  // namespace
}  // namespace faultsim
