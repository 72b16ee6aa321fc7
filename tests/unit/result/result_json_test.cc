#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "simulator/common/errors.h"
#include "simulator/result/result_json.h"

namespace faultsim {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Gives out different numbers that are not short in decimal.
double next() {
  static int count = 0;
  return ++count + 1.0 / 3.0;
}

FaultMetrics example_metrics() {
  FaultMetrics m;
  for (double* value :
       {&m.chi_bar, &m.chi_max, &m.chi_static_max, &m.area_chi_080, &m.thickness_chi_080_max,
        &m.thickness_chi_080_mean, &m.slipping_area, &m.open_area, &m.activated_area,
        &m.activated_length, &m.max_slip, &m.mean_slip, &m.potency, &m.moment, &m.moment_step}) {
    *value = next();
  }
  m.activated = true;
  return m;
}

StageMetrics example_stage(const char* name, bool active) {
  StageMetrics s;
  s.stage = name;
  s.first_step = 1;
  s.last_step = 2;
  s.activated = active;
  if (active) {
    s.activation_step = 2;
    s.activated_fault = "F1";
    s.magnitude_if_at_once = 2.5;
    FaultStageMetrics fault;
    fault.fault = "F1";
    fault.activated = true;
    fault.activation =
        FaultOnset{2, next(), {"centre", "", -1.234567890123e7, {}, next(), {}, next()}};
    for (double* value :
         {&fault.chi_bar, &fault.chi_max, &fault.area_chi_080, &fault.thickness_chi_080,
          &fault.activated_area, &fault.slipping_area, &fault.open_area, &fault.max_slip,
          &fault.potency, &fault.moment, &fault.event_moment}) {
      *value = next();
    }
    s.faults = {fault, FaultStageMetrics{}};
  }
  for (double* value :
       {&s.chi_bar, &s.chi_max, &s.area_chi_080, &s.thickness_chi_080, &s.activated_area,
        &s.slipping_area, &s.open_area, &s.max_slip, &s.potency, &s.moment}) {
    *value = next();
  }
  return s;
}

CaseResult example_result() {
  CaseResult r;
  r.title = "offset 80 m, \"quoted\", φ";
  r.identity = "0123456789abcdef0123456789abcdef";
  r.operator_fingerprint = "fedcba9876543210fedcba9876543210";
  r.numerics_version = 1;
  r.outcome = Outcome::unstable;
  r.reason = "snap-through at load factor 0.3";
  r.failed_step = 2;
  r.weakening_resolved = false;
  r.max_nucleation_ratio = 0.1;
  r.pressure_margin = 1e5 / 3;
  r.region_names = {"centre", "east"};
  r.fault_names = {"F1", "F2"};
  r.observation_names = {"above_centre.z"};
  for (int i = 0; i < 3; ++i) {
    StepResult step;
    step.step = i;
    step.stage = i == 0 ? "initial" : "primary_production";
    step.time = 31557600.0 * i;
    step.pressure_change = {-1e6 * i, 0.1 * i};
    step.outcome = i < 2 ? Outcome::converged : Outcome::unstable;
    step.n_stick = 7;
    step.n_slip = 2;
    step.n_open = 1;
    if (i < 2) step.faults = {example_metrics(), FaultMetrics{}};
    step.observed = {-0.01 * i};
    if (i > 0) step.temperature_change = {-12.5 / 3, 0};
    step.counts = {3, 2, 1, i};
    step.seconds = 0.25;
    r.steps.push_back(step);
  }
  r.steps[2].reason = "worst node 3";
  r.stages = {example_stage("primary_production", true), example_stage("gas_storage", false)};
  r.whole = example_stage("", true);
  r.unexpected = Reactivation{2, 1};
  r.counts = {9, 6, 3, 1};
  r.surface = CaseSurface{75, 70, 12, 1e-3, 1e-4 / 3, 2e-4 / 3, 4e-4 / 3, 5e-4 / 3};
  r.surface->n_cases = 24;
  r.surface->chi_tolerance = 3e-3;
  r.surface->chi_bar = 1e-3 / 3;
  r.surface->largest_slip = 2e-2 / 3;
  r.surface->flags_that_differ = 2;
  r.field_coverage = 0.8 / 3;
  r.field_assumed = 0.7 / 3;
  r.warnings = {"a", "b"};
  r.seconds = 1.5;
  return r;
}

json load_schema() {
  std::ifstream in(FAULTSIM_SOURCE_DIR "/schemas/result.schema.json");
  return json::parse(in);
}

/// The validator's complaints about a document; empty when it follows the schema.
std::string complaints(const json& document) {
  const json schema_document = load_schema();
  valijson::Schema schema;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_document), schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results)) {
    return "";
  }
  std::string text = "invalid";
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    text += "\n";
    for (const auto& part : error.context) text += part;
    text += ": " + error.description;
  }
  return text;
}

