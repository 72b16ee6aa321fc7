#include "simulator/figure/outcome_map.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr std::array<const char*, kCaseClasses> kClassColours = {"#3b82b8", "#7b5ea7", "#e08a1e",
                                                                 "#6e0a28", "#6b6b6b"};

/// A dot of a class: circle, square with a stroke, square, diamond, cross.
void draw_case(Svg& svg, Point p, CaseClass kind, double r) {
  const std::string colour = kClassColours[static_cast<std::size_t>(kind)];
  switch (kind) {
    case CaseClass::holds:
      svg.circle(p, r, "#ffffff", {colour, 1.4});
      return;
    case CaseClass::undecided:
      svg.rect({p.x - r, p.y - r, 2 * r, 2 * r}, "#ffffff", {colour, 1.2});
      svg.line({p.x - r, p.y + r}, {p.x + r, p.y - r}, {colour, 1.2});
      return;
    case CaseClass::slides:
      svg.rect({p.x - r, p.y - r, 2 * r, 2 * r}, colour, {"#ffffff", 0.5});
      return;
    case CaseClass::event:
      svg.polygon(
          {{p.x, p.y - 1.5 * r}, {p.x + 1.5 * r, p.y}, {p.x, p.y + 1.5 * r}, {p.x - 1.5 * r, p.y}},
          colour, {"#ffffff", 0.5});
      return;
    case CaseClass::ended_early:
      svg.line({p.x - r, p.y - r}, {p.x + r, p.y + r}, {colour, 1.5});
      svg.line({p.x - r, p.y + r}, {p.x + r, p.y - r}, {colour, 1.5});
      return;
  }
}

Axis map_axis(const std::string& label, const std::vector<double>& values,
              const std::vector<std::string>& words) {
  if (words.empty()) {
    const Axis axis = axis_over(label, values, {}, 6);
    const double margin = 0.03 * (axis.to - axis.from);
    return {label, axis.from - margin, axis.to + margin, axis.ticks};
  }
  Axis axis{label, -0.5, static_cast<double>(words.size()) - 0.5, {}};
  for (std::size_t k = 0; k < words.size(); ++k) {
    axis.ticks.push_back({static_cast<double>(k), words[k]});
  }
  return axis;
}

void draw_dots(Svg& svg, const Panel& panel, const OutcomeMap& map) {
  const double r = map.x.size() > 600 ? 2.2 : 3.4;
  for (int kind = 0; kind < kCaseClasses; ++kind) {  // bad ones last, on top
    for (std::size_t k = 0; k < map.x.size(); ++k) {
      if (static_cast<int>(map.kind[k]) != kind || !panel.holds(map.x[k], map.y[k])) continue;
      draw_case(svg, panel.at(map.x[k], map.y[k]), map.kind[k], r);
    }
  }
}

struct Bin {
  long n_decided = 0, n_slide = 0, n_undecided = 0;
};

void draw_bin(Svg& svg, const Bin& bin, Point corner, double w, double h) {
  if (bin.n_decided > 0) {
    const double share = static_cast<double>(bin.n_slide) / static_cast<double>(bin.n_decided);
    svg.rect({corner.x, corner.y, w, h}, sequential_colour(0.08 + 0.92 * share));
  }
  if (bin.n_undecided > bin.n_decided) {
    const std::string colour = kClassColours[static_cast<std::size_t>(CaseClass::undecided)];
    svg.line({corner.x, corner.y + h}, {corner.x + w, corner.y}, {colour, 1});
  }
}

void draw_bins(Svg& svg, const Panel& panel, const OutcomeMap& map) {
  constexpr int kColumns = 48, kRows = 30;
  std::vector<Bin> bins(std::size_t{kColumns} * kRows);
  const auto bin_at = [&bins](int i, int j) -> Bin& {
    return bins[static_cast<std::size_t>(j) * kColumns + static_cast<std::size_t>(i)];
  };
  for (std::size_t k = 0; k < map.x.size(); ++k) {
    if (!panel.holds(map.x[k], map.y[k]) || map.kind[k] == CaseClass::ended_early) continue;
    const int i =
        std::clamp(static_cast<int>(panel.x().share(map.x[k]) * kColumns), 0, kColumns - 1);
    const int j = std::clamp(static_cast<int>(panel.y().share(map.y[k]) * kRows), 0, kRows - 1);
    Bin& bin = bin_at(i, j);
    if (map.kind[k] == CaseClass::undecided) {
      ++bin.n_undecided;
      continue;
    }
    ++bin.n_decided;
    bin.n_slide += map.kind[k] == CaseClass::holds ? 0 : 1;
  }
  const double w = panel.box().width / kColumns, h = panel.box().height / kRows;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      draw_bin(svg, bin_at(i, j), {panel.box().x + i * w, panel.box().bottom() - (j + 1) * h}, w,
               h);
    }
  }
}

void draw_class_key(Svg& svg, const OutcomeMap& map, Point place) {
  std::array<long, kCaseClasses> counts = {};
  for (const CaseClass kind : map.kind) ++counts[static_cast<std::size_t>(kind)];
  for (int k = 0; k < kCaseClasses; ++k) {
    const long count = counts[static_cast<std::size_t>(k)];
    if (count == 0) continue;
    const auto kind = static_cast<CaseClass>(k);
    const std::string word =
        concat(to_string(kind), " (", plain_number(static_cast<double>(count), 6), ")");
    draw_case(svg, {place.x, place.y - 4}, kind, 3.8);
    svg.text({place.x + 10, place.y}, word, {kLabelSize, kInk});
    place.x += 30 + text_width(word, kLabelSize);
  }
}

void draw_share_key(Svg& svg, Point place) {
  svg.text({place.x, place.y}, "share of decided cases with sliding:  0", {kLabelSize, kInk});
  const double x = place.x + text_width("share of decided cases with sliding:  0", kLabelSize) + 4;
  for (int k = 0; k < 24; ++k) {
    svg.rect({x + 6 * k, place.y - 10, 6.3, 11}, sequential_colour(0.08 + 0.92 * (k + 0.5) / 24));
  }
  svg.text({x + 152, place.y}, "1", {kLabelSize, kInk});
}

}  // namespace

std::string draw(const OutcomeMap& map) {
  FAULTSIM_DEMAND(map.x.size() == map.y.size() && map.x.size() == map.kind.size(),
                  "columns of different length");
  constexpr double kWidth = 860, kHeight = 420, kRight = 24;
  double words = 40;
  for (const std::string& word : map.y_words) words = std::max(words, text_width(word, kTickSize));
  const double left = std::min(words, 180.0) + 36;
  const double heading = (map.remark.empty() ? 30 : 48) + 26;
  Svg svg(kWidth, heading + kHeight + 48, map.title);
  draw_heading(svg, map.title, map.remark, 16);
  Panel panel(svg, {left, heading, kWidth - left - kRight, kHeight},
              map_axis(map.x_label, map.x, map.x_words), map_axis(map.y_label, map.y, map.y_words));
  if (map.x.size() <= kMostDots) {
    draw_class_key(svg, map, {left + 6, heading - 10});
    draw_dots(svg, panel, map);
  } else {
    draw_share_key(svg, {left, heading - 10});
    draw_bins(svg, panel, map);
  }
  panel.frame();
  return svg.finish();
}

}  // namespace faultsim::figure
