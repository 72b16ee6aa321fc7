// Conditions about stored cases that may be undecided: which metric is when, of which fault and
// stage, and what stated errors do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "campaign/store/sqlite.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

/// What the cells of certain and possible come to.
char letter_of(const Cell& certain, const Cell& possible) {
  if (number_of(certain) == 1) return 'y';
  return number_of(possible) == 1 ? 'u' : 'n';
}

using faultsim::CaseResult;
using faultsim::Dimension;
using faultsim::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kQuiet = 0.4;   // nothing slips
constexpr double kSlides = 0.9;  // F1 slips by 4 mm, F2 by 2 mm

/// F2 might slide in storage.
CaseResult doubtful_in_storage() {
  CaseResult result = testing::made_up_result(kQuiet);
  result.stages[2].activation_resolved = result.stages[2].faults[1].activation_resolved = false;
  result.whole.activation_resolved = result.whole.faults[1].activation_resolved = false;
  return result;
}

/// F1 slides for certain, F2 perhaps, in production.
CaseResult certain_beside_doubtful() {
  CaseResult result = testing::made_up_result(kSlides);
  result.stages[0].faults[1].activation_resolved = false;
  result.whole.faults[1].activation_resolved = false;
  return result;
}

CaseResult with_unresolved_event(bool plane_strain) {
  CaseResult result = testing::made_up_result(kSlides);
  result.outcome = Outcome::unresolved_event;
  result.weakening_resolved = plane_strain;  // there its evidence does not hold
  result.plane_strain = plane_strain;
  result.whole.n_events = 1;
  result.whole.event_moment = 1e13;
  if (plane_strain) {
    result.whole.magnitude_if_at_once.reset();
    for (auto& stage : result.stages) stage.magnitude_if_at_once.reset();
  } else {
    result.whole.event_magnitude = 2.5;
  }
  return result;
}

/// Cells too coarse for the weakening where it slips; no event.
CaseResult too_coarse() {
  CaseResult result = testing::made_up_result(kQuiet);
  result.weakening_resolved = false;
  return result;
}

CaseResult ended_early() {
  CaseResult result = testing::made_up_result(kSlides);
  result.outcome = Outcome::unstable;
  return result;
}

class VerdictOfCases : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "verdict_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = std::make_unique<Store>(Store::open_owner(folder_));
    // Offset k x 10 m of case k; the eighth crashes.
    const std::vector<CaseResult> results = {testing::made_up_result(kQuiet),
                                             testing::made_up_result(kSlides),
                                             doubtful_in_storage(),
                                             certain_beside_doubtful(),
                                             with_unresolved_event(false),
                                             too_coarse(),
                                             ended_early(),
                                             {},
                                             with_unresolved_event(true)};
    Submission s;
    s.name = "sweep";
    s.parameters = {{"offset", Dimension::length, false}};
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1000, 100, 1, 1}};
    for (std::size_t k = 1; k <= results.size(); ++k) {
      s.cases.push_back({"identity-" + std::to_string(k),
                         0,
                         0,
                         "{}",
                         {{0, 10.0 * static_cast<double>(k), std::to_string(10 * k) + " m"}}});
    }
    const std::int64_t id = store_->submit(s).campaign;
    for (std::size_t k = 1; k <= results.size(); ++k) {
      RunRecord run;
      run.case_id = static_cast<std::int64_t>(k);
      if (k == 8) {
        run.reason = "killed by SIGSEGV (11)";
      } else {
        run.status = RunStatus::completed;
        run.result = results[k - 1];
      }
      store_->record_runs(id, {run});
    }
    campaign_ = store_->campaign("sweep");
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }

  Selection selection(const std::string& stage = "", const std::string& fault = "") const {
    return make_selection(*store_, campaign_, stage, fault);
  }
  /// A letter for each case: y, n, or u for undecided.
  std::string verdicts(const std::string& condition, const StatedErrors& errors = {},
                       const std::string& stage = "", const std::string& fault = "") const {
    const Selection asked = selection(stage, fault);
    const VerdictSql sql = parse_verdict(condition, campaign_, asked, errors);
    Store::TableQuery query;
    query.stage = stage;
    if (asked.fault) query.fault = asked.fault->id;
    query.columns = {sql.certain, sql.possible};
    std::string letters;
    store_->for_each_case(campaign_.id, query, [&](const CaseRow& row) {
      letters += letter_of(row.metrics[0], row.metrics[1]);
    });
    return letters;
  }
  std::vector<long> ranked(const SqlFragment& where, const Selection& asked) const {
    Store::RankingQuery query;
    query.stage = asked.stage.name;
    if (asked.fault) query.fault = asked.fault->id;
    query.where = where;
    std::vector<long> positions;
    for (const RankedCase& row : store_->ranking(campaign_.id, query))
      positions.push_back(row.position);
    std::sort(positions.begin(), positions.end());
    return positions;
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
  CampaignInfo campaign_;
};

