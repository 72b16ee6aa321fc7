// What the identity of a case depends on: every bit of every number of the scene, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "simulator/documents/schema.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// The identity with these values; none = the scene then has a problem.
std::optional<std::string> identity_with(JsonDocument document, const Settings& settings) {
  for (const auto& [pointer, text] : settings) set_value(document, pointer, text);
  std::vector<Problem> problems;
  const Scene scene = read_scene(document, problems);
  if (!problems.empty()) return std::nullopt;
  return case_identity(scene);
}

/// Seventeen digits, which tell every double from its neighbours, with the SI unit.
std::string exact_text(double value, Dimension dimension) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  const std::string unit = si_unit(dimension);
  return unit.empty() ? digits : concat(digits, " ", unit);
}

/// The least number above zero that a scene takes, and a bit: what is smaller was meant to be zero.
constexpr double kAboveZero = 1.0001e-20;

/// Identities of the scene with a value and with its nearest neighbour that is allowed: one bit
/// away, or, of whole numbers, the next ones. None = no value that we try is allowed.
std::optional<std::pair<std::string, std::string>> identities_of_neighbours(
    const JsonDocument& document, const ParameterInfo& row) {
  const auto with = [&](double value) {
    return identity_with(document, {{row.pointer, exact_text(value, row.dimension)}});
  };
  const ParsedQuantity given = parse_quantity(row.value, row.dimension);
  for (const double value : {given.ok ? given.value : 0.3, 1.0, 1000.0, 1e7}) {
    const auto here = with(value);
    if (!here) continue;
    for (const double neighbour :
         {value == 0 ? kAboveZero : std::nextafter(value, HUGE_VAL),
          value == 0 ? -kAboveZero : std::nextafter(value, -HUGE_VAL), value + 1, 2 * value}) {
      if (const auto there = with(neighbour)) return std::make_pair(*here, *there);
    }
  }
  return std::nullopt;
}

/// Pointers of all numbers of the scene, and of those of which a last bit changes the identity.
struct Numbers {
  std::set<std::string> all, distinguished;
};
Numbers numbers_of(const JsonDocument& document) {
  Numbers result;
  for (const ParameterInfo& row : parameters(document)) {
    if (row.is_text) continue;
    result.all.insert(row.pointer);
    const auto identities = identities_of_neighbours(document, row);
    if (identities && identities->first != identities->second) {
      result.distinguished.insert(row.pointer);
    }
  }
  return result;
}

/// Numbers of which no last bit changes the identity in any of these variants of a scene.
std::set<std::string> never_distinguished(const JsonDocument& document,
                                          const std::vector<Settings>& variants) {
  Numbers total;
  for (const Settings& settings : variants) {
    JsonDocument variant = document;
    for (const auto& [pointer, text] : settings) set_value(variant, pointer, text);
    Numbers numbers = numbers_of(variant);
    total.all.merge(numbers.all);
    total.distinguished.merge(numbers.distinguished);
  }
  EXPECT_GT(total.all.size(), 30U);
  for (const std::string& pointer : total.distinguished) total.all.erase(pointer);
  return total.all;
}

/// Variants in which every number counts. Three of the scene cannot be varied by themselves.
TEST(CaseIdentity, ChangesWithTheLastBitOfEveryNumber) {
  const JsonDocument scene =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-weakening.json");
  EXPECT_THAT(
      never_distinguished(
          scene,
          {{{"/materials/salt/viscosity", "1e17 Pa s"}, {"/fault_pressure/rule", "fraction"}},
           {{"/fault_pressure/rule", "prescribed"}, {"/fault_pressure/prescribed", "-10 bar"}}}),
      ::testing::ElementsAre("/geometry/blocks/0/to", "/geometry/blocks/1/from",  // one edge
                             "/geometry/layers/0/top"));                          // always 0
  const std::string less = exact_text(-kAboveZero, Dimension::length);
  EXPECT_NE(
      identity_with(scene, {{"/geometry/blocks/0/to", less}, {"/geometry/blocks/1/from", less}}),
      case_identity(read_scene(scene)));
}

