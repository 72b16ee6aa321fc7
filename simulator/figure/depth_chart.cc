#include "simulator/figure/depth_chart.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kBandWidth = 22;

/// The compartments beside a fault, left and right of a line that is the fault, in a strip with the
/// scale of depth.
void draw_band_strip(Svg& svg, const Box& box, const Axis& depth,
                     const std::vector<DepthBand>& bands) {
  const Panel scale(svg, box, {"", 0, 1, {}}, depth);
  const auto y_of = [&](double d) {
    return box.bottom() - box.height * std::clamp(depth.share(d), 0.0, 1.0);
  };
  for (const DepthBand& band : bands) {
    const double top = y_of(band.top), base = y_of(band.base);
    const Box block{band.on_plus_side ? box.x + kBandWidth : box.x, top, kBandWidth,
                    std::max(base - top, 0.0)};
    svg.rect(block, kReservoir, {kFrame, 0.75});
    svg.text({block.x + kBandWidth / 2 + 4, (top + base) / 2},
             fitted(band.name, block.height - 4, kTickSize),
             {.size = kTickSize, .colour = kInk, .anchor = Anchor::middle, .rotation = -90});
  }
  svg.line({box.x + kBandWidth, box.y}, {box.x + kBandWidth, box.bottom()}, {kInk, 1.5});
}

void draw_band_edges(Panel& panel, const std::vector<DepthBand>& bands) {
  for (const DepthBand& band : bands) {
    const Stroke stroke{"#b08900", 1, band.on_plus_side ? "2 3" : "6 3"};
    panel.line_at_y(band.top, stroke);
    panel.line_at_y(band.base, stroke);
  }
}

std::vector<double> values_of(const DepthColumn& column) {
  std::vector<double> values;
  for (const Curve& curve : column.curves) {
    for (const auto* list : {&curve.values, &curve.before})
      values.insert(values.end(), list->begin(), list->end());
  }
  return values;
}

/// Names of a column's curves below its axis: a line of each, and what it is.
void draw_column_key(Svg& svg, const Box& box, const DepthColumn& column) {
  if (column.curves.size() < 2) return;
  double y = box.bottom() + 16;
  for (const Curve& curve : column.curves) {
    svg.line({box.x, y - 4}, {box.x + 22, y - 4}, fault_stroke(curve.colour));
    svg.text({box.x + 28, y}, fitted(curve.name, box.width - 8, kTickSize),
             {kTickSize, fault_ink(curve.colour)});
    y += 15;
  }
}

Axis depth_axis(std::vector<double> depths, const std::vector<double>& more, double height) {
  depths.insert(depths.end(), more.begin(), more.end());
  Axis axis = axis_over("depth, m", depths, {}, static_cast<int>(height / 45));
  const auto [low, high] = std::ranges::minmax_element(depths);
  const double from = depths.empty() ? 1 : *high, to = depths.empty() ? 0 : *low;
  return from > to ? axis_between(axis.label, from, to, static_cast<int>(height / 45))
                   : axis_between(axis.label, from + 1, to - 1, 4);
}

}  // namespace

std::string draw(const DepthChart& chart) {
  constexpr double kLeft = 70, kGap = 26, kColumn = 138, kHeight = 430;
  std::size_t most = 0;
  for (const DepthColumn& column : chart.columns) most = std::max(most, column.curves.size());
  const double n = static_cast<double>(chart.columns.size());
  const double width = kLeft + 2 * kBandWidth + n * (kColumn + kGap) + 16;
  const double heading = (chart.remark.empty() ? 30 : 48) + 44;
  Svg svg(width, heading + kHeight + 14 + (most > 1 ? 15 * static_cast<double>(most) : 0),
          chart.title);
  draw_heading(svg, chart.title, chart.remark, 16);
  const Axis depth = depth_axis(chart.depth, chart.depth_before, kHeight);
  const Box strip{kLeft, heading, 2 * kBandWidth, kHeight};
  draw_band_strip(svg, strip, depth, chart.bands);
  double x = strip.right() + kGap;
  for (const DepthColumn& column : chart.columns) {
    const Box box{x, heading, kColumn, kHeight};
    Panel panel(svg, box, axis_over(column.label, values_of(column), column.always, 4), depth,
                {.y_labels = false, .x_on_top = true});
    draw_band_edges(panel, chart.bands);
    for (const Level& level : column.levels) panel.line_at_x(level.value, {kFaint, 1, "5 4"});
    for (const Curve& curve : column.curves)
      panel.curve(curve.before, chart.depth_before, before_stroke(curve.colour));
    for (const Curve& curve : column.curves) {
      panel.curve(curve.values, chart.depth, fault_stroke(curve.colour));
    }
    panel.frame();
    draw_column_key(svg, box, column);
    x += kColumn + kGap;
  }
  return svg.finish();
}

