#include "simulator/figure/history_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kHistoryWidth = 860, kHistoryLeft = 72, kPanelGap = 18;

/// Room for the names at the ends of curves, px; very long ones are cut.
double right_margin(const HistoryChart& chart) {
  constexpr double kLeast = 96, kMost = 190, kToTheName = 20, kBold = 1.12;
  double widest = 0;
  for (const HistoryPanel& panel : chart.panels)
    for (const Curve& curve : panel.curves)
      widest = std::max(widest, kBold * text_width(curve.name, kLabelSize));
  return std::clamp(widest + kToTheName, kLeast, kMost);
}

/// A stage's name above its middle; in two lines where one is too short for it.
void draw_stage_name(Svg& svg, const std::string& name, Point middle, double width) {
  const TextStyle style{kTickSize, kFaint, Anchor::middle};
  std::size_t cut = std::string::npos;
  for (std::size_t k = name.find(' '); k != std::string::npos; k = name.find(' ', k + 1)) {
    const auto from_middle = [&](std::size_t at) {
      return std::max(at, name.size() - at) - std::min(at, name.size() - at);
    };
    if (cut == std::string::npos || from_middle(k) < from_middle(cut)) cut = k;
  }
  if (text_width(name, kTickSize) <= width || cut == std::string::npos) {
    svg.text(middle, fitted(name, width, kTickSize), style);
    return;
  }
  svg.text({middle.x, middle.y - 13}, fitted(name.substr(0, cut), width, kTickSize), style);
  svg.text(middle, fitted(name.substr(cut + 1), width, kTickSize), style);
}

void draw_stages(Svg& svg, Panel& panel, const HistoryChart& chart, bool with_names) {
  bool shaded = true;
  for (const StageSpan& stage : chart.stages) {
    if (shaded) panel.band_in_x(stage.from, stage.to, kShade);
    shaded = !shaded;
    panel.line_at_x(stage.to, {kGrid, 1});
    if (!with_names) continue;
    const Point left = panel.at(stage.from, panel.y().to), right = panel.at(stage.to, panel.y().to);
    draw_stage_name(svg, stage.name, {(left.x + right.x) / 2, left.y - 7}, right.x - left.x - 4);
  }
}

/// The last value of a line and where it is; nothing where it has none.
std::optional<Point> end_of(const Panel& panel, const std::vector<double>& time,
                            const std::vector<double>& values) {
  for (std::size_t k = std::min(time.size(), values.size()); k-- > 0;) {
    if (std::isfinite(values[k])) return panel.at(time[k], values[k]);
  }
  return std::nullopt;
}
/// Of a curve; of one that was only there before a change, the end of that.
std::optional<Point> end_of(const Panel& panel, const HistoryChart& chart, const Curve& curve) {
  const std::optional<Point> end = end_of(panel, chart.time, curve.values);
  return end ? end : end_of(panel, chart.time_before, curve.before);
}

Axis axis_of(const HistoryPanel& panel) {
  std::vector<double> values;
  for (const Curve& curve : panel.curves)
    for (const auto* list : {&curve.values, &curve.low, &curve.high, &curve.before})
      values.insert(values.end(), list->begin(), list->end());
  Axis axis = axis_over(panel.label, values, panel.always, 5);
  axis.to += panel.headroom * (axis.to - axis.from);
  return axis;
}

