#include "campaign/report/case_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "campaign/expansion/expansion.h"
#include "campaign/report/parameters.h"
#include "campaign/report/selection.h"
#include "campaign/report/text_table.h"
#include "campaign/store/clock.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/output/write_result.h"
#include "simulator/scene/read_scene.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;
using faultsim::StageMetrics;
using nlohmann::json;

namespace {

constexpr double kYear = 31557600;  // s, 365.25 d

std::string parameters_text(const CampaignInfo& campaign, const StoredCase& one) {
  const auto parameters = parameters_from_json(campaign.parameters);
  const auto labels = labels_of(one.parameters, parameters);
  std::string text;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (!labels[k].empty())
      text += concat("  ", parameters[k].name, " = ", short_number(labels[k]), "\n");
  }
  return text;
}

/// "m2" or, of plane strain, "(m2/m)".
std::string unit(const char* si, const CaseResult& result) {
  return result.plane_strain ? concat("(", si, "/m)") : si;
}

bool is_asked(const std::string& asked, const std::string& name) {
  return asked.empty() || asked == name;
}

void add_stage(TextTable& table, const std::string& name, const StageMetrics& m) {
  const std::string sliding = first_fault(m.activated, m.activated_fault, m.activation_step);
  table.add_row({name, concat(m.first_step, "-", m.last_step),
                 (m.activated ? sliding
                  : m.slips   ? "no, slips"
                              : "no") +
                     (m.activation_resolved ? std::string() : ", unresolved"),
                 m.n_events > 0 ? std::to_string(m.n_events) : "",
                 first_fault(m.opens, m.opened_fault, m.opening_step),
                 m.opens ? format_number(m.open_area) : "", format_number(m.chi_bar, 3),
                 format_number(m.chi_max, 3), format_number(m.area_chi_080),
                 format_number(m.activated_area), format_number(m.max_slip, 3),
                 format_number(m.moment, 3)});
}

std::string stages_text(const CaseResult& result, const ShowRequest& request) {
  const std::string area = unit("m2", result);
  TextTable table({"stage", "steps", "slides", "jumps", "opens", "open/" + area, "χ̄", "χ max",
                   "area χ>0.8/" + area, "sliding/" + area, "slip/m", "M0/" + unit("Nm", result)});
  for (const StageMetrics& stage : result.stages) {
    if (is_asked(request.stage, stage.stage)) add_stage(table, stage.stage, stage);
  }
  if (request.stage.empty()) add_stage(table, "whole history", result.whole);
  return table.text();
}

/// "west: -57 bar, 164 bar": change and absolute pressure of the region on one side.
std::string side_text(const std::string& region, const std::optional<double>& change,
                      const std::optional<double>& absolute) {
  if (!change || !absolute) return "no region";
  return concat(region, ": ", format_number(*change / kBar, 4), ", ",
                format_number(*absolute / kBar, 4));
}
std::string minus_text(const faultsim::SidePressures& p) {
  return side_text(p.region_minus, p.change_minus, p.absolute_minus);
}
std::string plus_text(const faultsim::SidePressures& p) {
  return side_text(p.region_plus, p.change_plus, p.absolute_plus);
}
std::string in_fault_text(const faultsim::SidePressures& p) {
  return std::isnan(p.change_in_fault) ? "" : format_number(p.change_in_fault / kBar, 4);
}

void add_fault(TextTable& table, const std::string& stage, const faultsim::FaultStageMetrics& m) {
  const auto add = [&](const std::string& does, const std::optional<faultsim::FaultOnset>& onset,
                       double area) {
    std::vector<std::string> cells = {m.fault, stage, does, "", "", "", "", ""};
    if (onset) {
      cells = {m.fault,
               stage,
               does,
               std::to_string(onset->step),
               format_number(onset->depth),
               minus_text(onset->pressures),
               plus_text(onset->pressures),
               in_fault_text(onset->pressures)};
    }
    for (std::string& cell :
         std::vector<std::string>{format_number(area), format_number(m.max_slip, 3),
                                  format_number(m.moment, 3), format_number(m.chi_bar, 3)}) {
      cells.push_back(std::move(cell));
    }
    table.add_row(std::move(cells));
  };
  const std::string jumps = m.n_events > 0 ? concat(", jumps ", m.n_events, "x") : "";
  add((m.activated ? "slides"
       : m.slips   ? "slips"
                   : "sticks") +
          jumps,
      m.activation, m.activated_area);
  if (m.opens) add("opens", m.opening, m.open_area);
}

