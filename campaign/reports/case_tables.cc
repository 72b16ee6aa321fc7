#include "campaign/reports/case_report.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/reports/measure_columns.h"
#include "campaign/store/clock.h"

namespace faultsweep {

namespace {

constexpr const char* kWhole = "whole history";

bool is_asked(const std::string& asked, const std::string& name) {
  return asked.empty() || asked == name;
}

AnswerColumn column(std::string key, std::string heading, Need need = Need::always) {
  return {std::move(key), std::move(heading), {}, 4, need};
}
AnswerColumn column(std::string key, std::string heading, ShownUnit unit, int digits,
                    Need need = Need::always) {
  return {std::move(key), std::move(heading), std::move(unit), digits, need};
}

/// An area, potency or moment of the case: "moment_nm_per_m" of plane strain.
AnswerColumn extensive(const CaseResult& result, const std::string& key, std::string heading,
                       int digits = 3, Need need = Need::wanted) {
  return column(result.plane_strain ? key + "_per_m" : key, std::move(heading),
                shown_unit(faultsim::dimension_of(key), result.plane_strain), digits, need);
}

/// Whether the flag of sliding depends on the cells stands beside it.
std::vector<AnswerColumn> measures_of(const CaseResult& result) {
  std::vector<AnswerColumn> columns = measure_columns(result.plane_strain);
  AnswerColumn& resolved = columns[measure_called("activation_resolved").value()];
  resolved.heading = "resolved";
  resolved.need = Need::always;
  return columns;
}

/// Of the pressure regions: the store keeps no names of them, its scene has them.
std::vector<std::string> names_of_regions(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  if (!result.region_names.empty()) return result.region_names;
  std::size_t n = 0;
  for (const StepResult& step : result.steps) n = std::max(n, step.pressure_change.size());
  std::vector<std::string> names;
  for (std::size_t r = 0; r < n; ++r) {
    names.push_back(shown.initial.size() == n ? shown.initial[r].name : concat("region ", r + 1));
  }
  return names;
}

bool has_temperatures(const CaseResult& result) {
  return std::ranges::any_of(
      result.steps, [](const StepResult& step) { return !step.temperature_change.empty(); });
}

std::vector<AnswerColumn> history_columns(const CaseResult& result,
                                          const std::vector<std::string>& regions) {
  std::vector<AnswerColumn> columns = {
      column("fault", "fault"),
      column("step", "step"),
      column("chi_bar", "χ̄", {}, 3),
      column("activated", "slides"),
      column("activation_resolved", "resolved"),
      column("max_slip_m", "slip", metres(), 3),
      column("time_s", "at", shown_unit(Dimension::time), 4, Need::wanted),
      column("stage", "stage", Need::wanted),
      column("outcome", "outcome", Need::wanted)};
  for (const std::string& region : regions) {
    columns.push_back(column(region, "Δp " + region, bars(), 4, Need::wanted));
    columns.back().group = "pressure_change_pa";
  }
  for (std::size_t r = 0; has_temperatures(result) && r < regions.size(); ++r) {
    columns.push_back(column(regions[r], "ΔT " + regions[r] + ", K", {}, 3, Need::wanted));
    columns.back().group = "temperature_change_k";
  }
  append(columns,
         {extensive(result, "activated_area_m2", "sliding area", 4),
          extensive(result, "moment_nm", "M0"), extensive(result, "open_area_m2", "open area", 4),
          column("chi_max", "χ max", {}, 3, Need::extra),
          extensive(result, "area_chi_080_m2", "area χ > 0.8", 4, Need::extra),
          extensive(result, "slipping_area_m2", "slipping area", 4, Need::extra),
          column("creep_normal_min_pa", "creep ΔtN from", bars(), 3, Need::wanted),
          column("creep_normal_max_pa", "to", bars(), 3, Need::wanted),
          column("creep_shear_max_pa", "creep |ΔtT|", bars(), 3, Need::wanted),
          column("creep_time_steps", "time steps", Need::wanted),
          column("creep_time_resolved", "fine enough", Need::wanted)});
  return columns;
}

/// What the salt did to one fault up to a load step; empty where nothing creeps.
void add_creep(const StepResult& step, std::size_t fault, std::vector<AnswerCell>& cells) {
  if (!step.creep) return;
  const faultsim::StepCreep& creep = *step.creep;
  if (fault < creep.faults.size()) {
    const faultsim::FaultCreep& c = creep.faults[fault];
    append(cells, {c.normal_min, c.normal_max, c.shear_max});
  } else {
    cells.resize(cells.size() + 3);
  }
  append(cells, {creep.time_steps, creep.time_resolved});
}

std::vector<AnswerCell> history_row(const CaseResult& result, const StepResult& step,
                                    std::size_t fault, std::size_t n_regions) {
  const bool is_there = fault < step.faults.size();  // not of a step that failed
  const faultsim::FaultMetrics m = is_there ? step.faults[fault] : faultsim::FaultMetrics{};
  std::vector<AnswerCell> cells = {result.fault_names[fault], step.step};
  if (is_there) {
    append(cells, {m.chi_bar, m.activated, m.activation_resolved, m.max_slip});
  } else {
    cells.resize(cells.size() + 4);
  }
  append(cells, {step.time, step.stage, to_string(step.outcome)});
  for (std::size_t r = 0; r < n_regions; ++r)
    cells.push_back(r < step.pressure_change.size() ? AnswerCell(step.pressure_change[r])
                                                    : AnswerCell());
  for (std::size_t r = 0; has_temperatures(result) && r < n_regions; ++r)
    cells.push_back(r < step.temperature_change.size() ? AnswerCell(step.temperature_change[r])
                                                       : AnswerCell());
  if (!is_there) return cells;
  append(cells,
         {m.activated_area, m.moment, m.open_area, m.chi_max, m.area_chi_080, m.slipping_area});
  add_creep(step, fault, cells);
  return cells;
}

}  // namespace

AnswerTable settings_table(const ShownCase& shown) {
  const auto& parameters = shown.campaign.parameters;
  AnswerTable table{"settings",
                    "",
                    {column("parameter", "parameter"), column("given", "value"),
                     column("si", "in SI", Need::data), column("unit", "SI unit", Need::data)}};
  for (const CaseParameter& one : shown.stored.parameters) {
    const StoredParameter& parameter = parameters.at(static_cast<std::size_t>(one.index));
    table.rows.push_back(
        {parameter.name, one.text, one.si,
         parameter.is_text ? AnswerCell() : AnswerCell(faultsim::si_unit(parameter.dimension))});
  }
  return table;
}

AnswerTable runs_table(const StoredCase& stored) {
  AnswerTable table{
      "runs",
      stored.runs.empty() ? "" : "runs:",
      {column("attempt", "attempt"), column("ended_at", "ended", seconds(), 4, Need::data),
       column("when", "ended", Need::wanted), column("status", "status"),
       column("outcome", "outcome"), column("reason", "why"),
       column("wall_s", "took", seconds(), 3, Need::wanted), column("rank", "rank", Need::wanted),
       column("host", "host", Need::extra),
       column("fields_only", "for the fields only", Need::wanted),
       column("signal", "signal", Need::extra), column("exit_code", "exit code", Need::extra),
       column("log_tail", "last words", Need::data)}};
  for (const StoredRun& run : stored.runs) {
    table.rows.push_back({run.attempt, run.ended_at, format_time(run.ended_at), run.status,
                          words_or_nothing(run.outcome), run.reason, run.wall_seconds, run.rank,
                          run.host, run.fields_only, run.signal, run.exit_code, run.log_tail});
  }
  return table;
}

AnswerTable stages_table(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  AnswerTable table{"stages",
                    "",
                    {column("stage", "stage"), column("first_step", "steps from", Need::wanted),
                     column("last_step", "to", Need::wanted)}};
  append(table.columns, measures_of(result));
  append(table.columns, {column("activated_fault", "slides first", Need::wanted),
                         column("activation_step", "from step", Need::wanted),
                         column("opened_fault", "opens first", Need::extra),
                         column("opening_step", "from step", Need::data)});
  const auto add = [&](const std::string& name, const StageMetrics& m) {
    std::vector<AnswerCell> cells = {name, m.first_step, m.last_step};
    append(cells, measure_cells(m));
    append(cells, {words_or_nothing(m.activated_fault), m.activation_step,
                   words_or_nothing(m.opened_fault), m.opening_step});
    table.rows.push_back(std::move(cells));
  };
  for (const StageMetrics& stage : result.stages)
    if (is_asked(shown.request.stage, stage.stage)) add(stage.stage, stage);
  if (shown.request.stage.empty()) add(kWhole, result.whole);
  return table;
}

AnswerTable faults_table(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  AnswerTable table{"faults",
                    result.whole.faults.empty() ? "" : "faults:",
                    {column("fault", "fault"), column("stage", "stage"), column("does", "does")}};
  append(table.columns, measures_of(result));
  table.columns[3 + measure_called("slides").value()].need = Need::data;  // `does` says so
  append(table.columns, onset_columns(shown.pressures, "activation", Need::extra));
  std::vector<AnswerColumn> opens = onset_columns(shown.pressures, "opening", Need::data);
  for (AnswerColumn& one : opens) one.need = Need::data;
  append(table.columns, opens);
  const auto add = [&](const std::string& stage, const faultsim::FaultStageMetrics& m) {
    const std::string does =
        concat(m.activated ? "slides"
               : m.slips   ? "slips"
                           : "sticks",
               m.n_events > 0 ? concat(", jumps ", m.n_events, "x") : "", m.opens ? ", opens" : "");
    std::vector<AnswerCell> cells = {m.fault, stage, does};
    append(cells, measure_cells(m));
    add_onset(m.activation ? &*m.activation : nullptr, cells);
    add_onset(m.opening ? &*m.opening : nullptr, cells);
    table.rows.push_back(std::move(cells));
  };
  for (std::size_t f = 0; f < result.whole.faults.size(); ++f) {
    if (!is_asked(shown.request.fault, result.whole.faults[f].fault)) continue;
    for (const StageMetrics& stage : result.stages)
      if (f < stage.faults.size() && is_asked(shown.request.stage, stage.stage))
        add(stage.stage, stage.faults[f]);
    if (shown.request.stage.empty()) add(kWhole, result.whole.faults[f]);
  }
  if (!table.rows.empty()) table.notes = {pressure_note(shown.pressures)};
  return table;
}

AnswerTable events_table(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  AnswerTable table{
      "slip_events",
      result.events.empty() ? "" : "slip events:",
      {column("event", "event"), column("step", "step"), column("fault", "fault"),
       column("stage", "stage", Need::wanted), column("resolved", "resolved"),
       column("evidence_holds", "evidence holds"), column("max_slip_m", "slip", metres(), 3),
       extensive(result, "moment_nm", "M0", 3, Need::always),
       column("magnitude_mw", "Mw", {}, 2, Need::wanted),
       extensive(result, "slipped_area_m2", "area", 4),
       column("stress_drop_pa", "drop", bars(), 3, Need::wanted),
       column("nucleation_length_m", "nucleus", metres(), 3, Need::wanted)}};
  append(table.columns, place_columns(shown.pressures, "", Need::extra));
  int number = 0;
  for (const faultsim::SlipEvent& e : result.events) {
    ++number;
    if (!is_asked(shown.request.stage, e.stage) || !is_asked(shown.request.fault, e.fault))
      continue;
    std::vector<AnswerCell> cells = {number,
                                     e.step,
                                     e.fault,
                                     e.stage,
                                     {e.resolved, NAN, e.resolved ? "" : "mesh too coarse"},
                                     e.evidence_holds,
                                     e.max_slip,
                                     e.moment,
                                     e.magnitude,
                                     e.slipped_area,
                                     e.stress_drop,
                                     e.nucleation_length};
    add_place(e.depth, &e.pressures, cells);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

AnswerTable episodes_table(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  AnswerTable table{
      "episodes",
      result.episodes.empty() ? "" : "episodes (pressures at their first step):",
      {column("episode", "episode"), column("fault", "fault"), column("stage", "stage"),
       column("first_step", "steps from"), column("last_step", "to"),
       column("after_recovery", "pressure has recovered"),
       column("max_slip_m", "slip", metres(), 3), extensive(result, "moment_nm", "M0"),
       extensive(result, "activated_area_m2", "sliding area", 4)}};
  append(table.columns, place_columns(shown.pressures, "", Need::extra));
  int number = 0;
  for (const faultsim::Episode& e : result.episodes) {
    ++number;
    if (!is_asked(shown.request.stage, e.stage) || !is_asked(shown.request.fault, e.fault))
      continue;
    std::vector<AnswerCell> cells = {number,       e.fault,     e.stage,
                                     e.first_step, e.last_step, e.after_recovery,
                                     e.max_slip,   e.moment,    e.activated_area};
    add_place(e.depth, &e.pressures, cells);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

AnswerTable histories_table(const ShownCase& shown) {
  const CaseResult& result = shown.stored.result;
  const std::vector<std::string> regions = names_of_regions(shown);
  AnswerTable table{"histories", "load steps:", history_columns(result, regions)};
  for (std::size_t fault = 0; fault < result.fault_names.size(); ++fault) {
    if (!is_asked(shown.request.fault, result.fault_names[fault])) continue;
    for (const StepResult& step : result.steps)
      if (is_asked(shown.request.stage, step.stage))
        table.rows.push_back(history_row(result, step, fault, regions.size()));
  }
  if (table.rows.empty()) table.title.clear();
  return table;
}

AnswerTable initial_table(const std::vector<faultsim::InitialRegion>& regions) {
  AnswerTable table{
      "initial_state",
      regions.empty() ? ""
                      : "initial state at mid-depth of the regions (total stress, tension > 0):",
      {column("region", "region"), column("depth_m", "depth", metres(), 4),
       column("sigma_v_pa", "vertical", bars(), 4), column("sigma_across_pa", "across", bars(), 4),
       column("sigma_along_pa", "along", bars(), 4), column("pressure_pa", "pressure", bars(), 4)}};
  const bool has_source = std::ranges::any_of(
      regions, [](const faultsim::InitialRegion& r) { return !r.source.empty(); });
  if (has_source) table.columns.push_back(column("pressure_from", "pressure is"));
  for (const faultsim::InitialRegion& r : regions) {
    table.rows.push_back({r.name, r.depth, r.vertical, r.across, r.along, r.pressure});
    if (!has_source) continue;
    table.rows.back().emplace_back();
    if (!r.source.empty()) table.rows.back().back() = "mean of the " + r.source;
  }
  return table;
}

}  // namespace faultsweep
