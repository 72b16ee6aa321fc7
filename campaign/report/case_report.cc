#include "campaign/report/case_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "campaign/report/parameters.h"
#include "campaign/report/text_table.h"
#include "campaign/store/clock.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/output/write_result.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;
using faultsim::StageMetrics;
using nlohmann::json;

namespace {

constexpr double kBar = 1e5;        // Pa
constexpr double kYear = 31557600;  // s, 365.25 d

std::string parameters_text(const CampaignInfo& campaign, const StoredCase& one) {
  const auto parameters = parameters_from_json(campaign.parameters);
  const auto labels = labels_from_json(one.parameter_labels);
  std::string text;
  for (std::size_t k = 0; k < parameters.size() && k < labels.size(); ++k) {
    if (!labels[k].empty()) text += concat("  ", parameters[k].name, " = ", labels[k], "\n");
  }
  return text;
}

void add_stage(TextTable& table, const std::string& name, const StageMetrics& m) {
  table.add_row({name, concat(m.first_step, "-", m.last_step),
                 m.activated ? (m.activated_fault.empty() ? "yes" : m.activated_fault) : "no",
                 m.activation_step ? std::to_string(*m.activation_step) : "",
                 m.activation_pressure ? format_number(*m.activation_pressure / kBar) : "",
                 format_number(m.chi_bar, 3), format_number(m.chi_max, 3),
                 format_number(m.area_chi_080), format_number(m.activated_area),
                 format_number(m.max_slip, 3), format_number(m.moment, 3),
                 m.magnitude ? format_number(*m.magnitude, 2) : ""});
}

std::string stages_text(const CaseResult& result) {
  TextTable table({"stage", "steps", "activated", "at step", "Δp/bar", "χ̄", "χ max",
                   "area χ>0.8/m2", "activated/m2", "slip/m", "M0/Nm", "Mw"});
  for (const StageMetrics& stage : result.stages) add_stage(table, stage.stage, stage);
  add_stage(table, "whole history", result.whole);
  return table.text();
}

/// What the salt did to one fault up to a load step; empty where nothing creeps.
struct CreepCells {
  std::string normal, shear, time_steps;
};

CreepCells creep_cells(const faultsim::StepResult& step, std::size_t fault) {
  if (!step.creep) return {};
  CreepCells cells;
  cells.time_steps = concat(step.creep->time_steps, step.creep->time_resolved ? "" : "!");
  if (fault >= step.creep->faults.size()) return cells;
  const faultsim::FaultCreep& c = step.creep->faults[fault];
  cells.normal =
      concat(format_number(c.normal_min / kBar, 3), " to ", format_number(c.normal_max / kBar, 3));
  cells.shear = format_number(c.shear_max / kBar, 3);
  return cells;
}

/// The most that creep did to any fault, in one line; "" where nothing creeps.
std::string creep_text(const CaseResult& result) {
  faultsim::FaultCreep most;
  int n_time_steps = 0, n_unresolved = 0;
  double time_error = 0;
  bool creeps = false;
  for (const faultsim::StepResult& step : result.steps) {
    if (!step.creep) continue;
    creeps = true;
    n_time_steps += step.creep->time_steps;
    n_unresolved += step.creep->time_resolved ? 0 : 1;
    time_error = std::max(time_error, step.creep->time_error);
    for (const faultsim::FaultCreep& c : step.creep->faults) {
      most.normal_min = std::min(most.normal_min, c.normal_min);
      most.normal_max = std::max(most.normal_max, c.normal_max);
      most.shear_max = std::max(most.shear_max, c.shear_max);
    }
  }
  if (!creeps) return "";
  std::string text = concat(
      "salt creeps: it changed fault tractions by ", format_number(most.normal_min / kBar, 3),
      " bar (compression) to ", format_number(most.normal_max / kBar, 3),
      " bar (tension) normal and at most ", format_number(most.shear_max / kBar, 3),
      " bar in shear; ", n_time_steps, " time steps, halving them changes at most ",
      format_number(time_error / kBar, 2), " bar\n");
  if (n_unresolved > 0) {
    text += concat("time steps of ", n_unresolved,
                   " load steps (marked !) are coarser than creep_tolerance asks\n");
  }
  return text;
}

std::string history_text(const CaseResult& result, std::size_t fault) {
  TextTable table({"step", "stage", "year", "Δp/bar", "χ̄", "χ max", "area χ>0.8/m2", "slipping/m2",
                   "activated/m2", "slip/m", "M0/Nm", "creep ΔtN/bar", "creep |ΔtT|/bar",
                   "time steps"});
  for (const faultsim::StepResult& step : result.steps) {
    std::string pressure;
    for (const double change : step.pressure_change) {
      pressure += (pressure.empty() ? "" : " ") + format_number(change / kBar);
    }
    if (fault >= step.faults.size()) {
      table.add_row({std::to_string(step.step), step.stage, format_number(step.time / kYear),
                     pressure, faultsim::to_string(step.outcome), "", "", "", "", "", "", "", "",
                     ""});
      continue;
    }
    const faultsim::FaultMetrics& m = step.faults[fault];
    const CreepCells creep = creep_cells(step, fault);
    table.add_row({std::to_string(step.step), step.stage, format_number(step.time / kYear),
                   pressure, format_number(m.chi_bar, 3), format_number(m.chi_max, 3),
                   format_number(m.area_chi_080), format_number(m.slipping_area),
                   format_number(m.activated_area), format_number(m.max_slip, 3),
                   format_number(m.moment, 3), creep.normal, creep.shear, creep.time_steps});
  }
  return table.text();
}

/// M0 with its Mw, which plane strain has none of.
std::string size_text(double moment, const std::optional<double>& magnitude) {
  const std::string m0 = concat("M0 ", format_number(moment, 3));
  return magnitude ? concat("Mw ", format_number(*magnitude, 2), " (", m0, ")") : m0;
}

std::string events_text(const CaseResult& result) {
  if (result.events.empty()) return "";
  TextTable table({"event", "step", "stage", "Δp/bar", "fault", "depth/m", "nucleus/m", "area/m2",
                   "slip/m", "drop/bar", "size/Nm", "resolved", "evidence"});
  int number = 0;
  for (const faultsim::SlipEvent& e : result.events) {
    table.add_row({std::to_string(++number), std::to_string(e.step), e.stage,
                   format_number(e.pressure_change / kBar), e.fault, format_number(e.depth),
                   format_number(e.nucleation_length, 3), format_number(e.slipped_area),
                   format_number(e.max_slip, 3), format_number(e.stress_drop / kBar, 3),
                   size_text(e.moment, e.magnitude), e.resolved ? "yes" : "NO, mesh too coarse",
                   e.evidence_holds ? "holds" : "DOES NOT HOLD"});
  }
  return "\nslip events:\n" + table.text();
}

std::string episodes_text(const CaseResult& result) {
  if (result.episodes.empty()) return "";
  TextTable table({"episode", "stage", "steps", "fault", "from Δp/bar", "pressure", "activated/m2",
                   "slip/m", "size/Nm"});
  int number = 0;
  for (const faultsim::Episode& e : result.episodes) {
    table.add_row({std::to_string(++number), e.stage, concat(e.first_step, "-", e.last_step),
                   e.fault, format_number(e.pressure_change / kBar),
                   e.after_recovery ? "had been lower" : "the lowest so far",
                   format_number(e.activated_area), format_number(e.max_slip, 3),
                   size_text(e.moment, e.magnitude)});
  }
  return "\nactivation episodes:\n" + table.text();
}

std::string runs_text(const StoredCase& one) {
  std::string text;
  for (const StoredRun& run : one.runs) {
    text += concat("  attempt ", run.attempt, " (", format_time(run.ended_at), ", ",
                   format_number(run.wall_seconds, 3), " s, rank ", run.rank,
                   run.fields_only ? ", for the fields only): " : "): ", run.status,
                   run.outcome.empty() ? "" : ", " + run.outcome,
                   run.reason.empty() ? "" : ": " + run.reason, "\n");
    if (!run.log_tail.empty()) {
      text += "    last words of the simulator:\n";
      for (std::size_t at = 0; at < run.log_tail.size();) {
        const std::size_t end = std::min(run.log_tail.find('\n', at), run.log_tail.size());
        text += "    | " + run.log_tail.substr(at, end - at) + "\n";
        at = end + 1;
      }
    }
  }
  return text;
}

bool fields_are_there(const StoredCase& one) {
  std::error_code error;  // what cannot be looked at is not there
  return std::filesystem::exists(one.fields_folder / "faults.h5", error) &&
         std::filesystem::exists(one.fields_folder / "faults.xmf", error);
}

std::string fields_text(const CampaignInfo& campaign, const StoredCase& one) {
  switch (one.fields) {
    case FieldsState::none:
      return "";
    case FieldsState::wanted:
      return concat("fault fields: not yet; `faultsweep run ", campaign.name, "` writes them\n");
    case FieldsState::failed:
      return concat("fault fields: not written, see the last attempt; `faultsweep retry ",
                    campaign.name, " --case ", one.position, "` lets them be tried again\n");
    case FieldsState::kept:
      break;
  }
  if (!fields_are_there(one)) {
    return concat("fault fields: gone from ", one.fields_folder.string(), "; `faultsweep run ",
                  campaign.name, "` writes them again\n");
  }
  return concat("fault fields (",
                campaign.keep_fields == KeepFields::all ? "all load steps"
                                                        : "initial state and ends of stages",
                "): ", (one.fields_folder / "faults.xmf").string(), " for ParaView, faults.h5\n");
}

/// Why the last run for the fields only failed.
std::string last_fields_failure(const StoredCase& one) {
  std::string reason;
  for (const StoredRun& run : one.runs) {
    if (run.fields_only && run.status != "completed") reason = run.status + ", " + run.reason;
  }
  return reason;
}

json fields_to_json(const CampaignInfo& campaign, const StoredCase& one) {
  if (one.fields == FieldsState::none) return {};
  const bool gone = one.fields == FieldsState::kept && !fields_are_there(one);
  return {{"steps", to_string(campaign.keep_fields)},
          {"state", gone ? "gone" : to_string(one.fields)},
          {"folder", one.fields_folder.string()}};
}

}  // namespace