/// Cases: quiet, slides, F2 doubtful in storage, F2 doubtful in production beside F1, unresolved
/// event, coarse, ended early, crashed, unresolved event in plane strain.
TEST_F(VerdictOfCases, SlidingIsThatOfItsFaultAndStage) {
  EXPECT_EQ(verdicts("slides"), "nyuyynuuy");
  EXPECT_EQ(verdicts("activated"), "nyuyynuuy") << "the word of the files";
  EXPECT_EQ(verdicts("F1.slides"), "nynyynuuy");
  EXPECT_EQ(verdicts("F2.slides"), "nyuuynuuy");
  EXPECT_EQ(verdicts("F2.slides in gas_storage"), "nyuyynuuy");
  EXPECT_EQ(verdicts("F2.slides in primary_production"), "nynuynuuy");
  EXPECT_EQ(verdicts("F2.slides in whole_history"), "nyuuynuuy");
  EXPECT_EQ(verdicts("slides in gas_storage"), "nyuyynuuy");
  EXPECT_EQ(verdicts("slides in primary_production"), "nynyynuuy") << "F1 does for certain";
  EXPECT_EQ(verdicts("not F2.slides in gas_storage"), "ynunnyuun");
  EXPECT_EQ(verdicts("F1.slides or F2.slides"), "nyuyynuuy");
  EXPECT_EQ(verdicts("slides", {}, "gas_storage"), "nyuyynuuy");
  EXPECT_EQ(verdicts("slides", {}, "primary_production", "F2"), "nynuynuuy");
  EXPECT_EQ(verdicts("slides in gas_storage", {}, "primary_production", "F2"), "nyuyynuuy");
}

TEST_F(VerdictOfCases, WhetherItIsResolvedIsDecided) {
  EXPECT_EQ(verdicts("activation_resolved"), "yynyyyuuy");
  EXPECT_EQ(verdicts("F2.activation_resolved in primary_production"), "yyynyyuuy");
  EXPECT_EQ(verdicts("weakening_resolved"), "yyyynnuuy");
  EXPECT_EQ(verdicts("slides and activation_resolved"), "nynyynuuy");
  EXPECT_EQ(verdicts("slides or not activation_resolved"), "nyyyynuuy");
}

TEST_F(VerdictOfCases, OnsetsAreThoseOfTheFirstFault) {
  EXPECT_EQ(verdicts("activation_step = 1"), "nyuuynuuy") << "F2 may have been first";
  EXPECT_EQ(verdicts("activated_fault = 'F1'"), "nyuuynuuy");
  EXPECT_EQ(verdicts("activation_pressure_change < -5 bar"), "nyuuynuuy");
  EXPECT_EQ(verdicts("F1.activation_step = 1"), "nynyynuuy");
  EXPECT_EQ(verdicts("F2.activation_depth > 1 km"), "nyuuynuuy");
  EXPECT_EQ(verdicts("F2.activation_depth in gas_storage > 5 km"), "nnunnnuun");
}

TEST_F(VerdictOfCases, EpisodesFollowFromAnySliding) {
  EXPECT_EQ(verdicts("unexpected"), "nnuunnuun");
  EXPECT_EQ(verdicts("unexpected_fault = 'F2'"), "nnuunnuun");
  EXPECT_EQ(verdicts("n_episodes = 0"), "yyuuyyuuy");
  EXPECT_EQ(verdicts("pressure_margin > 0 bar"), "ynuunyuun");
}

