// Sampled designs from the spec to results in the store: the real faultsweep under the real mpirun
// with the real faultsim, in plane strain.
#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Designs : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
  }

  /// Submits a design of the small field; what submit says of it.
  json submit(const std::string& design, const nlohmann::ordered_json& operators = {},
              const std::string& tier = "") {
    auto spec = nlohmann::ordered_json::parse(
        std::ifstream(std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/campaigns/small.json"));
    spec["base"] = std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/scenes/rotliegend.json";
    spec["design"] = nlohmann::ordered_json::parse(design);
    if (!operators.is_null()) spec["operators"] = operators;
    if (!tier.empty()) {
      spec["set"] = {{"/tier", tier}, {"/numerics/plane_strain", "on"}};
      spec["name"] = "at-" + tier;
    }
    const std::string file = (folder_ / "spec.json").string();
    std::ofstream(file) << spec.dump(1);
    const auto submitted = faultsweep({"submit", file, "--json"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    return json::parse(submitted.out);
  }
  /// The same, and runs it.
  json run(const std::string& design) {
    const json submitted = submit(design);
    const auto end = wait(start({"run", "--workers", "2"}), 300);
    EXPECT_EQ(end.code, 0) << end.err;
    return submitted;
  }

  /// Parameter vectors of the rows of the only design, and that each has a complete result.
  std::vector<std::vector<double>> rows() {
    const Store store = Store::open_reader(store_);
    const CampaignInfo campaign = store.campaign("");
    EXPECT_EQ(campaign.n_complete(), campaign.n_cases);
    EXPECT_THAT(store.integrity_problems(), IsEmpty());
    std::vector<std::vector<double>> result;
    for (const DesignRow& row : store.design_rows(campaign.id)) {
      EXPECT_EQ(row.design, 0);
      EXPECT_EQ(row.row, static_cast<long>(result.size()) + 1);
      const StoredCase one = store.stored_case(campaign.id, std::to_string(row.position));
      EXPECT_TRUE(one.has_result);
      result.emplace_back();
      for (const CaseParameter& value : one.parameters) result.back().push_back(value.si.value());
    }
    return result;
  }
};

TEST_F(Designs, ALatinHypercubeSharesTheOperatorsOfItsLevels) {
  const json submitted = run(R"({"kind": "latin-hypercube", "samples": 8, "parameters": {
      "offset": ["0 m", "100 m"], "friction_angle": {"from": "15 deg", "to": "31 deg"}}})");
  EXPECT_EQ(submitted["families"].size(), 2u);
  std::vector<int> parts(8, 0);
  for (const auto& row : rows()) {
    ++parts.at(static_cast<std::size_t>((row[1] * 180 / M_PI - 15) / 2));
  }
  EXPECT_EQ(parts, std::vector<int>(8, 1)) << "one friction angle in each 2 deg";
}

TEST_F(Designs, EverySobolRowHasItsCase) {
  const json submitted = run(R"({"kind": "sobol", "samples": 4, "parameters": {
      "friction_angle": {"from": "15 deg", "to": "30 deg"}, "ratio_across": [0.5, 0.7]}})");
  EXPECT_EQ(submitted["designed"], 16);
  EXPECT_GT(submitted["merged"], 0) << "A and AB_2 have the same level somewhere";
  const auto all = rows();
  ASSERT_EQ(all.size(), 16u);
  for (std::size_t i = 0; i < 16; i += 4) {
    const auto &a = all[i], &b = all[i + 3];
    EXPECT_EQ(all[i + 1], (std::vector<double>{b[0], a[1]}));
    EXPECT_EQ(all[i + 2], (std::vector<double>{a[0], b[1]}));
  }
}

TEST_F(Designs, MorrisTrajectoriesThatMeetAreWhole) {
  const json submitted = run(R"({"kind": "morris", "trajectories": 4, "parameters": {
      "friction_angle": {"from": "15 deg", "to": "30 deg"}, "ratio_across": [0.5, 0.7]}})");
  const auto all = rows();
  ASSERT_EQ(all.size(), 12u);
  EXPECT_GT(submitted["merged"], 0) << "there are 8 cases";
  for (std::size_t i = 0; i < 12; ++i) {
    if (i % 3 == 0) continue;
    const bool angle = all[i][0] != all[i - 1][0], ratio = all[i][1] != all[i - 1][1];
    EXPECT_NE(angle, ratio) << "row " << i + 1;
  }
}

