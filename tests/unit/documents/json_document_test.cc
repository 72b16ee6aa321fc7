#include "simulator/documents/json_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/common/near_miss.h"

namespace faultsim {
namespace {

std::string error_of(const std::string& text) {
  try {
    parse_json(text, "f.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseJson, KnowsTheLineOfEveryValue) {
  const JsonDocument document = parse_json(
      "{\n"
      "  \"a\": 1,\n"
      "  \"b\": [10,\n"
      "    \"x\", true\n"
      "    , {\"c/d\":\n"
      "       -2.5e3\n"
      "    }\n"
      "  ]\n"
      "}",
      "f.json");
  EXPECT_EQ(document.line_of(""), 1);
  EXPECT_EQ(document.line_of("/a"), 2);
  EXPECT_EQ(document.line_of("/b"), 3);
  EXPECT_EQ(document.line_of("/b/0"), 3);
  EXPECT_EQ(document.line_of("/b/1"), 4);
  EXPECT_EQ(document.line_of("/b/2"), 4);
  EXPECT_EQ(document.line_of("/b/3"), 5);
  EXPECT_EQ(document.line_of("/b/3/c~1d"), 6);
  EXPECT_EQ(document.line_of("/b/3/missing/deeper"), 5) << "the nearest parent";
  EXPECT_EQ(document.value["b"][3]["c/d"], -2500);
}

TEST(ParseJson, TakesWholeNumbersAsSuchHoweverWritten) {
  const auto value = parse_json("[10.0, 1e1, 10, 0.5, -0.0]", "").value;
  EXPECT_TRUE(value[0].is_number_integer());
  EXPECT_TRUE(value[1].is_number_integer());
  EXPECT_EQ(value[1], value[2]);
  EXPECT_TRUE(value[3].is_number_float());
  EXPECT_EQ(value[4].get<double>(), 0.0);
}

TEST(ParseJson, RefusesDuplicateKeysAllOfThem) {
  EXPECT_EQ(error_of("{\"a\": 1,\n\"a\": 2,\n\"b\": {\"c\": 1, \"c\": 1}}"),
            "f.json:2: /a: key \"a\" is given twice, first in line 1; remove one of the two\n"
            "f.json:3: /b/c: key \"c\" is given twice, first in line 3; remove one of the two");
}

TEST(ParseJson, RefusesDeepNestingOverflowAndNaN) {
  EXPECT_EQ(error_of(std::string(64, '[') + std::string(64, ']')), "");
  EXPECT_THAT(error_of(std::string(65, '[')), testing::HasSubstr("nested deeper than 64"));
  EXPECT_EQ(error_of("{\"a\": [1,\n-1e400\n]}"),
            "f.json:2: /a/1: number -1e400 overflows; write a finite number");
  EXPECT_THAT(error_of("{\"a\": NaN}"), testing::HasSubstr("not valid JSON, column 7"));
  EXPECT_THAT(error_of("{\"a\": 1} x"), testing::HasSubstr("not valid JSON, column 10"));
}

TEST(ParseJson, RefusesMoreThan64MegabytesBeforeParsing) {
  const std::string huge(64'000'001, ' ');
  EXPECT_EQ(error_of(huge), "f.json: has 64000001 bytes; at most 64000000 are read");
}

TEST(ReadJsonFile, RefusesAMissingFile) {
  EXPECT_THROW(read_json_file("/no/such/file.json"), InputError);
}

TEST(SetValue, ReplacesKeepingTextsAsTexts) {
  JsonDocument document = parse_json("{\n\"a\": {\"b\": [1, 2]}}", "f.json");
  set_value(document, "/a/b/1", "25 deg");
  set_value(document, "/a/c", "true");
  set_value(document, "/a/b/0", "2.5");
  EXPECT_EQ(document.value.dump(), R"({"a":{"b":[2.5,"25 deg"],"c":true}})");
  EXPECT_EQ(document.line_of("/a/b/1"), 0) << "a set value stands in no line";
}

TEST(SetValue, MakesMissingObjectsButNoElements) {
  JsonDocument document = parse_json("{\"list\": [{}]}", "f.json");
  set_value(document, "/list/0/friction/friction_angle", "30 deg");
  EXPECT_EQ(document.value["list"][0]["friction"]["friction_angle"], "30 deg");
  EXPECT_THROW(set_value(document, "/list/1/name", "x"), InputError);
  EXPECT_THROW(set_value(document, "/list/first", "x"), InputError);
  EXPECT_THROW(set_value(document, "/list/0/friction/friction_angle/deeper", "x"), InputError);
  EXPECT_THROW(set_value(document, "list", "x"), InputError);
}

TEST(SetValue, ForgetsTheLinesOfWhatItReplaces) {
  JsonDocument document = parse_json("{\n\"a\":\n{\"b\": 1}}", "f.json");
  EXPECT_EQ(document.line_of("/a/b"), 3);
  set_value(document, "/a", "{\"b\": 2}");
  EXPECT_EQ(document.line_of("/a/b"), 0);
}

TEST(PutValue, MakesObjectsButNoArrayElements) {
  nlohmann::json document = {{"a", {1, 2}}, {"b", 3}};
  EXPECT_TRUE(put_value(document, "/x/y", 5));
  EXPECT_EQ(document["x"]["y"], 5);
  EXPECT_TRUE(put_value(document, "/a/1", 7));
  EXPECT_EQ(document["a"][1], 7);
  EXPECT_FALSE(put_value(document, "/a/2", 7));
  EXPECT_FALSE(put_value(document, "/a/-", 7));
  EXPECT_FALSE(put_value(document, "/a/01", 7)) << "no number of RFC 6901";
  EXPECT_FALSE(put_value(document, "/b/c", 7));
  EXPECT_TRUE(put_value(document, "/s~1t/u~0v", 1));
  EXPECT_EQ(document["s/t"]["u~v"], 1);
  EXPECT_EQ(*value_at(document, "/s~1t/" + pointer_token("u~v")), 1);
  EXPECT_EQ(value_at(document, ""), &document);
  EXPECT_EQ(value_at(document, "/a/2"), nullptr);
  EXPECT_EQ(value_at(document, "/b/c"), nullptr);
}

TEST(NearMiss, FindsSlipsOfThePen) {
  const std::vector<std::string> words = {"friction_angle", "cohesion", "mean", "min", "max"};
  EXPECT_EQ(near_miss("frictoin_angle", words), "friction_angle");
  EXPECT_EQ(near_miss("Friction-Angle", words), "friction_angle");
  EXPECT_EQ(near_miss("kohesion", words), "cohesion");
  EXPECT_EQ(near_miss("maen", words), "mean");
  EXPECT_EQ(near_miss("average", words), "");
  EXPECT_EQ(near_miss("", words), "");
  EXPECT_EQ(suggest("foo", {"a", "b"}), "write one of \"a\", \"b\"");
}

}  // namespace
}  // namespace faultsim