TEST_F(VerdictOfCases, SizesOfEventsThatCellsDoNotResolve) {
  for (const char* condition :
       {"jumps", "n_events > 0", "F1.jumps in gas_storage", "event_stress_drop > 1 bar"}) {
    EXPECT_EQ(verdicts(condition), "nnnnuuuuu") << condition;
  }
  EXPECT_EQ(verdicts("event_magnitude > 3"), "nnnnuuuun") << "none in plane strain";
  EXPECT_EQ(verdicts("magnitude_if_released_at_once > 0"), "nynyuuuun");
  for (const char* condition : {"max_slip > 1 mm", "slip in gas_storage > 1 mm",
                                "F1.max_slip > 1 mm", "moment > \"1 N m\""}) {
    EXPECT_EQ(verdicts(condition), "nynyuuuuu") << condition;
  }
  EXPECT_EQ(verdicts("activated_area > 0 m2"), "nyuuuuuuu") << "a sum over both faults";
  EXPECT_EQ(verdicts("F1.activated_area > 0 m2"), "nynyuuuuu");
}

TEST_F(VerdictOfCases, WhatIsOfTheseCellsIsDecided) {
  for (const char* condition : {"slips", "chi_max > 0.95", "chi_bar > 0.8"})
    EXPECT_EQ(verdicts(condition), "nynyynuuy") << condition;
  EXPECT_EQ(verdicts("opens"), "nnnnnnuun");
}

TEST_F(VerdictOfCases, ParametersAndTheRunAreDecidedWithoutAHistory) {
  EXPECT_EQ(verdicts("offset > 35 m"), "nnnyyyyyy");
  EXPECT_EQ(verdicts("offset > 75 m and slides"), "nnnnnnnuy");
  EXPECT_EQ(verdicts("offset < 75 m or slides"), "yyyyyyyuy");
  EXPECT_EQ(verdicts("outcome = 'unstable'"), "nnnnnnyun");
  EXPECT_EQ(verdicts("plane_strain"), "nnnnnnnuy");
}

TEST_F(VerdictOfCases, ErrorsHoldInAllScopes) {
  const StatedErrors errors = {{"chi_bar", 0.05}, {"max_slip", 1.5e-3}};
  EXPECT_EQ(verdicts("chi_bar > 0.87", errors), "nunuunuuu");
  EXPECT_EQ(verdicts("chi_bar > 0.8", errors), "nynyynuuy");
  EXPECT_EQ(verdicts("F2.chi_bar in gas_storage > 0.42", errors), "nunuunuuu");
  EXPECT_EQ(verdicts("F2.chi_bar > 0.35", errors), "nynyynuuy");
  EXPECT_EQ(verdicts("chi_max > 0.95", errors), "nynyynuuy") << "of another metric";
  EXPECT_EQ(verdicts("slip > 3 mm", errors), "nunuuuuuu");
  EXPECT_EQ(verdicts("slip > 2 mm", errors), "nynyuuuuu");
  EXPECT_EQ(verdicts("F1.slip in gas_storage - F2.slip in gas_storage > 4.9 mm", errors),
            "nunuuuuuu")
      << "2 mm, both with an error";
  EXPECT_EQ(verdicts("F1.slip in gas_storage - F2.slip in gas_storage > 5.1 mm", errors),
            "nnnnuuuuu");
}

TEST(StatedErrors, AreTheLargestThatWereMeasured) {
  EXPECT_EQ(stated_errors({{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05},
                           {"sweep", "screening", "max_slip", "standard", 32, 1e-4, 3e-4}}),
            (StatedErrors{{"chi_bar", 0.05}, {"max_slip", 3e-4}}));
  EXPECT_EQ(stated_errors({{"sweep", "screening", "chi_bar", "standard", 32, 0.02, 0.05},
                           {"sweep", "screening", "chi_bar", "reference", 8, 0.03, 0.04}}),
            (StatedErrors{{"chi_bar", 0.05}}));
}

