#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "campaign/nightly/baseline.h"
#include "campaign/nightly/night_report.h"
#include "campaign/nightly/nightly_suite.h"
#include "campaign/store/same_numbers.h"
#include "campaign/store/store.h"
#include "simulator/result/result_json.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

namespace fs = std::filesystem;
using faultsim::CaseResult;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Folder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "nights_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

const Environment kHere = {"0a", R"({"blas_kernel":"Zen","compiler":"g++ 12"})", "0.1", 2};
const Environment kThere = {"0b", R"({"blas_kernel":"Prescott","compiler":"g++ 12"})", "0.1", 2};

NightCampaign campaign(const std::vector<CaseResult>& results) {
  NightCampaign night{"sweep", {}};
  for (const CaseResult& result : results) {
    const long k = static_cast<long>(night.cases.size()) + 1;
    night.cases.push_back({k, "case-" + std::to_string(k), "offset = 0 m", result, "", 0.5});
  }
  return night;
}
CaseResult failed() {
  CaseResult result = testing::made_up_result(0.7);
  result.outcome = faultsim::Outcome::unconverged;
  result.failed_step = 12;
  result.steps.back().outcome = faultsim::Outcome::unconverged;
  result.steps.back().faults.clear();
  return result;
}

using BaselineFile = Folder;

TEST_F(BaselineFile, GivesBackEveryBit) {
  const std::vector<CaseResult> results = {testing::made_up_result(0.3),
                                           testing::made_up_result(1.0 / 1.3),
                                           testing::made_up_result_with_events(0.8), failed()};
  write_baseline(folder_,
                 {"suite", kHere, {{"2026-11-21", "first \"night\"", 2}}, {campaign(results)}});
  const auto back = find_baseline(folder_, "suite", kHere);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->blessings[0].reason, "first \"night\"");
  ASSERT_EQ(back->campaigns[0].cases.size(), results.size());
  for (std::size_t k = 0; k < results.size(); ++k) {
    const CaseResult& read = *back->campaigns[0].cases[k].result;
    EXPECT_EQ(first_difference(results[k], read), "") << k;
    EXPECT_EQ(result_digest(results[k]), result_digest(read)) << k;
  }
}

/// Else the first night of a program with a new field would find all cases changed.
TEST(ResultDigest, StaysWhereALaterFieldHasNoValue) {
  CaseResult result = testing::made_up_result(0.8);
  const std::string digest = result_digest(result);
  result.title.clear();
  result.operator_fingerprint.clear();
  nlohmann::json before = faultsim::result_to_json(result);
  before.erase("field_coverage");
  before.erase("field_assumed");
  for (nlohmann::json& step : before["steps"]) step.erase("temperature_change_k");
  int n_onsets = 0;
  const auto without_brackets = [&](nlohmann::json& stage) {
    for (nlohmann::json& fault : stage["faults"]) {
      for (const char* onset : {"activation", "opening"}) {
        if (!fault[onset].is_object()) continue;
        ++n_onsets;
        for (const char* key : {"load_factor_before", "load_factor_after", "change_before_pa"})
          fault[onset].erase(key);
      }
    }
  };
  without_brackets(before["whole"]);
  for (nlohmann::json& stage : before["stages"]) without_brackets(stage);
  EXPECT_GT(n_onsets, 0);
  EXPECT_EQ(digest, faultsim::fingerprint(before.dump()));
  result.field_coverage = 1;
  EXPECT_NE(result_digest(result), digest);
}

TEST_F(BaselineFile, OfAnotherEnvironmentTheNewestIsTaken) {
  EXPECT_FALSE(find_baseline(folder_, "suite", kHere).has_value());
  write_baseline(folder_, {"suite", kThere, {{"2026-11-21", "there", 2}}, {}});
  const Environment old = {"0c", "{}", "0.1", 2};
  write_baseline(folder_, {"suite", old, {{"2026-11-20", "long ago", 2}}, {}});
  EXPECT_EQ(find_baseline(folder_, "suite", kHere)->blessings.back().reason, "there");
  write_baseline(folder_, {"suite", kHere, {{"2026-01-01", "here", 2}}, {}});
  EXPECT_EQ(find_baseline(folder_, "suite", kHere)->blessings.back().reason, "here");
  EXPECT_THAT(environment_differences(kHere, kThere),
              ElementsAre("blas_kernel: \"Zen\" here, \"Prescott\" in the baseline"));
}

TEST_F(BaselineFile, IsRefusedWhenItIsNotWhatItSays) {
  const auto expect_refused = [&](const std::string& text, const char* why) {
    fs::create_directories(folder_ / "suite");
    std::ofstream(folder_ / "suite/0a.json") << text;
    try {
      find_baseline(folder_, "suite", kHere);
      FAIL() << text;
    } catch (const faultsim::StorageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
      EXPECT_THAT(error.what(), HasSubstr("0a.json"));
    }
  };
  expect_refused("", "parse error");
  expect_refused(R"({"format": 2})", "format 2");
  expect_refused(R"({"format": 1, "suite": "suite"})", "fingerprint");
  expect_refused(R"({"format": 1, "suite": "suite", "fingerprint": "0a", "environment": {},)"
                 R"( "version": "0.1", "numerics_version": 2, "blessed": [], "campaigns": {}})",
                 "blessed");
}

std::vector<std::string> verdicts(const std::vector<NightCaseRecord>& records) {
  std::vector<std::string> all;
  for (const NightCaseRecord& one : records) all.push_back(one.verdict);
  return all;
}

