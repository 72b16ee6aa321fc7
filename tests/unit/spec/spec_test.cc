#include "campaign/spec/spec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "campaign/spec/metrics.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {
namespace {

using nlohmann::json;

/// A spec on the reference scene; design and further keys as JSON text.
CampaignSpec spec_with(const std::string& design, const std::string& more = "") {
  const std::string text =
      R"({"format": 1, "name": "test", "base": "docs/examples/scenes/rotliegend.json", )" + more +
      R"("design": )" + design + "}";
  return parse_campaign(text, FAULTSIM_SOURCE_DIR "/test.json");
}

CampaignSpec grid_with(const std::string& parameters, const std::string& more = "") {
  return spec_with(R"({"kind": "grid", "parameters": )" + parameters + "}", more);
}

std::vector<std::string> texts(const Parameter& parameter) {
  std::vector<std::string> result;
  for (const Choice& choice : parameter.choices) result.push_back(choice.text);
  return result;
}

TEST(Spec, AliasBecomesPointer) {
  const auto spec = grid_with(R"({"offset": ["0 m", "0.1 km"], "/tier": ["screening"]})");
  ASSERT_EQ(spec.groups.size(), 1u);
  ASSERT_EQ(spec.groups[0].parameters.size(), 2u);
  const Parameter& offset = spec.groups[0].parameters[0];
  EXPECT_EQ(offset.targets, std::vector<std::string>{"/geometry/blocks/1/offset"});
  EXPECT_EQ(offset.choices[1].text, "0.1 km");
  EXPECT_EQ(offset.choices[1].si, 100.0);
  EXPECT_EQ(offset.choices[1].pointer, "/design/parameters/offset/1");
  EXPECT_EQ(offset.base.text, "0 m");
  EXPECT_TRUE(spec.groups[0].parameters[1].is_text);
}

TEST(Spec, ParametersKeepDocumentOrder) {
  const auto spec = grid_with(R"({"offset": ["0 m"], "cohesion": ["0 MPa"], "biot": [1]})");
  const auto& parameters = spec.groups[0].parameters;
  EXPECT_EQ(parameters[0].name, "offset");
  EXPECT_EQ(parameters[1].name, "cohesion");
  EXPECT_EQ(parameters[2].name, "biot");
}

TEST(Spec, RangesAreWhatAUserWouldHaveWritten) {
  const auto spec = grid_with(R"({
    "offset": {"from": "0 m", "to": "0.2 km", "count": 5},
    "ratio_across": {"from": 0, "to": 1, "count": 11},
    "slip_weakening_distance": {"from": "1 mm", "to": "100 mm", "count": 3, "spacing": "log"}})");
  const auto& parameters = spec.groups[0].parameters;
  EXPECT_EQ(texts(parameters[0]),
            (std::vector<std::string>{"0 m", "50 m", "100 m", "150 m", "200 m"}));
  EXPECT_EQ(parameters[1].choices[3].text, "0.3") << "not 0.30000000000000004";
  EXPECT_EQ(parameters[1].choices[3].changes[0].value, json(0.3));
  EXPECT_EQ(texts(parameters[2]), (std::vector<std::string>{"1 mm", "10 mm", "100 mm"}));
}

TEST(Spec, ScaleMultipliesTheBaseValue) {
  const auto spec = grid_with(
      R"({"stiff": {"scale": ["caprock_stiffness", "/materials/reservoir/youngs_modulus"],
                    "factors": [0.5, 1.1]}})");
  const Parameter& stiff = spec.groups[0].parameters[0];
  EXPECT_EQ(stiff.targets.size(), 2u);
  EXPECT_EQ(stiff.choices[0].changes[0].value, "20 GPa");
  EXPECT_EQ(stiff.choices[1].changes[1].value, "12.1 GPa");
  EXPECT_EQ(stiff.choices[1].si, 1.1);
  EXPECT_EQ(stiff.base.text, "1");
}

TEST(Spec, ScaleSeesWhatSetChanged) {
  const auto spec = grid_with(R"({"stiff": {"scale": "caprock_stiffness", "factors": [2]}})",
                              R"("set": {"caprock_stiffness": "30 GPa"}, )");
  EXPECT_EQ(spec.groups[0].parameters[0].choices[0].changes[0].value, "60 GPa");
  ASSERT_EQ(spec.groups[0].origins.size(), 1u);
  EXPECT_EQ(spec.groups[0].origins[0].spec_pointer, "/set/caprock_stiffness");
}

