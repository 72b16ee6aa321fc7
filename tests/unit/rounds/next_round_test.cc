#include "campaign/rounds/next_round.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "campaign/answers/limit_table.h"
#include "campaign/expansion/submission.h"
#include "campaign/rounds/answers_of.h"
#include "campaign/rounds/staged_sample.h"
#include "tests/campaign/made_up_result.h"
#include "tests/unit/answers/renderings.h"

namespace faultsweep {
namespace {

using json = nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A campaign of the reference scene in the spec's own folder; results are made up.
class NextRound : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "rounds_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static Expansion expansion(const std::string& rounds, int samples = 20, int first = 0) {
    const std::string text = faultsim::concat(
        R"({"format": 1, "name": "sample", "base": "docs/examples/scenes/rotliegend.json",
            "set": {"/tier": "screening"}, )",
        rounds, R"("design": {"kind": "monte-carlo", "samples": )", samples, R"(, "first": )",
        first,
        R"(, "parameters": {"offset": ["0 m", "100 m"],
                            "friction_angle": {"from": "15 deg", "to": "35 deg"}}}})");
    return expand(parse_campaign(text, FAULTSIM_SOURCE_DIR "/test.json"));
  }
  static constexpr const char* kRounds =
      R"("rounds": {"probability_of": "F1.slides in gas_storage", "width": 0.25,
                    "most_samples": 60}, )";

  /// Decides what waits: of every fourth case a fault slides, the first of all fails.
  void decide(Store& store, const std::string& name = "sample") {
    const CampaignInfo info = store.campaign(name);
    for (const WaitingFamily& family : store.waiting_families(info.id)) {
      for (const std::int64_t id : family.cases) {
        RunRecord run;
        run.case_id = id;
        run.status = id == 1 ? RunStatus::crashed : RunStatus::completed;
        if (id != 1) run.result = testing::made_up_result(id % 4 == 0 ? 0.9 : 0.2);
        store.record_runs(info.id, {run});
      }
    }
  }

  std::filesystem::path folder_;
};

TEST_F(NextRound, AMonteCarloSampleContinuesAndIsTheSameAsALongerOne) {
  const Expansion whole = expansion("", 30), first = expansion("", 12),
                  rest = expansion("", 18, 12);
  ASSERT_EQ(whole.cases.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) {
    const Expansion& part = i < 12 ? first : rest;
    EXPECT_EQ(whole.cases[i].identity, part.cases[i < 12 ? i : i - 12].identity) << i;
  }
}

TEST_F(NextRound, RoundsAreProposedUntilTheIntervalIsNarrow) {
  Store store = Store::open_owner(folder_);
  const std::int64_t id = store.submit(make_submission(expansion(kRounds))).campaign;
  decide(store);
  ASSERT_TRUE(add_next_round(store, "sample"));
  EXPECT_EQ(store.campaign("").n_waiting, 20) << "at most as many as there are";
  EXPECT_THAT(store.rounds(id).at(1).reason, HasSubstr("true in 5 of 20, not known in 1"));
  EXPECT_THAT(store.integrity_problems(), IsEmpty()) << "sealed again";
  decide(store);
  while (add_next_round(store, "sample")) decide(store);
  EXPECT_FALSE(add_next_round(store, "sample")) << "asked again it says the same";
  const CampaignInfo info = store.campaign("");
  EXPECT_THAT(info.conclusion, HasSubstr("% (confidence 95.0 %)"));
  EXPECT_GE(store.rounds(id).size(), 3u);
  EXPECT_LE(info.n_cases, 60);
  // The sample is that of a design with as many samples at once, which finds every result.
  Submission whole = make_submission(expansion("", static_cast<int>(info.n_cases)));
  whole.name = "whole";
  EXPECT_EQ(store.submit(whole).n_cached, info.n_cases - 1) << "one has failed";
  const auto rows = store.design_rows(id);
  ASSERT_EQ(static_cast<long>(rows.size()), info.n_cases);
  for (long k = 0; k < info.n_cases; ++k) {
    EXPECT_EQ(rows[k].row, k + 1);
    EXPECT_EQ(store.stored_case(id, std::to_string(rows[k].position)).identity,
              whole.cases[k].identity);
  }
}

