#include <gtest/gtest.h>

#include <map>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

JsonDocument example(const std::string& name) {
  return read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/" + name);
}

std::map<std::string, ParameterInfo> by_pointer(const JsonDocument& document) {
  std::map<std::string, ParameterInfo> result;
  for (const ParameterInfo& row : parameters(document)) result[row.pointer] = row;
  return result;
}

TEST(Parameters, HaveTheAliasesOfTheSeedsFamilies) {
  const JsonDocument document = example("rotliegend-weakening.json");
  const std::map<std::string, std::string> expected = {
      {"offset", "/geometry/blocks/1/offset"},
      {"offset_west", "/geometry/blocks/0/offset"},
      {"central_dip", "/faults/1/dip_from_vertical"},
      {"friction_angle", "/friction/friction_angle"},
      {"friction_angle_F2", "/faults/1/friction/friction_angle"},
      {"dynamic_friction_angle", "/friction/dynamic_friction_angle"},
      {"slip_weakening_distance", "/friction/slip_weakening_distance"},
      {"cohesion", "/friction/cohesion"},
      {"ratio_across", "/initial_state/ratio_across"},
      {"ratio_along", "/initial_state/ratio_along"},
      {"overpressure", "/initial_state/overpressure"},
      {"biot", "/materials/reservoir/biot"},
      {"reservoir_stiffness", "/materials/reservoir/youngs_modulus"},
      {"caprock_stiffness", "/materials/salt/youngs_modulus"},
      {"caprock_viscosity", "/materials/salt/viscosity"},
      {"fault_pressure", "/fault_pressure/rule"},
      {"fault_pressure_change", "/fault_pressure/prescribed"},
      {"scale_east", "/compartments/east/scale"},
      {"lag_west", "/compartments/west/lag"},
      {"primary_production_pressure", "/stages/0/pressure_change"}};
  for (const auto& [alias, pointer] : expected) {
    EXPECT_EQ(resolve_parameter(document, alias), pointer);
  }
  EXPECT_EQ(resolve_parameter(document, "/any/pointer"), "/any/pointer");
}

TEST(Parameters, ShowTheAliasThatResolves) {
  for (const char* name :
       {"rotliegend.json", "rotliegend-weakening.json", "rotliegend-salt.json"}) {
    const JsonDocument document = example(name);
    for (const ParameterInfo& row : parameters(document)) {
      if (row.alias.empty()) continue;
      EXPECT_EQ(resolve_parameter(document, row.alias), row.pointer);
    }
  }
}

TEST(Parameters, ResolveFaultPressureToWhatCounts) {
  JsonDocument document = example("rotliegend.json");
  set_value(document, "/fault_pressure/rule", "prescribed");
  EXPECT_EQ(resolve_parameter(document, "fault_pressure"), "/fault_pressure/prescribed");
}

TEST(Parameters, SuggestAliasesThatAreNear) {
  try {
    resolve_parameter(example("rotliegend.json"), "frction_angle");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"friction_angle\"?"),
              std::string::npos);
  }
}

TEST(Parameters, TellValueDefaultRangeAndFamily) {
  const auto rows = by_pointer(example("rotliegend.json"));
  const ParameterInfo& angle = rows.at("/friction/friction_angle");
  EXPECT_EQ(angle.value, "30 deg");
  EXPECT_EQ(angle.range, "[0 deg, 80 deg]");
  EXPECT_EQ(angle.dimension, Dimension::angle);
  EXPECT_FALSE(angle.new_family);
  EXPECT_FALSE(angle.is_text);
  EXPECT_TRUE(rows.at("/geometry/blocks/1/offset").new_family);
  EXPECT_TRUE(rows.at("/materials/salt/youngs_modulus").new_family);
  EXPECT_FALSE(rows.at("/materials/salt/density").new_family);
  EXPECT_FALSE(rows.at("/materials/reservoir/biot").new_family);
  EXPECT_TRUE(rows.at("/faults/1/dip_from_vertical").new_family);
  EXPECT_TRUE(rows.at("/tier").new_family);
  EXPECT_TRUE(rows.at("/fault_pressure/rule").is_text);
  EXPECT_EQ(rows.at("/numerics/slip_tolerance").value, "1e-4 m");
  EXPECT_EQ(rows.at("/faults/0/friction/friction_angle").value, "30 deg") << "from /friction";
  EXPECT_EQ(rows.count("/friction/friction_coefficient"), 0U) << "excluded by the angle";
  EXPECT_EQ(rows.count("/format"), 0U);
  const ParameterInfo& viscosity = rows.at("/materials/salt/viscosity");
  EXPECT_EQ(viscosity.alias, "caprock_viscosity");
  EXPECT_EQ(viscosity.range, "[1 Pa s, 1e30 Pa s]");
  EXPECT_EQ(viscosity.value, "elastic");
  EXPECT_TRUE(viscosity.new_family);
  EXPECT_EQ(rows.count("/output/observation_points/0/position/0"), 0U);
}

