#include "campaign/store/same_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::CaseResult;

/// A result that went through the store.
CaseResult stored(const CaseResult& result) {
  std::string name = ::testing::TempDir() + "numbers_XXXXXX";
  const std::filesystem::path folder = mkdtemp(name.data());
  std::optional<CaseResult> back;
  {
    Store store = Store::open_owner(folder);
    Submission s;
    s.name = "sweep";
    s.parameters = {};
    s.scenes = {{"scene.json", "{}"}};
    s.families = {{"family", 1, 1, 1, 1}};
    s.cases = {{"identity", 0, 0, "{}", {}}};
    const std::int64_t campaign = store.submit(s).campaign;
    RunRecord run;
    run.case_id = store.waiting_families(campaign)[0].cases[0];
    run.status = RunStatus::completed;
    run.result = result;
    store.record_runs(campaign, {run});
    back = store.stored_result(run.case_id);
  }
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(back.has_value());
  return *back;
}

/// Thirds and tenths in every place, so that a lost bit shows.
CaseResult example(double strength) {
  CaseResult result = testing::made_up_result(strength);
  for (faultsim::StepResult& step : result.steps) {
    step.time /= 3;
    for (double& change : step.pressure_change) change /= 3;
    for (faultsim::FaultMetrics& m : step.faults) {
      m.mean_slip = m.chi_bar / 7;
      m.potency = -0.0;
    }
  }
  return result;
}

TEST(SameNumbers, AResultIsTheSameAfterItsWayThroughTheStore) {
  for (const double strength : {0.3, 0.8}) {  // with and without a pressure margin
    const CaseResult result = example(strength);
    EXPECT_EQ(first_difference(stored(result), result), "");
  }
  const CaseResult with_events = testing::made_up_result_with_events(0.8);
  EXPECT_EQ(first_difference(stored(with_events), with_events), "");
  CaseResult failed = example(0.8);
  failed.outcome = faultsim::Outcome::unconverged;
  failed.reason = "load step 12: it cycles";
  failed.failed_step = 12;
  failed.steps.back().outcome = faultsim::Outcome::unconverged;
  failed.steps.back().faults.clear();
  EXPECT_EQ(first_difference(stored(failed), failed), "");
}

TEST(SameNumbers, EventsAndEpisodesCount) {
  const CaseResult result = testing::made_up_result_with_events(0.8);
  const CaseResult before = stored(result);
  const auto changed = [&](const auto& change) {
    CaseResult again = result;
    change(again);
    return first_difference(before, again);
  };
  EXPECT_EQ(changed([](CaseResult& r) { r.events[1].duration *= 1 + 1e-15; }), "the slip events");
  EXPECT_EQ(changed([](CaseResult& r) { r.episodes[0].moment *= 1 + 1e-15; }), "the episodes");
  EXPECT_EQ(changed([](CaseResult& r) { r.unexpected.reset(); }), "the episodes");
  EXPECT_EQ(changed([](CaseResult& r) { r.max_penetration = 0; }), "the metrics of the case");
  EXPECT_EQ(changed([](CaseResult& r) { r.steps[3].faults[1].activated_at_edge = false; }),
            "load step 3 (primary_production)");
  EXPECT_EQ(changed([](CaseResult& r) { r.steps[7].creep->time_error *= 1 + 1e-15; }),
            "load step 7 (cushion_gas_injection)");
  EXPECT_EQ(changed([](CaseResult& r) { r.steps[9].creep->faults[1].shear_max *= 1 + 1e-15; }),
            "load step 9 (gas_storage)");
  EXPECT_EQ(changed([](CaseResult& r) { r.steps[0].creep.reset(); }), "load step 0 (initial)");
  EXPECT_EQ(changed([](CaseResult& r) { r.stages[0].n_events = 2; }), "the metrics of the stages");
}

TEST(SameNumbers, TheLastBitOfAnythingIsADifference) {
  const CaseResult result = example(0.8);
  const CaseResult before = stored(result);
  const auto nudge = [](double& value) { value = std::nextafter(value, 1e300); };
  const struct {
    const char* where;
    std::function<void(CaseResult&)> change;
  } changes[] = {
      {"the outcome", [](CaseResult& r) { r.outcome = faultsim::Outcome::unstable; }},
      {"the outcome", [](CaseResult& r) { r.reason = "other"; }},
      {"the number of load steps", [](CaseResult& r) { r.steps.pop_back(); }},
      {"load step 7 (cushion_gas_injection)",
       [&](CaseResult& r) { nudge(r.steps[7].faults[1].mean_slip); }},
      {"load step 3 (primary_production)",
       [&](CaseResult& r) { nudge(r.steps[3].pressure_change[1]); }},
      {"load step 12 (gas_storage)", [](CaseResult& r) { ++r.steps[12].n_slip; }},
      {"the metrics of the stages", [&](CaseResult& r) { nudge(r.stages[1].moment); }},
      {"the metrics of the stages", [&](CaseResult& r) { nudge(r.whole.max_slip); }},
      {"the metrics of the stages", [&](CaseResult& r) { nudge(r.stages[2].faults[1].moment); }},
      {"the metrics of the stages",
       [&](CaseResult& r) { nudge(*r.whole.faults[0].activation->pressures.absolute_minus); }},
      {"the metrics of the case", [](CaseResult& r) { r.pressure_margin = 1; }},
      {"the metrics of the case", [&](CaseResult& r) { nudge(r.max_nucleation_ratio); }},
  };
  for (const auto& change : changes) {
    CaseResult again = result;
    change.change(again);
    EXPECT_EQ(first_difference(before, again), change.where);
  }
}

}  // namespace
}  // namespace faultsweep
