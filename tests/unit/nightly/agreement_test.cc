#include "campaign/nightly/agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "campaign/store/same_numbers.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;
using faultsim::Outcome;
using ::testing::HasSubstr;

const Tolerances kTolerances;

/// What a change makes of a case, in the same environment or another one.
Agreement after(const std::function<void(CaseResult&)>& change, bool same_environment = true) {
  const CaseResult baseline = testing::made_up_result_with_events(0.8);
  CaseResult tonight = baseline;
  change(tonight);
  return compare_results(baseline, tonight, same_environment, kTolerances);
}

TEST(Ulps, AreCountedOverTheWholeLine) {
  EXPECT_EQ(ulps_between(1, 1), 0u);
  EXPECT_EQ(ulps_between(0.0, -0.0), 0u);
  EXPECT_EQ(ulps_between(1, std::nextafter(1, 2)), 1u);
  EXPECT_EQ(ulps_between(-1, std::nextafter(-1, 0)), 1u);
  EXPECT_EQ(ulps_between(5e-324, -5e-324), 2u);
  EXPECT_EQ(ulps_between(1, 2), std::uint64_t{1} << 52);
  EXPECT_EQ(ulps_between(-1.7e308, 1.7e308), ulps_between(1.7e308, -1.7e308));
  EXPECT_GT(ulps_between(-1.7e308, 1.7e308), std::uint64_t{1} << 63);
}

TEST(Agreement, TheSameResultIsIdentical) {
  const Agreement agreement = after([](CaseResult& r) {
    r.title = "other";
    r.counts.newton_iterations += 7;
    r.seconds = 12;
    r.warnings = {"so what"};
    r.steps[2].observed = {1, 2};
  });
  EXPECT_EQ(agreement.verdict, Verdict::identical);
  EXPECT_FALSE(agreement.first.has_value());
}

TEST(Agreement, ARelativeChangeOf1e13IsFoundAndLocated) {
  const auto change = [](CaseResult& r) {
    for (std::size_t k = 7; k < r.steps.size(); ++k) r.steps[k].faults[1].moment *= 1 + 1e-13;
    r.whole.moment *= 1 + 1e-13;
  };
  const Agreement same = after(change);
  EXPECT_EQ(same.verdict, Verdict::last_bits);
  EXPECT_TRUE(is_regression(same.verdict));
  ASSERT_TRUE(same.first.has_value());
  EXPECT_EQ(same.first->step, 7);
  EXPECT_EQ(same.first->place, "load step 7 (cushion_gas_injection), fault 2");
  EXPECT_EQ(same.first->quantity, "moment_nm");
  EXPECT_NEAR(static_cast<double>(same.first->ulps), 1e-13 / 2.2e-16, 250);
  EXPECT_GE(same.max_ulps, same.first->ulps);
  const Agreement other = after(change, false);
  EXPECT_EQ(other.verdict, Verdict::within_tier);
  EXPECT_FALSE(is_regression(other.verdict));
  EXPECT_EQ(other.first->step, 7);
}