/// The whole way, with everything killed on it: as many cases, with the same bits, as without.
TEST_F(Designs, ASampleGrowsInRoundsWhateverIsKilled) {
  const std::string spec =
      std::string(FAULTSIM_SOURCE_DIR) + "/docs/examples/campaigns/staged.json";
  ASSERT_EQ(faultsweep({"submit", spec}).code, 0);
  const auto whole = wait(start({"run", "--workers", "2"}), 300);
  EXPECT_EQ(whole.code, 0) << whole.err;
  EXPECT_THAT(whole.err, HasSubstr("next round"));
  const auto ranked = faultsweep({"rank", "--json", "--top", "0"});
  const json status = json::parse(faultsweep({"status", "--json"}).out);
  EXPECT_GT(status["rounds"].size(), 1u);
  EXPECT_THAT(status["conclusion"].get<std::string>(), HasSubstr("% (confidence 95.0 %)"));
  std::filesystem::remove_all(store_);
  ASSERT_EQ(faultsweep({"submit", spec}).code, 0);
  for (const long n_done : {3L, 12L, 15L}) {
    const pid_t starter = start({"run", "--workers", "1"});
    EXPECT_TRUE(wait_for_done(n_done));
    for (const pid_t mpirun : children_of(starter)) {
      for (const pid_t rank : children_of(mpirun)) kill(rank, SIGKILL);
      kill(mpirun, SIGKILL);
    }
    kill(starter, SIGKILL);
    waitpid(starter, nullptr, 0);
  }
  const auto rest = wait(start({"run", "--workers", "2"}), 300);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(faultsweep({"rank", "--json", "--top", "0"}).out, ranked.out);
  EXPECT_EQ(json::parse(faultsweep({"status", "--json"}).out)["conclusion"], status["conclusion"]);
}

/// Moduli that are drawn: one surface for all of them, the same bits whoever builds it and however
/// often that is killed on the way, and exact cases of the first beside it.
TEST_F(Designs, SamplesShareASurfaceWhateverIsKilledAndTheFirstAreCertified) {
  const char* const design = R"({"kind": "monte-carlo", "samples": 40, "parameters": {
      "salt_stiffness": {"from": "20 GPa", "to": "60 GPa"},
      "friction_angle": {"from": "15 deg", "to": "35 deg"}}})";
  const json submitted = submit(design, {{"policy", "automatic"}});
  EXPECT_EQ(submitted["families"].size(), 1u);
  EXPECT_GT(submitted["families"][0]["n_operators"], 1);
  const auto whole = wait(start({"run", "--workers", "1"}), 300);
  EXPECT_EQ(whole.code, 0) << whole.err;
  const auto ranked = faultsweep({"rank", "--json", "--top", "0"});
  const json first = json::parse(ranked.out)["cases"][0];
  EXPECT_EQ(first["interpolated"], true);

  std::filesystem::remove_all(store_);
  submit(design, {{"policy", "automatic"}});
  const auto n_operators = [&] {
    const std::filesystem::path folder = std::filesystem::path(store_) / "operators";
    if (!std::filesystem::is_directory(folder)) return std::ptrdiff_t{0};
    return std::ranges::distance(std::filesystem::directory_iterator(folder));
  };
  for (const std::ptrdiff_t so_far : {2, 5}) {
    const pid_t starter = start({"run", "--workers", "2"});
    for (int tries = 0; tries < 1000 && n_operators() < so_far; ++tries) usleep(20'000);
    for (const pid_t mpirun : children_of(starter)) {
      for (const pid_t rank : children_of(mpirun)) kill(rank, SIGKILL);
      kill(mpirun, SIGKILL);
    }
    kill(starter, SIGKILL);
    waitpid(starter, nullptr, 0);
  }
  EXPECT_EQ(json::parse(faultsweep({"status", "--json"}).out)["done"], 0)
      << "it was killed before a case was done";
  const auto rest = wait(start({"run", "--workers", "3"}), 300);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(faultsweep({"rank", "--json", "--top", "0"}).out, ranked.out);

  const auto certified = faultsweep({"rank", "--certify", "5", "--workers", "2", "--json"});
  EXPECT_EQ(certified.code, 0) << certified.err;
  const json compared = json::parse(certified.out);
  EXPECT_EQ(compared["compared"], 5) << certified.out;
  EXPECT_EQ(compared["agrees"], true) << certified.out;
  const Store store = Store::open_reader(store_);
  const CampaignInfo exact = store.campaign("small-exact");
  EXPECT_EQ(exact.n_complete(), 5);
  EXPECT_FALSE(store.stored_case(exact.id, "1").result.surface);
}