TEST(Spec, OneValueForSeveralPointers) {
  const auto spec = grid_with(
      R"({"ratios": {"pointers": ["ratio_across", "ratio_along"], "values": [0.4, 0.74]}})");
  const Choice& choice = spec.groups[0].parameters[0].choices[1];
  ASSERT_EQ(choice.changes.size(), 2u);
  EXPECT_EQ(choice.changes[0].pointer, "/initial_state/ratio_across");
  EXPECT_EQ(choice.changes[1].value, json(0.74));
}

TEST(Spec, VariantsSetSeveralThings) {
  const auto spec = grid_with(
      R"({"p": {"variants": {"zero": {"/fault_pressure": {"rule": "none"}},
                             "all": {"fault_pressure": "max", "fault_biot": 0.5}}}})");
  const Parameter& p = spec.groups[0].parameters[0];
  EXPECT_TRUE(p.is_text);
  EXPECT_EQ(texts(p), (std::vector<std::string>{"zero", "all"}));
  EXPECT_EQ(p.choices[1].changes.size(), 2u);
}

TEST(Spec, ListsShareEqualValues) {
  const auto spec = spec_with(
      R"({"kind": "list", "cases": [{"offset": "0 m", "biot": 0.8}, {"biot": 1},
                                    {"offset": "0 m"}]})");
  const Group& group = spec.groups[0];
  ASSERT_EQ(group.parameters.size(), 2u);
  EXPECT_EQ(group.parameters[0].choices.size(), 1u);
  EXPECT_EQ(group.designs[0].rows, (std::vector<std::vector<int>>{{0, 0}, {-1, 1}, {0, -1}}));
}

TEST(Spec, GroupsInGroupsInheritSet) {
  const auto spec = spec_with(R"({"kind": "groups", "groups": [
      {"name": "a", "set": {"biot": 0.9}, "design": {"kind": "groups", "groups": [
         {"name": "b", "set": {"cohesion": "1 MPa"},
          "design": {"kind": "grid", "parameters": {"offset": ["0 m"]}}}]}},
      {"name": "c", "design": {"kind": "grid", "parameters": {"offset": ["0 m"]}}}]})");
  ASSERT_EQ(spec.groups.size(), 2u);
  EXPECT_EQ(spec.groups[0].name, "a/b");
  EXPECT_EQ(spec.groups[0].scene["materials"]["reservoir"]["biot"], 0.9);
  EXPECT_EQ(spec.groups[0].scene["friction"]["cohesion"], "1 MPa");
  EXPECT_EQ(spec.groups[1].scene["materials"]["reservoir"]["biot"], 1.0);
}

TEST(Spec, DerivedAreSortedByUse) {
  const auto spec = grid_with(R"({"ratio_across": [0.5]})", R"("derived": {
      "cohesion": "initial_biot * 1 MPa", "initial_biot": "ratio_along / 2",
      "ratio_along": "ratio_across"}, )");
  ASSERT_EQ(spec.derived.size(), 3u);
  EXPECT_EQ(spec.derived[0].name, "ratio_along");
  EXPECT_EQ(spec.derived[1].name, "initial_biot");
  EXPECT_EQ(spec.derived[2].name, "cohesion");
}

TEST(Spec, PolicyAndMetrics) {
  const auto spec = grid_with(R"({"offset": ["0 m"]})", R"~(
      "policy": {"on_failure": "retry", "retries": 3, "time_limit": "10 min",
                 "memory_limit": "8 GB"},
      "metrics": {"rank_by": "max(chi_bar, 0.5)"}, )~");
  EXPECT_EQ(spec.policy.on_failure, FailureAction::retry);
  EXPECT_EQ(spec.policy.retries, 3);
  EXPECT_EQ(spec.policy.time_limit, 600.0);
  EXPECT_EQ(spec.policy.memory_limit, 8e9);
  EXPECT_EQ(spec.rank_by, "max(chi_bar, 0.5)");
}

