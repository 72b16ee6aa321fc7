#include "simulator/figure/log_chart.h"

#include <cmath>

#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kLogWidth = 860, kLogHeight = 480, kLogLeft = 84, kLogRight = 190;

/// Whole decades, in their exponents.
Axis decades(const std::string& label, const std::vector<double>& exponents) {
  Axis axis = axis_over(label, exponents);
  axis.from = std::floor(axis.from), axis.to = std::ceil(axis.to);
  axis.ticks.clear();
  for (double k = axis.from; k <= axis.to; ++k)
    axis.ticks.push_back({k, plain_number(std::pow(10.0, k))});
  return axis;
}

}  // namespace

std::string draw(const LogChart& chart) {
  std::vector<double> all_x, all_y;
  for (const LogSeries& one : chart.series) {
    for (const LogPoint& point : one.points)
      all_x.push_back(std::log10(point.x)), all_y.push_back(std::log10(point.y));
  }
  Svg svg(kLogWidth, kLogHeight, chart.title);
  const double top = draw_heading(svg, chart.title, "", 16) + 12;
  Panel panel(svg, {kLogLeft, top, kLogWidth - kLogLeft - kLogRight, kLogHeight - top - 48},
              decades(chart.x_label, all_x), decades(chart.y_label, all_y));
  std::vector<EndLabel> labels;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const LogSeries& one = chart.series[k];
    const Stroke stroke = fault_stroke(k);
    std::vector<double> x, y;
    for (const LogPoint& point : one.points) {
      x.push_back(std::log10(point.x)), y.push_back(std::log10(point.y));
      const Point place = panel.at(x.back(), y.back());
      svg.circle(place, 4, stroke.colour);
      svg.text({place.x, place.y - 8}, point.name, {kTickSize, fault_ink(k), Anchor::middle});
    }
    panel.curve(x, y, stroke);
    if (!x.empty()) labels.push_back({one.name, panel.at(x.back(), y.back()), k});
  }
  panel.frame();
  draw_end_labels(svg, labels, panel.box());
  return svg.finish();
}

}  // namespace faultsim::figure
