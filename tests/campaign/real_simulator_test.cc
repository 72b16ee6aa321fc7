// Campaigns of weakening faults with the real faultsweep, mpirun and faultsim: the bits of every
// case are the same whatever happens around it.
#include <map>
#include <nlohmann/json.hpp>

#include "campaign/store/same_numbers.h"
#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using nlohmann::json;

class RealSimulator : public testing::CampaignTest {
 protected:
  void SetUp() override {
    CampaignTest::SetUp();
    simulator_ = FAULTSIM;
    std::ifstream file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-weakening.json");
    base_ = json::parse(file);
    base_["tier"] = "custom";
    base_["numerics"] = {{"plane_strain", "on"}, {"activation_length", "100 m"}};
    set_cells(50);
  }
  void set_cells(int metres) {
    const std::string size = std::to_string(metres) + " m";
    base_["mesh"] = {{"dip", size}, {"normal", size}};
  }

  /// n_angles friction angles from 15 deg up at each of the offsets; each offset is a family.
  void submit_cases(int n_angles, const std::vector<int>& offsets, bool shuffled = false) {
    std::vector<json> cases;
    for (const int offset : offsets) {
      for (int k = 0; k < n_angles; ++k) {
        const int hundredths = 1500 + 1000 * k / n_angles;
        char angle[32];
        std::snprintf(angle, sizeof angle, "%d.%02d deg", hundredths / 100, hundredths % 100);
        cases.push_back({{"offset", std::to_string(offset) + " m"}, {"friction_angle", angle}});
      }
    }
    if (shuffled) {
      unsigned state = 7;  // a permutation that every library repeats
      for (std::size_t i = cases.size(); i > 1; --i) {
        state = state * 1664525u + 1013904223u;
        std::swap(cases[i - 1], cases[(state >> 8) % i]);
      }
    }
    const json spec = {{"format", 1},
                       {"name", "weakening"},
                       {"base", base_},
                       {"design", {{"kind", "list"}, {"cases", cases}}},
                       {"policy", {{"on_failure", "retry"}, {"retries", 10}}}};
    std::ofstream(folder_ / "spec.json") << spec.dump();
    const auto end = faultsweep({"submit", (folder_ / "spec.json").string()});
    ASSERT_EQ(end.code, 0) << end.err;
  }
  void run(int n_workers) {
    const auto end = wait(start({"run", "--workers", std::to_string(n_workers)}), 300);
    ASSERT_EQ(end.code, 0) << end.err;
  }

  using Results = std::map<std::string, CaseResult>;  // by identity
  Results results() const {
    const Store store = Store::open_reader(store_);
    const CampaignInfo campaign = store.campaign("");
    Results all;
    for (long k = 1; k <= campaign.n_cases; ++k) {
      StoredCase one = store.stored_case(campaign.id, std::to_string(k));
      EXPECT_TRUE(one.has_result) << k;
      all[one.identity] = std::move(one.result);
    }
    return all;
  }
  static void expect_same(const Results& expected, const Results& found, const char* what) {
    ASSERT_EQ(expected.size(), found.size()) << what;
    for (const auto& [identity, result] : expected) {
      ASSERT_EQ(found.count(identity), 1u) << what << ", case " << identity;
      EXPECT_EQ(first_difference(result, found.at(identity)), "") << what << ", case " << identity;
    }
  }
  json base_;
};

TEST_F(RealSimulator, SameBitsWhateverTheWorkersTheOrderTheCacheOrAnInterruption) {
  constexpr int kAngles = 20;
  const std::vector<int> offsets = {0, 100, 150};
  submit_cases(kAngles, offsets);
  run(1);
  const Results expected = results();
  ASSERT_EQ(expected.size(), kAngles * offsets.size());
  std::size_t n_with_events = 0;
  for (const auto& [identity, result] : expected) n_with_events += !result.events.empty();
  EXPECT_GT(n_with_events, expected.size() / 4);  // otherwise there is little to compare

  const auto operators = folder_ / "operators";
  std::filesystem::rename(store_ / "operators", operators);
  const auto fresh_store = [&](bool warm, bool shuffled) {
    std::filesystem::remove_all(store_);
    if (warm) {
      std::filesystem::create_directories(store_);
      std::filesystem::copy(operators, store_ / "operators");
    }
    submit_cases(kAngles, offsets, shuffled);
  };
  fresh_store(true, false);
  run(2);
  expect_same(expected, results(), "2 workers, operators from the cache");
  fresh_store(false, true);
  run(4);
  expect_same(expected, results(), "4 workers, cold cache, shuffled cases");

  fresh_store(false, true);
  const pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(1));  // two families are yet to be built
  kill(starter, SIGINT);
  EXPECT_EQ(wait(starter).code, 75);
  EXPECT_LT(Store::open_reader(store_).campaign("").n_done, static_cast<long>(expected.size()));
  run(2);
  expect_same(expected, results(), "interrupted and resumed");
}

/// Kills the manager, workers and simulators in turn at pseudo-random moments. Nobody helps: the
/// campaign ends complete with the numbers of an undisturbed one, no case has two results, and no
/// simulator outlives its worker by 2 s.
TEST_F(RealSimulator, SlowThirtyKillsLeaveTheSameBits) {
  constexpr int kAngles = 250, kCases = 2 * kAngles, kKills = 30;
  set_cells(10);
  submit_cases(kAngles, {100, 150});
  run(2);
  const Results undisturbed = results();
  std::filesystem::remove_all(store_);
  submit_cases(kAngles, {100, 150});
  unsigned state = 2026;
  const auto dice = [&](std::size_t n) {
    state = state * 1664525u + 1013904223u;
    return (state >> 16) % n;
  };
  struct Orphan {
    pid_t pid;
    faultsim::Stopwatch since;
  };
  std::vector<Orphan> orphans;
  const pid_t starter = start({"run", "--workers", "2"});
  int kills = 0;
  while (kills < kKills) {
    // Between two kills some case is done: restarts without progress are given up, rightly.
    ASSERT_TRUE(wait_for_done(Store::open_reader(store_).campaign("").n_done + 1));
    usleep(static_cast<useconds_t>(1000 * dice(300)));
    std::vector<pid_t> targets;
    for (const pid_t mpirun : children_of(starter)) {
      for (const pid_t rank : children_of(mpirun)) {
        targets.push_back(rank);
        for (const pid_t simulator : children_of(rank)) targets.push_back(simulator);
      }
    }
    ASSERT_EQ(waitpid(starter, nullptr, WNOHANG), 0) << "ended after " << kills << " kills";
    if (targets.empty()) continue;  // between two jobs
    const pid_t target = targets[dice(targets.size())];
    for (const pid_t simulator : children_of(target)) orphans.push_back({simulator, {}});
    kill(target, SIGKILL);
    ++kills;
    std::erase_if(orphans, [](const Orphan& one) {
      if (one.since.seconds() < 2) return false;
      EXPECT_FALSE(is_running(one.pid)) << "a simulator outlived its worker";
      return true;
    });
  }
  const auto end = wait(starter, 300);
  EXPECT_EQ(end.code, 0) << end.err;
  const Store store = Store::open_reader(store_);
  expect_each_case_completed_once(store.campaign("").id, kCases);
  expect_same(undisturbed, results(), "after thirty kills");
}

}  // namespace
}  // namespace faultsweep