void draw_panel(Svg& svg, Panel& panel, const HistoryChart& chart, const HistoryPanel& content) {
  for (const Level& level : content.levels) {
    panel.line_at_y(level.value, {kFaint, 1, "5 4"});
    svg.text({panel.box().x + 5, panel.at(panel.x().from, level.value).y - 4}, level.name,
             {kTickSize, kFaint});
  }
  for (const Curve& curve : content.curves)
    panel.curve(chart.time_before, curve.before, before_stroke(curve.colour));
  std::vector<EndLabel> labels;
  for (const Curve& curve : content.curves) {
    const Stroke stroke = fault_stroke(curve.colour);
    panel.curve(chart.time, curve.values, stroke);
    for (const auto* bound : {&curve.low, &curve.high})
      panel.curve(chart.time, *bound, {stroke.colour, 0.75, stroke.dash});
    if (const auto end = end_of(panel, chart, curve)) {
      labels.push_back({curve.name, *end, curve.colour});
    }
  }
  for (const TimeMark& mark : chart.marks) {
    panel.line_at_x(mark.time, {"#b0003a", 1, "2 2"});
  }
  panel.frame();
  draw_end_labels(svg, labels, panel.box());
}

/// Words at the top of the first panel; those that would stand in another are left out: the line
/// is there, and tables have them all.
void draw_marks(Svg& svg, const Panel& panel, const HistoryChart& chart) {
  double taken = -INFINITY;
  for (const TimeMark& mark : chart.marks) {
    if (!panel.holds(mark.time, panel.y().from)) continue;
    const Point top = panel.at(mark.time, panel.y().to);
    svg.polygon({{top.x - 4, top.y}, {top.x + 4, top.y}, {top.x, top.y + 7}}, "#b0003a");
    if (top.x + 6 < taken) continue;
    svg.text({top.x + 6, top.y + 12}, mark.word, {kTickSize, "#b0003a"});
    taken = top.x + 12 + text_width(mark.word, kTickSize);
  }
}

/// From the first to the last time of lines and stages.
std::pair<double, double> ends_of_time(const HistoryChart& chart) {
  double first = INFINITY, last = -INFINITY;
  const auto take = [&](double from, double to) {
    first = std::min(first, from), last = std::max(last, to);
  };
  for (const auto* time : {&chart.time, &chart.time_before})
    if (!time->empty()) take(time->front(), time->back());
  if (first > last) take(0, 1);
  for (const StageSpan& stage : chart.stages) take(stage.from, stage.to);
  return {first, last > first ? last : first + 1};
}

}  // namespace

std::string draw(const HistoryChart& chart) {
  double height = (chart.remark.empty() ? 30 : 48) + 34 + 48;
  for (const HistoryPanel& panel : chart.panels) height += panel.height + kPanelGap;
  Svg svg(kHistoryWidth, height - kPanelGap, chart.title);
  const double heading = draw_heading(svg, chart.title, chart.remark, 16);
  const auto [first, last] = ends_of_time(chart);
  Axis time = axis_between(chart.time_label, first, last, 10);
  if (!chart.ticks.empty()) time.ticks = chart.ticks;
  double y = heading + 34;
  Box all{kHistoryLeft, y, kHistoryWidth - kHistoryLeft - right_margin(chart), 0};
  for (std::size_t k = 0; k < chart.panels.size(); ++k) {
    const HistoryPanel& content = chart.panels[k];
    Panel panel(svg, {kHistoryLeft, y, all.width, content.height}, time, axis_of(content),
                {.x_labels = k + 1 == chart.panels.size()});
    draw_stages(svg, panel, chart, k == 0);
    for (const Tick& tick : panel.y().ticks) panel.line_at_y(tick.value, {kGrid, 1});
    draw_panel(svg, panel, chart, content);
    if (k == 0) draw_marks(svg, panel, chart);
    all.height = panel.box().bottom() - all.y;
    y += content.height + kPanelGap;
  }
  if (chart.cursor) {
    const double zero = all.x + all.width * time.share(0), one = all.x + all.width * time.share(1);
    svg.begin_group({{"data-cursor", coordinate(*chart.cursor)},
                     {"data-x", coordinate(zero) + " " + coordinate(one)}});
    const double x = all.x + all.width * time.share(*chart.cursor);
    svg.line({x, all.y}, {x, all.bottom()}, {kInk, 1.5});
    svg.end_group();
  }
  return svg.finish();
}

}  // namespace faultsim::figure
