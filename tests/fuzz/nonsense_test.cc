#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/expansion/expansion.h"
#include "simulator/plan/geometry_check.h"
#include "simulator/reading/read_scene.h"

/// Nonsense that a person may write and a program may swallow: each is refused at the place where
/// it stands, with a cure.
namespace faultsim {
namespace {

struct Nonsense {
  const char* pointer;  ///< where it is put.
  const char* value;
  const char* said_at = nullptr;  ///< pointer of the problem, where it is another one.
};

std::string text_of(const std::vector<Problem>& problems) {
  return problems.empty() ? "accepted" : format_problems("it", problems);
}

void expect_refused(const Nonsense& one, const std::vector<Problem>& problems) {
  const std::string place = one.said_at == nullptr ? one.pointer : one.said_at;
  const bool said = std::any_of(problems.begin(), problems.end(), [&](const Problem& problem) {
    return problem.pointer == place && !problem.what.empty() && !problem.cure.empty();
  });
  EXPECT_TRUE(said) << one.pointer << " = " << one.value << " is not refused at " << place << ":\n"
                    << text_of(problems);
}

std::vector<Problem> problems_of(const JsonDocument& document) {
  std::vector<Problem> problems;
  const Scene scene = read_scene(document, problems);
  if (!problems.empty()) return problems;
  const Plan plan = make_plan(scene, problems);
  return problems.empty() ? geometry_problems(scene, plan) : problems;
}

void expect_all_refused(const JsonDocument& document, const std::vector<Nonsense>& list) {
  ASSERT_EQ(text_of(problems_of(document)), "accepted");
  for (const Nonsense& one : list) {
    JsonDocument changed = document;
    set_value(changed, one.pointer, one.value);
    expect_refused(one, problems_of(changed));
  }
}

const char* const kTableWithoutFactors =
    R"({"rule": "prescribed", "prescribed": "-10 bar", "table": {"time": ["0 year", "1 year"]}})";
const char* const kTableMisspelt =
    R"({"rule": "prescribed", "prescribed": "-10 bar", "table": {"time": ["1 year"], "factr": [1]}})";
const char* const kTableNoList =
    R"({"rule": "prescribed", "prescribed": "-10 bar", "table": {"time": ["1 year"], "factor": 1}})";

TEST(Nonsense, InAFieldIsRefusedWhereItStands) {
  JsonDocument field = parse_json(starter_scene("field"), "field");
  expect_all_refused(
      field,
      {{"/materials/salt/youngs_modulus", "40"},
       {"/materials/salt/youngs_modulus", "-40 GPa"},
       {"/materials/salt/youngs_modulus", "40 kg"},
       {"/materials/salt/youngs_modulus", "1.7e308 Pa"},
       {"/materials/salt/youngs_modulus", "1e-320 Pa"},
       {"/materials/salt/youngs_modulus", "2 Pa"},
       {"/materials/salt/youngs_modulus", "40 GPA", "/materials/salt/youngs_modulus"},
       {"/materials/salt/poisson_ratio", "0.5"},
       {"/materials/salt/poisson_ratio", "-0.1"},
       {"/materials/salt/poisson_ratio", "30 %"},
       {"/materials/salt/density", "2.1 kg/m3", "/materials/salt/density"},
       {"/materials/salt/density", "1e300 kg/m3"},
       {"/materials/salt/viscosity", "0 Pa s"},
       {"/materials/salt/viscosity", "1e300 Pa s"},
       {"/materials/salt/viscosty", "1e17 Pa s"},
       {"/materials/reservoir/biot", "1.2"},
       {"/materials/reservoir/biot", "1e-320"},
       {"/materials/", "{\"youngs_modulus\": \"1 GPa\", \"poisson_ratio\": 0.2}"},
       {"/geometry/width", "1e300 m"},
       {"/geometry/width", "0 m"},
       {"/geometry/depth", "-5 km"},
       {"/geometry/layers/1/top", "2500 m", "/geometry/layers/2/top"},
       {"/geometry/layers/0/name", "\"a\\u001b[31m\""},
       {"/geometry/reservoir_layer", "resevoir"},
       {"/geometry/blocks/0/name", "\"a\\u202e\""},
       {"/geometry/blocks/1/from", "1 m"},
       {"/geometry/blocks/1/offset", "3000 m"},
       {"/geometry/fault_length", "1e-9 m"},
       {"/geometry/fault_overshoot", "-1 m"},
       {"/mesh/largest", "1e-6 m"},
       {"/mesh/normal", "1e-6 m"},
       {"/mesh/dip", "0 m"},
       {"/mesh/growth", "0.9"},
       {"/mesh/growth", "1e-320"},
       {"/mesh/largest", "2 mm", "/mesh"},
       {"/tier", "screning"},
       {"/initial_state/ratio_across", "-0.7"},
       {"/initial_state/ratio_across", "1e300"},
       {"/initial_state/overpressure", "1e300 bar"},
       {"/initial_state/kind", "colum"},
       {"/friction/friction_angle", "30"},
       {"/friction/friction_angle", "95 deg"},
       {"/friction/cohesion", "-1 MPa"},
       {"/friction/cohesion", "1e300 MPa"},
       {"/friction", R"({"friction_angle": "30 deg", "dynamic_friction_angle": "10 deg"})",
        "/friction/dynamic_friction_angle"},
       {"/friction",
        R"({"friction_angle": "30 deg", "dynamic_friction_angle": "10 deg",
            "slip_weakening_distance": "1e-320 m"})",
        "/friction/slip_weakening_distance"},
       {"/fault_pressure", kTableWithoutFactors, "/fault_pressure/table"},
       {"/fault_pressure", kTableMisspelt, "/fault_pressure/table/factr"},
       {"/fault_pressure", kTableNoList, "/fault_pressure/table/factor"},
       {"/fault_pressure/rule", "maen"},
       {"/fault_pressure/fault_biot", "-1"},
       {"/faults/0/dip_from_vertical", "89 deg"},
       {"/faults/1/name", ""},
       {"/faults/1/fault_pressure", kTableWithoutFactors, "/faults/1/fault_pressure/table"},
       {"/stages/0/duration", "1e300 year"},
       {"/stages/0/duration", "0 s"},
       {"/stages/0/duration", "-1 year"},
       {"/stages/0/steps", "0"},
       {"/stages/0/steps", "2.5"},
       {"/stages/0/steps", "1000000"},
       {"/stages/0/pressure_change", "{\"\": \"-10 bar\"}", "/stages/0/pressure_change/"},
       {"/stages/0/pressure_change", "{\"wset\": \"-10 bar\"}", "/stages/0/pressure_change/wset"},
       {"/stages/0/pressure_change", "-1000 bar"},
       {"/stages/0/presure_change", "-10 bar"},
       {"/compartments", "{\"\": {\"scale\": 0.5}}", "/compartments/"},
       {"/compartments/east/scale", "1e300"},
       {"/compartments/east/lag", "-1 year"},
       {"/compartments/east/csv", "/dev/zero"},
       {"/compartments/east/csv", "/"},
       {"/pressure_csv", "/dev/null"},
       {"/numerics/slip_tolerance", "0 m"},
       {"/numerics/traction_tolerance", "1e-30"},
       {"/numerics/max_newton_iterations", "0"},
       {"/numerics/activation_length", "40"},
       {"/numerics/creep", "on"},
       {"/numerics/creep_time_step", "1e-300 s"},
       {"/output/observation_points", R"([{"name": "a", "position": ["0 m", "0 m", "1 km"]}])",
        "/output/observation_points/0/position/2"},
       {"/title", "\"two\\nlines and a \\u0007 bell\""},
       {"/format", "2"}});
}

