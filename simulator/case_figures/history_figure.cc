#include <algorithm>
#include <cmath>

#include "simulator/case_figures/chosen.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/history_chart.h"
#include "simulator/initial_state/pressure_history.h"

namespace faultsim::case_figures {
namespace {

using figure::plain_number;

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

/// The values of a fault in the steps that have metrics.
template <typename Value>
std::vector<double> values_of(const CaseResult& result, std::size_t fault, Value& value) {
  std::vector<double> values;
  const std::size_t n = n_steps_of(result);
  for (std::size_t k = 0; k < n; ++k) values.push_back(value(result.steps[k].faults[fault]));
  return values;
}

/// A number of each fault against time; of those too that were there before the change alone.
template <typename Value>
std::vector<figure::Curve> curves_of(const CasePicture& picture, Value&& value) {
  std::vector<figure::Curve> curves;
  const CaseResult& result = picture.result;
  for (std::size_t f = 0; f < result.fault_names.size(); ++f)
    curves.push_back({result.fault_names[f], f, values_of(result, f, value)});
  if (picture.original == nullptr) return curves;
  const CaseResult& original = picture.original->result;
  for (std::size_t f = 0; f < original.fault_names.size(); ++f) {
    const std::string& name = original.fault_names[f];
    const auto now = place_of(result.fault_names, name);
    if (!now) curves.push_back({name + ", before", curves.size(), {}});
    curves[now.value_or(curves.size() - 1)].before = values_of(original, f, value);
  }
  return curves;
}

/// A line of a compartment. Those with one history are one line with both names.
void add_region(figure::Curve curve, std::size_t region, figure::HistoryPanel& panel) {
  for (figure::Curve& one : panel.curves) {
    if (one.values != curve.values || one.before != curve.before) continue;
    one.name += ", " + curve.name;
    return;
  }
  // From the colours' other end: a compartment does not look like a fault.
  curve.colour = 6 + 7 * region;
  panel.curves.push_back(std::move(curve));
}

/// Changes of pressure of a compartment, bar; none where it is none of the result's.
std::vector<double> pressures_of(const CaseResult& result, const std::string& region) {
  const auto r = place_of(result.region_names, region);
  if (!r) return {};
  return mapped(result.steps, [&](const StepResult& step) {
    return *r < step.pressure_change.size() ? step.pressure_change[*r] / kBarInPascal
                                            : std::nan("");
  });
}

/// Of a flow result these are means over the compartments, which the label says.
figure::HistoryPanel pressure_panel(const Chosen& chosen) {
  const CaseResult& result = chosen.result();
  const CasePicture* original = chosen.picture.original;
  const bool is_mean = chosen.scene().pressure_field.is_given();
  figure::HistoryPanel panel{is_mean ? "mean Δp, bar" : "Δp, bar", {}, {}, {0}, 120};
  for (std::size_t r = 0; r < result.region_names.size(); ++r) {
    figure::Curve curve{result.region_names[r], 0, pressures_of(result, result.region_names[r])};
    if (original != nullptr) curve.before = pressures_of(original->result, curve.name);
    add_region(std::move(curve), r, panel);
  }
  return panel;
}

/// Changes of temperature of a compartment, K; none where nothing says them. Results of older
/// programs have none, where those that stages change follow from the scene.
std::vector<double> temperatures_of(const CasePicture& picture, const std::string& region) {
  const CaseResult& result = picture.result;
  const auto r = place_of(result.region_names, region);
  const auto has = [&](const StepResult& step) { return r && *r < step.temperature_change.size(); };
  if (std::ranges::any_of(result.steps, has)) {
    return mapped(result.steps, [&](const StepResult& step) {
      return has(step) ? step.temperature_change[*r] : std::nan("");
    });
  }
  for (const TemperatureHistory& history : picture.scene.temperature) {
    if (picture.scene.pressure.at(static_cast<std::size_t>(history.region)).region != region)
      continue;
    return mapped(result.steps, [&](const StepResult& step) {
      return step.time < history.time.front() ? 0.0
                                              : value_at(history.time, history.change, step.time);
    });
  }
  return {};
}

/// Of regions whose temperature the stages change, and of all where a flow result does: means.
figure::HistoryPanel temperature_panel(const Chosen& chosen) {
  const Scene& scene = chosen.scene();
  const bool is_mean = scene.temperature_field.is_given();
  figure::HistoryPanel panel{is_mean ? "mean ΔT, K" : "ΔT, K", {}, {}, {0}, 120};
  for (std::size_t r = 0; r < scene.pressure.size(); ++r) {
    if (!is_mean && !contains(scene.temperature, static_cast<int>(r), &TemperatureHistory::region))
      continue;
    figure::Curve curve{scene.pressure[r].region, 0, {}};
    curve.values = temperatures_of(chosen.picture, curve.name);
    if (curve.values.empty()) continue;
    if (chosen.picture.original != nullptr)
      curve.before = temperatures_of(*chosen.picture.original, curve.name);
    add_region(std::move(curve), r, panel);
  }
  return panel;
}

std::string ending_of(const CaseResult& result) {
  if (in_equilibrium(result.outcome)) return "";
  return concat("; the history ends early (", to_string(result.outcome), ")");
}

}  // namespace

std::string draw_history(const Chosen& chosen) {
  const CaseResult& result = chosen.result();
  figure::HistoryChart chart;
  chart.ticks = date_ticks(chosen.picture);
  chart.time_label = chart.ticks.empty() ? "time, " + time_unit_text(chosen.picture) : "date";
  const auto times = [&](const CaseResult& of) {  // in the unit of the axis
    return mapped(of.steps, [&](const StepResult& step) { return time_of(result, step.time); });
  };
  chart.time = times(result);
  if (chosen.picture.original != nullptr)
    chart.time_before = times(chosen.picture.original->result);
  chart.stages = stage_spans(result);
  chart.marks = event_marks(result);
  if (chosen.request.with_cursor) chart.cursor = chart.time[chosen.step];
  const auto draw_panel = [&](const char* title, const char* label, auto value) {
    chart.title = title;
    chart.panels.push_back({label, curves_of(chosen.picture, value), {}, {0}, 260});
  };
  if (chosen.request.chart == CaseChart::history) {
    draw_panel("How near each fault is to sliding: χ̄", "χ̄",
               [](const FaultMetrics& m) { return m.chi_bar; });
    chart.panels.back().levels = {{1, "strength reached"}, {0.8, ""}};
    chart.panels.back().always = {0, 1};
    chart.panels.back().headroom = 0.08;
  } else if (chosen.request.chart == CaseChart::thickness) {
    draw_panel("Down-dip length with χ > 0.8", "length, m",
               [](const FaultMetrics& m) { return m.thickness_chi_080_max; });
  } else {
    draw_panel("Largest slip of each fault", "slip, mm",
               [](const FaultMetrics& m) { return m.max_slip / kMillimetre; });
  }
  chart.remark = words_of_original(chosen.picture) + subject_of(chosen.picture) + ending_of(result);
  if (!result.region_names.empty()) chart.panels.push_back(pressure_panel(chosen));
  if (chosen.scene().has_temperatures()) {
    figure::HistoryPanel panel = temperature_panel(chosen);
    if (!panel.curves.empty()) chart.panels.push_back(std::move(panel));
  }
  return figure::draw(chart);
}

}  // namespace faultsim::case_figures