std::string case_to_text(const CampaignInfo& campaign, const StoredCase& one) {
  std::string text = concat("case ", one.position, " of ", campaign.name, ", ", one.state, "\n");
  text += concat("identity ", one.identity, ", family ", one.family, "\n");
  text += parameters_text(campaign, one);
  text += fields_text(campaign, one);
  if (!one.runs.empty()) text += "\nruns:\n" + runs_text(one);
  if (!one.has_result) return text;
  const CaseResult& result = one.result;
  text += concat("\n", faultsim::to_string(result.outcome),
                 result.reason.empty() ? "" : ": " + result.reason, "; ", result.steps.size(),
                 " load steps, ", result.counts.newton_iterations, " Newton iterations\n");
  if (result.unexpected) text += "UNEXPECTED REACTIVATION: activated again as pressure recovers\n";
  if (result.outcome == faultsim::Outcome::unresolved_event) {
    text += result.weakening_resolved
                ? "UNRESOLVED: the evidence of a slip event does not hold\n"
                : "UNRESOLVED: the size of its slip events depends on the mesh\n";
  }
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  if (std::isfinite(result.pressure_margin)) {
    text += concat("activates after ", format_number(result.pressure_margin / kBar),
                   " bar more depletion, extrapolated\n");
  }
  text += creep_text(result);
  text += "\n" + stages_text(result) + events_text(result) + episodes_text(result);
  for (std::size_t fault = 0; fault < result.fault_names.size(); ++fault) {
    text += concat("\nfault ", result.fault_names[fault], ":\n", history_text(result, fault));
  }
  return text;
}

