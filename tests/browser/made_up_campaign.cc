// A campaign of as many made-up cases as wanted in a store of its own: for pages of campaigns whose
// cases would take minutes to run. Usage: made_up_campaign STORE NAME CASES
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaign/common/names.h"
#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

constexpr const char* kScene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";

/// Values that look random and are the same every time (Weyl's sequences), 0 to 1.
double spread(int k, double step) { return std::fmod((k + 1) * step, 1.0); }
double strength(int k) { return spread(k, 0.6180339887498949); }

Submission submission(const std::string& name, int n) {
  std::ostringstream scene;
  scene << std::ifstream(kScene).rdbuf();
  Submission s;
  s.name = name;
  s.source = "made-up.json";
  s.scenes = {{kScene, scene.str()}};
  s.families = {{"family-a", 1000, 100, 1, 1}};
  s.parameters = {{"strength", Dimension::number, false},
                  {"cohesion", Dimension::pressure, false},
                  {"offset", Dimension::length, false},
                  {"rule", Dimension::number, true}};
  for (int k = 0; k < n; ++k) {
    const double cohesion = 5 * spread(k, 0.4142135623730951);
    s.cases.push_back({"identity-" + std::to_string(k),
                       0,
                       0,
                       "{}",
                       {{0, strength(k), std::to_string(strength(k))},
                        {1, 1e6 * cohesion, std::to_string(cohesion) + " MPa"},
                        {2, 25.0 * (k % 9), std::to_string(25 * (k % 9)) + " m"},
                        {3, std::nullopt, k % 3 == 0 ? "mean" : "min"}}});
  }
  nlohmann::json parameters = nlohmann::json::array();
  for (const StoredParameter& one : s.parameters) parameters.push_back({{"name", one.name}});
  s.spec_resolved =
      nlohmann::json{{"groups", {{{"kind", "monte-carlo"}, {"parameters", parameters}}}}}.dump();
  return s;
}

void record(Store& store, const CampaignInfo& campaign, int n) {
  constexpr int kAtOnce = 1000, kSteps = 3;
  std::vector<RunRecord> runs;
  for (int k = 0; k < n; ++k) {
    RunRecord run;
    run.case_id = k + 1;
    run.status = RunStatus::completed;
    run.result = testing::made_up_result(strength(k), kSteps);
    if (k % 10 == 7) {  // the cells do not tell
      run.result->whole.activation_resolved = false;
      for (auto& fault : run.result->whole.faults) fault.activation_resolved = false;
    }
    runs.push_back(std::move(run));
    if (runs.size() == kAtOnce || k + 1 == n) {
      store.record_runs(campaign.id, runs);
      runs.clear();
    }
  }
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: made_up_campaign STORE NAME CASES\n");
    return 2;
  }
  using namespace faultsweep;
  const int n = std::atoi(argv[3]);
  Store store = Store::open_owner(argv[1]);
  store.submit(submission(argv[2], n));
  record(store, store.campaign(argv[2]), n);
  return 0;
}