TEST_F(VerdictOfCases, RankingsTakeThemAsConditions) {
  const Selection whole = selection(), storage = selection("gas_storage", "F2");
  const VerdictSql slides = parse_verdict("F2.slides", campaign_, whole, {});
  EXPECT_THAT(ranked(slides.certain, whole), ElementsAre(2, 5, 9));
  EXPECT_THAT(ranked(slides.possible, whole), ElementsAre(2, 3, 4, 5, 7, 9));
  const VerdictSql there = parse_verdict("slides", campaign_, storage, {});
  EXPECT_THAT(ranked(there.certain, storage), ElementsAre(2, 4, 5, 9));
  EXPECT_THAT(ranked(there.possible, storage), ElementsAre(2, 3, 4, 5, 7, 9));
  const VerdictSql jumps = parse_verdict("not jumps", campaign_, storage, {});
  EXPECT_THAT(ranked(jumps.certain, storage), ElementsAre(1, 2, 3, 4));
}

/// Of each metric, of the row asked for and of another one: what is resolved is as the plain
/// condition says, and nothing is known of the case that crashed.
TEST_F(VerdictOfCases, EveryMetricSaysOnWhatItDepends) {
  const Selection asked = selection("gas_storage", "F2");
  const auto known = known_metrics(asked);
  Store::TableQuery query;
  query.stage = asked.stage.name;
  query.fault = asked.fault->id;
  std::vector<std::string> conditions;
  for (const MetricInfo& metric : metric_catalogue()) {
    for (const char* before : {"", "F1."}) {
      for (const char* behind : {"", " in primary_production"}) {
        const auto found = known.find(before + metric.name + behind);
        if (found == known.end()) continue;
        const std::string& name = found->second.spelled;
        conditions.push_back(metric.is_flag ? name : name + " >= 0.5 * " + name);
        const VerdictSql sql = parse_verdict(conditions.back(), campaign_, asked, {});
        query.columns.insert(
            query.columns.end(),
            {parse_condition(conditions.back(), campaign_, asked), sql.certain, sql.possible});
      }
    }
  }
  EXPECT_GT(conditions.size(), 2 * metric_catalogue().size());
  store_->for_each_case(campaign_.id, query, [&](const CaseRow& row) {
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      const Cell* cells = &row.metrics[3 * k];
      const std::string what = conditions[k] + " of case " + std::to_string(row.position);
      if (row.position <= 2) {
        EXPECT_EQ(cells[1], cells[0]) << what;
        EXPECT_EQ(cells[2], cells[0]) << what;
      } else if (row.position == 8) {
        EXPECT_EQ(letter_of(cells[1], cells[2]), 'u') << what;
      }
    }
  });
}

/// Before migration 10 nobody said whether an activation is resolved.
TEST_F(VerdictOfCases, OldResultsDoNotKnow) {
  Connection(folder_ / "campaign.sqlite", Connection::Mode::read_write)
      .execute(
          "UPDATE stage_metrics SET activation_resolved = NULL;"
          "UPDATE fault_metrics SET activation_resolved = NULL");
  EXPECT_EQ(verdicts("slides"), "uuuuuuuuu");
  EXPECT_EQ(verdicts("F1.slides in gas_storage"), "uuuuuuuuu");
  EXPECT_EQ(verdicts("unexpected"), "uuuuuuuuu");
  EXPECT_EQ(verdicts("chi_bar > 0.8"), "nynyynuuy");
}

TEST_F(VerdictOfCases, WhatIsNoConditionIsRefused) {
  const auto refusal = [&](const std::string& condition) -> std::string {
    try {
      parse_verdict(condition, campaign_, selection(), {});
    } catch (const faultsim::InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal("chi_bar"), HasSubstr("'chi_bar' is not a condition"));
  EXPECT_THAT(refusal("F2.slidez"), HasSubstr("did you mean F2.slides?"));
  EXPECT_THAT(refusal(""), HasSubstr("the expression is empty"));
}

}  // namespace
}  // namespace faultsweep