/// Any change that first_difference sees has a place, and is a regress in the same environment.
TEST(Agreement, EveryNumberCounts) {
  const auto nudge = [](double& value) { value = std::nextafter(value, 1e300); };
  const struct {
    const char* place;
    const char* quantity;
    Verdict verdict;
    std::function<void(CaseResult&)> change;
  } changes[] = {
      {"load step 3 (primary_production)", "pressure_change_pa", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.steps[3].pressure_change[1]); }},
      {"load step 12 (gas_storage)", "n_slip", Verdict::beyond_tier,
       [](CaseResult& r) { ++r.steps[12].n_slip; }},
      {"load step 3 (primary_production), fault 2", "activated_at_edge", Verdict::beyond_tier,
       [](CaseResult& r) { r.steps[3].faults[1].activated_at_edge = false; }},
      {"load step 7 (cushion_gas_injection)", "time_error_pa", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.steps[7].creep->time_error); }},
      {"load step 9 (gas_storage), creep at fault 2", "shear_max_pa", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.steps[9].creep->faults[1].shear_max); }},
      {"load step 0 (initial)", "time_steps", Verdict::beyond_tier,
       [](CaseResult& r) { r.steps[0].creep.reset(); }},
      {"slip event 2", "duration_s", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.events[1].duration); }},
      {"slip event 1", "fault", Verdict::beyond_tier,
       [](CaseResult& r) { r.events[0].fault = "F9"; }},
      {"episode 1", "moment_nm", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.episodes[0].moment); }},
      {"stage 2", "moment_nm", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.stages[1].moment); }},
      {"stage 2, fault 1", "moment_nm", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.stages[1].faults[0].moment); }},
      {"the whole history, fault 2, activation, pressures", "change_plus_pa", Verdict::last_bits,
       [&](CaseResult& r) { nudge(*r.whole.faults[1].activation->pressures.change_plus); }},
      {"the whole history", "max_slip_m", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.whole.max_slip); }},
      {"the case", "max_penetration_m", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.max_penetration); }},
      {"the case", "unexpected", Verdict::beyond_tier, [](CaseResult& r) { r.unexpected.reset(); }},
      {"the case", "pressure_margin_pa", Verdict::beyond_tier,
       [](CaseResult& r) { r.pressure_margin = 1; }},
      {"the case, surface", "error_of_slip", Verdict::last_bits,
       [&](CaseResult& r) { nudge(r.surface->slip); }},
      {"the case", "surface", Verdict::beyond_tier, [](CaseResult& r) { r.surface.reset(); }},
      {"the case", "field_coverage", Verdict::last_bits,
       [&](CaseResult& r) { nudge(*r.field_coverage); }},
      {"the case", "reason", Verdict::last_bits, [](CaseResult& r) { r.reason = "other"; }},
      {"load step 5 (cushion_gas_injection), fault 1", "activated", Verdict::activation_flipped,
       [](CaseResult& r) { r.steps[5].faults[0].activated = false; }},
      {"stage 3", "activated", Verdict::activation_flipped,
       [](CaseResult& r) { r.stages[2].activated = false; }},
      {"the whole history", "activation_step", Verdict::activation_flipped,
       [](CaseResult& r) { r.whole.activation_step = 2; }},
      {"the case", "outcome", Verdict::outcome_changed,
       [](CaseResult& r) { r.outcome = Outcome::unstable; }},
      {"load step 4 (primary_production)", "outcome", Verdict::outcome_changed,
       [](CaseResult& r) { r.steps[4].outcome = Outcome::event; }},
      {"number of load steps", "number", Verdict::outcome_changed,
       [](CaseResult& r) { r.steps.pop_back(); }},
      {"number of slip event", "number", Verdict::outcome_changed,
       [](CaseResult& r) { r.events.pop_back(); }},
      {"number of episode", "number", Verdict::outcome_changed,
       [](CaseResult& r) { r.episodes.pop_back(); }},
  };
  for (const auto& one : changes) {
    const Agreement agreement = after(one.change);
    ASSERT_TRUE(agreement.worst.has_value()) << one.place << " " << one.quantity;
    EXPECT_EQ(agreement.worst->place, one.place) << one.quantity;
    EXPECT_EQ(agreement.worst->quantity, one.quantity) << one.place;
    EXPECT_STREQ(to_string(agreement.verdict), to_string(one.verdict)) << one.place;
    EXPECT_TRUE(is_regression(agreement.verdict));
  }
}

TEST(Agreement, AQuantityNearZeroIsJudgedByItsRange) {
  const auto change = [](CaseResult& r) {
    r.steps[0].faults[0].moment += 1e3;
  };  // was 0; up to 3e14
  EXPECT_EQ(after(change, false).verdict, Verdict::within_tier);
  const auto more = [](CaseResult& r) { r.steps[0].faults[0].moment += 1e9; };
  EXPECT_EQ(after(more, false).verdict, Verdict::beyond_tier);
}

