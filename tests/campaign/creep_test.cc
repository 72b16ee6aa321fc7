// Campaigns whose salt creeps: the real faultsweep under the real mpirun with the real faultsim.
#include <nlohmann/json.hpp>
#include <set>

#include "campaign/store/same_numbers.h"
#include "simulator/result/result_json.h"
#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

class Creep : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    write("scene.json", coarse_field());
  }

  /// The reference field with viscous salt in plane strain on 50 m cells, offset by 200 m.
  static json coarse_field() {
    json scene = read_json(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json");
    scene["tier"] = "custom";
    scene["mesh"] = {{"dip", "50 m"}, {"normal", "50 m"}};
    scene["numerics"] = {
        {"plane_strain", "on"}, {"activation_length", "100 m"}, {"creep_refinements", 1}};
    scene["geometry"]["blocks"][1]["offset"] = "200 m";
    return scene;
  }

  void write(const std::string& name, const json& document) const {
    std::ofstream(folder_ / name) << document.dump(1);
  }
  /// Submits the grid of friction angles and pressures prescribed in the faults.
  void submit_grid(const std::vector<std::string>& angles,
                   const std::vector<std::string>& pressures) {
    json spec = {{"format", 1}, {"name", "salt"}, {"base", "scene.json"}};
    spec["set"] = {{"/fault_pressure", {{"rule", "prescribed"}, {"prescribed", "0 bar"}}}};
    spec["design"] = {
        {"kind", "grid"},
        {"parameters", {{"friction_angle", angles}, {"/fault_pressure/prescribed", pressures}}}};
    write("spec.json", spec);
    const auto end = faultsweep({"submit", (folder_ / "spec.json").string()});
    ASSERT_EQ(end.code, 0) << end.err;
    EXPECT_THAT(
        end.out,
        HasSubstr("salt creeps in 1 family: each worker that runs one builds its operators"));
  }
  double predicted_memory() {
    const auto status = faultsweep({"status", "--json"});
    const json family = json::parse(status.out)["families"].at(0);
    EXPECT_EQ(family["n_operators"], 4);
    return family["predicted_memory_bytes"];
  }
  /// The ranks that ran cases of the campaign.
  std::set<int> ranks() const {
    const Store store = Store::open_reader(store_);
    const CampaignInfo campaign = store.campaign("");
    std::set<int> found;
    for (long k = 1; k <= campaign.n_cases; ++k) {
      for (const StoredRun& run : store.stored_case(campaign.id, std::to_string(k)).runs) {
        found.insert(run.rank);
      }
    }
    return found;
  }
  /// The same case by `faultsim run`.
  CaseResult run_alone(const std::string& angle, const std::string& pressure) const {
    const std::filesystem::path out = folder_ / ("alone" + angle + pressure);
    const std::string command = std::string(FAULTSIM) + " run " +
                                (folder_ / "scene.json").string() + " --set friction_angle='" +
                                angle + "' --set /fault_pressure/rule=prescribed" +
                                " --set /fault_pressure/prescribed='" + pressure +
                                "' --no-cache -o '" + out.string() + "' >/dev/null 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return faultsim::result_from_json(read_json(out / "result.json"));
  }
};

TEST_F(Creep, NumbersAreThoseOfCasesRunAloneWhateverTheWorkersAndTheOrder) {
  const std::vector<std::string> angles = {"12 deg", "16 deg", "20 deg", "28 deg"};
  const std::vector<std::string> pressures = {"0 bar", "-100 bar"};
  submit_grid(angles, pressures);
  ASSERT_EQ(faultsweep({"run", "--workers", "2", "--memory", "0"}).code, 0);
  const std::filesystem::path two = store_;
  store_ = folder_ / "one";
  submit_grid({angles.rbegin(), angles.rend()}, {pressures.rbegin(), pressures.rend()});
  ASSERT_EQ(faultsweep({"run", "--workers", "1"}).code, 0);
  double most_slip = 0, most_creep = 0;
  int time_steps = 0;
  for (int k = 0; k < 8; ++k) {
    const std::string& pressure = pressures[static_cast<std::size_t>(k / 4)];
    const std::string& angle = angles[static_cast<std::size_t>(k % 4)];
    const CaseResult alone = run_alone(angle, pressure);
    const Store forth = Store::open_reader(two), back = Store::open_reader(store_);
    const auto stored = [&](const Store& store, int position) {
      const StoredCase one = store.stored_case(store.campaign("").id, std::to_string(position));
      std::vector<std::string> texts;
      for (const CaseParameter& value : one.parameters) texts.push_back(value.text);
      EXPECT_THAT(texts, ::testing::UnorderedElementsAre(angle, pressure));
      return one.result;
    };
    const CaseResult first = stored(forth, k + 1), last = stored(back, 8 - k);
    EXPECT_EQ(first_difference(first, alone), "") << angle << ", " << pressure;
    EXPECT_EQ(first_difference(last, alone), "") << angle << ", " << pressure;
    EXPECT_EQ(first.operator_fingerprint, alone.operator_fingerprint);
    most_slip = std::max(most_slip, alone.whole.max_slip);
    const auto& creep = first.steps.back().creep;
    ASSERT_TRUE(creep);
    time_steps += creep->time_steps;
    for (const faultsim::FaultCreep& fault : creep->faults) {
      most_creep = std::max(most_creep, fault.shear_max);
    }
  }
  // The comparison must see more than zeros.
  EXPECT_GT(most_slip, 1e-2);
  EXPECT_GT(most_creep, 1e5);
  EXPECT_GE(time_steps, 16);
}

TEST_F(Creep, ASecondWorkerTakesPartOnlyWhereItsOperatorsFit) {
  std::vector<std::string> angles;
  for (int k = 0; k < 12; ++k) angles.push_back(std::to_string(10 + k) + " deg");
  submit_grid(angles, {"0 bar", "-100 bar"});
  const double megabytes = predicted_memory() / 1e6;
  const auto narrow =
      faultsweep({"run", "--workers", "2", "--memory", std::to_string(1.5 * megabytes) + " MB"});
  EXPECT_EQ(narrow.code, 0) << narrow.err;
  EXPECT_THAT(ranks(), ElementsAre(1));
  std::filesystem::remove_all(store_);
  submit_grid(angles, {"0 bar", "-100 bar"});
  const auto wide =
      faultsweep({"run", "--workers", "2", "--memory", std::to_string(2.5 * megabytes) + " MB"});
  EXPECT_EQ(wide.code, 0) << wide.err;
  EXPECT_THAT(ranks(), ElementsAre(1, 2));
}

TEST_F(Creep, AKilledSimulatorCostsItsCaseAndTheLadderIsBuiltAgain) {
  std::vector<std::string> angles;
  for (int k = 0; k < 24; ++k) angles.push_back(std::to_string(10 + k) + " deg");
  submit_grid(angles, {"0 bar"});
  const pid_t starter = start({"run", "--workers", "1"});
  ASSERT_TRUE(wait_for_done(8));  // from then on the worker has several cases at hand
  int n_kills = 0;
  for (const pid_t mpirun : children_of(starter)) {
    for (const pid_t rank : children_of(mpirun)) {
      for (const pid_t simulator : children_of(rank)) n_kills += kill(simulator, SIGKILL) == 0;
    }
  }
  EXPECT_GE(n_kills, 1);
  EXPECT_EQ(wait(starter).code, 1);
  Store store = Store::open_reader(store_);
  EXPECT_EQ(store.campaign("").n_done, 23);
  EXPECT_EQ(store.campaign("").n_failed, 1);
}

}  // namespace
}  // namespace faultsweep
