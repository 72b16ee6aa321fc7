// What answers say of results that are approximate beyond mesh and time steps.
#include <gtest/gtest.h>

#include <filesystem>

#include "campaign/query/ranking.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;

/// On an operator surface, with these relative errors of H and of slip without friction.
CaseResult interpolated(double stiffness, double slip) {
  CaseResult result = testing::made_up_result(0.4);
  result.surface.emplace();
  result.surface->stiffness = stiffness;
  result.surface->slip = slip;
  return result;
}

/// Of a flow result that covers this share of the compartments.
CaseResult covered(double share) {
  CaseResult result = testing::made_up_result(0.4);
  result.field_coverage = share;
  return result;
}

class ApproximationNote : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "approximations_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Of a campaign with these results and one case that waits.
  std::string note(const std::vector<CaseResult>& results) const {
    Store store = Store::open_owner(folder_);
    Submission s;
    s.name = "sweep";
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    for (std::size_t k = 0; k <= results.size(); ++k)
      s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {}});
    const std::int64_t id = store.submit(s).campaign;
    for (std::size_t k = 0; k < results.size(); ++k) {
      RunRecord run;
      run.case_id = static_cast<std::int64_t>(k) + 1;
      run.status = RunStatus::completed;
      run.result = results[k];
      store.record_runs(id, {run});
    }
    return approximation_note(store, store.campaign("sweep"));
  }

  std::filesystem::path folder_;
};

TEST_F(ApproximationNote, IsSilentWhereEveryResultIsExact) {
  EXPECT_EQ(note({testing::made_up_result(0.4), covered(1)}), "");
}

TEST_F(ApproximationNote, TellsInterpolatedOperatorsFromExactOnes) {
  EXPECT_EQ(
      note({interpolated(2e-4, 3e-3), testing::made_up_result(0.4), interpolated(5e-4, 1e-3)}),
      "2 of 3 results have an interpolated operator, off by at most 0.0005 in H and 0.003 in "
      "slip without friction (relative errors, where measured); the others have exact operators.");
}

TEST_F(ApproximationNote, SaysHowFarTheWorstProbingCaseIsOff) {
  CaseResult worse = interpolated(2e-4, 3e-3), better = interpolated(5e-4, 1e-3);
  worse.surface->chi_bar = 1.3e-3, better.surface->chi_bar = 4e-4;
  EXPECT_EQ(note({worse, better}),
            "All 2 results have an interpolated operator, off by at most 0.0005 in H and 0.003 in "
            "slip without friction (relative errors, where measured); χ̄ of probing cases by at "
            "most 0.0013.");
}

TEST_F(ApproximationNote, SpeaksOfNoOthersWhereAllAreInterpolated) {
  EXPECT_EQ(note({interpolated(2e-4, 3e-3), interpolated(5e-4, 1e-3)}),
            "All 2 results have an interpolated operator, off by at most 0.0005 in H and 0.003 in "
            "slip without friction (relative errors, where measured).");
}

TEST_F(ApproximationNote, SaysHowLittleAFlowResultCovers) {
  EXPECT_EQ(note({covered(0.9), covered(1), covered(0.254)}),
            "2 of 3 results use a flow result that covers the compartments only in part: at least "
            "25.4 % of them.");
}

}  // namespace
}  // namespace faultsweep