TEST_F(NextRound, AnswersAreOfTheRoundThatAskedForThem) {
  Store store = Store::open_owner(folder_);
  store.submit(make_submission(expansion(kRounds)));
  decide(store);
  ASSERT_TRUE(add_next_round(store, "sample"));
  decide(store);
  const CampaignInfo campaign = store.campaign("");
  const StoredRounds stored = stored_rounds(store, campaign).value();
  const StagedSampler sampler(*parse_spec(stored).staged_sample);
  const std::vector<RowAnswers> answers = answers_of(store, campaign, stored, sampler, false);
  ASSERT_EQ(answers.size(), 40u);
  for (std::size_t k = 0; k < answers.size(); ++k) {
    EXPECT_EQ(answers[k].position, static_cast<long>(k) + 1);
    EXPECT_EQ(answers[k].round, k < 20 ? 0 : 1) << k;
    EXPECT_EQ(answers[k].complete, k != 0) << "the first of all fails";
    EXPECT_EQ(answers[k].failed, k == 0);
  }
}

TEST_F(NextRound, ResultsThatAreKnownAlreadyAreShared) {
  Store store = Store::open_owner(folder_);
  Submission other = make_submission(expansion("", 30));
  other.name = "other";
  store.submit(other);
  decide(store, "other");
  store.submit(make_submission(expansion(kRounds)));
  store.retry(store.campaign("sample").id, false, std::nullopt);
  decide(store);
  ASSERT_TRUE(add_next_round(store, "sample"));
  EXPECT_EQ(store.campaign("sample").n_waiting, 10) << "of 20, the other campaign has run 10";
}

/// Its first case is stored as changes of the scene of another campaign.
TEST_F(NextRound, FurtherRoundsAreOnTheCampaignsOwnScene) {
  const Expansion own = expansion(kRounds);
  json first = json::object();
  for (const ParameterValue& one : parameters_of(own, own.cases.front()))
    first[one.name] = one.text;
  first["cohesion"] = "0 MPa";
  const json other = {{"format", 1},
                      {"name", "other"},
                      {"base", "docs/examples/scenes/rotliegend.json"},
                      {"set", {{"/tier", "screening"}, {"cohesion", "3 MPa"}}},
                      {"design", {{"kind", "list"}, {"cases", {first}}}}};
  Store store = Store::open_owner(folder_);
  store.submit(
      make_submission(expand(parse_campaign(other.dump(), FAULTSIM_SOURCE_DIR "/test.json"))));
  ASSERT_EQ(store.preview(make_submission(own)).n_cached, 0);
  decide(store, "other");
  const std::int64_t id = store.submit(make_submission(own)).campaign;
  ASSERT_EQ(store.stored_case(id, "1").id, 1) << "shared with the other campaign";
  decide(store);
  ASSERT_TRUE(add_next_round(store, "sample"));
  const Expansion whole = expansion("", 40);
  for (int k = 21; k <= 40; ++k) {
    EXPECT_EQ(store.stored_case(id, std::to_string(k)).identity, whole.cases[k - 1].identity) << k;
  }
}

/// Of two offsets, the highest storage pressure for which F1 does not slide.
json limit_spec() {
  return {{"format", 1},
          {"name", "sample"},
          {"base", "docs/examples/scenes/rotliegend.json"},
          {"set", {{"/tier", "screening"}}},
          {"design", {{"kind", "grid"}, {"parameters", {{"offset", {"0 m", "100 m"}}}}}},
          {"limits",
           {{"top",
             {{"parameter",
               {{"pointers", {"/stages/2/pressure_between/1"}},
                {"from", "-110 bar"},
                {"to", "-10 bar"},
                {"count", 5}}},
              {"faults", {"F1"}},
              {"stage", "gas_storage"},
              {"tolerance", "2 bar"}}}}}};
}

