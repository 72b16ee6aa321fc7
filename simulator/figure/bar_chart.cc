#include "simulator/figure/bar_chart.h"

#include <algorithm>
#include <cmath>

#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kBarWidth = 860, kRow = 22, kHeadRow = 26;

double width_of_names(const std::vector<std::string>& names, double least) {
  double widest = least;
  for (const std::string& name : names) widest = std::max(widest, text_width(name, kLabelSize));
  return std::min(widest, 260.0);
}

void draw_whisker(Svg& svg, const Panel& panel, const Bounded& value, double y,
                  const std::string& colour) {
  if (!std::isfinite(value.low) || !std::isfinite(value.high)) return;
  const double low = panel.at(value.low, 0).x, high = panel.at(value.high, 0).x;
  svg.line({low, y}, {high, y}, {colour, 1.25});
  for (const double x : {low, high}) svg.line({x, y - 3}, {x, y + 3}, {colour, 1.25});
}

void draw_bar(Svg& svg, const Panel& panel, const Bounded& value, const Box& row,
              const std::string& fill) {
  const double y = row.y + row.height / 2;
  if (!std::isfinite(value.value)) {
    svg.text({panel.at(panel.x().from, 0).x + 4, y + 4}, "no value", {kTickSize, kFaint});
    return;
  }
  const double zero = panel.at(std::clamp(0.0, panel.x().from, panel.x().to), 0).x;
  const double end = panel.at(value.value, 0).x;
  svg.rect({std::min(zero, end), row.y, std::abs(end - zero), row.height}, fill);
  draw_whisker(svg, panel, value, y, kInk);
}

void draw_key(Svg& svg, const BarChart& chart, Point place) {
  if (chart.second_name.empty()) return;
  svg.rect({place.x, place.y - 9, 12, 9}, fault_stroke(0).colour);
  svg.text({place.x + 17, place.y}, chart.first_name, {kLabelSize, kInk});
  const double x = place.x + 40 + text_width(chart.first_name, kLabelSize);
  svg.rect({x, place.y - 9, 12, 9}, fault_stroke(4).colour);
  svg.text({x + 17, place.y}, chart.second_name, {kLabelSize, kInk});
}

}  // namespace

std::string draw(const BarChart& chart) {
  std::vector<std::string> names;
  std::vector<double> values;
  double height = 0;
  for (const BarChart::Block& block : chart.blocks) {
    height += kHeadRow;
    for (const BarRow& row : block.rows) {
      names.push_back(row.name);
      values.insert(values.end(), {row.first.value, row.first.low, row.first.high});
      for (const Bounded& b : row.second) values.insert(values.end(), {b.value, b.low, b.high});
      height += kRow + (row.second.empty() ? 0 : 10);
    }
  }
  const double left = width_of_names(names, 40) + 24;
  const double heading = (chart.remark.empty() ? 30 : 48) + (chart.second_name.empty() ? 8 : 26);
  Svg svg(kBarWidth, heading + height + 50, chart.title);
  draw_heading(svg, chart.title, chart.remark, 16);
  draw_key(svg, chart, {left, heading - 10});
  const Box box{left, heading, kBarWidth - left - 24, height + 4};
  Panel panel(svg, box, axis_over(chart.label, values, chart.always, 6), {"", 0, 1, {}});
  double y = heading;
  for (const BarChart::Block& block : chart.blocks) {
    svg.rect({box.x + 1, y + 1, box.width - 2, kHeadRow - 8}, kShade);
    svg.text({box.x + 6, y + 14}, fitted(block.name, box.width - 12, kLabelSize),
             {.size = kLabelSize, .bold = true});
    y += kHeadRow;
    for (const BarRow& row : block.rows) {
      const double tall = row.second.empty() ? kRow - 8 : 12;
      svg.text({left - 8, y + 11}, fitted(row.name, left - 16, kLabelSize),
               {kLabelSize, kInk, Anchor::end});
      draw_bar(svg, panel, row.first, {box.x, y, box.width, tall}, fault_stroke(0).colour);
      for (const Bounded& b : row.second) {
        draw_bar(svg, panel, b, {box.x, y + tall + 1, box.width, tall}, fault_stroke(4).colour);
      }
      y += kRow + (row.second.empty() ? 0 : 10);
    }
  }
  panel.frame();
  return svg.finish();
}

std::string draw(const IntervalChart& chart) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const IntervalChart::Row& row : chart.rows) {
    names.push_back(row.name);
    values.insert(values.end(), {row.value.low, row.value.high});
  }
  const double left = width_of_names(names, 40) + 24, right = 130;
  const double heading = chart.remark.empty() ? 38 : 56;
  const double height = 26 * static_cast<double>(std::max<std::size_t>(chart.rows.size(), 1)) + 8;
  Svg svg(kBarWidth, heading + height + 46, chart.title);
  draw_heading(svg, chart.title, chart.remark, 16);
  const Box box{left, heading, kBarWidth - left - right, height};
  Panel panel(svg, box, axis_over(chart.label, values, {0, 1}, 5), {"", 0, 1, {}});
  double y = heading + 17;
  for (const IntervalChart::Row& row : chart.rows) {
    svg.text({left - 8, y + 4}, fitted(row.name, left - 16, kLabelSize),
             {kLabelSize, kInk, Anchor::end});
    draw_whisker(svg, panel, row.value, y, fault_stroke(0).colour);
    if (std::isfinite(row.value.value)) {
      svg.circle({panel.at(row.value.value, 0).x, y}, 4.5, fault_stroke(0).colour, {"#ffffff", 1});
    }
    svg.text({box.right() + 8, y + 4}, row.note, {kTickSize, kFaint});
    y += 26;
  }
  panel.frame();
  return svg.finish();
}

}  // namespace faultsim::figure
