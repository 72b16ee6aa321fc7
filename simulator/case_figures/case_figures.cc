#include "simulator/case_figures/case_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "simulator/case_figures/field_section.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/depth_chart.h"
#include "simulator/figure/history_chart.h"
#include "simulator/figure/palette.h"
#include "simulator/figure/section.h"
#include "simulator/figure/stress_path.h"
#include "simulator/scene/initial_state.h"

namespace faultsim {
namespace {

using figure::plain_number;

constexpr double kYearInSeconds = 365.25 * 86400, kDayInSeconds = 86400;
constexpr double kBarInPascal = 1e5, kMegapascal = 1e6, kMillimetre = 1e-3;

/// What is drawn, decided: a fault and a step of the result.
struct Chosen {
  const CasePicture& picture;
  CaseChartRequest request;
  std::size_t fault = 0;
  std::size_t step = 0;  ///< index in CaseResult::steps.

  const CaseResult& result() const { return picture.result; }
  const Scene& scene() const { return picture.scene; }
  const std::string& fault_name() const { return result().fault_names[fault]; }
};

[[noreturn]] void refuse(const std::string& option, const std::string& what,
                         const std::string& cure) {
  throw InputError(option, {{"", 0, what, cure}});
}

/// Steps that have metrics.
std::size_t n_steps_of(const CaseResult& result) {
  std::size_t n = 0;
  while (n < result.steps.size() && result.steps[n].faults.size() == result.fault_names.size()) {
    ++n;
  }
  return n;
}

/// By χ̄ and, where both have reached their strength, by the area that is near to it.
bool is_more_critical(const FaultMetrics& a, const FaultMetrics& b) {
  const double chi_a = std::min(a.chi_bar, figure::kChiAtLimit),
               chi_b = std::min(b.chi_bar, figure::kChiAtLimit);
  return chi_a != chi_b ? chi_a > chi_b : a.area_chi_080 > b.area_chi_080;
}

std::string with_blanks(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string subject_of(const CasePicture& picture) {
  return picture.name.empty() ? picture.result.title : picture.name;
}

bool in_days(const CaseResult& result) {
  return !result.steps.empty() && result.steps.back().time < 2 * kYearInSeconds;
}
double time_of(const CaseResult& result, double seconds) {
  return seconds / (in_days(result) ? kDayInSeconds : kYearInSeconds);
}

std::string moment_text(const Chosen& chosen) {
  const StepResult& step = chosen.result().steps[chosen.step];
  return concat("load step ", step.step, ", ", with_blanks(step.stage), ", ",
                plain_number(time_of(chosen.result(), step.time)),
                in_days(chosen.result()) ? " days" : " years");
}

std::vector<figure::StageSpan> stage_spans(const CaseResult& result) {
  std::vector<figure::StageSpan> spans;
  double before = 0;
  for (std::size_t k = 0; k < result.steps.size(); ++k) {
    const StepResult& step = result.steps[k];
    const double time = time_of(result, step.time);
    if (k > 0) {
      if (spans.empty() || spans.back().name != with_blanks(step.stage))
        spans.push_back({with_blanks(step.stage), before, time});
      spans.back().to = time;
    }
    before = time;
  }
  return spans;
}

std::vector<figure::TimeMark> event_marks(const CaseResult& result) {
  std::vector<figure::TimeMark> marks;
  for (const SlipEvent& event : result.events) {
    const std::string size = event.magnitude ? "Mw " + plain_number(*event.magnitude, 2) : "event";
    marks.push_back({time_of(result, event.time),
                     concat(size, event.resolved ? "" : " (unresolved)", " on ", event.fault)});
  }
  return marks;
}

/// A number of each fault against time.
template <typename Value>
std::vector<figure::Curve> curves_of(const CaseResult& result, Value&& value) {
  std::vector<figure::Curve> curves;
  const std::size_t n = n_steps_of(result);
  for (std::size_t f = 0; f < result.fault_names.size(); ++f) {
    figure::Curve curve{result.fault_names[f], f, {}};
    for (std::size_t k = 0; k < n; ++k) curve.values.push_back(value(result.steps[k].faults[f]));
    curves.push_back(std::move(curve));
  }
  return curves;
}

figure::HistoryPanel pressure_panel(const CaseResult& result) {
  figure::HistoryPanel panel{"Δp, bar", {}, {}, {0}, 120};
  for (std::size_t r = 0; r < result.region_names.size(); ++r) {
    // From the colours' other end: a compartment does not look like a fault.
    figure::Curve curve{result.region_names[r], 6 + 7 * r, {}};
    for (const StepResult& step : result.steps) {
      curve.values.push_back(
          r < step.pressure_change.size() ? step.pressure_change[r] / kBarInPascal : std::nan(""));
    }
    // Compartments with one history are one line with both names.
    const auto same = std::find_if(panel.curves.begin(), panel.curves.end(),
                                   [&](const auto& c) { return c.values == curve.values; });
    if (same != panel.curves.end())
      same->name += ", " + curve.name;
    else
      panel.curves.push_back(std::move(curve));
  }
  return panel;
}

std::string ending_of(const CaseResult& result) {
  if (in_equilibrium(result.outcome)) return "";
  return concat("; the history ends early (", to_string(result.outcome), ")");
}

std::string draw_history(const Chosen& chosen) {
  const CaseResult& result = chosen.result();
  figure::HistoryChart chart;
  chart.time_label = in_days(result) ? "time, days" : "time, years";
  for (const StepResult& step : result.steps) chart.time.push_back(time_of(result, step.time));
  chart.stages = stage_spans(result);
  chart.marks = event_marks(result);
  if (chosen.request.with_cursor) chart.cursor = chart.time[chosen.step];
  const std::string subject = subject_of(chosen.picture) + ending_of(result);
  if (chosen.request.chart == CaseChart::history) {
    chart.title = "How near each fault is to sliding: χ̄";
    chart.panels.push_back({"χ̄",
                            curves_of(result, [](const FaultMetrics& m) { return m.chi_bar; }),
                            {{1, "strength reached"}, {0.8, "0.8"}},
                            {0, 1},
                            260});
  } else if (chosen.request.chart == CaseChart::thickness) {
    chart.title = "Down-dip length with χ > 0.8";
    chart.panels.push_back(
        {"length, m",
         curves_of(result, [](const FaultMetrics& m) { return m.thickness_chi_080_max; }),
         {},
         {0},
         260});
  } else {
    chart.title = "Largest slip of each fault";
    chart.panels.push_back(
        {"slip, mm",
         curves_of(result, [](const FaultMetrics& m) { return m.max_slip / kMillimetre; }),
         {},
         {0},
         260});
  }
  chart.remark = subject;
  if (!result.region_names.empty()) chart.panels.push_back(pressure_panel(result));
  return figure::draw(chart);
}

// Charts of the fields --------------------------------------------------------------------------

/// The fault in the file of fields.
std::size_t stored_fault(const Chosen& chosen) {
  const std::vector<StoredFault>& faults = chosen.picture.fields->faults();
  for (std::size_t f = 0; f < faults.size(); ++f) {
    if (faults[f].name == chosen.fault_name()) return f;
  }
  refuse("--fault", "no fields of fault " + chosen.fault_name() + " were kept", "name another");
}

/// The entry of the chosen step; where it was not kept and nobody asked for it, the last one
/// before.
std::size_t stored_entry(Chosen& chosen) {
  const std::vector<int>& steps = chosen.picture.fields->steps();
  if (steps.empty()) refuse("--step", "the fields hold no load step", "run the case again");
  const int wanted = chosen.result().steps[chosen.step].step;
  const auto after = std::upper_bound(steps.begin(), steps.end(), wanted);
  const std::size_t entry =
      after == steps.begin() ? 0 : static_cast<std::size_t>(after - steps.begin()) - 1;
  if (steps[entry] != wanted && chosen.request.step) {
    std::string there;
    for (const int step : steps) there += (there.empty() ? "" : ", ") + std::to_string(step);
    refuse("--step", concat("the fields of load step ", wanted, " were not kept"),
           "choose one of " + there);
  }
  for (std::size_t k = 0; k < chosen.result().steps.size(); ++k) {
    if (chosen.result().steps[k].step == steps[entry]) chosen.step = k;
  }
  return entry;
}

/// Split points of a line down dip, by depth.
std::vector<std::size_t> column_through(const StoredFault& fault, double y) {
  std::vector<std::size_t> column;
  constexpr double kSameLine = 1e-3;  // m
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] != 0 &&
        std::abs(fault.points(1, static_cast<Eigen::Index>(i)) - y) < kSameLine) {
      column.push_back(i);
    }
  }
  std::sort(column.begin(), column.end(), [&](std::size_t a, std::size_t b) {
    return fault.points(2, static_cast<Eigen::Index>(a)) >
           fault.points(2, static_cast<Eigen::Index>(b));
  });
  return column;
}