TEST_F(NextRound, AnExclusionLeavesOutWholeSearchesOnly) {
  json spec = limit_spec();
  const std::string source = FAULTSIM_SOURCE_DIR "/test.json";
  spec["exclude"] = {"offset > 50 m"};
  EXPECT_NO_THROW(check_rounds(expand(parse_campaign(spec.dump(), source))));
  spec["exclude"] = {"top > -50 bar"};
  try {
    check_rounds(expand(parse_campaign(spec.dump(), source)));
    FAIL() << "accepted";
  } catch (const faultsim::InputError& error) {
    EXPECT_EQ(error.problems().at(0).pointer, "/exclude");
    EXPECT_THAT(error.what(), HasSubstr("2 of the 5 values of a search (row 1 of the design)"));
  }
}

/// Slides above a storage pressure of -40 bar; the second offset never does.
TEST_F(NextRound, LimitsAreFoundOnTheStore) {
  const Expansion limits =
      expand(parse_campaign(limit_spec().dump(), FAULTSIM_SOURCE_DIR "/test.json"));
  EXPECT_EQ(limits.cases.size(), 10u) << "five values in each of two rows";
  EXPECT_NO_THROW(check_rounds(limits));
  Store store = Store::open_owner(folder_);
  const std::int64_t id = store.submit(make_submission(limits)).campaign;
  const auto decide_all = [&] {
    for (const WaitingFamily& family : store.waiting_families(id)) {
      for (const std::int64_t one : family.cases) {
        const CaseParameters values = store.stored_case(id, std::to_string(one)).parameters;
        RunRecord run;
        run.case_id = one;
        run.status = RunStatus::completed;
        const bool slides = *values[0].si < 50 && *values[1].si > -40e5;
        run.result = testing::made_up_result(slides ? 0.9 : 0.2);
        store.record_runs(id, {run});
      }
    }
  };
  decide_all();
  while (add_next_round(store, "sample")) decide_all();
  EXPECT_EQ(store.campaign("").conclusion, "2 searches: 1 safe throughout, 1 limit");
  const LimitTable table = make_limit_table(store, store.campaign(""));
  EXPECT_TRUE(table.is_finished);
  ASSERT_EQ(table.rows.size(), 2u);
  const Crossing& limit = *table.rows[0].cells[0]->finding.limit();
  EXPECT_LE(limit.before.value, -40);
  EXPECT_GT(limit.after.value, -40);
  EXPECT_LE(limit.width(), 2);
  EXPECT_EQ(table.rows[0].settings, std::vector<std::string>{"0 m"});
  const Answer answer = to_answer(table, 0);
  testing::expect_same_renderings(answer);
  EXPECT_THAT(render_csv(table_named(answer, "")),
              HasSubstr("2,100 m,F1,top,Pa,safe throughout,safe in the whole range tried (-110 to "
                        "-10 bar),,,"));
  const json first = json(render_json(answer)).at("limits").at(0);
  EXPECT_NEAR(first.at("safe").get<double>(), 1e5 * limit.before.value, 1e-6);
  EXPECT_EQ(first.at("safe_case"), limit.before.position);
  EXPECT_EQ(first.at("parameters").at("offset"), "0 m");
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

/// The doubt of a condition is its own: of what it names, on the fault that it names.
TEST_F(NextRound, WhatTheCellsLeaveOpenOfALimitIsThatOfItsCondition) {
  json spec = limit_spec();
  spec["design"]["parameters"]["offset"] = {"0 m"};
  spec["limits"]["top"]["tolerance"] = "25 bar";
  const auto only_row = [&](const std::string& name, const std::string& unsafe) {
    spec["name"] = name;
    spec["limits"]["top"]["unsafe"] = unsafe;
    Store store = Store::open_owner(folder_);
    const Expansion limits = expand(parse_campaign(spec.dump(), FAULTSIM_SOURCE_DIR "/test.json"));
    const std::int64_t id = store.submit(make_submission(limits)).campaign;
    for (const WaitingFamily& family : store.waiting_families(id)) {
      for (const std::int64_t one : family.cases) {
        const bool slides = *store.stored_case(id, std::to_string(one)).parameters[1].si > -40e5;
        RunRecord run;
        run.case_id = one;
        run.status = RunStatus::completed;
        run.result = testing::made_up_result(slides ? 0.9 : 0.2);
        run.result->weakening_resolved = false;                       // events are open
        run.result->stages[2].faults[1].activation_resolved = false;  // F2, not F1
        if (slides) run.result->stages[2].faults[0].n_events = run.result->stages[2].n_events = 1;
        store.record_runs(id, {run});
      }
    }
    EXPECT_FALSE(add_next_round(store, name));
    return make_limit_table(store, store.campaign(name)).rows.at(0).cells[0]->finding;
  };
  const LimitFinding slides = only_row("slides", "slides");
  EXPECT_EQ(slides.surely_safe->value, slides.limit()->before.value);
  EXPECT_EQ(slides.surely_unsafe->value, slides.limit()->after.value);
  const LimitFinding jumps = only_row("jumps", "jumps");
  EXPECT_EQ(jumps.limit()->before.value, slides.limit()->before.value);
  EXPECT_FALSE(jumps.surely_safe);
  EXPECT_FALSE(jumps.surely_unsafe);
  EXPECT_FALSE(only_row("others", "F2.slides in gas_storage").surely_safe);
  EXPECT_TRUE(only_row("chi", "chi_bar > 0.5").surely_safe) << "does not hang on events";
}

/// Every further round has only cases that are known, but makes the sample larger.
TEST_F(NextRound, RoundsOfKnownCasesAreAnsweredAtOnce) {
  const json spec = {
      {"format", 1},
      {"name", "sample"},
      {"base", "docs/examples/scenes/rotliegend.json"},
      {"set", {{"/tier", "screening"}}},
      {"rounds",
       {{"probability_of", "F1.slides in gas_storage"}, {"width", 0.25}, {"most_samples", 400}}},
      {"design",
       {{"kind", "monte-carlo"},
        {"samples", 20},
        {"parameters", {{"offset", {"0 m", "100 m"}}, {"friction_angle", {"15 deg", "25 deg"}}}}}}};
  Store store = Store::open_owner(folder_);
  const std::int64_t id = store
                              .submit(make_submission(expand(
                                  parse_campaign(spec.dump(), FAULTSIM_SOURCE_DIR "/test.json"))))
                              .campaign;
  ASSERT_EQ(store.campaign("").n_cases, 4);
  for (const WaitingFamily& family : store.waiting_families(id)) {
    for (const std::int64_t one : family.cases) {
      RunRecord run;
      run.case_id = one;
      run.status = RunStatus::completed;
      run.result = testing::made_up_result(one <= 2 ? 0.9 : 0.2);
      store.record_runs(id, {run});
    }
  }
  EXPECT_FALSE(add_next_round(store, "sample"));
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_cases, 4);
  EXPECT_GT(store.rounds(id).size(), 1u);
  EXPECT_GT(store.design_rows(id).size(), 40u);
  EXPECT_THAT(info.conclusion, ::testing::Not(HasSubstr("wider")));
  EXPECT_THAT(store.integrity_problems(), IsEmpty());
}

TEST_F(NextRound, ACampaignWithoutRoundsHasOne) {
  Store store = Store::open_owner(folder_);
  const std::int64_t id = store.submit(make_submission(expansion(""))).campaign;
  decide(store);
  EXPECT_FALSE(add_next_round(store, "sample"));
  EXPECT_EQ(store.rounds(id).size(), 1u);
  EXPECT_EQ(store.campaign("").conclusion, "");
}

TEST_F(NextRound, AConditionThatResultsCannotAnswerIsRefusedBefore) {
  EXPECT_NO_THROW(check_rounds(expansion(kRounds)));
  try {
    check_rounds(expansion(R"("rounds": {"probability_of": "F9.slides in gas_storage",
                                         "width": 0.2, "most_samples": 60}, )"));
    FAIL() << "accepted";
  } catch (const faultsim::InputError& error) {
    EXPECT_EQ(error.problems().at(0).pointer, "/rounds/probability_of");
    EXPECT_THAT(error.what(), HasSubstr("F9"));
  }
}

}  // namespace
}  // namespace faultsweep
