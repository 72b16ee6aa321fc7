// faultsweep nightly with the real faultsweep, mpirun and faultsim: what it must notice, and what
// it must not take for a regress.
#include <nlohmann/json.hpp>

#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class Nightly : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    write_spec({"15 deg", "20 deg", "30 deg"});
    write("suite.json",
          {{"format", 1}, {"name", "test"}, {"campaigns", json::array({"spec.json"})}});
  }
  void write(const char* name, const json& document) const {
    std::ofstream(folder_ / name) << document.dump();
  }
  /// One family, a case per friction angle; under a second of work.
  void write_spec(const std::vector<std::string>& angles) const {
    std::ifstream file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
    json base = json::parse(file);
    base["tier"] = "custom";
    base["numerics"] = {{"plane_strain", "on"}, {"activation_length", "100 m"}};
    base["mesh"] = {{"dip", "50 m"}, {"normal", "50 m"}};
    write("spec.json",
          {{"format", 1},
           {"name", "angles"},
           {"base", base},
           {"set", {{"offset", "100 m"}}},
           {"design", {{"kind", "grid"}, {"parameters", {{"friction_angle", angles}}}}}});
  }
  std::filesystem::path baselines() const { return folder_ / "baselines"; }
  testing::ProgramEnd nightly(std::vector<std::string> options = {},
                              const std::function<void()>& prepare = {}) {
    options.insert(options.begin(), {"nightly", (folder_ / "suite.json").string(), "--baselines",
                                     baselines().string(), "--workers", "2"});
    return faultsweep(options, prepare);
  }
  void bless(const std::function<void()>& prepare = {}) {
    const auto end = nightly({"--bless", "--reason", "first"}, prepare);
    ASSERT_EQ(end.code, 0) << end.err;
  }
  /// The one file of the suite.
  std::filesystem::path baseline() const {
    const auto files = std::filesystem::directory_iterator(baselines() / "test");
    return files->path();
  }
  json read_baseline() const {
    std::ifstream file(baseline());
    return json::parse(file);
  }
  void change_baseline(const std::function<void(json& cases)>& change) const {
    json document = read_baseline();
    change(document["campaigns"]["angles"]);
    std::ofstream(baseline()) << document.dump();
  }
  /// The simulator, with a sed script on the cases it is given and one on what it prints. It is not
  /// told whose cases they are, as it would refuse changed ones.
  void wrap(const std::string& requests, const std::string& output) {
    const auto script = folder_ / "wrapped", verify = folder_ / "faultsim-verify";
    std::ofstream(verify) << "#!/bin/sh\n'" << FAULTSIM << "-verify' \"$@\" >\"$0.out\"; code=$?\n"
                          << "sed '" << output << "' \"$0.out\"; exit $code\n";
    std::filesystem::permissions(verify, std::filesystem::perms::owner_all);
    std::ofstream(script) << "#!/bin/sh\nreal='" FAULTSIM "'\n"
                          << "if [ \"$1\" != worker ]; then \"$real\" \"$@\" >\"$0.out\"; code=$?\n"
                          << "  sed '" << output << "' \"$0.out\"; exit $code; fi\n"
                          << "shift 3\n"
                          << "sed -u 's/,\"identity\":\"[0-9a-f]*\"//;" << requests
                          << "' <&3 | \"$real\" worker --requests 0 \"$@\"\n";
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    simulator_ = script;
  }
  /// Of a night as JSON, by case number.
  static std::vector<std::string> verdicts(const testing::ProgramEnd& end) {
    std::vector<std::string> all;
    const json night = json::parse(end.out);
    for (const json& one : night.at("cases")) all.push_back(one.at("verdict"));
    return all;
  }
};

TEST_F(Nightly, TwoNightsInARowAreIdenticalAndTheSecondReusesNothing) {
  bless();
  for (int night = 0; night < 2; ++night) {
    const auto end = nightly({"--json"});
    EXPECT_EQ(end.code, 0) << end.err;
    EXPECT_THAT(verdicts(end), ::testing::ElementsAre("identical", "identical", "identical"));
    EXPECT_EQ(json::parse(end.out)["compared"], 3);
    const Store last = Store::open_reader(store_ / "last");
    const auto families = last.family_progress(last.campaign("").id);
    ASSERT_EQ(families.size(), 1u);
    EXPECT_TRUE(families[0].build_seconds.has_value()) << "the operator came from a cache";
  }
  const auto history = faultsweep({"nightly", "--history", "--json"});
  const json nights = json::parse(history.out)["nights"];
  ASSERT_EQ(nights.size(), 3u);
  EXPECT_EQ(nights[0]["blessed"], "first");
  EXPECT_EQ(nights[2]["regressed"], 0);
  EXPECT_EQ(nights[1]["cases"][1]["digest"], nights[2]["cases"][1]["digest"]);
  EXPECT_THAT(faultsweep({"nightly", "--history"}).out, HasSubstr("first"));
}