/// The split point with the largest χ, the first of them in the file's order.
std::size_t most_critical(const StoredFault& fault, const StoredFields& fields) {
  std::size_t most = fault.split.size();
  for (std::size_t i = 0; i < fault.split.size(); ++i) {
    if (fault.split[i] == 0) continue;
    const auto k = static_cast<Eigen::Index>(i);
    if (most == fault.split.size() ||
        fields.critical_index[k] > fields.critical_index[static_cast<Eigen::Index>(most)]) {
      most = i;
    }
  }
  if (most == fault.split.size()) refuse("--fault", "no point of it can move", "name another");
  return most;
}

double shear_at(const StoredFields& fields, Eigen::Index k) {
  return std::hypot(fields.traction(1, k), fields.traction(2, k));
}

std::string draw_profiles(Chosen chosen) {
  const std::size_t f = stored_fault(chosen), entry = stored_entry(chosen);
  const StoredFault& fault = chosen.picture.fields->faults()[f];
  const StoredFields now = chosen.picture.fields->fields(f, entry);
  const double y = fault.points(1, static_cast<Eigen::Index>(most_critical(fault, now)));
  const Friction& friction = chosen.scene().faults[chosen.fault].friction;
  figure::DepthChart chart;
  figure::Curve pressure{"", 0, {}}, normal{"", 0, {}}, shear{"|τ|", 0, {}},
      strength{"strength before slip", 1, {}}, chi{"", 0, {}}, slip{"", 0, {}};
  for (const std::size_t i : column_through(fault, y)) {
    const auto k = static_cast<Eigen::Index>(i);
    chart.depth.push_back(-fault.points(2, k));
    pressure.values.push_back(now.fault_pressure_change[k] / kBarInPascal);
    normal.values.push_back(-now.traction(0, k) / kMegapascal);
    shear.values.push_back(shear_at(now, k) / kMegapascal);
    strength.values.push_back((friction.cohesion - std::min(now.traction(0, k), 0.0) *
                                                       std::tan(friction.static_friction_angle)) /
                              kMegapascal);
    chi.values.push_back(now.critical_index[k]);
    slip.values.push_back(std::hypot(now.slip(1, k), now.slip(2, k)) / kMillimetre);
  }
  chart.title = concat("Fault ", chosen.fault_name(), " against depth: ", moment_text(chosen));
  chart.remark = subject_of(chosen.picture) +
                 (chosen.result().plane_strain
                      ? ""
                      : concat("; line down dip at ", plain_number(y, 4), " m along strike"));
  chart.bands = compartments_beside(chosen.scene(), chosen.fault);
  chart.columns = {{"Δp in the fault, bar", {pressure}, {}, {0}},
                   {"σ'ₙ, MPa (compression +)", {normal}, {}, {0}},
                   {"shear, MPa", {shear, strength}, {}, {0}},
                   {"χ", {chi}, {{0.8, ""}, {1, ""}}, {0, 1}},
                   {"slip, mm", {slip}, {}, {0}}};
  return figure::draw(chart);
}