TEST(ResultJson, ComesBackComplete) {
  const CaseResult result = example_result();
  const json document = result_to_json(result);
  const CaseResult copy = result_from_json(json::parse(document.dump()));
  EXPECT_EQ(result_to_json(copy).dump(2), document.dump(2));
  // Spot checks against the struct itself, as both directions share one list of fields.
  EXPECT_EQ(copy.title, result.title);
  EXPECT_EQ(copy.outcome, Outcome::unstable);
  EXPECT_EQ(copy.failed_step, 2);
  EXPECT_EQ(copy.steps[1].faults[0].thickness_chi_080_mean,
            result.steps[1].faults[0].thickness_chi_080_mean);
  EXPECT_EQ(copy.steps[1].faults[0].moment_step, result.steps[1].faults[0].moment_step);
  EXPECT_EQ(copy.steps[2].counts.wasted_newton_iterations, 2);
  EXPECT_EQ(copy.whole, result.whole);
  EXPECT_EQ(copy.unexpected, result.unexpected);
  EXPECT_EQ(copy.surface, result.surface);
  EXPECT_EQ(copy.field_coverage, result.field_coverage);
  EXPECT_EQ(copy.field_assumed, result.field_assumed);
  EXPECT_EQ(copy.steps[1].temperature_change, result.steps[1].temperature_change);
  EXPECT_FALSE(copy.stages[1].magnitude_if_at_once.has_value());
  EXPECT_FALSE(copy.weakening_resolved);
  EXPECT_EQ(copy.pressure_margin, result.pressure_margin);
}

TEST(ResultJson, NamesCarryUnits) {
  const json document = result_to_json(example_result());
  EXPECT_EQ(document.at("/steps/1/time_s"_json_pointer), 31557600.0);
  EXPECT_EQ(document.at("/steps/1/pressure_change_pa/0"_json_pointer), -1e6);
  EXPECT_EQ(document.at("/steps/1/outcome"_json_pointer), "converged");
  EXPECT_TRUE(document.at("/steps/1/faults/0/area_chi_080_m2"_json_pointer).is_number());
  EXPECT_TRUE(document.at("/stages/0/moment_nm"_json_pointer).is_number());
  EXPECT_EQ(document.at("/stages/0/faults/0/activation/pressures/change_minus_pa"_json_pointer),
            -1.234567890123e7);
  EXPECT_TRUE(document.at("/stages/0/faults/1/activation"_json_pointer).is_null());
}

/// A result of an older program has no such keys, one without has null.
TEST(ResultJson, HowExactAResultIsMayBeMissing) {
  json document = result_to_json(example_result());
  for (const char* key : {"surface", "field_coverage", "field_assumed"}) {
    EXPECT_TRUE(document.contains(key));
    document.erase(key);
    EXPECT_TRUE(result_to_json(CaseResult()).at(key).is_null()) << key;
  }
  const CaseResult old = result_from_json(document);
  EXPECT_FALSE(old.surface);
  EXPECT_FALSE(old.field_coverage);
  EXPECT_FALSE(old.field_assumed);
}

