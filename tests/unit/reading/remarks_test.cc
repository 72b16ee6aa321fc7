// Input that changes nothing is said, and nothing else is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;

JsonDocument box() { return parse_json(starter_scene("box"), "box.json"); }

std::vector<std::string> remarks_of(JsonDocument document, const Changes& changes = {}) {
  for (const auto& [pointer, text] : changes) set_value(document, pointer, text);
  std::vector<std::string> texts;
  for (const Remark& remark : read_scene(document).remarks) texts.push_back(remark_text(remark));
  return texts;
}

/// The scene with these changes has exactly one remark, and it begins so.
void expect_one(const JsonDocument& document, const Changes& changes, const std::string& begin) {
  EXPECT_THAT(remarks_of(document, changes), testing::ElementsAre(testing::StartsWith(begin)))
      << changes.back().first;
}

TEST(Remarks, AreNoneOnTheExamples) {
  int n_scenes = 0;
  for (const char* folder : {"scenes", "verification"}) {
    const std::string path = std::string(FAULTSIM_SOURCE_DIR "/docs/examples/") + folder;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() != ".json") continue;
      ++n_scenes;
      EXPECT_THAT(remarks_of(read_json_file(entry.path())), testing::IsEmpty()) << entry.path();
    }
  }
  EXPECT_GE(n_scenes, 10);
  EXPECT_THAT(remarks_of(box()), testing::IsEmpty());
  EXPECT_THAT(remarks_of(parse_json(starter_scene("field"), "field.json")), testing::IsEmpty());
}

TEST(Remarks, NameWhatIsForAnotherRule) {
  const JsonDocument field = rotliegend();
  for (const char* key : {"fraction", "prescribed", "depth_window", "table"}) {
    const std::string value = std::string(key) == "fraction"     ? "0.3"
                              : std::string(key) == "prescribed" ? "-10 bar"
                              : std::string(key) == "table"
                                  ? R"({"time": ["0 year"], "factor": [0.5]})"
                                  : R"(["2000 m", "2100 m"])";
    const std::string pointer = std::string("/fault_pressure/") + key;
    expect_one(field, {{"/fault_pressure/rule", "min"}, {pointer, value}},
               pointer + " has no effect: it is for the rule");
    const std::string own = std::string("/faults/1") + pointer;
    expect_one(field, {{"/fault_pressure/rule", "min"}, {own, value}}, own + " has no effect");
  }
}

TEST(Remarks, NameAPrescribedPressureThatReachesNoFault) {
  JsonDocument alone = box();
  alone.value["geometry"].erase("regions");
  alone.value["stages"][0].erase("pressure_change");
  const Changes prescribed = {{"/fault_pressure/rule", "prescribed"},
                              {"/fault_pressure/prescribed", "20 bar"}};
  expect_one(alone, prescribed,
             "/fault_pressure/prescribed has no effect: on fault F1 it acts where a pressure "
             "region lies on either side, but there is none");
  Changes window = prescribed;
  window.emplace_back("/fault_pressure/depth_window", R"(["1000 m", "1500 m"])");
  expect_one(alone, window,
             "/fault_pressure/depth_window has no effect: fault F1 lies between 1700 m and 2300 m");
  window.back().second = R"(["1000 m", "1800 m"])";
  EXPECT_THAT(remarks_of(alone, window), testing::IsEmpty());
  EXPECT_THAT(remarks_of(box(), prescribed), testing::IsEmpty());
  expect_one(rotliegend(),
             {{"/fault_pressure/rule", "prescribed"},
              {"/fault_pressure/prescribed", "-20 bar"},
              {"/fault_pressure/depth_window", R"(["4000 m", "4100 m"])"}},
             "/fault_pressure/depth_window has no effect");
}

TEST(Remarks, TakeCoolingAsALoad) {
  JsonDocument cooled = box();
  cooled.value["stages"][0].erase("pressure_change");
  const Changes cooling = {{"/stages/0/temperature_change", "-40 K"}};
  Changes expanding = cooling;
  expanding.emplace_back("/materials/rock/thermal_expansion", "1e-5 1/K");
  EXPECT_THAT(remarks_of(cooled, expanding), testing::IsEmpty());
  EXPECT_THAT(remarks_of(cooled, cooling),
              testing::Contains(testing::StartsWith("/stages/0/temperature_change has no effect: "
                                                    "no material has a thermal_expansion")));
  EXPECT_THAT(remarks_of(cooled, cooling),
              testing::Contains(testing::StartsWith("/stages has no effect")));
  expect_one(box(), {{"/materials/rock/thermal_expansion", "1e-5 1/K"}},
             "/materials/rock/thermal_expansion has no effect: no temperature changes in it");
  JsonDocument field = rotliegend();
  Changes salt = {{"/materials/salt/thermal_expansion", "1e-5 1/K"},
                  {"/stages/0/temperature_change", "-10 K"}};
  EXPECT_THAT(remarks_of(field, salt),
              testing::IsSupersetOf(
                  {testing::StartsWith("/materials/salt/thermal_expansion has no effect"),
                   testing::StartsWith("/stages/0/temperature_change has no effect: the regions "
                                       "are made of \"reservoir\", which has no")}));
}