/// A column of faces per load step: what a fault in plane strain does in time.
void add_time_map(const Chosen& chosen, std::size_t f, figure::FaultMap& map) {
  const FieldReader& file = *chosen.picture.fields;
  const StoredFault& fault = file.faults()[f];
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const double from = time_of(chosen.result(), file.times()[entry == 0 ? 0 : entry - 1]);
    const double to = time_of(chosen.result(), file.times()[entry]);
    if (!(to > from)) continue;
    const StoredFields now = file.fields(f, entry);
    for (const std::vector<int>& face : fault.faces) {
      const Eigen::Index a = face.front(), b = face.back();
      const double top = -fault.points(2, a), base = -fault.points(2, b);
      const double value = (now.critical_index[a] + now.critical_index[b]) / 2;
      map.cells.push_back({{{from, top}, {to, top}, {to, base}, {from, base}}, value, false});
    }
  }
  map.across = in_days(chosen.result()) ? "time, days" : "time, years";
}

/// Faces at one step, and which of them slide in it or are open.
void add_plane_map(const StoredFault& fault, const StoredFields& now, figure::FaultMap& map) {
  for (const std::vector<int>& face : fault.faces) {
    figure::FaultCell cell;
    std::size_t n_moving = 0;
    for (const int point : face) {
      cell.corners.push_back({fault.points(1, point), -fault.points(2, point)});
      cell.value += now.critical_index[point] / static_cast<double>(face.size());
      n_moving += now.state[static_cast<std::size_t>(point)] == 0 ? 0U : 1U;
    }
    cell.is_marked = 2 * n_moving >= face.size();
    map.cells.push_back(std::move(cell));
  }
  map.across = "along strike, m";
  map.marked = "slips or is open in this step (half of a face's corners or more)";
}

