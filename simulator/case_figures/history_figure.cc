#include <algorithm>
#include <cmath>

#include "simulator/case_figures/chosen.h"
#include "simulator/common/errors.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/history_chart.h"

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
    const auto same = std::ranges::find(panel.curves, curve.values, &figure::Curve::values);
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

}  // namespace

std::string draw_history(const Chosen& chosen) {
  const CaseResult& result = chosen.result();
  figure::HistoryChart chart;
  chart.time_label = in_days(result) ? "time, days" : "time, years";
  for (const StepResult& step : result.steps) chart.time.push_back(time_of(result, step.time));
  chart.stages = stage_spans(result);
  chart.marks = event_marks(result);
  if (chosen.request.with_cursor) chart.cursor = chart.time[chosen.step];
  const auto draw_panel = [&](const char* title, const char* label, auto value) {
    chart.title = title;
    chart.panels.push_back({label, curves_of(result, value), {}, {0}, 260});
  };
  if (chosen.request.chart == CaseChart::history) {
    draw_panel("How near each fault is to sliding: χ̄", "χ̄",
               [](const FaultMetrics& m) { return m.chi_bar; });
    chart.panels.back().levels = {{1, "strength reached"}, {0.8, "0.8"}};
    chart.panels.back().always = {0, 1};
  } else if (chosen.request.chart == CaseChart::thickness) {
    draw_panel("Down-dip length with χ > 0.8", "length, m",
               [](const FaultMetrics& m) { return m.thickness_chi_080_max; });
  } else {
    draw_panel("Largest slip of each fault", "slip, mm",
               [](const FaultMetrics& m) { return m.max_slip / kMillimetre; });
  }
  chart.remark = subject_of(chosen.picture) + ending_of(result);
  if (!result.region_names.empty()) chart.panels.push_back(pressure_panel(result));
  return figure::draw(chart);
}

}  // namespace faultsim::case_figures
