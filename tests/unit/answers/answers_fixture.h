#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "campaign/answers/probability.h"
#include "campaign/answers/why.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/answers/resolved_design.h"

namespace faultsweep {

class AnswersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "answers_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
    s_.name = "sweep";
    s_.scenes = {{"scene.json", "{}"}};
    s_.families = {{"family-a", 1000, 100, 1, 1}};
    s_.parameters = {{"strength", faultsim::Dimension::number, false},
                     {"offset", faultsim::Dimension::length, false},
                     {"rule", faultsim::Dimension::number, true}};
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  /// Cases whose results follow from `strength` alone (made_up_result: F1 slides above 0.5).
  void submit(const std::string& kind, const std::vector<std::array<double, 2>>& values,
              const std::vector<std::string>& names = {"strength", "offset", "rule"},
              bool second_order = false) {
    for (const auto& [strength, offset] : values) {
      const std::size_t n = s_.cases.size();
      s_.cases.push_back({"identity-" + std::to_string(n),
                          0,
                          0,
                          "{}",
                          {{0, strength, std::to_string(strength)},
                           {1, offset, std::to_string(offset) + " m"},
                           {2, std::nullopt, n % 2 == 0 ? "mean" : "min"}}});
    }
    nlohmann::json parameters = nlohmann::json::array();
    for (const std::string& name : names) parameters.push_back({{"name", name}});
    nlohmann::json group = {{"kind", kind},
                            {"parameters", parameters},
                            {"second_order", second_order},
                            {"scene", {{"tier", "screening"}}}};
    group.update(design_keys_);
    s_.spec_resolved = nlohmann::json{{"groups", {group}}, {"exclude", excluded_}}.dump();
    store_->submit(s_);
    campaign_ = store_->campaign("");
    for (std::size_t k = 0; k < values.size(); ++k) {
      RunRecord run;
      run.case_id = static_cast<long>(k) + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(values[k][0]);
      runs_.push_back(run);
    }
  }
  void record() { store_->record_runs(campaign_.id, runs_); }
  Why why(long position, RankRequest request = {}) {
    return explain_rank(*store_, campaign_,
                        store_->stored_case(campaign_.id, std::to_string(position)), request);
  }
  Probability probability(ProbabilityRequest request) {
    return find_probability(*store_, campaign_, request);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  Submission s_;
  nlohmann::json design_keys_ = nlohmann::json::object(),
                 excluded_ = nlohmann::json::array();  ///< of the spec.
  CampaignInfo campaign_;
  std::vector<RunRecord> runs_;
};

/// Cases with results of their own, of two parameters: friction and offset.
class FrictionAndOffset : public AnswersTest {
 protected:
  void SetUp() override {
    AnswersTest::SetUp();
    s_.parameters = {{"friction", faultsim::Dimension::number, false},
                     {"offset", faultsim::Dimension::length, false}};
  }
  static CaseParameters both(double friction, double offset) {
    return {{0, friction, std::to_string(friction)}, {1, offset, std::to_string(offset) + " m"}};
  }
  void add_case(const CaseParameters& parameters, faultsim::CaseResult result) {
    const std::size_t n = s_.cases.size();
    s_.cases.push_back({"identity-" + std::to_string(n), 0, 0, "{}", parameters});
    RunRecord run;
    run.case_id = static_cast<long>(n) + 1;
    run.status = RunStatus::completed;
    run.result = std::move(result);
    runs_.push_back(std::move(run));
  }
  void submit_as(const std::string& kind) {
    s_.spec_resolved = testing::resolved_design(kind);
    store_->submit(s_);
    campaign_ = store_->campaign("");
  }
};

/// Strengths evenly in [0, 1], offsets that say nothing.
inline std::vector<std::array<double, 2>> even(int n) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 300);
  std::vector<std::array<double, 2>> values;
  for (int k = 0; k < n; ++k) values.push_back({(k + 0.5) / n, uniform(random)});
  return values;
}

}  // namespace faultsweep
