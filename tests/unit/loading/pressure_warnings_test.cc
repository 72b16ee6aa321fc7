#include "simulator/loading/pressure_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The starter field, whose east block lies 100 m lower, with one stage.
std::vector<std::string> warnings(const json& change, const json& fault_pressure = nullptr) {
  json scene = json::parse(starter_scene("field"));
  scene["stages"] = {
      {{"name", "storage"}, {"duration", "2 year"}, {"steps", 2}, {"pressure_change", change}}};
  scene.erase("compartments");
  if (!fault_pressure.is_null()) scene["fault_pressure"] = fault_pressure;
  return pressure_warnings(read_scene(parse_json(scene.dump(), "test")));
}

TEST(PressureWarnings, SayNothingOfDepletion) {
  EXPECT_THAT(warnings("-100 bar"), IsEmpty());
  EXPECT_THAT(warnings("0 bar"), IsEmpty());
}

TEST(PressureWarnings, SayWhereItRisesAboveTheInitialOne) {
  EXPECT_THAT(warnings({{"west", "20 bar"}, {"east", "-20 bar"}}),
              ElementsAre("the pressure of west rises to 241.2 bar at 2000 m depth in load step 2 "
                          "(storage, after 2 year), 20.0 bar above the initial one of 221.2 bar"));
}

/// At 2000 m: σ_v = 1500 m x 2200 + 500 m x 2100 kg/m3 = 426.7 bar, p0 = 196.2 + 25 bar, M1 = 0.74:
/// σ_h = 0.74 (426.7 − 221.2) + 221.2 = 373.3 bar, so that 152.1 bar of rise reach it.
TEST(PressureWarnings, SayWhereItIsAboveTheLeastTotalStress) {
  EXPECT_EQ(warnings({{"west", "152 bar"}, {"east", "0 bar"}}).size(), 1u);
  EXPECT_THAT(
      warnings({{"west", "153 bar"}, {"east", "0 bar"}}),
      ElementsAre(HasSubstr("153.0 bar above the initial one"),
                  HasSubstr("the pressure of west reaches 374.2 bar at 2000 m depth in "
                            "load step 2 (storage, after 2 year), above the least total principal "
                            "stress of 373.3 bar there before production")));
}

TEST(PressureWarnings, OfAPrescribedFaultPressureToo) {
  const auto all = warnings("-50 bar", {{"rule", "prescribed"}, {"prescribed", "30 bar"}});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_THAT(all[1], HasSubstr("the prescribed pressure of fault F2 rises to"));
  EXPECT_THAT(all[1], HasSubstr("30.0 bar above the initial one of"));
}

TEST(PressureWarnings, OfATableOfFaultPressureToo) {
  json scene = json::parse(starter_scene("field"));
  scene["stages"] = {{{"name", "injection"}, {"duration", "2 year"}, {"steps", 2}}};
  scene.erase("compartments");
  scene["faults"][1]["fault_pressure"] = {{"rule", "table"}, {"csv", "inj.csv"}};
  scene["tables"]["inj.csv"] = {"depth [m], 0 year [bar], 1 year [bar], 2 year [bar]",
                                "1850, 0, 0, 0", "2000, 0, 160, 30", "2500, 0, 0, 0"};
  const auto all = pressure_warnings(read_scene(parse_json(scene.dump(), "test")));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_THAT(all[0], HasSubstr("the pressure of fault F2 from its table rises to"));
  EXPECT_THAT(all[0], HasSubstr("at 2000 m depth in load step 1 (injection, after 1 year), 160.0 "
                                "bar above the initial one of"));
  EXPECT_THAT(all[1], HasSubstr("at 2000 m depth in load step 1 (injection, after 1 year), above "
                                "the least total principal stress"));
}

}  // namespace
}  // namespace faultsim