TEST_F(Nightly, NothingComparedIsNoSuccessAndMakesNoBaseline) {
  const auto missing = nightly();
  EXPECT_EQ(missing.code, 5);
  EXPECT_THAT(missing.err, HasSubstr("nothing was compared: there is no baseline"));
  EXPECT_THAT(missing.err, HasSubstr("--bless --reason"));
  EXPECT_FALSE(std::filesystem::exists(baselines()));
  write("suite.json", {{"format", 1}, {"name", "test"}});
  const auto empty = nightly();
  EXPECT_EQ(empty.code, 5);
  EXPECT_THAT(empty.err, HasSubstr("nothing was compared: the suite names no campaign"));
  EXPECT_EQ(nightly({"--bless"}).code, 2);
  EXPECT_EQ(nightly({"--bless", "--reason", " "}).code, 2);
  EXPECT_EQ(nightly({"--reason", "because"}).code, 2);
  write("suite.json", {{"format", 1},
                       {"name", "te/st"},
                       {"campaigns", json::array({"nowhere.json"})},
                       {"tolerances", {{"momentum", 0.1}}}});
  EXPECT_EQ(nightly().code, 2);
  write("suite.json", {{"format", 1},
                       {"name", "test"},
                       {"campaigns", json::array({"nowhere.json"})},
                       {"tolerances", {{"momentum", 0.1}}}});
  const auto wrong = nightly();
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("/campaigns/0: there is no file"));
  EXPECT_THAT(wrong.err, HasSubstr("/tolerances/momentum: \"momentum\" is not a quantity"));
  EXPECT_FALSE(std::filesystem::exists(baselines()));
}

TEST_F(Nightly, ADamagedBaselineIsAnError) {
  bless();
  std::filesystem::resize_file(baseline(), 1000);
  const auto end = nightly();
  EXPECT_EQ(end.code, 5);
  EXPECT_THAT(end.err, HasSubstr("reading the baseline"));
  bless();
  const auto copy = baseline().parent_path() / "0123.json";
  std::filesystem::rename(baseline(), copy);
  EXPECT_THAT(nightly().err, HasSubstr("not of the one in its name"));
}

TEST_F(Nightly, APlanted1e13InTheBaselineIsLocated) {
  bless();
  constexpr int kStep = 7;
  change_baseline([](json& cases) {
    json& steps = cases[1]["result"]["steps"];
    for (std::size_t k = 0; k < steps["keys"].size(); ++k) {
      if (steps["keys"][k] != "/faults/0/chi_bar") continue;
      json& value = steps["rows"][kStep][k];
      value = value.get<double>() * (1 + 1e-13);
      return;
    }
    FAIL() << "no chi_bar in the baseline";
  });
  const auto end = nightly({"--json"});
  EXPECT_EQ(end.code, 5) << end.err;
  EXPECT_THAT(verdicts(end), ::testing::ElementsAre("identical", "last bits", "identical"));
  const json one = json::parse(end.out)["cases"][1];
  EXPECT_EQ(one["load_step"], kStep);
  EXPECT_EQ(one["quantity"], "chi_bar");
  EXPECT_GT(one["max_ulps"], 200);
  EXPECT_LT(one["max_ulps"], 1000);
  EXPECT_THAT(one["remark"].get<std::string>(), HasSubstr("fault 1: chi_bar"));
  EXPECT_THAT(nightly().out, HasSubstr("REGRESSED: 1 cases"));
}

TEST_F(Nightly, APerturbationOf1e13InTheSimulationIsLocated) {
  bless();
  wrap("s/\"20 deg\"/\"20.000000000002 deg\"/g", "");
  const auto end = nightly({"--json"});
  EXPECT_EQ(end.code, 5) << end.err;
  const json night = json::parse(end.out);
  EXPECT_EQ(night["regressed"], 1);
  EXPECT_EQ(night["cases"][0]["verdict"], "identical");
  EXPECT_EQ(night["cases"][2]["verdict"], "identical");
  const json one = night["cases"][1];
  EXPECT_EQ(one["verdict"], "last bits") << one;
  EXPECT_FALSE(one["load_step"].is_null());
  EXPECT_NE(one["quantity"], "");
  EXPECT_EQ(night["advice"].size(), 1u);  // other numbers than in the night before
}