json case_to_json(const CampaignInfo& campaign, const StoredCase& one) {
  const auto parameters = parameters_from_json(campaign.parameters);
  const auto labels = labels_from_json(one.parameter_labels);
  const json values = json::parse(one.parameter_values, nullptr, false);
  json named = json::object();
  for (std::size_t k = 0; k < parameters.size() && k < values.size(); ++k) {
    if (values[k].is_null()) continue;
    named[parameters[k].name] = {
        {"value", values[k]},
        {"unit", parameters[k].is_text ? "" : faultsim::si_unit(parameters[k].dimension)},
        {"text", k < labels.size() ? labels[k] : ""}};
  }
  json runs = json::array();
  for (const StoredRun& run : one.runs) {
    runs.push_back({{"attempt", run.attempt},
                    {"ended_at", run.ended_at},
                    {"wall_s", run.wall_seconds},
                    {"host", run.host},
                    {"rank", run.rank},
                    {"status", run.status},
                    {"fields_only", run.fields_only},
                    {"outcome", run.outcome.empty() ? json() : json(run.outcome)},
                    {"reason", run.reason},
                    {"signal", run.signal ? json(*run.signal) : json()},
                    {"exit_code", run.exit_code ? json(*run.exit_code) : json()},
                    {"log_tail", run.log_tail}});
  }
  return {{"campaign", campaign.name},
          {"case", one.position},
          {"identity", one.identity},
          {"family", one.family},
          {"state", one.state},
          {"parameters", named},
          {"changes", json::parse(one.changes, nullptr, false)},
          {"fields", fields_to_json(campaign, one)},
          {"runs", runs},
          {"result", one.has_result ? faultsim::result_to_json(one.result) : json()}};
}

