#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>

#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/reports/renderings.h"

namespace faultsweep {

/// A store with 6 cases: offset k x 10 m, rule "mean" or "min", strengths that mix the order.
class ReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "report_XXXXXX";
    folder_ = mkdtemp(name.data());
    Submission s;
    s.name = "sweep";
    s.source = "sweep.json";
    s.rank_by = "activated_area";
    s.parameters = {{"offset", faultsim::Dimension::length, false},
                    {"rule", faultsim::Dimension::number, true}};
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    for (int k = 0; k < 6; ++k) {
      const std::string rule = k % 2 == 0 ? "mean" : "min";
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, 10.0 * k, std::to_string(10 * k) + " m"}, {1, std::nullopt, rule}}});
    }
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    const std::int64_t id = store_->submit(s).campaign;
    const double strengths[] = {0.2, 0.9, 0.4, 0.6, 0.95};
    for (int k = 0; k < 5; ++k) {
      RunRecord run;
      run.case_id = k + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(strengths[k]);
      if (k == 4) {
        run.result->outcome = faultsim::Outcome::unstable;
        run.result->reason = "slip weakening outran the stiffness at step 7";
        run.result->weakening_resolved = false;
      }
      store_->record_runs(id, {run});
    }
    RunRecord crash;
    crash.case_id = 6;
    crash.reason = "killed by SIGSEGV (11)";
    crash.log_tail = "first line\nlast words";
    store_->record_runs(id, {crash});
    campaign_ = store_->campaign("");
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  std::vector<long> order(RankRequest request) {
    std::vector<long> positions;
    for (const auto& row : make_ranking(*store_, campaign_, std::move(request)).rows) {
      positions.push_back(row.position);
    }
    return positions;
  }
  static RankRequest request(const std::string& by, const std::string& where = "") {
    RankRequest r;
    r.by = by;
    r.where = where;
    return r;
  }

  Answer shown(const CampaignInfo& campaign, const char* name) const {
    return to_answer(shown_case(*store_, campaign, store_->stored_case(campaign.id, name), {}));
  }
  std::string shown_text(const CampaignInfo& campaign, const char* name) const {
    return render_text(shown(campaign, name), 1000);
  }
  std::string explained(const CampaignInfo& campaign, const char* name) const {
    return render_text(explanation(*store_, campaign, store_->stored_case(campaign.id, name)),
                       1000);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

}  // namespace faultsweep
