// Limits from the spec to the table: the real faultsweep under the real mpirun with the real
// faultsim, in plane strain.
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kDocs = std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/";

class Limits : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    spec_ = ordered_json::parse(std::ifstream(kDocs + "campaigns/storage-limit.json"));
    spec_["base"] = kDocs + "scenes/rotliegend.json";
    spec_["set"]["/tier"] = "custom";
    spec_["set"]["/mesh"] = {{"dip", "20 m"}, {"normal", "20 m"}};
    spec_["design"]["parameters"] = {{"offset", {"100 m", "200 m"}},
                                     {"friction_angle", {"20 deg", "24 deg"}}};
  }
  std::string file() {
    const std::string name = (folder_ / "spec.json").string();
    std::ofstream(name) << spec_.dump(1);
    return name;
  }
  /// Whether F2 slides in storage, by a run of faultsim alone.
  bool slides(const json& parameters, const std::string& pressure) {
    const std::string folder = (folder_ / "run").string();
    std::filesystem::remove_all(folder);
    std::string command =
        faultsim::concat(FAULTSIM " run ", kDocs, "scenes/rotliegend.json -o ", folder, " --cache ",
                         (folder_ / "cache").string(), " >/dev/null 2>&1");
    const auto set = [&](const std::string& pointer, const json& value) {
      command += faultsim::concat(" --set '", pointer, "=", value.dump(), "'");
    };
    for (const auto& [pointer, value] : spec_["set"].items()) set(pointer, value);
    for (const auto& [name, value] : parameters.items()) set(name, value);
    set("/stages/2/pressure_between/1", pressure);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    const json result = json::parse(std::ifstream(folder + "/result.json"));
    for (const json& stage : result.at("stages")) {
      if (stage.at("stage") != "gas_storage") continue;
      for (const json& fault : stage.at("faults"))
        if (fault.at("fault") == "F2") return fault.at("activated").get<bool>();
    }
    ADD_FAILURE() << "no F2 in gas_storage";
    return false;
  }
  ordered_json spec_;
};

TEST_F(Limits, OneCommandAnswersAndRunsAgreeOnBothSides) {
  const auto end = wait(start({"limits", file(), "--workers", "2", "--json"}), 300);
  ASSERT_EQ(end.code, 0) << end.err;
  const json found = json::parse(end.out);
  EXPECT_TRUE(found["finished"]);
  ASSERT_EQ(found["limits"].size(), 4u);
  int n_limits = 0;
  for (const json& row : found["limits"]) {
    if (row["verdict"] != "limit") {
      EXPECT_EQ(row["verdict"], "safe throughout") << row;
      EXPECT_FALSE(slides(row["parameters"], "0 bar"));
      continue;
    }
    ++n_limits;
    EXPECT_NEAR(row["unsafe"].get<double>() - row["safe"].get<double>(), 1e5, 1e-6);
    EXPECT_FALSE(slides(row["parameters"], row["safe_text"])) << row;
    EXPECT_TRUE(slides(row["parameters"], row["unsafe_text"])) << row;
    EXPECT_NEAR(row["absolute_pa"].get<double>(), 221.2e5 + row["safe"].get<double>(), 0.1e5)
        << "p0 is hydrostatic at 2000 m and 25 bar";
  }
  EXPECT_EQ(n_limits, 2) << "of an offset as large as the reservoir is thick";
  const Store store = Store::open_reader(store_);
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
  EXPECT_GT(store.rounds(store.campaign("").id).size(), 2u);
  EXPECT_EQ(faultsweep({"limits", file(), "--json"}).out, end.out) << "nothing is computed again";
  EXPECT_THAT(faultsweep({"limits", "storage-limit", "--map", "offset", "friction_angle"}).out,
              HasSubstr("24 deg          all safe"));
}

TEST_F(Limits, ANonMonotoneAnswerIsFoundAndSaid) {
  spec_["name"] = "offset-limit";
  spec_["set"]["/stages/0/pressure_change"] = "-120 bar";
  spec_["design"]["parameters"] = {{"friction_angle", {"28 deg"}}};
  spec_["limits"] = {
      {"throw",
       {{"parameter", {{"pointers", {"offset"}}, {"from", "0 m"}, {"to", "300 m"}, {"count", 11}}},
        {"faults", {"F2"}},
        {"stage", "primary_production"},
        {"tolerance", "10 m"}}}};
  const auto end = wait(start({"limits", file(), "--workers", "2", "--wide"}), 300);
  ASSERT_EQ(end.code, 0) << end.err;
  EXPECT_THAT(end.out, HasSubstr("non-monotone: unsafe"));
  EXPECT_THAT(end.out, HasSubstr("1 of 1 is non-monotone"));
}

TEST_F(Limits, AWrongQuestionIsRefusedBeforeAnythingIsStored) {
  spec_["limits"]["storage_pressure"]["faults"] = {"F9"};
  const auto wrong = faultsweep({"limits", file()});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("/limits/storage_pressure/unsafe"));
  EXPECT_THAT(wrong.err, HasSubstr("F9"));
  spec_.erase("limits");
  EXPECT_THAT(faultsweep({"limits", file()}).err, HasSubstr("does not search for limits"));
  EXPECT_FALSE(std::filesystem::exists(store_ / "campaign.sqlite"));
}

}  // namespace
}  // namespace faultsweep