namespace {

/// Whether an open campaign computes the case, and why: "will run..." or "will not run...".
std::string verdict_of(const CampaignInfo& campaign, const StoredCase& one) {
  const StoredRun* last = one.runs.empty() ? nullptr : &one.runs.back();
  if (one.state == "done" && one.fields == FieldsState::wanted) {
    return concat("will run, for its fault fields only: it has a result (",
                  faultsim::to_string(one.result.outcome),
                  "), which the run must repeat bit for bit\n");
  }
  if (one.state == "done" && one.fields == FieldsState::failed) {
    return concat("will not run: it has a result, but its fault fields could not be added: ",
                  last_fields_failure(one), "; `faultsweep retry ", campaign.name, " --case ",
                  one.position, "` lets them be tried again\n");
  }
  if (one.state == "done" && one.fields == FieldsState::kept && !fields_are_there(one)) {
    return "will run, for its fault fields only: their files are gone\n";
  }
  if (one.state == "done") {
    return concat("will not run: it has a result (", faultsim::to_string(one.result.outcome),
                  ") from ", format_time(last->ended_at),
                  "; the same scene gives the same numbers, so nothing would change\n");
  }
  if (one.state == "failed") {
    return concat("will not run: attempt ", last->attempt, " ", last->status, ": ", last->reason,
                  "; `faultsweep retry ", campaign.name, " --case ", one.position,
                  "` lets it run again\n");
  }
  if (last == nullptr) {
    return "will run: no scene with this identity has been run in this store\n";
  }
  return concat("will run: it waits for another attempt after attempt ", last->attempt, " ",
                last->status, last->reason.empty() ? "" : ": " + last->reason, "\n");
}

}  // namespace

std::string explain_case(const Store& store, const CampaignInfo& campaign, const StoredCase& one) {
  std::string text = concat("case ", one.position, " of ", campaign.name, " (identity ",
                            one.identity, ", numerics version ", faultsim::kNumericsVersion, ")\n");
  const std::string verdict = verdict_of(campaign, one);
  text += campaign.cancelled && verdict.starts_with("will run")
              ? concat("will not run: the campaign is cancelled; `faultsweep submit ",
                       campaign.source, "` reopens it\n")
              : verdict;
  for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
    if (family.fingerprint != one.family) continue;
    text += concat(
        "its family has ", family.n_cases, " cases in this campaign, ", family.n_done,
        " done; the operator is ",
        family.operator_fingerprint.empty() ? "not known yet" : family.operator_fingerprint, "\n");
  }
  std::string names;
  for (const std::string& name : store.campaigns_with(one.id)) names += " " + name;
  return text + "campaigns with this case:" + names + "\n";
}

}  // namespace faultsweep