TEST(Remarks, NameWhatOtherInputMakesIdle) {
  const JsonDocument field = rotliegend();
  const std::string rock = R"({"density": "2400 kg/m3", "youngs_modulus": "11 GPa",
                               "poisson_ratio": 0.15})";
  expect_one(field, {{"/materials/spare", rock}},
             "/materials/spare has no effect: nothing is made");
  expect_one(field, {{"/mesh/fine_margin", "100 m"}}, "/mesh/fine_margin has no effect");
  expect_one(field, {{"/tier", "screening"}, {"/mesh/strike", "50 m"}},
             "/mesh/strike has no effect");
  expect_one(field, {{"/numerics/creep_tolerance", "1 bar"}}, "/numerics/creep_tolerance has no");
  expect_one(field, {{"/numerics/follow_events", "false"}, {"/numerics/max_events", "3"}},
             "/numerics/max_events has no effect");
  expect_one(field, {{"/numerics/turning_points", "report"}, {"/numerics/max_added_steps", "3"}},
             "/numerics/max_added_steps has no effect");
  expect_one(field, {{"/start_date", "1990-01-01"}}, "/start_date has no effect: no CSV table");
  expect_one(field, {{"/pressure_csv_end", "hold"}}, "/pressure_csv_end has no effect");
  expect_one(field, {{"/compartments/east/datum", "2000 m"}}, "/compartments/east/datum has no");
  expect_one(field, {{"/friction/slip_weakening_distance", "1 cm"}},
             "/friction/slip_weakening_distance has no effect: friction does not weaken");
  expect_one(field, {{"/friction/cohesion", "0 MPa"}, {"/friction/cohesion_after_slip", "false"}},
             "/friction/cohesion_after_slip has no effect: there is no cohesion");
  expect_one(field, {{"/compartments/west/scale", "0"}, {"/compartments/west/lag", "1 year"}},
             "/compartments/west/lag has no effect");
  expect_one(read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json"),
             {{"/initial_state/viscous_layers", "ratios"}, {"/numerics/creep", "off"}},
             "/materials/");
}

TEST(Remarks, NameATopLevelKeyThatEveryFaultReplaces) {
  const JsonDocument field = rotliegend();
  Changes own;
  for (std::size_t f = 0; f < field.value["faults"].size(); ++f) {
    own.emplace_back("/faults/" + std::to_string(f) + "/friction/friction_coefficient", "0.5");
  }
  expect_one(field, own, "/friction/friction_angle has no effect: every fault has its own");
  own.pop_back();
  EXPECT_THAT(remarks_of(field, own), testing::IsEmpty());
}

TEST(Remarks, NameFacesAndRegionsThatDoNothing) {
  const std::string constant = R"({"time": ["0 year"], "factor": [1]})";
  const std::string never = R"({"time": ["0 year"], "factor": [0]})";
  const std::string zero = R"([["0 bar", "0 bar", "0 bar"], ["0 bar", "0 bar", "0 bar"],
                               ["0 bar", "0 bar", "0 bar"]])";
  const auto stress = [&](const std::string& first, const std::string& table) {
    std::string tensor = zero;
    tensor.replace(tensor.find("0 bar"), 5, first);
    return R"([{"sides": ["x-"], "kind": "stress", "stress": )" + tensor + R"(, "table": )" +
           table + "}]";
  };
  const std::string at = "/geometry/boundary";
  expect_one(box(), {{at, stress("1 bar", constant)}},
             at + "/0/table has no effect: it is 1 at all times");
  expect_one(box(), {{at, stress("1 bar", never)}},
             at + "/0/table has no effect: it is 0 at all times");
  EXPECT_THAT(remarks_of(box(), {{at, stress("0 bar", never)}}), testing::SizeIs(2));
  JsonDocument two = box();
  two.value["geometry"]["regions"].push_back(two.value["geometry"]["regions"][0]);
  two.value["geometry"]["regions"][1]["name"] = "idle";
  expect_one(two, {{"/stages/0/pressure_change", R"({"reservoir": "-50 bar"})"}},
             "/geometry/regions/1 has no effect: its pressure never changes");
  EXPECT_THAT(remarks_of(box(), {{"/stages/0/pressure_change", "0 bar"}}),
              testing::Contains(testing::StartsWith(
                  "/stages has no effect: no pressure or temperature changes")));
}

TEST(Remarks, NameStagesThatATableReplaces) {
  JsonDocument document = box();
  document.value["pressure_csv"] = "p.csv";
  document.value["tables"]["p.csv"] = {"time [year], reservoir [bar]", "0, 0", "10, -100"};
  expect_one(document, {{"/title", "x"}},
             "/stages/0/pressure_change has no effect: CSV tables replace it in all regions");
  document.value["stages"][0].erase("pressure_change");
  EXPECT_THAT(remarks_of(document), testing::IsEmpty());
  expect_one(document, {{"/compartments/reservoir/csv", "p.csv"}},
             "/pressure_csv has no effect on reservoir: /compartments/reservoir/csv replaces it");
}

}  // namespace
}  // namespace faultsim
