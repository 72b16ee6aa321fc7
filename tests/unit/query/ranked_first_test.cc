// Which cases reports and pages show first, and whose fields are kept for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RankedFirst : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "ranked_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Of a campaign with cases of these strengths and one that waits; they have the ids 1, 2, ….
  std::vector<std::int64_t> first(const std::string& rank_by, const std::vector<double>& strengths,
                                  bool plane_strain_last = false) {
    Store store = Store::open_owner(folder_);
    Submission s;
    s.name = "sweep";
    s.rank_by = rank_by;
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    for (std::size_t k = 0; k <= strengths.size(); ++k)
      s.cases.push_back({"identity-" + std::to_string(k), 0, 0, "{}", {}});
    const std::int64_t id = store.submit(s).campaign;
    for (std::size_t k = 0; k < strengths.size(); ++k) {
      RunRecord run;
      run.case_id = static_cast<std::int64_t>(k) + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(strengths[k]);
      run.result->plane_strain = plane_strain_last && k + 1 == strengths.size();
      store.record_runs(id, {run});
    }
    const CampaignInfo campaign = store.campaign("");
    const std::vector<std::int64_t> ids = cases_ranked_first(store, campaign);
    // It is the beginning of what `rank` and a report list.
    std::vector<std::int64_t> listed =
        mapped(make_ranking(store, campaign, {.by = {}, .top = 0}).rows, &RankedCase::id);
    listed.resize(std::min<std::size_t>(listed.size(), kShownFirst));
    EXPECT_EQ(ids, listed);
    return ids;
  }
  std::filesystem::path folder_;
};

TEST_F(RankedFirst, AreTheFirstThreeOfTheDefaultOrder) {
  EXPECT_THAT(first("activated_area", {0.2, 0.9, 0.6, 0.8, 0.7}), ElementsAre(2, 4, 5));
}

TEST_F(RankedFirst, FollowTheCampaignsOwnOrder) {
  EXPECT_THAT(first("0 - chi_bar", {0.2, 0.9, 0.6, 0.8, 0.7}), ElementsAre(1, 3, 5));
}

TEST_F(RankedFirst, AreFewerWhereFewerHaveResults) {
  EXPECT_THAT(first("activated_area", {0.2, 0.9}), ElementsAre(2, 1));
}

TEST_F(RankedFirst, AreNoneWithoutResults) { EXPECT_THAT(first("activated_area", {}), IsEmpty()); }

/// Areas per metre of strike are not compared with areas.
TEST_F(RankedFirst, LeaveOutPlaneStrainBesideOthers) {
  EXPECT_THAT(first("activated_area", {0.2, 0.6, 0.7, 0.9}, true), ElementsAre(3, 2, 1));
}

}  // namespace
}  // namespace faultsweep
