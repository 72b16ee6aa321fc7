#include "campaign/reports/case_report.h"

#include <nlohmann/json.hpp>

#include "campaign/common/names.h"
#include "campaign/store/clock.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

namespace {

/// Why the last run for the fields only failed.
std::string last_fields_failure(const StoredCase& one) {
  std::string reason;
  for (const StoredRun& run : one.runs) {
    if (run.fields_only && run.status != "completed") reason = run.status + ", " + run.reason;
  }
  return reason;
}

/// Whether an open campaign computes the case, and why: "will run..." or "will not run...".
std::string verdict_if_open(const CampaignInfo& campaign, const StoredCase& one) {
  const StoredRun* last = one.runs.empty() ? nullptr : &one.runs.back();
  if (one.state == "done" && one.fields == FieldsState::wanted) {
    return concat("will run, for its fault fields only: it has a result (",
                  to_string(one.result.outcome), "), which the run must repeat bit for bit");
  }
  if (one.state == "done" && one.fields == FieldsState::failed) {
    return concat("will not run: it has a result, but its fault fields could not be added: ",
                  last_fields_failure(one), "; `faultsweep retry ", campaign.name, " --case ",
                  one.position, "` tries again");
  }
  if (one.state == "done" && one.fields == FieldsState::kept &&
      !fields_are_there(one.fields_folder)) {
    return concat("will run, for its fault fields only",
                  campaign.keep_fields == KeepFields::shown ? ", if it is still ranked first" : "",
                  ": their files are gone");
  }
  if (one.state == "done") {
    return concat("will not run: it has a result (", to_string(one.result.outcome), ") from ",
                  format_time(last->ended_at), "; the same scene gives the same numbers");
  }
  if (one.state == "failed") {
    return concat("will not run: attempt ", last->attempt, " ", last->status, ": ", last->reason,
                  "; `faultsweep retry ", campaign.name, " --case ", one.position,
                  "` runs it again");
  }
  if (last == nullptr) {
    return "will run: no scene with this identity has been run in this store";
  }
  return concat("will run: it waits for another attempt after attempt ", last->attempt, " ",
                last->status, last->reason.empty() ? "" : ": " + last->reason, "");
}

std::string verdict_of(const CampaignInfo& campaign, const StoredCase& one) {
  const std::string verdict = verdict_if_open(campaign, one);
  if (!campaign.cancelled || !verdict.starts_with("will run")) return verdict;
  return concat("will not run: the campaign is cancelled; `faultsweep submit ", campaign.source,
                "` reopens it");
}

}  // namespace

Answer explanation(const Store& store, const CampaignInfo& campaign, const StoredCase& one) {
  const std::string verdict = verdict_of(campaign, one);
  const std::size_t colon = verdict.find(": ");
  const std::vector<std::string> campaigns = store.campaigns_with(one.id);
  Answer answer{{concat("Case ", one.position, " of ", campaign.name, " ", verdict, ".")}};
  answer.facts = {{"campaign", campaign.name},
                  {"case", one.position},
                  {"identity", one.identity},
                  {"numerics_version", faultsim::kNumericsVersion},
                  {"will_run", verdict.starts_with("will run")},
                  {"why", colon == std::string::npos ? verdict : verdict.substr(colon + 2)},
                  {"family", nullptr},
                  {"campaigns", campaigns}};
  answer.note(concat("identity ", one.identity, ", numerics version ", faultsim::kNumericsVersion));
  for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
    if (family.fingerprint != one.family) continue;
    answer.facts["family"] = {{"fingerprint", family.fingerprint},
                              {"cases", family.n_cases},
                              {"done", family.n_done},
                              {"operator", family.operator_fingerprint}};
    answer.note(concat(
        "its family has ", family.n_cases, " cases in this campaign, ", family.n_done,
        " done; the operator is ",
        family.operator_fingerprint.empty() ? "not known yet" : family.operator_fingerprint));
  }
  std::string names = joined(campaigns, ", ");
  answer.note("campaigns with this case: " + names);
  return answer;
}

}  // namespace faultsweep