std::string draw_fault_map(Chosen chosen) {
  const std::size_t f = stored_fault(chosen);
  figure::FaultMap map;
  map.quantity = "χ";
  map.bands = compartments_beside(chosen.scene(), chosen.fault);
  map.remark = subject_of(chosen.picture);
  if (chosen.result().plane_strain) {
    map.title = concat("χ of fault ", chosen.fault_name(), " against depth and time");
    add_time_map(chosen, f, map);
  } else {
    const std::size_t entry = stored_entry(chosen);
    map.title = concat("χ on fault ", chosen.fault_name(), ": ", moment_text(chosen));
    add_plane_map(chosen.picture.fields->faults()[f], chosen.picture.fields->fields(f, entry), map);
  }
  return figure::draw(map);
}

/// Principal effective stresses across the fault at the start, MPa, compression positive. With
/// σ_xz = 0 in every initial state but a tensor's, these are σ'_xx and σ'_zz.
std::optional<figure::StressPath::Circle> initial_circle(const Scene& scene, double z) {
  if (scene.initial.tensor || scene.geometry_kind != GeometryKind::field) return std::nullopt;
  const StressAtDepth start = initial_state(scene, z);
  const double across = -(start.sigma[0] + start.pressure),
               down = -(start.sigma[8] + start.pressure);
  return figure::StressPath::Circle{std::max(across, down) / kMegapascal,
                                    std::min(across, down) / kMegapascal};
}

std::string draw_stress_path(Chosen chosen) {
  const std::size_t f = stored_fault(chosen), critical = stored_entry(chosen);
  const FieldReader& file = *chosen.picture.fields;
  const StoredFault& fault = file.faults()[f];
  const auto k = static_cast<Eigen::Index>(most_critical(fault, file.fields(f, critical)));
  const Friction& friction = chosen.scene().faults[chosen.fault].friction;
  figure::StressPath path;
  std::map<int, std::string> stages;
  for (const StepResult& step : chosen.result().steps) stages[step.step] = step.stage;
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const StoredFields now = file.fields(f, entry);
    path.normal.push_back(-now.traction(0, k) / kMegapascal);
    path.shear.push_back(shear_at(now, k) / kMegapascal);
    const std::string stage = with_blanks(stages[file.steps()[entry]]);
    const bool is_last = entry + 1 == file.steps().size();
    const bool ends_stage = is_last || with_blanks(stages[file.steps()[entry + 1]]) != stage;
    if (entry == 0)
      path.marks.push_back({entry, "start"});
    else if (ends_stage)
      path.marks.push_back({entry, "end of " + stage});
  }
  path.title = concat("Stress path of fault ", chosen.fault_name(), " at ",
                      plain_number(-fault.points(2, k), 4), " m depth");
  path.remark =
      concat("where χ is largest at ", moment_text(chosen), "; ", subject_of(chosen.picture));
  path.cohesion = friction.cohesion / kMegapascal;
  path.friction = std::tan(friction.static_friction_angle);
  if (friction.dynamic_friction_angle != friction.static_friction_angle) {
    path.weakened = std::tan(friction.dynamic_friction_angle);
  }
  path.circle = initial_circle(chosen.scene(), fault.points(2, k));
  return figure::draw(path);
}