namespace {

using Kind = FaceColours::Kind;

/// Lines across a face, which tell its state without colours. @param corners  px, four of them.
void draw_state_lines(Svg& svg, const std::vector<Point>& corners, double state) {
  if (state < 0.5 || corners.size() != 4) return;
  svg.line(corners[0], corners[2], {kInk, 0.6});
  if (state > 1.5) svg.line(corners[1], corners[3], {"#ffffff", 0.9});
}

/// The three states by name beside what they look like, ending at `right`.
void draw_state_key(Svg& svg, double right, double y) {
  double x = right - 220;
  for (const auto& [state, name] : {std::pair(0.0, "sticks"), {1.0, "slips"}, {2.0, "is open"}}) {
    const Box box{x, y, 18, 12};
    svg.rect(box, colour_of({.kind = Kind::state}, state), {kFrame, 0.75});
    draw_state_lines(
        svg,
        {{box.x, box.y}, {box.right(), box.y}, {box.right(), box.bottom()}, {box.x, box.bottom()}},
        state);
    svg.text({x + 23, y + 10}, name, {kLabelSize, kInk});
    x += 78;
  }
}

/// The height that the words below a scale take, px.
double scale_height(const FaceColours& colours) { return colours.same.empty() ? 0 : 15; }

void draw_colour_key(Svg& svg, const FaceColours& colours, Point place, double width) {
  if (colours.kind == Kind::chi) return draw_chi_scale(svg, place, width);
  if (colours.kind == Kind::state) return draw_state_key(svg, place.x + width, place.y);
  draw_scale(svg, colours, place, width);
  svg.text({place.x + width, place.y + 38}, colours.same, {kTickSize, kFaint, Anchor::end});
}

/// Faces in their colours, then the outlines of those that are marked, over their neighbours.
void draw_faces(Svg& svg, const Panel& panel, const FaultMap& map, const FaceColours& colours) {
  for (const bool outlines : {false, true}) {
    for (const FaultCell& cell : map.cells) {
      if (outlines && !cell.is_marked) continue;
      std::vector corners =
          mapped(cell.corners, [&](const Point& corner) { return panel.at(corner.x, corner.y); });
      if (outlines) {
        svg.polygon(corners, "none", {kInk, 0.9});
        continue;
      }
      const std::string fill = colour_of(colours, cell.value);
      svg.polygon(corners, fill, {fill, 0.8});  // the seams between cells are closed
    }
  }
  if (map.colours.kind != Kind::state) return;
  for (const FaultCell& cell : map.cells) {
    draw_state_lines(
        svg,
        mapped(cell.corners, [&](const Point& corner) { return panel.at(corner.x, corner.y); }),
        cell.value);
  }
}

}  // namespace

std::string draw(const FaultMap& map) {
  constexpr double kLeft = 70, kWidth = 860, kHeight = 300;
  std::vector<double> across, depths;
  FaceColours colours = map.colours;
  for (const FaultCell& cell : map.cells) {
    colours.hold(cell.value);
    for (const Point& corner : cell.corners) {
      across.push_back(corner.x);
      depths.push_back(corner.y);
    }
  }
  const double heading = map.remark.empty() ? 44 : 62;
  Svg svg(kWidth, heading + kHeight + 92 + scale_height(colours), map.title);
  draw_heading(svg, map.title, map.remark, 16);
  const Axis depth = depth_axis(depths, {}, kHeight);
  const Box strip{kLeft, heading, 2 * kBandWidth, kHeight};
  draw_band_strip(svg, strip, depth, map.bands);
  double low = 0, high = 1;
  if (!across.empty()) {
    low = *std::ranges::min_element(across);
    high = *std::ranges::max_element(across);
  }
  if (!(high > low)) high = low + 1;
  const Box box{strip.right() + 14, heading, kWidth - strip.right() - 14 - 24, kHeight};
  Panel panel(svg, box, axis_between(map.across, low, high, 8), depth, {.y_labels = false});
  draw_faces(svg, panel, map, colours);
  draw_band_edges(panel, map.bands);
  panel.frame();
  const double y = box.bottom() + 54;
  draw_colour_key(svg, colours, {box.right() - 250, y}, 240);
  if (!map.marked.empty()) {
    svg.rect({box.x, y, 14, 10}, "none", {kInk, 0.9});
    svg.text({box.x + 20, y + 10}, map.marked, {kLabelSize, kInk});
  }
  return svg.finish();
}

}  // namespace faultsim::figure