TEST(Spec, AnAmountOfMemoryIsANumberAndAUnit) {
  const char* offset = R"({"offset": ["0 m"]})";
  const auto with = [&](const std::string& amount) {
    return grid_with(offset, R"("policy": {"memory_limit": ")" + amount + "\"}, ");
  };
  EXPECT_EQ(with("8  GB").policy.memory_limit, 8e9);
  for (const char* wrong : {"8 x GB", "8 GB GB", "8 GB ", "8 ", "8", " GB"})
    EXPECT_THROW(with(wrong), faultsim::InputError) << wrong;
}

TEST(Spec, KeepsFieldsOfTheCasesShownFirstUnlessAskedForOthers) {
  const char* offset = R"({"offset": ["0 m"]})";
  const auto silent = grid_with(offset);
  EXPECT_EQ(silent.keep_fields, KeepFields::shown);
  EXPECT_EQ(silent.resolved().find("keep_fields"), std::string::npos)
      << "specs of stores that did not know the key must stay the same";
  EXPECT_EQ(grid_with(offset, R"("keep_fields": "shown", )").resolved(), silent.resolved());
  const auto none = grid_with(offset, R"("keep_fields": "none", )");
  EXPECT_EQ(none.keep_fields, KeepFields::none);
  EXPECT_EQ(json::parse(none.resolved())["keep_fields"], "none")
      << "it is another campaign than that which says nothing";
  const auto stages = grid_with(offset, R"("keep_fields": "stages", )");
  EXPECT_EQ(stages.keep_fields, KeepFields::stages);
  EXPECT_EQ(json::parse(stages.resolved())["keep_fields"], "stages");
  EXPECT_EQ(grid_with(offset, R"("keep_fields": "all", )").keep_fields, KeepFields::all);
}

TEST(Spec, ResolvedNamesPointersAndValues) {
  const auto spec = grid_with(R"({"offset": {"from": "0 m", "to": "10 m", "count": 2}})");
  const json resolved = json::parse(spec.resolved());
  const json& group = resolved["groups"][0];
  EXPECT_EQ(group["scene"]["tier"], "standard");
  EXPECT_EQ(group["parameters"][0]["choices"][1]["changes"],
            json({{"/geometry/blocks/1/offset", "10 m"}}));
  EXPECT_EQ(spec.resolved(), grid_with(R"({"offset": ["0 m", "10 m"]})").resolved())
      << "a range is its values";
}

TEST(Spec, ExamplesAreRead) {
  const std::string folder = FAULTSIM_SOURCE_DIR "/docs/examples/campaigns/";
  EXPECT_EQ(read_campaign(folder + "quickstart.json").groups.size(), 3u);
  EXPECT_EQ(read_campaign(folder + "small.json").groups.size(), 1u);
  EXPECT_EQ(read_campaign(folder + "rotliegend-events.json").groups.size(), 2u);
  EXPECT_EQ(read_campaign(folder + "rotliegend-salt.json").groups.size(), 1u);
  EXPECT_EQ(read_campaign(folder + "fields.json").keep_fields, KeepFields::stages);
}

TEST(Spec, MissingFile) {
  EXPECT_THROW(read_campaign("no/such/file.json"), faultsim::InputError);
  EXPECT_THROW(read_campaign(FAULTSIM_SOURCE_DIR), faultsim::InputError) << "a folder";
}

TEST(Overlap, IsByToken) {
  EXPECT_TRUE(overlap("/a", "/a/b"));
  EXPECT_TRUE(overlap("/a/b", "/a"));
  EXPECT_TRUE(overlap("/a", "/a"));
  EXPECT_FALSE(overlap("/a", "/ab"));
  EXPECT_FALSE(overlap("/a/b", "/a/c"));
}

TEST(CampaignSchema, IsDraft7AndDescribesEveryMetric) {
  EXPECT_EQ(campaign_schema().text()["$schema"], "http://json-schema.org/draft-07/schema#");
  const std::string text = campaign_schema().text().dump();
  for (const char* newer : {"prefixItems", "unevaluated", "$defs", "dependentSchemas", "$anchor"}) {
    EXPECT_EQ(text.find(newer), std::string::npos) << newer << " is not in draft-07";
  }
  for (const MetricInfo& metric : metric_catalogue()) EXPECT_FALSE(metric.description.empty());
}

}  // namespace
}  // namespace faultsweep
