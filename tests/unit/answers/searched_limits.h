#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "campaign/expansion/submission.h"
#include "campaign/rounds/next_round.h"
#include "campaign/store/store.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep::testing {

/// Whether a case slides, by its offset, m, and its pressure change in the second region, Pa.
using SlidesAt = std::function<bool(double offset, double change)>;

/// Submits the campaign "storage" and runs it until nothing is left to search.
inline void search_limits(Store& store, const std::string& spec_text, const SlidesAt& slides) {
  const CampaignSpec spec = parse_campaign(spec_text, FAULTSIM_SOURCE_DIR "/test.json");
  const std::int64_t id = store.submit(make_submission(expand(spec))).campaign;
  do {
    for (const WaitingFamily& family : store.waiting_families(id)) {
      for (const std::int64_t one : family.cases) {
        const CaseParameters values = store.stored_case(id, std::to_string(one)).parameters;
        const double change = values[1].si.value();
        RunRecord run;
        run.case_id = one;
        run.status = RunStatus::completed;
        run.result = made_up_result(slides(values[0].si.value(), change) ? 0.9 : 0.2);
        run.result->steps[9].pressure_change[1] = change;
        store.record_runs(id, {run});
      }
    }
  } while (add_next_round(store, "storage"));
}

}  // namespace faultsweep::testing
