// CSV tables of a campaign's scene: what was submitted is what runs, and nothing else is stored
// under its name.
#include <nlohmann/json.hpp>

#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"
#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using nlohmann::json;
using ::testing::HasSubstr;

class Tables : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    std::ifstream file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
    scene_ = json::parse(file);
    scene_["tier"] = "custom";
    scene_["mesh"] = {{"dip", "50 m"}, {"normal", "50 m"}};
    scene_["numerics"] = {{"plane_strain", "on"}};
    scene_["stages"] = {{{"name", "production"}, {"duration", "2 year"}, {"steps", 2}}};
    scene_["pressure_csv"] = "history.csv";
    write_history(-100);
  }
  /// Both blocks at so many bar after two years.
  void write_history(int change) const {
    std::ofstream(folder_ / "history.csv")
        << "time [year], west [bar], east [bar]\n0, 0, 0\n2, " << change << ", " << change << "\n";
  }
  void submit_spec(const json& design) {
    std::ofstream(folder_ / "scene.json") << scene_.dump();
    const json spec = {
        {"format", 1}, {"name", "tables"}, {"base", "scene.json"}, {"design", design}};
    std::ofstream(folder_ / "spec.json") << spec.dump();
    const auto end = faultsweep({"submit", (folder_ / "spec.json").string()});
    ASSERT_EQ(end.code, 0) << end.err;
  }
  void run() {
    const auto end = wait(start({"run", "--workers", "1"}), 120);
    ASSERT_EQ(end.code, 0) << end.out << end.err;
  }
  StoredCase stored(const std::string& position) const {
    const Store store = Store::open_reader(store_);
    return store.stored_case(store.campaign("").id, position);
  }
  /// Of west at the end, bar.
  static double last_change(const CaseResult& result) {
    return result.steps.back().pressure_change.at(0) / 1e5;
  }
  json scene_;
};

const json kTwoAngles = {{"kind", "grid"},
                         {"parameters", {{"friction_angle", {{"values", {"25 deg", "30 deg"}}}}}}};

TEST_F(Tables, EditedAfterSubmissionChangeNothing) {
  submit_spec(kTwoAngles);
  write_history(-50);
  run();
  const std::string first = stored("1").identity;
  EXPECT_NEAR(last_change(stored("1").result), -100, 1e-9);
  submit_spec(kTwoAngles);
  run();
  EXPECT_NE(stored("1").identity, first) << "another table is another case";
  EXPECT_NEAR(last_change(stored("1").result), -50, 1e-9);
  std::filesystem::remove(folder_ / "history.csv");
  const auto shown = faultsweep({"show", "1", "--wide"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("initial state at mid-depth"));
  EXPECT_THAT(faultsweep({"show", "1", "--json"}).out, HasSubstr("\"initial_state\""));
}

TEST_F(Tables, OfVariantsGoWithTheCampaign) {
  std::ofstream(folder_ / "other.csv")
      << "time [year], west [bar], east [bar]\n0, 0, 0\n2, -70, -70\n";
  const json history = {
      {"variants",
       {{"one", {{"/pressure_csv", "history.csv"}}}, {"other", {{"/pressure_csv", "other.csv"}}}}}};
  submit_spec({{"kind", "grid"}, {"parameters", {{"history", history}}}});
  std::filesystem::remove(folder_ / "history.csv");
  std::filesystem::remove(folder_ / "other.csv");
  run();
  EXPECT_NEAR(last_change(stored("1").result), -100, 1e-9);
  EXPECT_NEAR(last_change(stored("2").result), -70, 1e-9);
}

/// A store from before scenes had their tables with them: its scene names a file.
TEST_F(Tables, ThatWereEditedInAnOldStoreRefuseTheCase) {
  const std::string source = (folder_ / "scene.json").string();
  const faultsim::JsonDocument document = faultsim::parse_json(scene_.dump(), source);
  const faultsim::Scene scene = faultsim::read_scene(document);
  std::vector<faultsim::Problem> problems;
  Submission s;
  s.name = "old";
  s.source = "spec.json";
  s.spec_given = "{}";
  s.spec_resolved = R"({"groups": [{"parameters": []}]})";
  s.parameters = {};
  s.rank_by = "activated_area";
  s.scenes = {{source, scene_.dump()}};
  s.families = {{faultsim::make_plan(scene, problems).family, 1000, 100, 1, 1e8}};
  s.cases = {{faultsim::case_identity(scene), 0, 0, "{}", {}}};
  Store::open_writer(store_).submit(s);
  write_history(-50);
  EXPECT_EQ(faultsweep({"run", "--workers", "1"}).code, 1);
  const StoredCase one = stored("1");
  EXPECT_FALSE(one.has_result) << "a result of another scene under this case's name";
  ASSERT_EQ(one.runs.size(), 1U);
  EXPECT_EQ(one.runs[0].status, "refused");
  EXPECT_THAT(one.runs[0].reason, HasSubstr("the scene is not the one that was submitted"));
  EXPECT_THAT(one.runs[0].reason, HasSubstr("submit the campaign again"));
  write_history(-100);
  EXPECT_EQ(faultsweep({"retry"}).code, 0);
  EXPECT_EQ(faultsweep({"run", "--workers", "1"}).code, 0);
  EXPECT_NEAR(last_change(stored("1").result), -100, 1e-9);
}

}  // namespace
}  // namespace faultsweep
