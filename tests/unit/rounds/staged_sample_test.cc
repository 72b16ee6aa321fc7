#include "campaign/rounds/staged_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign/statistics/intervals.h"

namespace faultsweep {
namespace {

using json = nlohmann::ordered_json;
using ::testing::HasSubstr;

/// n answers of which every other holds; the last n_failed have failed.
std::vector<RowAnswers> every_other(int n, int n_failed = 0) {
  std::vector<RowAnswers> answers(n);
  for (int k = 0; k < n; ++k) {
    answers[k].position = k + 1;
    answers[k].failed = k >= n - n_failed;
    answers[k].complete = !answers[k].failed;
    answers[k].held = {answers[k].failed ? Held::unknown : k % 2 == 0 ? Held::yes : Held::no};
  }
  return answers;
}

const json kFirst = {{"kind", "monte-carlo"}, {"samples", 100}, {"first", 7}, {"seed", 3}};

TEST(StagedSampler, GoesOnBehindTheSamplesThatItHas) {
  const StagedSampler sampler({.condition = "slides", .width = 0.12, .most = 1000});
  const Proposal second = sampler.propose(every_other(100), {kFirst});
  EXPECT_EQ(second.design.at("first"), 107);
  EXPECT_EQ(second.design.at("samples"), 100) << "at most as many as there are";
  EXPECT_EQ(second.design.at("seed"), 3);
  EXPECT_THAT(second.reason, HasSubstr("39.8 to 60.2 %"));
  const Proposal third = sampler.propose(every_other(200), {kFirst, second.design});
  EXPECT_EQ(third.design.at("first"), 207);
  EXPECT_EQ(third.design.at("samples"), samples_for_half_width(0.5, 0.06, 0.95) - 200);
}

TEST(StagedSampler, EndsWhenTheIntervalIsNarrowOrTheSamplesAreUsedUp) {
  const StagedSampler wide({.condition = "slides", .width = 0.21, .most = 1000});
  EXPECT_TRUE(wide.propose(every_other(100), {kFirst}).design.is_null());
  const StagedSampler few({.condition = "slides", .width = 0.1, .most = 130});
  const Proposal second = few.propose(every_other(100), {kFirst});
  EXPECT_EQ(second.design.at("samples"), 30);
  const Proposal end = few.propose(every_other(130), {kFirst, second.design});
  EXPECT_TRUE(end.design.is_null());
  EXPECT_THAT(end.reason, HasSubstr("130 samples are the most"));
}

TEST(StagedSampler, AFailedCaseMayBeEither) {
  const StagedSampler sampler({.condition = "slides", .width = 0.21, .most = 1000});
  const Proposal proposal = sampler.propose(every_other(100, 20), {kFirst});
  EXPECT_FALSE(proposal.design.is_null()) << "the same width without failures would be enough";
  EXPECT_THAT(proposal.reason, HasSubstr("true in 40 of 100, not known in 20"));
}

/// The bounds are those of `probability`. Their width without what is undecided decides, as further
/// cases would be undecided as often.
TEST(StagedSampler, WhatIsUndecidedWidensTheIntervalAndTakesNoFurtherCases) {
  std::vector<RowAnswers> answers = every_other(100);
  for (std::size_t k = 0; k < 16; ++k)
    answers[k].held = {k % 2 == 0 ? Held::undecided_yes : Held::undecided_no};
  const Interval bounds = proportion_bounds(42, 16, 100, 0.95);
  const std::string range = faultsim::concat(faultsim::formatted("%.1f", 100 * bounds.low), " to ",
                                             faultsim::formatted("%.1f", 100 * bounds.high), " %");
  const StagedSampler enough({.condition = "slides", .width = 0.21, .most = 1000});
  const Proposal end = enough.propose(answers, {kFirst});
  EXPECT_TRUE(end.design.is_null());
  EXPECT_EQ(end.reason.substr(0, range.size()), range);
  EXPECT_THAT(end.reason, HasSubstr("true in 50 of 100, undecided in 16; ± 10.2 % by the number of "
                                    "cases; the rest is due to cases that are not decided"));
  const StagedSampler more({.condition = "slides", .width = 0.19, .most = 1000});
  const Proposal next = more.propose(answers, {kFirst});
  EXPECT_EQ(next.design.at("first"), 107);
  EXPECT_THAT(next.reason, HasSubstr("; that alone is wider than 19.0 %"));
}

TEST(StagedSampler, EndsWhereNoCaseSaysAnything) {
  const StagedSampler sampler({.condition = "slides", .width = 0.21, .most = 1000});
  const Proposal end = sampler.propose(every_other(100, 100), {kFirst});
  EXPECT_TRUE(end.design.is_null());
  EXPECT_EQ(end.reason,
            "0.0 to 100.0 % (confidence 95.0 %): true in 0 of 100, not known in 100; no case has a "
            "full history");
}

}  // namespace
}  // namespace faultsweep