TEST(JudgeCampaign, CasesAreMatchedByIdentityAndNoneIsLost) {
  const NightCampaign baseline =
      campaign({testing::made_up_result(0.9), testing::made_up_result(0.8),
                testing::made_up_result(0.7), testing::made_up_result(0.3)});
  NightCampaign tonight = baseline;
  tonight.cases[1].result.reset();  // crashed
  tonight.cases[1].trouble = "crashed: killed by SIGSEGV (11)";
  tonight.cases[2].identity = "another";  // a new case, and one that is gone
  const auto records = judge_campaign(&baseline, tonight, true, {});
  EXPECT_THAT(verdicts(records),
              ElementsAre("identical", "missing", "unblessed", "identical", "missing"));
  EXPECT_EQ(records[1].remark, "crashed: killed by SIGSEGV (11)");
  EXPECT_TRUE(records[4].regressed);
  EXPECT_EQ(records[4].identity, "case-3");
  EXPECT_THAT(verdicts(judge_campaign(nullptr, tonight, true, {})),
              ElementsAre("unblessed", "missing", "unblessed", "unblessed"));
}

TEST(JudgeCampaign, AChangedRankingIsARegressInAnyEnvironment) {
  const NightCampaign baseline =
      campaign({testing::made_up_result(0.9), testing::made_up_result(0.8)});
  NightCampaign tonight = baseline;
  tonight.cases[1].result->whole.activated_area = 1e6;
  EXPECT_THAT(verdicts(judge_campaign(&baseline, tonight, false, {})),
              ElementsAre("ranking changed", "ranking changed"));
  const auto records = judge_campaign(&baseline, tonight, false, {});
  EXPECT_TRUE(records[0].regressed && records[1].regressed);
  EXPECT_THAT(records[0].remark, HasSubstr("other side of case 2"));
}

NightRecord night(const std::string& digest, double seconds) {
  NightRecord record;
  record.suite = "suite";
  record.environment = "0a";
  record.environment_fields = "{}";
  NightCaseRecord one;
  one.campaign = "sweep";
  one.position = 1;
  one.identity = "case-1";
  one.verdict = "identical";
  one.digest = digest;
  one.wall_seconds = seconds;
  record.cases = {one};
  return record;
}

TEST(NightAdvice, NumbersAndTimesThatStep) {
  const std::vector<NightRecord> calm = {night("x", 1), night("x", 1.1), night("x", 0.9)};
  EXPECT_THAT(night_advice(night("x", 1.2), calm), IsEmpty());
  EXPECT_THAT(night_advice(night("x", 1.6), calm), ElementsAre(HasSubstr("sweep/1 took 1.6 s")));
  EXPECT_THAT(night_advice(night("x", 9), {night("x", 1), night("x", 1)}), IsEmpty());
  EXPECT_THAT(night_advice(night("y", 1), calm), ElementsAre(HasSubstr("numbers differ")));
  NightRecord elsewhere = night("y", 9);
  elsewhere.environment = "0b";
  EXPECT_THAT(night_advice(elsewhere, calm), IsEmpty());
}

using NightStore = Folder;

TEST_F(NightStore, GivesBackItsNights) {
  NightRecord record = night("x", 1);
  record.at = 1e9;
  record.n_compared = 1;
  record.exit_code = 5;
  record.blessed = "why not";
  record.cases[0].load_step = 7;
  record.cases[0].max_ulps = 1e19;
  record.cases[0].remark = "off";
  {
    Store store = Store::open_owner(folder_);
    store.record_night(night("w", 2));
    store.record_night(record);
  }
  const auto nights = Store::open_reader(folder_).nights("suite", 10);
  ASSERT_EQ(nights.size(), 2u);
  EXPECT_EQ(nights[0].cases[0].digest, "w");
  EXPECT_FALSE(nights[0].blessed.has_value());
  EXPECT_EQ(nights[1].blessed, "why not");
  EXPECT_EQ(nights[1].exit_code, 5);
  EXPECT_EQ(nights[1].cases[0].load_step, 7);
  EXPECT_EQ(nights[1].cases[0].max_ulps, 1e19);
  EXPECT_EQ(nights[1].cases[0].wall_seconds, 1);
  EXPECT_THAT(Store::open_reader(folder_).nights("other", 10), IsEmpty());
  EXPECT_EQ(Store::open_reader(folder_).nights("", 1)[0].cases[0].digest, "x");
  EXPECT_EQ(history_to_json(nights)["nights"][1]["cases"][0]["remark"], "off");
}

TEST(SampledPlaces, TheTopAndOneOfEachPart) {
  std::vector<std::string> keys;
  for (int k = 0; k < 100; ++k) keys.push_back(std::to_string(k));
  const auto places = sampled_places(keys, 10, 9);
  ASSERT_EQ(places.size(), 19u);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(places[k], k);
  for (std::size_t part = 0; part < 9; ++part) EXPECT_EQ((places[10 + part] - 10) / 10, part);
  EXPECT_EQ(sampled_places(keys, 10, 9), places);
  EXPECT_EQ(sampled_places(keys, 1000, 1000).size(), 100u);
  EXPECT_EQ(sampled_places(keys, 0, 1000).size(), 100u);
  EXPECT_THAT(sampled_places({}, 5, 5), IsEmpty());
}

}  // namespace
}  // namespace faultsweep