// The section -----------------------------------------------------------------------------------

/// Pieces of a fault's line with their χ, from the fields on the line through the most critical
/// point; false where they were not kept.
bool colour_by_fields(const Chosen& chosen, std::size_t fault, figure::Section::FaultLine& line) {
  const FieldReader* file = chosen.picture.fields;
  if (file == nullptr) return false;
  const int step = chosen.result().steps[chosen.step].step;
  const auto entry = std::find(file->steps().begin(), file->steps().end(), step);
  if (entry == file->steps().end()) return false;
  for (std::size_t f = 0; f < file->faults().size(); ++f) {
    const StoredFault& stored = file->faults()[f];
    if (stored.name != chosen.result().fault_names[fault]) continue;
    const StoredFields now =
        file->fields(f, static_cast<std::size_t>(entry - file->steps().begin()));
    const auto most = static_cast<Eigen::Index>(most_critical(stored, now));
    const std::vector<std::size_t> column = column_through(stored, stored.points(1, most));
    if (column.size() < 2) return false;
    line.points.clear();
    for (std::size_t i = 0; i < column.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(column[i]);
      line.points.push_back({stored.points(0, k), -stored.points(2, k)});
      if (i == 0) continue;
      line.chi.push_back(std::max(now.critical_index[static_cast<Eigen::Index>(column[i - 1])],
                                  now.critical_index[k]));
    }
    return true;
  }
  return false;
}

/// "Δp −160 bar" of a compartment at a step; "" where its pressure is not given.
std::string pressure_note(const CaseResult& result, const StepResult& step,
                          const std::string& name) {
  for (std::size_t r = 0; r < result.region_names.size(); ++r) {
    if (result.region_names[r] != name || r >= step.pressure_change.size()) continue;
    return "Δp " + plain_number(step.pressure_change[r] / kBarInPascal) + " bar";
  }
  return "";
}

/// The section with χ and pressures of the step. @return whether all χ are those of fields.
bool fill_section(const Chosen& chosen, figure::Section& section) {
  const StepResult& step = chosen.result().steps[chosen.step];
  bool all_fields = true;
  for (std::size_t f = 0; f < section.faults.size() && f < step.faults.size(); ++f) {
    if (colour_by_fields(chosen, f, section.faults[f])) continue;
    section.faults[f].chi = {step.faults[f].chi_bar};
    all_fields = false;
  }
  for (figure::Section::Rock& rock : section.rocks) {
    if (rock.is_reservoir) rock.note = pressure_note(chosen.result(), step, rock.name);
  }
  return all_fields;
}

std::string draw_section(const Chosen& chosen) {
  if (chosen.scene().geometry_kind != GeometryKind::field) {
    refuse("chart", "a section is drawn of a field, and this scene is a box",
           "choose another chart: history, profiles, fault-map");
  }
  figure::Section section = field_section(chosen.scene());
  const bool all_fields = fill_section(chosen, section);
  section.title = concat("The field across its faults",
                         chosen.request.with_cursor ? "" : ": " + moment_text(chosen));
  section.remark = concat(subject_of(chosen.picture), "; to scale; colour: ",
                          all_fields ? "χ down dip, on the line where it is largest"
                                     : "χ̄ of the whole fault (fields were not kept)");
  return figure::draw(section);
}

Chosen choose(const CasePicture& picture, const CaseChartRequest& request) {
  const CaseResult& result = picture.result;
  const std::size_t n = n_steps_of(result);
  if (result.fault_names.empty() || n == 0) {
    refuse("case", "the result has no faults or no load step to draw", "choose another case");
  }
  const CriticalMoment critical = critical_moment(result);
  Chosen chosen{picture, request, critical.fault, critical.step};
  if (!request.fault.empty()) {
    const auto found =
        std::find(result.fault_names.begin(), result.fault_names.end(), request.fault);
    if (found == result.fault_names.end()) {
      std::string names;
      for (const std::string& name : result.fault_names)
        names += (names.empty() ? "" : ", ") + name;
      refuse("--fault", "\"" + request.fault + "\" is no fault of the case",
             "choose one of " + names);
    }
    chosen.fault = static_cast<std::size_t>(found - result.fault_names.begin());
    chosen.step = 0;
    for (std::size_t k = 1; k < n; ++k) {
      const std::size_t f = chosen.fault;
      if (is_more_critical(result.steps[k].faults[f], result.steps[chosen.step].faults[f]))
        chosen.step = k;
    }
  }
  if (request.step) {
    const auto found = std::find_if(result.steps.begin(), result.steps.end(),
                                    [&](const StepResult& s) { return s.step == *request.step; });
    if (found == result.steps.end() ||
        static_cast<std::size_t>(found - result.steps.begin()) >= n) {
      refuse("--step", concat("the history has no load step ", *request.step),
             concat("choose 0 to ", result.steps[n - 1].step));
    }
    chosen.step = static_cast<std::size_t>(found - result.steps.begin());
  }
  return chosen;
}

}  // namespace