/// What each fault does in each stage; "" for results from before metrics per fault.
std::string faults_text(const CaseResult& result, const ShowRequest& request) {
  TextTable table({"fault", "stage", "does", "from step", "depth/m", "minus side: Δp, p/bar",
                   "plus side: Δp, p/bar", "in fault: Δp/bar", "area/" + unit("m2", result),
                   "slip/m", "M0/" + unit("Nm", result), "χ̄"});
  for (std::size_t f = 0; f < result.whole.faults.size(); ++f) {
    if (!is_asked(request.fault, result.whole.faults[f].fault)) continue;
    for (const StageMetrics& stage : result.stages) {
      if (f < stage.faults.size() && is_asked(request.stage, stage.stage))
        add_fault(table, stage.stage, stage.faults[f]);
    }
    if (request.stage.empty()) add_fault(table, "whole history", result.whole.faults[f]);
  }
  if (table.empty()) return "";
  return "\nfaults (change and absolute pressure of the regions beside them, at that depth):\n" +
         table.text();
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

std::string history_text(const CaseResult& result, std::size_t fault, const std::string& stage) {
  const std::string area = unit("m2", result);
  TextTable table({"step", "stage", "year", "Δp/bar", "χ̄", "χ max", "area χ>0.8/" + area,
                   "slipping/" + area, "slides", "sliding/" + area, "open/" + area, "slip/m",
                   "M0/" + unit("Nm", result), "creep ΔtN/bar", "creep |ΔtT|/bar", "time steps"});
  for (const faultsim::StepResult& step : result.steps) {
    if (!is_asked(stage, step.stage)) continue;
    std::string pressure;
    for (const double change : step.pressure_change) {
      pressure += (pressure.empty() ? "" : " ") + format_number(change / kBar);
    }
    if (fault >= step.faults.size()) {
      table.add_row({std::to_string(step.step), step.stage, format_number(step.time / kYear),
                     pressure, faultsim::to_string(step.outcome), "", "", "", "", "", "", "", "",
                     "", "", ""});
      continue;
    }
    const faultsim::FaultMetrics& m = step.faults[fault];
    const CreepCells creep = creep_cells(step, fault);
    table.add_row({std::to_string(step.step), step.stage, format_number(step.time / kYear),
                   pressure, format_number(m.chi_bar, 3), format_number(m.chi_max, 3),
                   format_number(m.area_chi_080), format_number(m.slipping_area),
                   concat(m.activated ? "yes" : "no", m.activation_resolved ? "" : "?"),
                   format_number(m.activated_area),
                   m.open_area > 0 ? format_number(m.open_area) : "", format_number(m.max_slip, 3),
                   format_number(m.moment, 3), creep.normal, creep.shear, creep.time_steps});
  }
  return table.text();
}

std::string events_text(const CaseResult& result, const ShowRequest& request) {
  TextTable table({"event", "step", "stage", "fault", "depth/m", "minus side: Δp, p/bar",
                   "plus side: Δp, p/bar", "in fault: Δp/bar", "nucleus/m",
                   "area/" + unit("m2", result), "slip/m", "drop/bar", "M0/" + unit("Nm", result),
                   "Mw", "resolved", "evidence"});
  int number = 0;
  for (const faultsim::SlipEvent& e : result.events) {
    ++number;
    if (!is_asked(request.stage, e.stage) || !is_asked(request.fault, e.fault)) continue;
    table.add_row(
        {std::to_string(number), std::to_string(e.step), e.stage, e.fault, format_number(e.depth),
         minus_text(e.pressures), plus_text(e.pressures), in_fault_text(e.pressures),
         format_number(e.nucleation_length, 3), format_number(e.slipped_area),
         format_number(e.max_slip, 3), format_number(e.stress_drop / kBar, 3),
         format_number(e.moment, 3), e.magnitude ? format_number(*e.magnitude, 2) : "",
         e.resolved ? "yes" : "NO, mesh too coarse", e.evidence_holds ? "holds" : "DOES NOT HOLD"});
  }
  return table.empty() ? "" : "\nslip events:\n" + table.text();
}

std::string episodes_text(const CaseResult& result, const ShowRequest& request) {
  TextTable table({"episode", "stage", "steps", "fault", "pressure", "depth/m",
                   "minus side: Δp, p/bar", "plus side: Δp, p/bar", "in fault: Δp/bar",
                   "sliding/" + unit("m2", result), "slip/m", "M0/" + unit("Nm", result)});
  int number = 0;
  for (const faultsim::Episode& e : result.episodes) {
    ++number;
    if (!is_asked(request.stage, e.stage) || !is_asked(request.fault, e.fault)) continue;
    table.add_row({std::to_string(number), e.stage, concat(e.first_step, "-", e.last_step), e.fault,
                   e.after_recovery ? "has recovered" : "not recovered", format_number(e.depth),
                   minus_text(e.pressures), plus_text(e.pressures), in_fault_text(e.pressures),
                   format_number(e.activated_area), format_number(e.max_slip, 3),
                   format_number(e.moment, 3)});
  }
  return table.empty() ? "" : "\nepisodes (pressures at their first step):\n" + table.text();
}

/// The evidence of an unexpected reactivation; "" = none.
std::string unexpected_text(const CaseResult& result) {
  if (!result.unexpected) return "";
  const std::size_t n = result.episodes.size();
  const auto again = static_cast<std::size_t>(result.unexpected->episode - 1);
  const auto before = static_cast<std::size_t>(result.unexpected->after - 1);
  if (again >= n || before >= n) return "UNEXPECTED REACTIVATION\n";
  const auto when = [&](std::size_t k) {
    const faultsim::Episode& e = result.episodes[k];
    return concat(e.stage, ", steps ", e.first_step, "-", e.last_step, " (episode ", k + 1, ")");
  };
  return concat("UNEXPECTED REACTIVATION: fault ", result.episodes[again].fault,
                " slides again in ", when(again), " after its pressure has recovered, having slid",
                " in ", when(before), "\n");
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

void check_request(const CaseResult& result, const ShowRequest& request) {
  if (!request.fault.empty()) require_name("--fault", "fault", request.fault, result.fault_names);
  if (request.stage.empty()) return;
  std::vector<std::string> stages;
  for (const StageMetrics& stage : result.stages) stages.push_back(stage.stage);
  require_name("--stage", "stage", request.stage, stages);
}

json fields_to_json(const CampaignInfo& campaign, const StoredCase& one) {
  if (one.fields == FieldsState::none) return {};
  const bool gone = one.fields == FieldsState::kept && !fields_are_there(one);
  return {{"steps", to_string(campaign.keep_fields)},
          {"state", gone ? "gone" : to_string(one.fields)},
          {"folder", one.fields_folder.string()}};
}

}  // namespace

std::string case_to_text(const CampaignInfo& campaign, const StoredCase& one,
                         const ShowRequest& request) {
  if (one.has_result) check_request(one.result, request);
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
  text += unexpected_text(result);
  if (result.outcome == faultsim::Outcome::unresolved_event) {
    text += result.weakening_resolved
                ? "UNRESOLVED: the evidence of a slip event does not hold\n"
                : "UNRESOLVED: the size of its slip events depends on the mesh\n";
  }
  if (!result.whole.activation_resolved) {
    text += "UNRESOLVED: whether a fault slides depends on the mesh (? below)\n";
  }
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  if (std::isfinite(result.pressure_margin)) {
    text += concat("reaches χ̄ = 1 after ", format_number(result.pressure_margin / kBar),
                   " bar more depletion, extrapolated\n");
  }
  text += creep_text(result);
  text += "\n" + stages_text(result, request) + faults_text(result, request) +
          events_text(result, request) + episodes_text(result, request);
  for (std::size_t fault = 0; fault < result.fault_names.size(); ++fault) {
    if (!is_asked(request.fault, result.fault_names[fault])) continue;
    text += concat("\nfault ", result.fault_names[fault], ":\n",
                   history_text(result, fault, request.stage));
  }
  return text;
}

json case_to_json(const CampaignInfo& campaign, const StoredCase& one) {
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
          {"parameters", values_to_json(one.parameters, parameters_from_json(campaign.parameters))},
          {"changes", json::parse(one.changes, nullptr, false)},
          {"fields", fields_to_json(campaign, one)},
          {"runs", runs},
          {"result", one.has_result ? faultsim::result_to_json(one.result) : json()}};
}