/// What is said of the first cases at another tier is what all of them there say.
TEST_F(Designs, TheFirstCasesAreCertifiedAtAnotherTier) {
  const std::string design = R"({"kind": "monte-carlo", "samples": 30, "parameters": {
      "friction_angle": {"from": "30 deg", "to": "38 deg"},
      "ratio_across": {"from": 0.74, "to": 0.82}}})";
  for (const char* tier : {"screening", "demonstration"}) {
    submit(design, {}, tier);
    EXPECT_EQ(wait(start({"run", "--workers", "2"}), 300).code, 0);
  }
  const auto refused =
      faultsweep({"rank", "at-screening", "--certify", "6", "--tier", "screening"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("the campaign has the tier screening"));
  const auto certified = faultsweep({"rank", "at-screening", "--by", "chi_bar", "--certify", "6",
                                     "--tier", "demonstration", "--json"});
  EXPECT_EQ(certified.code, 0) << certified.err;
  const json said = json::parse(certified.out);
  ASSERT_EQ(said["first"].size(), 6u) << certified.out;
  const auto scores = [&](const char* campaign) {
    const auto ranked = faultsweep({"rank", campaign, "--by", "chi_bar", "--top", "0", "--json"});
    EXPECT_EQ(ranked.code, 0) << ranked.err << ranked.out;
    std::map<long, double> all;  // the design is the same, and so are the numbers of its cases
    const json answer = json::parse(ranked.out);
    for (const json& row : answer["cases"]) all[row["case"]] = row["score"];
    return all;
  };
  const auto before = scores("at-screening"), after = scores("at-demonstration");
  std::set<long> run;
  double least = std::numeric_limits<double>::infinity();
  for (const json& one : said["first"]) {
    const long position = one["case"];
    EXPECT_EQ(one["before"], before.at(position));
    EXPECT_EQ(one["after"], after.at(position));
    if (one["place"] <= said["certain"]) least = std::min(least, after.at(position));
    run.insert(position);
  }
  EXPECT_GT(said["certain"], 0) << certified.out;
  for (const auto& [position, score] : after) {
    if (run.contains(position)) continue;
    EXPECT_LE(before.at(position), said["next"]);
    const double rise = score - before.at(position);
    EXPECT_TRUE(rise > said["largest_rise"] || score < least) << position;
  }
}

TEST_F(Designs, NestedSamplesAreTheSameInEachOuterRow) {
  run(R"({"kind": "nested", "designs": [
      {"kind": "grid", "parameters": {"offset": ["0 m", "100 m"]}},
      {"kind": "latin-hypercube", "samples": 3, "seed": 5, "parameters": {
         "friction_angle": {"from": "15 deg", "to": "30 deg"}}}]})");
  const auto all = rows();
  ASSERT_EQ(all.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(all[i][0], 0);
    EXPECT_EQ(all[i + 3], (std::vector<double>{100, all[i][1]}));
  }
}

/// A grid whose cases a sampled design hits too: the export has the rows of both, in order.
TEST_F(Designs, AGridKeepsTheCasesThatASampleHits) {
  const json submitted = submit(R"({"kind": "groups", "groups": [
      {"name": "steps", "design": {"kind": "grid", "parameters": {
         "friction_angle": ["15 deg", "20 deg", "30 deg"]}}},
      {"name": "sample", "design": {"kind": "latin-hypercube", "samples": 4, "parameters": {
         "friction_angle": ["15 deg", "30 deg"]}}}]})");
  EXPECT_EQ(submitted["cases"], 3);
  EXPECT_EQ(submitted["merged"], 4) << "all rows of the sample are cases of the grid";
  const std::string folder = (folder_ / "salib").string();
  const auto exported = faultsweep({"export", "--format", "salib", "-o", folder});
  ASSERT_EQ(exported.code, 0) << exported.err;
  std::ifstream file(folder + "/cases.txt");
  std::vector<int> cases;
  for (int one = 0; file >> one;) cases.push_back(one);
  ASSERT_EQ(cases.size(), 7u);
  EXPECT_EQ(std::vector<int>(cases.begin(), cases.begin() + 3), (std::vector<int>{1, 2, 3}));
  std::sort(cases.begin() + 3, cases.end());
  EXPECT_EQ(std::vector<int>(cases.begin() + 3, cases.end()), (std::vector<int>{1, 1, 3, 3}));
}

}  // namespace
}  // namespace faultsweep
