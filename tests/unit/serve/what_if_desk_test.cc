// Questions of pages to a real simulator.
#include "campaign/serve/what_if_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace faultsweep::serve {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr auto kPatience = 120s;  // under the sanitizers and beside others

std::string field_scene(const char* tier = "screening") {
  std::ostringstream text;
  text << std::ifstream(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json").rdbuf();
  json scene = json::parse(text.str());
  scene["tier"] = tier;
  return scene.dump();
}

WhatIfQuestion question(const std::string& page, long number, const std::string& angle,
                        const std::string& scene = field_scene()) {
  return {page,
          number,
          scene,
          "scene.json",
          {{"changes", {{"/friction/friction_angle", angle}}}, {"charts", {"history"}}}};
}

json answer(WhatIfDesk& desk, const WhatIfQuestion& one) {
  return json::parse(desk.ask(one, kPatience));
}

class WhatIfDeskTest : public ::testing::Test {
 protected:
  faultsim::TemporaryFolder folder_;
  WhatIfDesk desk_{{FAULTSIM, folder_.path()}};
};

TEST_F(WhatIfDeskTest, AnswersAndTheSameQuestionAgainIsNotAskedAgain) {
  const json weak = answer(desk_, question("a", 1, "12 deg"));
  ASSERT_EQ(weak.at("state"), "done") << weak;
  EXPECT_THAT(weak.at("charts").at("history").get<std::string>(), HasSubstr("<svg"));
  const json again = answer(desk_, question("a", 1, "12 deg"));
  EXPECT_EQ(again, weak);
  const json strong = answer(desk_, question("a", 2, "35 deg"));
  EXPECT_NE(strong.at("identity"), weak.at("identity"));
  EXPECT_EQ(answer(desk_, question("a", 1, "12 deg")).at("state"), "superseded");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << "something was written to the store";
}

/// A question that nobody waits for says how far it is; a newer one of another page ends it.
TEST_F(WhatIfDeskTest, TheNewestQuestionOfAnyPageWins) {
  const json open =
      json::parse(desk_.ask(question("a", 1, "12 deg", field_scene("demonstration")), 0ms));
  EXPECT_THAT(open.at("state"), ::testing::AnyOf("running", "building"));
  std::thread waiting([&] {
    const json ended = answer(desk_, question("a", 1, "12 deg", field_scene("demonstration")));
    EXPECT_EQ(ended.at("state"), "superseded");
    EXPECT_THAT(ended.at("says").get<std::string>(), HasSubstr("another page"));
  });
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(answer(desk_, question("b", 1, "20 deg")).at("state"), "done");
  waiting.join();
}

TEST_F(WhatIfDeskTest, WhatCannotBeIsRefusedAndTheNextIsAnswered) {
  const json refused = answer(desk_, question("a", 1, "95 deg"));
  EXPECT_EQ(refused.at("state"), "refused");
  EXPECT_EQ(refused.at("problems").at(0).at("place"), "/friction/friction_angle");
  EXPECT_EQ(answer(desk_, question("a", 2, "20 deg")).at("state"), "done");
}

TEST_F(WhatIfDeskTest, RestsAndIsThereAgain) {
  WhatIfDesk desk({FAULTSIM, folder_.path(), 1, 0.01});
  EXPECT_EQ(answer(desk, question("a", 1, "20 deg")).at("state"), "done");
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(answer(desk, question("a", 2, "21 deg")).at("state"), "done");
}

TEST(WhatIfDesk, SaysThatThereIsNoSimulator) {
  const faultsim::TemporaryFolder folder;
  WhatIfDesk desk({folder.path() / "faultsim", folder.path()});
  const json failed = answer(desk, question("a", 1, "20 deg"));
  EXPECT_EQ(failed.at("state"), "failed");
  EXPECT_THAT(failed.at("says").get<std::string>(), HasSubstr("cannot start the simulator"));
}

}  // namespace
}  // namespace faultsweep::serve