namespace {

/// Whether an open campaign computes the case, and why: "will run..." or "will not run...".
std::string verdict_if_open(const CampaignInfo& campaign, const StoredCase& one) {
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

std::string verdict_of(const CampaignInfo& campaign, const StoredCase& one) {
  const std::string verdict = verdict_if_open(campaign, one);
  if (!campaign.cancelled || !verdict.starts_with("will run")) return verdict;
  return concat("will not run: the campaign is cancelled; `faultsweep submit ", campaign.source,
                "` reopens it\n");
}

}  // namespace

std::vector<faultsim::InitialRegion> initial_state_of(const Store& store, const StoredCase& one) {
  const BaseScene base = store.base_scene(one.scene);
  std::vector<faultsim::Problem> problems;
  const faultsim::Scene scene = faultsim::read_scene(
      {base.source, scene_from_changes(base.document, one.changes), {}}, problems);
  return problems.empty() ? faultsim::initial_regions(scene)
                          : std::vector<faultsim::InitialRegion>();
}

std::string explain_case(const Store& store, const CampaignInfo& campaign, const StoredCase& one) {
  std::string text = concat("case ", one.position, " of ", campaign.name, " (identity ",
                            one.identity, ", numerics version ", faultsim::kNumericsVersion, ")\n");
  text += verdict_of(campaign, one);
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

json explanation_to_json(const Store& store, const CampaignInfo& campaign, const StoredCase& one) {
  std::string verdict = verdict_of(campaign, one);
  if (!verdict.empty() && verdict.back() == '\n') verdict.pop_back();
  const std::size_t colon = verdict.find(": ");
  json document = {{"campaign", campaign.name},
                   {"case", one.position},
                   {"identity", one.identity},
                   {"numerics_version", faultsim::kNumericsVersion},
                   {"will_run", verdict.starts_with("will run")},
                   {"why", colon == std::string::npos ? verdict : verdict.substr(colon + 2)},
                   {"family", nullptr},
                   {"campaigns", store.campaigns_with(one.id)}};
  for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
    if (family.fingerprint != one.family) continue;
    document["family"] = {{"fingerprint", family.fingerprint},
                          {"cases", family.n_cases},
                          {"done", family.n_done},
                          {"operator", family.operator_fingerprint}};
  }
  return document;
}

}  // namespace faultsweep
