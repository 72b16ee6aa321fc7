#include "simulator/figure/range_bars.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kRowHeight = 19, kBar = 12, kKeySize = 10;

struct FillLook {
  const char* colour;
  const char* lines;
  bool rises, falls;  ///< lines of the texture.
};
constexpr std::array<FillLook, 5> kLooks = {{{"#b9dcc4", "#2f6b46", false, false},
                                             {"#f0b04a", "#7a4a00", true, false},
                                             {"#c8503c", "#5a0d02", true, true},
                                             {"#c9ced6", "#5a6068", false, false},
                                             {"#ffffff", "#8c8c8c", false, true}}};

/// Lines at 45 degrees through a box, a few pixels apart, ending at its edges.
void draw_lines(Svg& svg, const Box& box, bool rises, const Stroke& stroke) {
  constexpr double kApart = 6;
  for (double c = kApart; c < box.width + box.height; c += kApart) {
    const double from = std::max(0.0, c - box.height), to = std::min(c, box.width);
    if (to - from < 0.5) continue;  // a corner
    const auto at = [&](double x) {
      return Point{box.x + x, rises ? box.y + c - x : box.bottom() - c + x};
    };
    svg.line(at(from), at(to), stroke);
  }
}

double name_width(const RangeBars& bars) {
  double widest = 40;
  for (const RangeBars::Row& row : bars.rows)
    widest = std::max(widest, text_width(row.name, kTickSize));
  return std::min(widest, 0.34 * bars.width) + 10;
}

double note_width(const RangeBars& bars) {
  double widest = 0;
  for (const RangeBars::Row& row : bars.rows)
    widest = std::max(widest, text_width(row.note, kTickSize));
  return std::min(widest, 0.45 * bars.width) + 14;
}

Axis axis_of(const RangeBars& bars) {
  if (bars.axis) return *bars.axis;
  std::vector<double> values;
  for (const RangeBars::Row& row : bars.rows) {
    for (const RangeBars::Range& one : row.ranges) values.insert(values.end(), {one.from, one.to});
    if (row.bounds) values.insert(values.end(), {row.bounds->low, row.bounds->high});
  }
  for (const RangeBars::Mark& one : bars.marks) values.push_back(one.at);
  return axis_over(bars.label, values, {}, 6);
}

/// The fills that have words, side by side; as many lines as they take.
double draw_key(Svg& svg, const RangeBars& bars, Point place) {
  double x = place.x, y = place.y;
  bool is_any = false;
  for (std::size_t k = 0; k < std::min(bars.key.size(), kLooks.size()); ++k) {
    if (bars.key[k].empty()) continue;
    const double width = 22 + text_width(bars.key[k], kKeySize) + 12;
    if (is_any && x + width > bars.width) x = place.x, y += 15;
    draw_fill(svg, {x, y - 9, 16, 10}, static_cast<RangeFill>(k));
    svg.text({x + 21, y}, bars.key[k], {kKeySize, kInk});
    x += width;
    is_any = true;
  }
  return is_any ? y + 8 : place.y - 10;
}

/// A row along the axis that fills the box from left to right.
void draw_row(Svg& svg, const Box& box, const Axis& axis, const RangeBars::Row& row,
              double thickness) {
  const double middle = box.y + box.height / 2;
  const auto at = [&](double value) {
    return box.x + box.width * std::clamp(axis.share(value), 0.0, 1.0);
  };
  for (const RangeBars::Range& one : row.ranges) {
    const auto [a, b] = std::minmax({at(one.from), at(one.to)});
    if (!(b - a >= 0.05)) continue;
    draw_fill(svg, {a, middle - thickness / 2, b - a, thickness}, one.fill);
  }
  if (!row.bounds) return;
  const double reach = 0.38 * thickness;
  if (std::isfinite(row.bounds->low) && std::isfinite(row.bounds->high)) {
    const double low = at(row.bounds->low), high = at(row.bounds->high);
    svg.line({low, middle}, {high, middle}, {kInk, 1.5});
    for (const double x : {low, high})
      svg.line({x, middle - reach}, {x, middle + reach}, {kInk, 1.5});
  }
  if (std::isfinite(row.bounds->value))
    svg.circle({at(row.bounds->value), middle}, 3.5, kInk, {"#ffffff", 1});
}

}  // namespace

void draw_fill(Svg& svg, const Box& box, RangeFill fill) {
  const FillLook& look = kLooks.at(static_cast<std::size_t>(fill));
  svg.rect(box, look.colour);
  if (look.rises) draw_lines(svg, box, true, {look.lines, 0.9});
  if (look.falls) draw_lines(svg, box, false, {look.lines, 0.9});
  svg.rect(box, "none", {look.lines, 0.75});
}

std::string draw(const RangeBars& bars) {
  const double left = name_width(bars), right = note_width(bars);
  const bool has_key =
      std::ranges::any_of(bars.key, [](const std::string& one) { return !one.empty(); });
  // Drawn twice: how many lines the key takes is known when it is drawn.
  Svg measure(bars.width, 10, "");
  const double under_key = has_key ? draw_key(measure, bars, {4, 12}) : 2;
  const double top = under_key + (bars.marks.empty() ? 2 : 16);
  const double height =
      kRowHeight * static_cast<double>(std::max<std::size_t>(bars.rows.size(), 1));
  Svg svg(bars.width, top + height + 40, bars.title);
  if (has_key) draw_key(svg, bars, {4, 12});
  const Box box{left, top, bars.width - left - right, height};
  Panel panel(svg, box, axis_of(bars), {"", 0, 1, {}});
  double middle = top + kRowHeight / 2;
  for (const RangeBars::Row& row : bars.rows) {
    svg.text({left - 6, middle + 4}, fitted(row.name, left - 8, kTickSize),
             {kTickSize, kInk, Anchor::end});
    draw_row(svg, {box.x, middle - kRowHeight / 2, box.width, kRowHeight}, panel.x(), row, kBar);
    svg.text({box.right() + 8, middle + 4}, fitted(row.note, right - 8, kTickSize),
             {kTickSize, kInk});
    middle += kRowHeight;
  }
  for (const RangeBars::Mark& one : bars.marks) {
    panel.line_at_x(one.at, {kInk, 1.25, "4 3"});
    svg.text({panel.at(one.at, 0).x, top - 4}, one.word, {kKeySize, kInk, Anchor::middle});
  }
  panel.frame();
  return svg.finish();
}

std::string draw_alone(const RangeBars::Row& row, const Axis& axis, double width, double height) {
  Svg svg(width, height, row.name);
  const Box box{1, 1, width - 2, height - 2};
  svg.rect(box, "none", {kFrame, 0.75});
  draw_row(svg, box, axis, row, box.height - 3);
  return svg.finish();
}

std::string draw_swatch(RangeFill fill) {
  Svg svg(20, 12, "");
  draw_fill(svg, {1, 1, 18, 10}, fill);
  return svg.finish();
}

}  // namespace faultsim::figure
