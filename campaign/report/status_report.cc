#include "campaign/report/status_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/report/text_table.h"
#include "campaign/store/clock.h"
#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::counted;
using nlohmann::json;

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
  if (counts.n_failed > 0 || counts.n_done > counts.n_complete()) {
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

std::string manager_text(const StatusReport& status) {
  if (status.manager_died) return "the last manager died; `faultsweep run` takes over\n";
  if (!status.manager) return "";
  const json progress = json::parse(status.manager->progress, nullptr, false);
  std::string text = concat("running: process ", status.manager->pid, " on ", status.manager->host,
                            ", ", status.manager->n_workers, " workers");
  if (progress.is_object() && progress.contains("seconds_left")) {
    text += concat(", ", format_number(progress.value("cases_per_second", 0.0), 3), " cases/s, ",
                   format_duration(progress.value("seconds_left", 0.0)), " left\n");
    TextTable table({"rank", "host", "state", "cases at hand", "family"});
    for (const json& worker : progress.value("workers", json::array())) {
      const json& family = worker.at("family");
      table.add_row({std::to_string(worker.at("rank").get<int>()), worker.at("host"),
                     worker.at("state"), std::to_string(worker.at("cases_at_hand").get<long>()),
                     family.is_string() ? family.get<std::string>().substr(0, 8) : ""});
    }
    return text + table.text();
  }
  return text + "\n";
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
                ": operators are built by each worker that runs it, at most ",
                format_number(memory / kGigabyte, 2), " GB each\n");
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

}  // namespace

std::string status_to_text(const StatusReport& status) {
  const CampaignInfo& c = status.campaign;
  std::string text = concat(c.name, ": ", c.n_cases, " cases, ", c.n_done, " done (", c.n_converged,
                            " converged", events_text(c), "), ", c.n_failed, " failed, ",
                            c.n_waiting, " waiting", c.cancelled ? "; cancelled" : "", "\n");
  text += concat("submitted ", format_time(c.submitted_at), " from ", c.source, ", ",
                 counted(status.families.size(), "family", "families"), ", ", c.n_excluded,
                 " excluded, ", c.n_merged, " merged, on failure: ", to_string(c.policy.on_failure),
                 "\n");
  if (status.rounds.size() > 1 || !c.conclusion.empty()) {
    text += concat(counted(status.rounds.size(), "round", "rounds"), "; ",
                   c.conclusion.empty() ? status.rounds.back().reason : c.conclusion, "\n");
  }
  text += creep_text(status.families);
  if (c.keep_fields != KeepFields::none) {
    const long n_lacking = c.n_fields_waiting + c.n_fields_failed;
    text += concat("fault fields: ", to_string(c.keep_fields));
    if (n_lacking > 0) {
      text += concat("; ", n_lacking, " cases have a result and lack them (", c.n_fields_failed,
                     " failed)");
    }
    text += "\n";
  }
  text += manager_text(status);
  if (!status.failures.empty()) {
    TextTable table({"cases", "ended", "why"});
    for (const FailureCount& failure : status.failures) {
      table.add_row({std::to_string(failure.count), failure.status, failure.reason});
    }
    text += "\nwithout a full result:\n" + table.text();
  }
  if (!status.events.empty()) {
    text += "\nlast events:\n";
    for (const EventRecord& event : status.events) {
      text += concat("  ", format_time(event.at), "  ", event.kind, ": ", event.text, "\n");
    }
  }
  if (!status.others.empty()) {
    text += "\nother campaigns:";
    for (const std::string& name : status.others) text += " " + name;
    text += "\n";
  }
  return text;
}

json status_to_json(const StatusReport& status) {
  const CampaignInfo& c = status.campaign;
  json failures = json::array();
  for (const FailureCount& failure : status.failures) {
    failures.push_back(
        {{"status", failure.status}, {"reason", failure.reason}, {"cases", failure.count}});
  }
  json families = json::array();
  for (const auto& family : status.families) {
    families.push_back({{"family", family.fingerprint},
                        {"operator", family.operator_fingerprint},
                        {"creeps", family.n_operators > 1},
                        {"n_operators", family.n_operators},
                        {"predicted_memory_bytes", family.memory_bytes},
                        {"cases", family.n_cases},
                        {"done", family.n_done},
                        {"failed", family.n_failed},
                        {"build_s", family.build_seconds ? json(*family.build_seconds) : json()}});
  }
  json rounds = json::array();
  for (const RoundRecord& round : status.rounds) {
    rounds.push_back(
        {{"first_case", round.first_position}, {"cases", round.n_cases}, {"reason", round.reason}});
  }
  json events = json::array();
  for (const EventRecord& event : status.events) {
    events.push_back({{"at", event.at}, {"kind", event.kind}, {"text", event.text}});
  }
  json manager;
  if (status.manager) {
    manager = {{"host", status.manager->host},
               {"pid", status.manager->pid},
               {"workers", status.manager->n_workers},
               {"heartbeat_at", status.manager->heartbeat_at},
               {"progress", json::parse(status.manager->progress, nullptr, false)}};
  }
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
          {"manager", manager},
          {"manager_died", status.manager_died},
          {"failures", failures},
          {"families", families},
          {"rounds", rounds},
          {"conclusion", c.conclusion},
          {"events", events},
          {"other_campaigns", status.others}};
}

}  // namespace faultsweep