TEST(CaseIdentity, ChangesWithTheLastBitOfEveryNumberOfABox) {
  const Settings weakening = {{"/friction/dynamic_friction_angle", "10 deg"},
                              {"/friction/slip_weakening_distance", "1 mm"}};
  Settings a = weakening, b = weakening;
  a.insert(a.end(),
           {{"/fault_pressure/rule", "fraction"}, {"/materials/rock/viscosity", "1e17 Pa s"}});
  b.insert(b.end(),
           {{"/fault_pressure/rule", "prescribed"}, {"/fault_pressure/prescribed", "-10 bar"}});
  EXPECT_THAT(never_distinguished(parse_json(starter_scene("box"), "box"), {a, b}),
              ::testing::ElementsAre("/mesh/corner", "/mesh/corner_growth"));  // refused in a box
}

/// The one exception: a scene holds the angle of a coefficient, so that coefficients with the same
/// angle are the same case, bit for bit.
TEST(CaseIdentity, OfACoefficientIsThatOfItsAngle) {
  JsonDocument scene = rotliegend();
  scene.value["friction"] = {{"law", "coefficient"}, {"cohesion", "0 MPa"}};
  const auto with = [&](double coefficient) {
    return identity_with(
        scene, {{"/friction/friction_coefficient", exact_text(coefficient, Dimension::number)}});
  };
  int n_same = 0;
  double coefficient = 0.6;
  for (int k = 0; k < 40; ++k) {
    const double next = std::nextafter(coefficient, 1);
    ASSERT_TRUE(with(next));
    EXPECT_EQ(with(coefficient) == with(next), std::atan(coefficient) == std::atan(next));
    n_same += std::atan(coefficient) == std::atan(next);
    coefficient = next;
  }
  EXPECT_GT(n_same, 0);
  EXPECT_LT(n_same, 20);
}

/// Usual units: neighbours differ in the text, but a factor is between them and the stored double.
TEST(CaseIdentity, TellsNeighboursInUsualUnitsApart) {
  const JsonDocument scene = rotliegend();
  for (const ParameterInfo& row : parameters(scene)) {
    const ParsedQuantity given = parse_quantity(row.value, row.dimension);
    if (row.is_text || !given.ok || given.value == 0) continue;
    const auto blank = row.value.find(' ');
    if (blank == std::string::npos) continue;
    const std::string unit = row.value.substr(blank);
    // The text of the double next to the given one, in the given unit, to as many digits as a
    // reader needs.
    const long double factor =
        static_cast<long double>(given.value) / std::strtold(row.value.c_str(), nullptr);
    const double next = std::nextafter(given.value, HUGE_VAL);
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.20Lg", static_cast<long double>(next) / factor);
    EXPECT_EQ(parse_quantity(digits + unit, row.dimension).value, next)
        << row.pointer << " = " << digits << unit;
  }
}

/// The text with the keys of every object in the opposite order.
nlohmann::ordered_json reversed(const nlohmann::json& value) {
  if (value.is_array()) {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const auto& each : value) result.push_back(reversed(each));
    return result;
  }
  if (!value.is_object()) return nlohmann::ordered_json::parse(value.dump());
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  std::vector<std::string> keys;
  for (const auto& [key, each] : value.items()) keys.insert(keys.begin(), key);
  for (const std::string& key : keys) result[key] = reversed(value[key]);
  return result;
}