TEST(ResultJson, SameResultGivesSameText) {
  const CaseResult result = example_result();
  EXPECT_EQ(result_to_json(result).dump(2), result_to_json(result).dump(2));
}

TEST(ResultJson, NaNIsNullAndInfinityIsABug) {
  CaseResult result = example_result();
  result.pressure_margin = std::nan("");
  const json document = result_to_json(result);
  EXPECT_TRUE(document.at("pressure_margin_pa").is_null());
  EXPECT_TRUE(std::isnan(result_from_json(document).pressure_margin));
  EXPECT_EQ(complaints(document), "");
  result.steps[0].faults[0].chi_max = std::numeric_limits<double>::infinity();
  EXPECT_THROW(result_to_json(result), InternalError);
}

TEST(ResultJson, FollowsTheSchema) {
  EXPECT_EQ(complaints(result_to_json(example_result())), "");
  EXPECT_EQ(complaints(result_to_json(CaseResult())), "");
}

TEST(ResultJson, SchemaRefusesWhatIsMissingUnknownOrOfAnotherType) {
  const json good = result_to_json(example_result());
  for (const char* pointer : {"/whole/chi_bar", "/steps/0/faults/0/moment_nm", "/counts/sub_steps",
                              "/steps/0/observed_m", "/identity"}) {
    json document = good;
    const json::json_pointer at(pointer);
    document.at(at.parent_pointer()).erase(at.back());
    EXPECT_NE(complaints(document), "") << "without " << pointer;
    document = good;
    document.at(at) = json::object();
    EXPECT_NE(complaints(document), "") << "another type at " << pointer;
    document = good;
    document.at(at.parent_pointer())["surprise"] = "yes";
    EXPECT_NE(complaints(document), "") << "more beside " << pointer;
  }
}

/// Every object of the schema describes, and requires, each of its properties; but for what
/// `faultsim run` alone adds, and what of that a flow result does.
void expect_described(const json& node, const std::string& where) {
  if (node.contains("properties")) {
    std::size_t n = node.at("properties").size();
    for (const char* added : {"initial_state", "field_integrals", "pressure_from", "flow_grid"})
      n -= node.at("properties").count(added);
    EXPECT_EQ(n, node.at("required").size()) << where;
    const bool has_measures = where == "/definitions/stage" || where == "/definitions/fault_stage";
    EXPECT_TRUE(node.at("additionalProperties") == false || has_measures) << where;
    for (const auto& [name, property] : node.at("properties").items()) {
      EXPECT_TRUE(property.contains("description") || property.contains("$ref"))
          << where << "/" << name;
    }
  }
  for (const auto& [key, child] : node.items()) {
    if (child.is_structured()) expect_described(child, where + "/" + key);
  }
}

TEST(ResultJson, SchemaDescribesEveryField) { expect_described(load_schema(), ""); }

void expect_refused(const json& document, const char* why) {
  try {
    result_from_json(document);
    ADD_FAILURE() << "accepted, expected: " << why;
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

TEST(ResultJson, ReadingRefusesWhatItDoesNotKnow) {
  const json good = result_to_json(example_result());
  json document = good;
  document["format"] = 1;
  expect_refused(document, "format version 1");
  document = good;
  document.erase("format");
  expect_refused(document, "\"format\" is missing");
  expect_refused(json::array(), "not a JSON object");
  document = good;
  document["steps"][1]["faults"][0].erase("chi_bar");
  expect_refused(document,
                 "the key \"chi_bar\" is missing / while reading faults/0 / while "
                 "reading steps/1");
  document = good;
  document["outcome"] = "splendid";
  expect_refused(document, "splendid");
  document = good;
  document["numerics_version"] = 1.5;
  expect_refused(document, "instead of an integer");
}

}  // namespace
}  // namespace faultsim