TEST(Agreement, TolerancesAreOfTheirQuantityAndNoneHelpsAgainstFlips) {
  const CaseResult baseline = testing::made_up_result(0.8);
  CaseResult tonight = baseline;
  tonight.whole.moment *= 1.001;
  Tolerances wide;
  EXPECT_EQ(compare_results(baseline, tonight, false, wide).verdict, Verdict::beyond_tier);
  wide.of_quantity["moment_nm"] = 0.01;
  EXPECT_EQ(compare_results(baseline, tonight, false, wide).verdict, Verdict::within_tier);
  EXPECT_EQ(compare_results(baseline, tonight, true, wide).verdict, Verdict::last_bits);
  wide.all = 1e9;
  tonight.whole.activated = false;
  EXPECT_EQ(compare_results(baseline, tonight, false, wide).verdict, Verdict::activation_flipped);
  tonight.outcome = Outcome::event;
  EXPECT_EQ(compare_results(baseline, tonight, false, wide).verdict, Verdict::outcome_changed);
}

/// The surface of a case was not stored when older baselines were written.
TEST(Agreement, WhatABaselineDoesNotHaveIsNoDifference) {
  CaseResult tonight = testing::made_up_result_with_events(0.8);
  tonight.steps[1].temperature_change = {-10, 0};
  CaseResult baseline = tonight;
  baseline.steps[1].temperature_change.clear();
  baseline.surface.reset();
  baseline.field_coverage.reset();
  baseline.field_assumed.reset();
  EXPECT_EQ(compare_results(baseline, tonight, true, kTolerances).verdict, Verdict::identical);
  baseline.whole.moment *= 1 + 1e-13;
  const Agreement other = compare_results(baseline, tonight, true, kTolerances);
  EXPECT_EQ(other.verdict, Verdict::last_bits);
  EXPECT_EQ(other.worst->quantity, "moment_nm");
}

/// As another C library's logarithm makes it, of the same moments.
TEST(Agreement, AMagnitudeAloneMayDifferInItsLastBits) {
  const auto nudge = [](CaseResult& r) {
    ASSERT_TRUE(r.events[0].magnitude.has_value());
    r.events[0].magnitude = std::nextafter(*r.events[0].magnitude, 9);
  };
  const Agreement same = after(nudge);
  EXPECT_EQ(same.verdict, Verdict::last_bits);
  ASSERT_TRUE(same.first.has_value());
  EXPECT_EQ(same.first->place, "slip event 1");
  EXPECT_EQ(same.first->quantity, "magnitude_mw");
  EXPECT_EQ(same.max_ulps, 1u);
  EXPECT_EQ(after(nudge, false).verdict, Verdict::within_tier);
  const auto other_formula = [](CaseResult& r) { r.whole.event_magnitude = 4.5; };
  EXPECT_EQ(after(other_formula, false).verdict, Verdict::beyond_tier);
}

TEST(Agreement, QuantitiesAreTheKeysOfAResult) {
  const auto names = quantities();
  EXPECT_THAT(names,
              ::testing::IsSupersetOf({"moment_nm", "chi_bar", "pressure_margin_pa", "shear_max_pa",
                                       "stress_drop_pa", "n_slip", "change_minus_pa",
                                       "error_of_slip", "field_coverage", "field_assumed"}));
  EXPECT_THAT(names, ::testing::Not(::testing::Contains("wall_s")));
}

TEST(ChangedOrder, OnlyWhatIsClearCounts) {
  const std::vector<CaseResult> before = {
      testing::made_up_result(0.9), testing::made_up_result(0.8), testing::made_up_result(0.3)};
  EXPECT_THAT(changed_order(before, before, kTolerances), ::testing::Each(std::nullopt));
  auto now = before;
  now[1].whole.activated_area = now[0].whole.activated_area * (1 + 1e-9);
  EXPECT_THAT(changed_order(before, now, kTolerances), ::testing::Each(std::nullopt));
  now[1].whole.activated_area = now[0].whole.activated_area * 1.1;
  const auto changed = changed_order(before, now, kTolerances);
  EXPECT_EQ(changed[0], 1u);
  EXPECT_EQ(changed[1], 0u);
  EXPECT_EQ(changed[2], std::nullopt);
  now = before;
  now[0].outcome = Outcome::unstable;  // listed behind all complete histories
  EXPECT_EQ(changed_order(before, now, kTolerances)[2], 0u);
}

}  // namespace
}  // namespace faultsweep