TEST(Nonsense, InABoxIsRefusedWhereItStands) {
  JsonDocument box = parse_json(starter_scene("box"), "box");
  expect_all_refused(
      box, {{"/geometry/to/2", "-4000 m"},
            {"/geometry/material", "rokc"},
            {"/geometry/boundary/0/sides", "[\"x-\", \"x-\"]"},
            {"/geometry/boundary/0/kind", "rollr"},
            {"/geometry/boundary/0/kind", "tied", "/geometry/boundary/0/sides"},
            {"/geometry/boundary/0/sides", "[\"z-\"]", "/geometry/boundary"},  // slides away
            {"/geometry/regions/0/to/0", "-2000 m"},
            {"/geometry/regions/0/name", ""},
            {"/geometry/regions/0/radius", "1 m"},
            {"/faults/0/length", "0 m"},
            {"/faults/0/length", "1 m", "/faults"},  // splits no node
            {"/faults/0/dip_from_vertical", "60 deg"},
            {"/faults/0/center/0", "1e300 m"},
            {"/faults/0/center/0", "5000 m", "/faults/0/center"},
            {"/mesh/fine_margin", "-1 m"},
            {"/mesh/strike", "1e-4 m"},
            {"/initial_state/vertical_stress", "-1.7e308 Pa"},
            {"/initial_state/vertical_stress_gradient", "-22 MPa"},
            {"/initial_state/tensor", "[[\"1 MPa\"]]"}});
}

