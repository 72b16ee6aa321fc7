#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "simulator/documents/schema.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

std::string problems_of(const std::string& text, const json& schema) {
  return format_problems("f", check_schema(parse_json(text, "f"), Schema(schema)));
}

const json kSchema = json::parse(R"({
  "type": "object",
  "required": ["name", "kind"],
  "additionalProperties": false,
  "properties": {
    "name": {"type": "string"},
    "kind": {"enum": ["circle", "square"]},
    "count": {"type": "integer", "minimum": 1, "maximum": 3},
    "list": {"type": "array", "items": {"$ref": "#/definitions/item"}, "minItems": 2}
  },
  "if": {"properties": {"kind": {"const": "circle"}}, "required": ["kind"]},
  "then": {"properties": {"count": {"maximum": 2}}},
  "definitions": {"item": {"type": "object", "additionalProperties": false,
                           "properties": {"size": {"type": "number"}}}}
})");

TEST(CheckSchema, IsSilentWhereAllIsWell) {
  EXPECT_EQ(problems_of(R"({"name": "a", "kind": "circle", "list": [{"size": 1}, {}]})", kSchema),
            "");
}

TEST(CheckSchema, ReportsEachMistakeOnceWithItsCure) {
  EXPECT_EQ(problems_of("{\"nmae\": \"a\",\n\"kind\": \"sqare\",\n\"count\": 4,\n\"list\": [{\n"
                        "\"size\": \"big\"},\n{\"sise\": 1, \"colour\": 2}]}",
                        kSchema),
            "f:1: /nmae: \"nmae\" is not a key of this object; did you mean \"name\"?\n"
            "f:2: /kind: \"sqare\" is not known here; did you mean \"square\"?\n"
            "f:3: /count: 4 is outside [1, 3]; write a number in the range\n"
            "f:5: /list/0/size: \"big\" is not a number; write a number\n"
            "f:6: /list/1/colour: \"colour\" is not a key of this object; write \"size\"\n"
            "f:6: /list/1/sise: \"sise\" is not a key of this object; did you mean \"size\"?");
}

TEST(CheckSchema, SeesTheBranchOfAConditional) {
  EXPECT_EQ(problems_of(R"({"name": "a", "kind": "square", "count": 3})", kSchema), "");
  EXPECT_NE(problems_of(R"({"name": "a", "kind": "circle", "count": 3})", kSchema), "");
}

TEST(CheckSchema, NamesMissingKeysAndShortLists) {
  EXPECT_EQ(problems_of(R"({"name": "a", "list": [{}]})", kSchema),
            "f:1: \"kind\" is missing; add \"kind\"\n"
            "f:1: /list: has 1 elements; write at least 2");
}

TEST(Schema, RefusesAKeywordThatTheWalkDoesNotCheck) {
  EXPECT_THROW(Schema(json::parse(R"({"properties": {"a": {"anyOf": []}}})")), InternalError);
  EXPECT_NO_THROW(scene_schema());
}

/// Quantities without a dimension, of their own or of the parameter beside them, would slip through
/// unconverted.
TEST(SceneSchema, GivesEveryTextOrNumberADimension) {
  int n_quantities = 0;
  const std::function<void(const json&)> visit = [&](const json& schema) {
    if (schema.is_object()) {
      if (schema.contains("type") && schema["type"] == json({"string", "number"})) {
        EXPECT_TRUE(schema.contains("x-dimension") || schema.contains("x-dimension-of"))
            << schema.dump();
        ++n_quantities;
      }
      for (const auto& [key, inner] : schema.items()) visit(inner);
    } else if (schema.is_array()) {
      for (const auto& inner : schema) visit(inner);
    }
  };
  visit(scene_schema().text());
  EXPECT_GE(n_quantities, 8);
}

TEST(CheckSchema, RefusesControlCharactersExceptInComments) {
  const json schema = json::parse(R"({"type": "object", "additionalProperties": {}})");
  EXPECT_EQ(
      problems_of("{\"a\": \"x\\u001b\",\n\"b\\r\": [{\"comment\": \"\\n\"}, \"\\n\"]}", schema),
      "f:1: /a: the text contains the control character or stray byte \\u001b; remove it\n"
      "f:2: /b\\u000d: the key contains the control character or stray byte \\u000d; remove it\n"
      "f:2: /b\\u000d/1: the text contains the control character or stray byte \\u000a; remove it");
}

/// Compared in pairs it would take minutes.
TEST(CheckSchema, FindsEqualElementsInLongListsToo) {
  const json schema = json::parse(
      R"({"type": "object", "properties": {"list": {"type": "array", "uniqueItems": true}}})");
  std::string list;
  for (int i = 0; i < 20'000; ++i) list += std::to_string(i) + ",";
  EXPECT_EQ(problems_of("{\"list\": [" + list + "-1]}", schema), "");
  EXPECT_EQ(problems_of("{\"list\": [" + list + "7]}", schema),
            "f:1: /list: [0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,1... has duplicate elements; "
            "remove one of them");
}

}  // namespace
}  // namespace faultsim