TEST(CaseIdentity, IgnoresTheOrderOfKeys) {
  for (const char* name :
       {"rotliegend.json", "rotliegend-weakening.json", "rotliegend-salt.json"}) {
    const JsonDocument scene =
        read_json_file(std::string(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/") + name);
    const std::string text = reversed(scene.value).dump();
    EXPECT_GT(text.find("\"format\""), text.find("\"title\"")) << "not turned round";
    EXPECT_EQ(case_identity(read_scene(parse_json(text, name))), case_identity(read_scene(scene)));
  }
}

/// Results in which a block's own overpressure met an edge of the column's were other ones once:
/// only they are calculated again.
TEST(CaseIdentity, SaysWhereABlocksOwnOverpressureMeetsAnEdgeOfTheColumns) {
  const auto text = [](const Settings& settings) {
    return canonical_scene(varied(rotliegend(), settings));
  };
  const std::pair<std::string, std::string> own = {"/geometry/blocks/1/overpressure", "65 bar"};
  const auto says = [](bool is_there) {
    const testing::Matcher<std::string> said = testing::StartsWith(R"({"block_edge":2,)");
    return is_there ? said : testing::Not(testing::HasSubstr("block_edge"));
  };
  EXPECT_THAT(text({own}), says(true));
  EXPECT_THAT(text({own, {"/geometry/blocks/1/offset", "200 m"}}), says(true)) << "top at the base";
  EXPECT_THAT(text({}), says(false));
  EXPECT_THAT(text({own, {"/geometry/blocks/1/offset", "50 m"}}), says(false));
  EXPECT_THAT(text({own,
                    {"/initial_state/overpressure", "0 bar"},
                    {"/stages/0/pressure_change", "-190 bar"}}),
              says(false));
}

TEST(CaseIdentity, FollowsABlockToAnEdgeOfTheColumn) {
  const auto with_offset = [](const char* offset) {
    return varied(rotliegend(), {{"/geometry/blocks/1/overpressure", "65 bar"},
                                 {"/geometry/blocks/1/offset", offset}});
  };
  const Scene at_edge = with_offset("0 m");
  CanonicalParts parts = canonical_parts(with_offset("50 m"));
  write_parts(at_edge, kGeometry, parts);
  EXPECT_EQ(case_identity(parts), case_identity(at_edge));
}

/// The version of the estimate by which creep is left out, 1 where the identity says none.
int estimate_version(const JsonDocument& document, const Settings& settings) {
  const std::string text = canonical_scene(varied(document, settings)), key = "\"estimate\":";
  const std::size_t at = text.find(key);
  return at == std::string::npos ? 1 : std::stoi(text.substr(at + key.size()));
}

/// Scenes without what creep: automatic did not count once are the cases that they were.
TEST(CaseIdentity, SaysWhatMayKeepCreep) {
  const std::pair<std::string, std::string> viscous = {"/materials/salt/viscosity", "1e17 Pa s"},
                                            cools = {"/stages/0/temperature_change", "-9 K"};
  JsonDocument tabled = rotliegend();
  tabled.value["fault_pressure"] = {{"rule", "table"}, {"csv", "p.csv"}};
  tabled.value["tables"]["p.csv"] = std::vector<std::string>{
      "depth [m], 0 year [bar], 18 year [bar]", "1800, 0, 9", "2400, 0, 9"};
  EXPECT_EQ(estimate_version(rotliegend(), {viscous}), 1);
  EXPECT_EQ(estimate_version(rotliegend(), {viscous, cools}), 2);
  EXPECT_EQ(estimate_version(tabled, {viscous}), 3);
  EXPECT_EQ(estimate_version(tabled, {viscous, cools}), 3);
  EXPECT_EQ(estimate_version(tabled, {viscous, {"/numerics/creep", "on"}}), 1) << "no estimate";
  EXPECT_EQ(estimate_version(tabled, {}), 1) << "nothing creeps";
  const JsonDocument box = parse_json(starter_scene("box"), "box");
  const std::pair<std::string, std::string> salt = {"/materials/rock/viscosity", "1e17 Pa s"},
                                            open = {"/initial_state/pressure", "600 bar"};
  EXPECT_EQ(estimate_version(box, {salt}), 1);
  EXPECT_EQ(estimate_version(box, {salt, open}), 3);
  EXPECT_EQ(estimate_version(box, {open}), 1) << "nothing creeps";
}

/// Whatever a scene can ask to be written, every key of the section.
TEST(CaseIdentity, IgnoresEverythingInTheOutputSection) {
  const std::map<std::string, std::string> outputs = {
      {"comment", "\"hello\""},
      {"fault_fields", "false"},
      {"observation_points", R"([{"name": "p", "position": ["1 m", "2 m", "-3 m"]}])"},
      {"volume_fields", "true"}};
  const std::string before = case_identity(read_scene(rotliegend()));
  for (const auto& [key, schema] :
       scene_schema().text()["definitions"]["output"]["properties"].items()) {
    ASSERT_EQ(outputs.count(key), 1U) << key;
    EXPECT_EQ(identity_with(rotliegend(), {{"/output/" + key, outputs.at(key)}}), before) << key;
  }
}

}  // namespace
}  // namespace faultsim
