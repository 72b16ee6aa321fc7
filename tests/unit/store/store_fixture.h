#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

/// A folder for a store, and what tests put into it.
namespace faultsweep {

class StoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "store_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  /// The first column of the first row, as another program reads it.
  std::int64_t count(const char* sql) const {
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_only);
    Statement query(connection, sql);
    query.step();
    return query.integer(0);
  }
  std::filesystem::path folder_;
};

/// n cases in two families, strengths i/n.
inline Submission submission(int n, const std::string& name = "sweep") {
  Submission s;
  s.name = name;
  s.source = "sweep.json";
  s.spec_given = "{}";
  s.spec_resolved = "{}";
  s.parameters = {{"strength", faultsim::Dimension::number, false}};
  s.rank_by = "activated_area";
  s.scenes = {{"scene.json", R"({"title": "base"})"}};
  s.families = {{"family-a", 1000, 100, 2.5, 1e8}, {"family-b", 500, 50, 1.0, 1e7}};
  for (int i = 0; i < n; ++i) {
    const std::string number = std::to_string(i);
    s.cases.push_back({"identity-" + number,
                       i % 2,
                       0,
                       R"({"/title": "case )" + number + "\"}",
                       {{0, static_cast<double>(i), number + " m"}}});
  }
  return s;
}

inline RunRecord completed(std::int64_t case_id, double strength) {
  RunRecord run;
  run.case_id = case_id;
  run.status = RunStatus::completed;
  run.host = "here";
  run.rank = 1;
  run.wall_seconds = 0.5;
  run.result = testing::made_up_result(strength);
  return run;
}

inline RunRecord crashed(std::int64_t case_id, bool final) {
  RunRecord run;
  run.case_id = case_id;
  run.status = RunStatus::crashed;
  run.reason = "killed by SIGSEGV";
  run.signal = 11;
  run.log_tail = "last words";
  run.final = final;
  return run;
}

inline std::vector<std::int64_t> waiting(const Store& store, std::int64_t campaign) {
  std::vector<std::int64_t> ids;
  for (const WaitingFamily& family : store.waiting_families(campaign)) {
    ids.insert(ids.end(), family.cases.begin(), family.cases.end());
  }
  return ids;
}

}  // namespace faultsweep
