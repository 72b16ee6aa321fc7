// What-if as a page asks for it: a store, its requests and a real simulator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "campaign/serve/store_api.h"
#include "simulator/files/temporary_folder.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The process that answers this program's questions; none where there is none.
std::optional<pid_t> simulator_of_this_program() {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(thread.path() / "children");
    for (pid_t child; children >> child;) {
      std::ifstream file("/proc/" + std::to_string(child) + "/comm");
      std::string name;
      if (std::getline(file, name) && name == "faultsim") return child;
    }
  }
  return std::nullopt;
}

/// A store with one case of a field, of whose friction angle a page has a slider.
class WhatIfRoute : public ::testing::Test {
 protected:
  static constexpr const char* kBase = "/api/campaigns/sweep/cases/1/what-if?page=me";

  WhatIfRoute() {
    std::ostringstream text;
    text << std::ifstream(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json").rdbuf();
    json scene = json::parse(text.str());
    scene["tier"] = "screening";
    scene["friction"]["friction_angle"] = "12 deg";
    scene["geometry"]["blocks"][1]["offset"] = "150 m";  // so that the middle fault slips
    Submission s;
    s.name = "sweep";
    s.spec_given = "{}";
    s.spec_resolved = json{{"groups", json::array()}}.dump();
    s.scenes = {{"scene.json", scene.dump()}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    s.cases = {{"identity-0", 0, 0, "{}", {}}};
    Store::open_owner(folder_.path() / "store").submit(s);
    api_.emplace(folder_.path() / "store", FAULTSIM);
  }

  /// The answer to a question, which is asked until it is there, as the page does.
  json answer(const std::string& asks) {
    const std::string target = kBase + std::string("&wait=2000&ask=") + std::to_string(++number_);
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);;) {
      const HttpResponse response = api_->answer(parse_target(target + asks));
      EXPECT_EQ(response.status, 200) << asks << response.body;
      json reply = json::parse(response.body, nullptr, false);
      const std::string state = reply.value("state", "no answer");
      if ((state != "running" && state != "building") || std::chrono::steady_clock::now() > end)
        return reply;
    }
  }
  /// Of a case with another friction angle.
  static std::string with_angle(const char* degrees) {
    return std::string("&changes=%7B%22/friction/friction_angle%22:%22") + degrees + "%20deg%22%7D";
  }

  faultsim::TemporaryFolder folder_;
  std::optional<StoreApi> api_;
  long number_ = 0;
};

TEST_F(WhatIfRoute, ShowsOnAFaultMapWhatIsAskedFor) {
  const auto map = [&](const std::string& show) {
    const json reply = answer("&chart=fault-map&chart=history&fault=F2" + show);
    EXPECT_EQ(reply.value("state", ""), "done") << reply;
    const std::string svg = reply.at("charts").at("fault-map").get<std::string>();
    EXPECT_EQ(faultsim::figure::xml_problem(svg), "");
    return svg;
  };
  const std::string chi = map("");
  EXPECT_THAT(chi, HasSubstr(">χ o"));
  EXPECT_EQ(map("&show=chi"), chi);
  const std::string slip = map("&show=slip");
  for (const char* text : {">Slip o", ">slip, mm<"}) EXPECT_THAT(slip, HasSubstr(text));
  const std::string state = map("&show=state");
  for (const char* text : {">State of fault F2", ">sticks<"}) EXPECT_THAT(state, HasSubstr(text));
  const std::string pressure = map("&show=pressure");
  for (const char* text : {">Pressure change in fault F2", ">Δp, bar<"})
    EXPECT_THAT(pressure, HasSubstr(text));
}

/// Before a simulator is asked at all.
TEST_F(WhatIfRoute, AWordThatNothingShowsIsAnErrorInJson) {
  for (const char* show : {"colour", "", "Slip", "slip%20", "chi,slip", "0"}) {
    const HttpResponse response =
        api_->answer(parse_target(std::string(kBase) + "&ask=1&chart=fault-map&show=" + show));
    EXPECT_EQ(response.status, 400) << show;
    EXPECT_EQ(response.type, "application/json");
    const json error = json::parse(response.body).at("error");
    EXPECT_EQ(error.at("place"), "show");
    EXPECT_THAT(error.at("cure").get<std::string>(), HasSubstr("chi, slip, state, pressure"));
  }
  const HttpResponse twice =
      api_->answer(parse_target(std::string(kBase) + "&ask=1&show=slip&show=chi"));
  EXPECT_EQ(json::parse(twice.body).at("error").at("place"), "show");
  EXPECT_FALSE(simulator_of_this_program());
}

/// A simulator that is begun anew has the case, but not the result of it unchanged, which all
/// others are held against: its answers have no differences until that is asked for again.
TEST_F(WhatIfRoute, ASimulatorThatIsBegunAnewHasLostTheCaseAsItWas) {
  const auto has_differences = [](const json& reply) { return reply.contains("differences"); };
  const json before = answer("&chart=history");
  ASSERT_EQ(before.value("state", ""), "done") << before;
  EXPECT_FALSE(has_differences(before));
  const json changed = answer("&chart=history" + with_angle("30"));
  EXPECT_EQ(changed.value("state", ""), "done") << changed;
  ASSERT_TRUE(has_differences(changed));
  EXPECT_THAT(changed.at("charts").at("history").get<std::string>(),
              HasSubstr("before the change"));

  const auto simulator = simulator_of_this_program();
  ASSERT_TRUE(simulator);
  ASSERT_EQ(::kill(*simulator, SIGKILL), 0);
  const json lost = answer("&chart=history" + with_angle("30"));
  EXPECT_EQ(lost.value("state", ""), "failed") << lost;
  EXPECT_THAT(lost.value("says", ""), HasSubstr("simulator"));

  const json alone = answer("&chart=history" + with_angle("30"));
  ASSERT_EQ(alone.value("state", ""), "done") << alone << ": it was not told the scene again";
  EXPECT_EQ(alone.at("identity"), changed.at("identity"));
  EXPECT_FALSE(has_differences(alone));
  EXPECT_THAT(alone.at("charts").at("history").get<std::string>(),
              Not(HasSubstr("before the change")));
  EXPECT_NE(simulator_of_this_program(), simulator);

  EXPECT_EQ(answer("").at("identity"), before.at("identity"));  // as the page asks then
  const json again = answer("&chart=history" + with_angle("30"));
  ASSERT_TRUE(has_differences(again));
  for (const char* same : {"differences", "charts", "identity"})
    EXPECT_EQ(again.at(same), changed.at(same)) << same;
}

}  // namespace
}  // namespace faultsweep
