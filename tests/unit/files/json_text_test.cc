#include "simulator/files/json_text.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(JsonText, HoldsNothingThatATerminalObeys) {
  // ESC, DEL, a C1 control and an override of the direction; χ̄ stays readable.
  const std::string name = "a\x1b[31m\x7f\xc2\x9b\xe2\x80\xae χ̄";
  const std::string text = json_text(nlohmann::json{{"name", name}});
  for (const char* obeyed : {"\x1b", "\x7f", "\xc2\x9b", "\xe2\x80\xae"})
    EXPECT_THAT(text, Not(HasSubstr(obeyed)));
  EXPECT_THAT(text, HasSubstr("\\u007f\\u009b\\u202e χ̄"));
  EXPECT_EQ(nlohmann::json::parse(text).at("name"), name);
}

TEST(JsonText, SaysItsFormat) {
  EXPECT_EQ(json_text(nlohmann::ordered_json{{"a", 1}}), "{\n  \"format\": 1,\n  \"a\": 1\n}\n");
  EXPECT_EQ(json_text(nlohmann::json{{"format", 2}}), "{\n  \"format\": 2\n}\n");
}

}  // namespace
}  // namespace faultsim