TEST(Parameters, OfStepsCostOperatorsWhereSaltCreeps) {
  JsonDocument salt = example("rotliegend-salt.json");
  const auto elastic = by_pointer(example("rotliegend.json"));
  const auto viscous = by_pointer(salt);
  set_value(salt, "/numerics/creep", "off");
  const auto off = by_pointer(salt);
  for (const char* pointer : {"/stages/0/duration", "/stages/0/steps"}) {
    EXPECT_FALSE(elastic.at(pointer).new_family) << pointer;
    EXPECT_TRUE(viscous.at(pointer).new_family) << pointer;
    EXPECT_FALSE(off.at(pointer).new_family) << pointer;
  }
  EXPECT_FALSE(viscous.at("/stages/0/pressure_change").new_family);
  EXPECT_EQ(viscous.at("/materials/salt/viscosity").value, "1e17 Pa s");
}

TEST(Parameters, ComeInTheOrderOfTheDocument) {
  const JsonDocument document = example("rotliegend.json");
  int line = 0;
  for (const ParameterInfo& row : parameters(document)) {
    EXPECT_LE(line, document.line_of(row.pointer)) << row.pointer;
    line = document.line_of(row.pointer);
  }
}

TEST(Parameters, OfABoxMarkLoadsAsNoNewFamily) {
  JsonDocument document = parse_json(starter_scene("box"), "box");
  set_value(document, "/geometry/boundary/1", R"({"sides": ["z+"], "kind": "stress", "stress":
      [["0 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "-2 MPa"]]})");
  const auto rows = by_pointer(document);
  EXPECT_FALSE(rows.at("/geometry/boundary/1/stress/2/2").new_family);
  EXPECT_TRUE(rows.at("/geometry/regions/0/from/0").new_family);
  EXPECT_TRUE(rows.at("/faults/0/strike").new_family);
}

/// Campaigns ask for the parameters of a base before its schema is checked.
TEST(Parameters, OfAMisshapenSceneAreNoAccident) {
  const JsonDocument document = example("rotliegend-weakening.json");
  std::size_t n_tried = 0;
  for (const auto& [pointer, line] : document.lines) {
    for (const char* wrong : {"[1, {}, []]", "{\"0\": 1}", "7", "\"word\"", "null", "[]"}) {
      JsonDocument misshapen = document;
      if (pointer.empty()) {
        misshapen.value = nlohmann::json::parse(wrong);
      } else {
        misshapen.value[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(wrong);
      }
      EXPECT_NO_THROW(parameters(misshapen)) << pointer << " = " << wrong;
      ++n_tried;
    }
  }
  EXPECT_GT(n_tried, 600U);
}

/// Sets each number of a document to another value; whatever can be set changes the identity, or is
/// refused, but for the few keys that are known to be without effect in this scene.
/// @return how many changed it.
int count_changes(const JsonDocument& document, const std::vector<std::string>& idle) {
  const std::string before = case_identity(read_scene(document));
  int n_changed = 0;
  for (const ParameterInfo& row : parameters(document)) {
    const std::string key = row.pointer.substr(row.pointer.rfind('/') + 1);
    if (std::count(idle.begin(), idle.end(), key) != 0 || row.is_text) continue;
    JsonDocument varied = document;
    const bool has_number = !row.value.empty() && row.value.find_first_of("0123456789") == 0;
    double number = has_number ? std::stod(row.value) : 7;
    const auto blank = row.value.find(' ');
    std::string unit = has_number && blank != std::string::npos ? row.value.substr(blank) : "";
    if (!has_number && row.dimension != Dimension::number) {
      unit = std::string(" ") + usual_unit(row.dimension);
    }
    if (row.dimension == Dimension::number && unit.empty() && !has_number) number = 0.3;
    const bool whole = key == "steps";
    set_value(varied, row.pointer, concat(whole ? 2 * number : 0.9 * number + 0.001, unit));
    std::vector<Problem> problems;
    const Scene scene = read_scene(varied, problems);
    if (!problems.empty()) continue;
    EXPECT_NE(case_identity(scene), before) << row.pointer;
    ++n_changed;
  }
  return n_changed;
}

/// The strongest check of the identity.
TEST(Parameters, AllOfThemChangeTheIdentity) {
  const std::vector<std::string> idle = {"fraction", "prescribed", "creep_time_step",
                                         "creep_refinements", "creep_tolerance"};
  EXPECT_GT(count_changes(example("rotliegend-weakening.json"), idle), 60);
}

TEST(Parameters, AllOfThoseOfViscousSaltToo) {
  JsonDocument document = example("rotliegend-weakening.json");
  set_value(document, "/materials/salt/viscosity", "1e17 Pa s");
  EXPECT_GT(count_changes(document, {"fraction", "prescribed"}), 64);
}

}  // namespace
}  // namespace faultsim