const char* const kSpec = R"({
  "format": 1,
  "name": "nonsense",
  "base": "rotliegend.json",
  "set": { "/tier": "screening" },
  "design": { "kind": "grid", "parameters": { "offset": ["0 m", "100 m"] } },
  "exclude": ["offset > 150 m"],
  "derived": { "ratio_along": "ratio_across" },
  "policy": { "on_failure": "continue" },
  "metrics": { "rank_by": "activated_area" }
})";

std::vector<Problem> problems_of_spec(const nlohmann::json& spec) {
  try {
    faultsweep::expand(faultsweep::parse_campaign(
        spec.dump(), FAULTSIM_SOURCE_DIR "/docs/examples/scenes/spec.json"));
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

TEST(Nonsense, InASpecIsRefusedWhereItStands) {
  ASSERT_EQ(text_of(problems_of_spec(nlohmann::json::parse(kSpec))), "accepted");
  const std::vector<Nonsense> list = {
      {"/name", "\"a/b\""},
      {"/name", "\"\""},
      {"/name", "\"\\u001b[31m\""},
      {"/base", "\"no-such-scene.json\""},
      {"/base", "\"/dev/zero\""},
      {"/base", "\"..\""},
      {"/base", "7"},
      {"/bse", "\"rotliegend.json\""},
      {"/set/offst", "\"1 m\""},
      {"/set/friction_angle", "\"95 deg\""},
      {"/design/kind", "\"gird\""},
      {"/design/parameters", "{}"},
      {"/design/parameters/offset", "[]"},
      {"/design/parameters/offset", "[\"0 m\", \"0 m\"]", "/design/parameters/offset/1"},
      {"/design/parameters/offset", "[\"100\"]", "/design/parameters/offset/0"},
      {"/design/parameters/offset", "[\"100 bar\"]", "/design/parameters/offset/0"},
      {"/design/parameters/offset", R"({"from": "0 m", "to": "100 m", "count": 2000000})",
       "/design/parameters/offset/count"},
      {"/design/parameters/offset", R"({"from": "0 m", "to": "100 m"})"},
      {"/design/parameters/offset", R"({"from": "0 m", "to": "0 m", "count": 3})",
       "/design/parameters/offset/to"},
      {"/design/parameters/", "[1]"},
      {"/design/parameters/frction_angle", "[\"20 deg\"]"},
      {"/exclude/0", "\"offset >\""},
      {"/exclude/0", "\"offset > 100\""},
      {"/exclude/0", "\"ofset > 100 m\""},
      {"/exclude/0", "\"offset\""},
      {"/derived/ratio_along", "\"ratio_along\""},
      {"/derived/ratio_along", "\"offset\""},
      {"/policy/on_failure", "\"retyr\""},
      {"/policy/retries", "-1"},
      {"/policy/time_limit", "\"10\""},
      {"/metrics/rank_by", "\"activated_aera\""},
      {"/keep_fields", "\"some\""}};
  for (const Nonsense& one : list) {
    nlohmann::json spec = nlohmann::json::parse(kSpec);
    spec[nlohmann::json::json_pointer(one.pointer)] = nlohmann::json::parse(one.value);
    expect_refused(one, problems_of_spec(spec));
  }
}

/// A key that is misspelt is missing too; that ended in an internal error once.
TEST(Nonsense, AMisspeltKeyOfASpecIsRefusedAsSuch) {
  for (const char* key : {"name", "base", "design", "format"}) {
    nlohmann::json spec = nlohmann::json::parse(kSpec);
    const std::string misspelt = std::string(key) + "e";
    spec[misspelt] = spec[key];
    spec.erase(key);
    const std::string pointer = "/" + misspelt;
    expect_refused({pointer.c_str(), key}, problems_of_spec(spec));
  }
}

}  // namespace
}  // namespace faultsim
