// Charts and the page of a made-up campaign, with names that would break a page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/report/parameters.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/figure/xml_check.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using faultsim::InputError;
using faultsim::figure::xml_problem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNasty = "</script><b onload=\"x()\">&'";
constexpr const char* kScene = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json";

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Cases whose results follow from `strength` alone (made_up_result: F1 slides above 0.5).
class FiguresTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "figures_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_ / "store"));
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  void submit(int n, int n_results) {
    Submission s;
    s.name = kNasty;
    s.source = "/somebody/secret/spec.json";
    s.spec_given = kNasty;
    s.scenes = {{kScene, text_of(kScene)}};
    s.families = {{"family-a", 1000, 100, 1, 1}};
    s.parameters = parameters_to_json({{"strength", Dimension::number, false},
                                       {"offset", Dimension::length, false},
                                       {"rule", Dimension::number, true}});
    for (int k = 0; k < n; ++k) {
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, strength(k, n), std::to_string(strength(k, n))},
                          {1, 7.0 * (k % 11), std::to_string(7 * (k % 11)) + " m"},
                          {2, std::nullopt, k % 2 == 0 ? kNasty : "min"}}});
    }
    json parameters = json::array({{{"name", "strength"}}, {{"name", "offset"}}});
    s.spec_resolved =
        json{{"groups", {{{"kind", "monte-carlo"}, {"parameters", parameters}}}}}.dump();
    store_->submit(s);
    campaign_ = store_->campaign("");
    std::vector<RunRecord> runs;
    for (int k = 0; k < n_results; ++k) {
      RunRecord run;
      run.case_id = k + 1;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(strength(k, n));
      runs.push_back(run);
    }
    store_->record_runs(campaign_.id, runs);
    campaign_ = store_->campaign("");
  }
  static double strength(int k, int n) { return (k + 0.5) / n; }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

TEST_F(FiguresTest, TheMapHasEachCaseWithAResultAndSaysWhatParametersThereAre) {
  submit(40, 30);
  const std::string svg = draw_outcome_map(*store_, campaign_, {});
  EXPECT_EQ(xml_problem(svg), "");
  EXPECT_THAT(svg, HasSubstr("What became of 30 cases"));
  EXPECT_THAT(svg, HasSubstr("offset, m"));
  EXPECT_EQ(xml_problem(draw_outcome_map(*store_, campaign_, {"rule", "strength"})), "");
  EXPECT_THROW(draw_outcome_map(*store_, campaign_, {"offsett", ""}), InputError);
}

TEST_F(FiguresTest, OutcomesAreCountedAsTheStoreHasThem) {
  submit(40, 40);
  const auto counts = count_outcomes(*store_, campaign_);
  EXPECT_EQ(counts[0] + counts[1] + counts[2] + counts[3], 40);
  EXPECT_EQ(counts[1] + counts[2], 20);  // those that slide, with or without an event
}

TEST_F(FiguresTest, ThePageSaysTheAnswerAndHasNothingThatBreaksOut) {
  submit(40, 40);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(page, HasSubstr("A fault slides in 20 of 40 cases: 50 % (95 %: 33.8 to 66.2 %)"));
  EXPECT_THAT(page, Not(HasSubstr("<b onload")));
  EXPECT_THAT(page, Not(HasSubstr("/somebody/secret")));  // no paths of the machine
  EXPECT_THAT(page, Not(HasSubstr("src=")));              // nothing is loaded
  EXPECT_EQ(page, report_page(*store_, campaign_, {.program = "faultsweep test"}));
  for (std::size_t at = page.find("<svg"); at != std::string::npos;
       at = page.find("<svg", at + 1)) {
    EXPECT_EQ(xml_problem(page.substr(at, page.find("</svg>", at) + 6 - at)), "");
  }
}

TEST_F(FiguresTest, APageWithoutResultsSaysSo) {
  submit(5, 0);
  const std::string page = report_page(*store_, campaign_, {.program = "faultsweep test"});
  EXPECT_THAT(page, HasSubstr("None of the 5 cases has a full history yet"));
  EXPECT_THAT(page, HasSubstr("No case has a result yet."));
}

TEST_F(FiguresTest, ACaseWithoutAResultIsRefused) {
  submit(2, 1);
  const StoredCase waiting = store_->stored_case(campaign_.id, "2");
  EXPECT_THROW(StoredPicture(*store_, campaign_, waiting), InputError);
}

}  // namespace
}  // namespace faultsweep