const std::vector<CaseChartInfo>& case_charts() {
  static const std::vector<CaseChartInfo> charts = {
      {CaseChart::history, "history", "χ̄ per fault and pressures against time", false},
      {CaseChart::thickness, "thickness", "down-dip length with χ > 0.8 against time", false},
      {CaseChart::slip, "slip", "largest slip per fault against time", false},
      {CaseChart::section, "section", "cut across the field, faults coloured by χ", false},
      {CaseChart::profiles, "profiles", "pressure, tractions, χ, slip against depth", true},
      {CaseChart::fault_map, "fault-map", "χ on a fault's plane; plane strain: in time", true},
      {CaseChart::stress_path, "stress-path", "traction against strength, with circle", true}};
  return charts;
}

const CaseChartInfo* case_chart_named(std::string_view name) {
  for (const CaseChartInfo& info : case_charts()) {
    if (name == info.name) return &info;
  }
  return nullptr;
}

CriticalMoment critical_moment(const CaseResult& result) {
  CriticalMoment critical;
  const FaultMetrics* most = nullptr;
  for (std::size_t k = 0; k < n_steps_of(result); ++k) {
    for (std::size_t f = 0; f < result.steps[k].faults.size(); ++f) {
      const FaultMetrics& now = result.steps[k].faults[f];
      if (most != nullptr && !is_more_critical(now, *most)) continue;
      most = &now;
      critical = {f, k};
    }
  }
  return critical;
}

std::string draw_case(const CasePicture& picture, const CaseChartRequest& request) {
  Chosen chosen = choose(picture, request);
  for (const CaseChartInfo& info : case_charts()) {
    if (info.chart != request.chart || !info.needs_fields || picture.fields != nullptr) continue;
    refuse("chart",
           concat(info.name, " is drawn from the fields on the faults, which were not kept"),
           "run the scene with fault fields (/output/fault_fields), a campaign with "
           "\"keep_fields\"");
  }
  switch (request.chart) {
    case CaseChart::history:
    case CaseChart::thickness:
    case CaseChart::slip:
      return draw_history(chosen);
    case CaseChart::section:
      return draw_section(chosen);
    case CaseChart::profiles:
      return draw_profiles(chosen);
    case CaseChart::fault_map:
      return draw_fault_map(chosen);
    case CaseChart::stress_path:
      return draw_stress_path(chosen);
  }
  return {};
}

std::vector<StepLook> step_looks(const CasePicture& picture) {
  std::vector<StepLook> looks;
  Chosen chosen{picture, {}, 0, 0};
  const figure::Section empty = field_section(picture.scene);
  for (chosen.step = 0; chosen.step < n_steps_of(picture.result); ++chosen.step) {
    figure::Section section = empty;
    fill_section(chosen, section);
    const StepResult& step = picture.result.steps[chosen.step];
    StepLook look{step.step, time_of(picture.result, step.time), moment_text(chosen), {}, {}};
    for (const figure::Section::FaultLine& fault : section.faults) {
      std::vector<std::string>& colours = look.colours.emplace_back();
      for (const double chi : fault.chi) colours.push_back(figure::chi_colour(chi));
    }
    for (const figure::Section::Rock& rock : section.rocks) {
      if (rock.is_reservoir) look.notes.emplace_back(rock.name, rock.note);
    }
    looks.push_back(std::move(look));
  }
  return looks;
}

}  // namespace faultsim