TEST_F(Nightly, AnotherBlasKernelIsAnotherEnvironmentAndNoRegress) {
  // Two kernels by name: the one that this machine takes by itself may be either of them.
  bless([] {
    setenv("OPENBLAS_CORETYPE", __builtin_cpu_supports("avx2") ? "Haswell" : "Nehalem", 1);
  });
  const auto prescott = [] { setenv("OPENBLAS_CORETYPE", "Prescott", 1); };
  const auto end = nightly({"--json"}, prescott);
  EXPECT_EQ(end.code, 0) << end.out << end.err;
  const json night = json::parse(end.out);
  EXPECT_NE(night["environment"], night["baseline_environment"]);
  EXPECT_THAT(night["remarks"].dump(), HasSubstr("ENVIRONMENT DIFFERS FROM THE BASELINE'S"));
  EXPECT_THAT(night["remarks"].dump(), HasSubstr("blas_kernel"));
  // Otherwise the kernel did not matter, and nothing was shown:
  EXPECT_THAT(verdicts(end), ::testing::Contains("within tier"));
  // What no environment excuses:
  change_baseline([](json& cases) { cases[2]["result"]["outcome"] = "event"; });
  const auto flipped = nightly({"--json"}, prescott);
  EXPECT_EQ(flipped.code, 5);
  EXPECT_EQ(verdicts(flipped)[2], "outcome changed");
  change_baseline([](json& cases) {
    cases[2]["result"]["outcome"] = "converged";
    json& activated = cases[0]["result"]["whole"]["activated"];
    activated = !activated.get<bool>();
  });
  EXPECT_EQ(verdicts(nightly({"--json"}, prescott))[0], "activation flipped");
  // A baseline of its own: from now on bit for bit.
  EXPECT_EQ(nightly({"--bless", "--reason", "another kernel"}, prescott).code, 0);
  const auto own = nightly({"--json"}, prescott);
  EXPECT_EQ(own.code, 0);
  EXPECT_THAT(verdicts(own), ::testing::Each("identical"));
}

TEST_F(Nightly, ACaseThatIsGoneIsARegressUntilBlessed) {
  bless();
  write_spec({"15 deg", "30 deg", "35 deg"});
  const auto end = nightly({"--json"});
  EXPECT_EQ(end.code, 5);
  EXPECT_THAT(verdicts(end),
              ::testing::ElementsAre("identical", "identical", "unblessed", "missing"));
  EXPECT_EQ(nightly({"--bless", "--reason", "20 deg is out"}).code, 0);
  EXPECT_EQ(read_baseline()["blessed"].size(), 2u);  // the first reason is kept
  EXPECT_EQ(nightly().code, 0);
}

TEST_F(Nightly, ASampleOfAStoreIsComparedWithWhatIsStored) {
  const auto nights = store_;
  store_ = folder_ / "swept";
  ASSERT_EQ(faultsweep({"submit", (folder_ / "spec.json").string()}).code, 0);
  ASSERT_EQ(faultsweep({"run", "--workers", "2"}).code, 0);
  store_ = nights;
  write("suite.json",
        {{"format", 1},
         {"name", "test"},
         {"verification", json::array({"V3"})},
         {"samples",
          json::array({{{"store", "swept"}, {"campaign", "angles"}, {"top", 1}, {"sample", 1}}})}});
  const auto same = nightly({"--json"});
  EXPECT_EQ(same.code, 0) << same.err;
  const json cases = json::parse(same.out)["cases"];
  EXPECT_EQ(cases[0]["campaign"], "sample-angles");
  EXPECT_EQ(cases[0]["verdict"], "identical");
  EXPECT_EQ(cases[1]["verdict"], "identical");
  EXPECT_EQ(cases[2]["campaign"], "faultsim-verify");
  EXPECT_EQ(cases[2]["verdict"], "within tier");
  wrap("s/15 deg/15.0000000000015 deg/g", "s/\"passed\": true/\"passed\": false/");
  const auto other = nightly({"--json"});
  EXPECT_EQ(other.code, 5);
  EXPECT_EQ(verdicts(other)[0], "last bits");
  EXPECT_EQ(verdicts(other)[2], "beyond tier");
}

}  // namespace
}  // namespace faultsweep
