#include "campaign/reports/status_report.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"
#include "campaign/reports/case_report.h"
#include "campaign/store/clock.h"

namespace faultsweep {

StatusReport make_status(const Store& store, const std::string& campaign) {
  constexpr int kEvents = 10;
  StatusReport status;
  // Cases are counted once, by family: with 10^5 of them each pass takes some 50 ms.
  status.campaign = store.campaign(campaign, false);
  status.families = store.family_progress(status.campaign.id);
  for (const auto& family : status.families) status.campaign += family;
  if (auto owner = store.owner()) {
    if (!owner->alive) {
      status.manager_died = true;
    } else if (owner->campaign == status.campaign.id) {
      status.manager = std::move(owner);
    }
  }
  const CaseCounts& counts = status.campaign;
  if (counts.n_failed > 0 || counts.n_fields_failed > 0 || counts.n_done > counts.n_complete()) {
    status.failures = store.failure_counts(status.campaign.id);
  }
  status.rounds = store.rounds(status.campaign.id);
  status.events = store.events(status.campaign.id, kEvents);
  for (const CampaignInfo& other : store.campaigns()) {
    if (other.id != status.campaign.id) status.others.push_back(other.name);
  }
  return status;
}

namespace {

/// What its manager says of it; not an object where nothing runs.
json progress_of(const StatusReport& status) {
  if (!status.manager) return {};
  return json::parse(status.manager->progress, nullptr, false);
}

/// Who runs it and for how long yet; "" where nobody does.
std::string manager_sentence(const StatusReport& status) {
  if (status.manager_died) return "The last manager died; `faultsweep run` takes over.";
  if (!status.manager) return "";
  const json progress = progress_of(status);
  std::string text = concat("Running: process ", status.manager->pid, " on ", status.manager->host,
                            ", ", status.manager->n_workers, " workers");
  if (progress.is_object() && progress.contains("seconds_left")) {
    text += concat(", ", format_number(progress.value("cases_per_second", 0.0), 3), " cases/s, ",
                   format_duration(progress.value("seconds_left", 0.0)), " left");
  }
  return text + ".";
}

/// Families whose operators are not shared; "" where there are none.
std::string creep_text(const std::vector<Store::FamilyProgress>& families) {
  long n_creeping = 0;
  double memory = 0;
  for (const auto& family : families) {
    if (family.n_operators < 2) continue;
    ++n_creeping;
    memory = std::max(memory, family.memory_bytes);
  }
  if (n_creeping == 0) return "";
  constexpr double kGigabyte = 1e9;
  return concat("salt creeps in ", counted(n_creeping, "family", "families"),
                ": each worker that runs one builds its operators, at most ",
                format_number(memory / kGigabyte, 2), " GB each");
}

/// Complete histories with slip events, counted apart from converged ones.
std::string events_text(const CampaignInfo& c) {
  std::string text;
  if (c.n_event > 0) text += concat(", ", c.n_event, " with slip events");
  if (c.n_unresolved > 0) {
    text += concat(", ", c.n_unresolved, " with unresolved slip events");
  }
  return text;
}

std::string counts_sentence(const CampaignInfo& c) {
  return concat(c.name, ": ", c.n_cases, " cases, ", c.n_done, " done (", c.n_converged,
                " converged", events_text(c), "), ", c.n_failed, " failed, ", c.n_waiting,
                " waiting", c.cancelled ? "; cancelled" : "", ".");
}

std::string origin_note(const StatusReport& status) {
  const CampaignInfo& c = status.campaign;
  return concat("submitted ", format_time(c.submitted_at), " from ", c.source, ", ",
                counted(status.families.size(), "family", "families"), ", ", c.n_excluded,
                " excluded, ", c.n_merged, " merged, on failure: ", to_string(c.policy.on_failure));
}

std::string rounds_note(const StatusReport& status) {
  const std::string& conclusion = status.campaign.conclusion;
  if (status.rounds.size() < 2 && conclusion.empty()) return "";
  return concat(counted(status.rounds.size(), "round", "rounds"), "; ",
                conclusion.empty() ? status.rounds.back().reason : conclusion);
}

/// "fault fields of the three cases ranked first are kept; 2 cases have them, of 1 they ...".
std::string shown_fields_note(const CampaignInfo& c) {
  std::string text = kept_fields_text(c.keep_fields);
  if (c.n_waiting > 0) return text + " once all are decided";
  text += concat("; ", counted(c.n_fields_kept, "case has", "cases have"), " them");
  if (c.n_fields_waiting > 0) text += concat(", ", c.n_fields_waiting, " still to be written");
  if (c.n_fields_failed == 0) return text;
  return concat(text, ", ", c.n_fields_failed, " could not be written: `faultsweep retry ", c.name,
                "` tries again");
}

std::string fields_note(const CampaignInfo& c) {
  if (c.keep_fields == KeepFields::none) return "";
  if (c.keep_fields == KeepFields::shown) return shown_fields_note(c);
  const std::string kept = concat("fault fields: ", to_string(c.keep_fields));
  const long n_lacking = c.n_fields_waiting + c.n_fields_failed;
  if (n_lacking == 0) return kept;
  return concat(kept, "; ", n_lacking, " cases have a result and lack them (", c.n_fields_failed,
                " failed)");
}

std::string others_note(const std::vector<std::string>& others) {
  return others.empty() ? "" : "other campaigns: " + joined(others, ", ");
}

AnswerTable workers_table(const StatusReport& status) {
  AnswerTable table{"workers",
                    "",
                    {{"rank", "rank", {}, 4, Need::always},
                     {"host", "host", {}, 4, Need::wanted},
                     {"state", "state", {}, 4, Need::always},
                     {"cases_at_hand", "cases at hand", {}, 4, Need::always},
                     {"family", "family", {}, 4, Need::wanted}}};
  const json progress = progress_of(status);
  if (!progress.is_object()) return table;
  constexpr std::size_t kShort = 8;
  for (const json& worker : progress.value("workers", json::array())) {
    const json& family = worker.at("family");
    table.rows.push_back(
        {worker.at("rank").get<long>(), worker.at("host").get<std::string>(),
         worker.at("state").get<std::string>(), worker.at("cases_at_hand").get<long>(),
         family.is_string() ? AnswerCell(family.get<std::string>().substr(0, kShort))
                            : AnswerCell()});
  }
  return table;
}

AnswerTable failures_table(const StatusReport& status) {
  const std::vector<FailureCount>& failures = status.failures;
  AnswerTable table{"failures",
                    failures.empty()                       ? ""
                    : status.campaign.n_fields_failed == 0 ? "without a full result:"
                                                           : "without a full result or its fields:",
                    {{"cases", "cases", {}, 4, Need::always},
                     {"status", "ended", {}, 4, Need::always},
                     {"reason", "why", {}, 4, Need::always}}};
  for (const FailureCount& failure : failures)
    table.rows.push_back({failure.count, failure.status, failure.reason});
  return table;
}

AnswerTable families_table(const std::vector<Store::FamilyProgress>& families) {
  constexpr std::size_t kMostOnScreen = 12;
  AnswerTable table{"families",
                    families.empty() ? "" : "families:",
                    {{"family", "family", {}, 4, Need::data},
                     {"cases", "cases", {}, 4, Need::always},
                     {"done", "done", {}, 4, Need::always},
                     {"failed", "failed", {}, 4, Need::always},
                     {"operator", "operator", {}, 4, Need::wanted},
                     {"build_s", "built in", seconds(), 3, Need::wanted},
                     {"predicted_memory_bytes", "memory", gigabytes(), 2, Need::wanted},
                     {"creeps", "creeps", {}, 4, Need::extra},
                     {"n_operators", "operators", {}, 4, Need::extra}}};
  table.most_on_screen = kMostOnScreen;
  for (const Store::FamilyProgress& family : families) {
    table.rows.push_back({family.fingerprint, family.n_cases, family.n_done, family.n_failed,
                          family.operator_fingerprint, family.build_seconds, family.memory_bytes,
                          family.n_operators > 1, family.n_operators});
  }
  return table;
}

AnswerTable rounds_table(const std::vector<RoundRecord>& rounds) {
  const Need need = rounds.size() > 1 ? Need::always : Need::data;  // the first is the campaign
  AnswerTable table{"rounds",
                    rounds.size() > 1 ? "rounds:" : "",
                    {{"first_case", "from case", {}, 4, need},
                     {"cases", "cases", {}, 4, need},
                     {"reason", "why", {}, 4, need}}};
  for (const RoundRecord& round : rounds)
    table.rows.push_back({round.first_position, round.n_cases, round.reason});
  return table;
}

AnswerTable events_table(const std::vector<EventRecord>& events) {
  AnswerTable table{"events",
                    events.empty() ? "" : "last events:",
                    {{"at", "s since 1970", seconds(), 4, Need::data},
                     {"when", "when", {}, 4, Need::always},
                     {"kind", "what", {}, 4, Need::always},
                     {"text", "", {}, 4, Need::always}}};
  for (const EventRecord& event : events)
    table.rows.push_back({event.at, format_time(event.at), event.kind, event.text});
  return table;
}

ordered_json manager_json(const StatusReport& status) {
  if (!status.manager) return nullptr;
  return {{"host", status.manager->host},
          {"pid", status.manager->pid},
          {"workers", status.manager->n_workers},
          {"heartbeat_at", status.manager->heartbeat_at},
          {"progress", progress_of(status)}};
}

ordered_json facts_of(const StatusReport& status) {
  const CampaignInfo& c = status.campaign;
  return {{"campaign", c.name},
          {"submitted_at", c.submitted_at},
          {"source", c.source},
          {"cancelled", c.cancelled},
          {"cases", c.n_cases},
          {"done", c.n_done},
          {"converged", c.n_converged},
          {"event", c.n_event},
          {"unresolved_event", c.n_unresolved},
          {"failed", c.n_failed},
          {"waiting", c.n_waiting},
          {"keep_fields", to_string(c.keep_fields)},
          {"waiting_for_fields_only", c.n_fields_waiting},
          {"failed_fields", c.n_fields_failed},
          {"excluded", c.n_excluded},
          {"merged", c.n_merged},
          {"manager", manager_json(status)},
          {"manager_died", status.manager_died},
          {"conclusion", c.conclusion},
          {"other_campaigns", status.others}};
}

}  // namespace

Answer to_answer(const StatusReport& status) {
  Answer answer{{counts_sentence(status.campaign)}};
  const std::string manager = manager_sentence(status);
  if (!manager.empty()) answer.headline.push_back(manager);
  answer.facts = facts_of(status);
  answer.note(origin_note(status));
  for (const std::string& note : {rounds_note(status), creep_text(status.families),
                                  fields_note(status.campaign), others_note(status.others)})
    answer.note_if(note);
  for (AnswerTable table :
       {workers_table(status), failures_table(status), families_table(status.families),
        rounds_table(status.rounds), events_table(status.events)})
    answer.add(std::move(table));
  return answer;
}

Answer campaigns_answer(const Store& store) {
  AnswerTable table{"campaigns",
                    "",
                    {{"campaign", "campaign", {}, 4, Need::always},
                     {"state", "state", {}, 4, Need::always},
                     {"cases", "cases", {}, 4, Need::always},
                     {"done", "done", {}, 4, Need::always},
                     {"failed", "failed", {}, 4, Need::always},
                     {"waiting", "waiting", {}, 4, Need::always},
                     {"submitted_at", "s since 1970", seconds(), 4, Need::data},
                     {"submitted", "submitted", {}, 4, Need::wanted}}};
  const auto owner = store.owner();
  std::vector<CampaignInfo> campaigns = store.campaigns();
  std::ranges::reverse(campaigns);
  for (const CampaignInfo& one : campaigns) {
    const CampaignInfo c = store.campaign(one.name);
    const bool runs = owner && owner->alive && owner->campaign == c.id;
    const char* state = runs              ? "running"
                        : c.cancelled     ? "cancelled"
                        : c.n_waiting > 0 ? "waiting"
                                          : "ended";
    table.rows.push_back({c.name, state, c.n_cases, c.n_done, c.n_failed, c.n_waiting,
                          c.submitted_at, format_time(c.submitted_at)});
  }
  Answer answer{{campaigns.empty()
                     ? std::string("The store has no campaign yet.")
                     : concat("The store has ", counted(campaigns.size(), "campaign", "campaigns"),
                              ", the newest first.")}};
  answer.add(std::move(table));
  return answer;
}

}  // namespace faultsweep
