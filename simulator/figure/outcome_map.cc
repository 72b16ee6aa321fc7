#include "simulator/figure/outcome_map.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/figure/limit_line.h"
#include "simulator/figure/outcome_cells.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kMapWidth = 860, kMapHeight = 420, kMapRight = 24;
constexpr std::array<const char*, kCaseClasses> kClassColours = {"#3b82b8", "#7b5ea7", "#e08a1e",
                                                                 "#6e0a28", "#6b6b6b"};
/// Ink and paper of what is written in a cell: they go with its colour, which stays in dark pages.
constexpr const char* kCellInk = "#1b1b1b";
constexpr const char* kCellPaper = "#fdfdfd";
constexpr double kLimitWidth = 2.5;
constexpr double kKeyRow = 20;  // from one line of words to the next

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

// One by one --------------------------------------------------------------------------------------

Axis axis_of_dots(const std::string& label, const std::vector<double>& values,
                  const std::vector<std::string>& words) {
  if (!words.empty()) return side_of(label, values, words).axis;
  const Axis axis = axis_over(label, values, {}, 6);
  const double margin = 0.03 * (axis.to - axis.from);
  return {label, axis.from - margin, axis.to + margin, axis.ticks};
}

double radius_of_dots(const OutcomeMap& map) { return map.x.size() > 600 ? 2.2 : 3.4; }

/// Nothing where they would lie over each other, or are too many.
bool can_be_dots(const OutcomeMap& map, const Box& box) {
  if (map.x.size() > kMostDots) return false;
  const Axis x = axis_of_dots("", map.x, map.x_words), y = axis_of_dots("", map.y, map.y_words);
  std::vector<Point> places;
  for (std::size_t k = 0; k < map.x.size(); ++k)
    places.push_back({box.width * x.share(map.x[k]), box.height * y.share(map.y[k])});
  return !would_overlap(std::move(places), radius_of_dots(map));
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

void draw_dots(Svg& svg, const OutcomeMap& map, const Box& box) {
  draw_class_key(svg, map, {box.x + 6, box.y - 10});
  Panel panel(svg, box, axis_of_dots(map.x_label, map.x, map.x_words),
              axis_of_dots(map.y_label, map.y, map.y_words));
  const double r = radius_of_dots(map);
  for (int kind = 0; kind < kCaseClasses; ++kind) {
    for (std::size_t k = 0; k < map.x.size(); ++k) {
      if (static_cast<int>(map.kind[k]) != kind || !panel.holds(map.x[k], map.y[k])) continue;
      draw_case(svg, panel.at(map.x[k], map.y[k]), map.kind[k], r);
    }
  }
  panel.frame();
}

// Counted in cells --------------------------------------------------------------------------------

/// Strokes to the right and up, as one line that goes back and forth, however wide.
void draw_hatch(Svg& svg, const Box& box) {
  constexpr double kStep = 7;
  svg.rect(box, "#efeaf5");
  std::vector<Point> points;
  bool goes_up = false;
  for (double c = kStep / 2; c < box.width + box.height; c += kStep, goes_up = !goes_up) {
    const Point above{box.x + std::min(c, box.width), box.y + std::max(0.0, c - box.width)};
    const Point below{box.x + std::max(0.0, c - box.height), box.y + std::min(c, box.height)};
    points.push_back(goes_up ? below : above);
    points.push_back(goes_up ? above : below);
  }
  svg.polyline(points, {"#a08cc8", 0.9});
}

void draw_share(Svg& svg, const MapCell& cell, long few, const Box& box) {
  const std::string text = share_text(cell, few);
  const double size = box.width >= 46 ? kTickSize : 9.5;
  const double room = 0.93 * text_width(text, size);  // digits are narrower than letters
  if (room > box.width - 2 || size > box.height - 2) return;
  const Point middle{box.x + box.width / 2, box.y + box.height / 2 + 0.36 * size};
  const double decided = static_cast<double>(cell.n_slide()) / static_cast<double>(cell.n_known());
  const bool on_hatch = cell.n_undecided() > 0;
  if (on_hatch)
    svg.rect({middle.x - room / 2 - 1, middle.y - size + 1, room + 2, size + 1}, kCellPaper);
  svg.text(middle, text,
           {.size = size,
            .colour = !on_hatch && decided > 0.6 ? kCellPaper : kCellInk,
            .anchor = Anchor::middle});
}

/// Decided cases at the left, in the colour of their share that slides; undecided ones at the
/// right.
void draw_cell(Svg& svg, const MapCell& cell, long few, const Box& box) {
  if (cell.n_known() == 0) return;
  const double undecided =
      box.width * static_cast<double>(cell.n_undecided()) / static_cast<double>(cell.n_known());
  if (cell.n_decided() > 0) {
    const double share =
        static_cast<double>(cell.n_slide()) / static_cast<double>(cell.n_decided());
    svg.rect({box.x, box.y, box.width - undecided, box.height}, share_colour(share));
  }
  if (undecided > 0) draw_hatch(svg, {box.right() - undecided, box.y, undecided, box.height});
  draw_share(svg, cell, few, box);
}

/// What colours and hatches mean.
void draw_share_key(Svg& svg, Point place) {
  const auto say = [&](double width, const std::string& words) {
    place.x += width + 6;
    svg.text(place, words, {kLabelSize, kInk});
    place.x += text_width(words, kLabelSize) + 8;
  };
  constexpr int kParts = 20;
  for (int k = 0; k < kParts; ++k)
    svg.rect({place.x + 5.0 * k, place.y - 10, 5.0 * (kParts - k), 11},
             share_colour((k + 0.5) / kParts));
  say(5 * kParts, "0 to 100 % of the decided cases slide");
  draw_hatch(svg, {place.x, place.y - 10, 26, 11});
  say(26, "undecided by the cells (25–75: if none of these slide, if all do)");
}

/// The line along edges of cells, in colours that stay in dark pages as those of the cells do; the
/// pale border tells it from the gaps between cells there.
void draw_limit(Svg& svg, const std::vector<std::pair<Point, Point>>& pieces) {
  for (const Stroke& stroke :
       {Stroke{kCellPaper, kLimitWidth + 3}, Stroke{kCellInk, kLimitWidth}}) {
    for (const auto& [from, to] : pieces) svg.polyline({from, to}, stroke);
  }
}

/// A piece of the line between cells, where there is one, and what it says.
void draw_limit_key(Svg& svg, const LimitLine& limit, Point place) {
  if (!limit.edges.empty()) {
    constexpr double kCell = 13, kHeight = 11;
    const double top = place.y - 10;
    svg.rect({place.x, top, kCell, kHeight}, share_colour(0));
    svg.rect({place.x + kCell, top, kCell, kHeight}, share_colour(0.3));
    draw_limit(svg, {{{place.x + kCell, top}, {place.x + kCell, top + kHeight}}});
    place.x += 2 * kCell + 6;
  }
  const LimitWords words = words_of(limit);
  svg.text(place, words.sentence, {kLabelSize, kInk});
  svg.text({place.x, place.y + kKeyRow}, words.remark, {kLabelSize, kFaint});
}

/// How many cases of each class, in words.
std::string counts_text(const OutcomeMap& map) {
  std::array<long, kCaseClasses> counts = {};
  for (const CaseClass kind : map.kind) ++counts[static_cast<std::size_t>(kind)];
  std::string text;
  for (int k = 0; k < kCaseClasses; ++k) {
    const long count = counts[static_cast<std::size_t>(k)];
    if (count == 0) continue;
    text += concat(text.empty() ? "" : "; ", to_string(static_cast<CaseClass>(k)), ": ",
                   plain_number(static_cast<double>(count), 9));
  }
  if (counts[static_cast<std::size_t>(CaseClass::ended_early)] > 0) text += " (left out)";
  return text;
}

/// Columns and rows of a few values are no larger than they need to be.
Box box_of_cells(const CellGrid& grid, Box box) {
  constexpr double kWidest = 110, kHighest = 46;
  if (!grid.x.levels.empty()) box.width = std::min(box.width, kWidest * grid.x.n);
  if (!grid.y.levels.empty()) box.height = std::min(box.height, kHighest * grid.y.n);
  return box;
}

/// Names of columns and rows, as much of each as has room.
CellGrid with_fitted_names(CellGrid grid, const Box& box) {
  const auto fit = [](Axis& axis, double room) {
    for (Tick& tick : axis.ticks) tick.label = fitted(tick.label, room, kTickSize);
  };
  if (!grid.x.levels.empty()) fit(grid.x.axis, box.width / grid.x.n - 4);
  if (!grid.y.levels.empty()) fit(grid.y.axis, box.x - 30);
  return grid;
}

void draw_cells(Svg& svg, const CellGrid& grid, const LimitLine& limit, const Box& box) {
  Panel panel(svg, box, grid.x.axis, grid.y.axis);
  const double w = box.width / grid.x.n, h = box.height / grid.y.n;
  for (int j = 0; j < grid.y.n; ++j) {
    for (int i = 0; i < grid.x.n; ++i)
      draw_cell(svg, grid.at(i, j), limit.needed,
                {box.x + i * w + 0.5, box.bottom() - (j + 1) * h + 0.5, w - 1, h - 1});
  }
  const auto place = [&](Point p) { return Point{box.x + p.x * w, box.bottom() - p.y * h}; };
  draw_limit(svg, mapped(limit.edges, [&](const auto& edge) {
               return std::pair(place(edge.first), place(edge.second));
             }));
  panel.frame();
}

}  // namespace

std::string draw(const OutcomeMap& map) {
  FAULTSIM_DEMAND(map.x.size() == map.y.size() && map.x.size() == map.kind.size(),
                  "columns of different length");
  if (map.x.empty()) {
    Svg svg(kMapWidth, 80, map.title);
    draw_heading(svg, map.title, map.remark, 16);
    svg.text({16, 66}, "No case with both parameters has a result yet.", {kLabelSize, kFaint});
    return svg.finish();
  }
  double names = 40;
  for (const std::string& word : map.y_words) names = std::max(names, text_width(word, kTickSize));
  const double left = std::min(names, 180.0) + 36;
  const double heading = (map.remark.empty() ? 30 : 48) + 26;
  Box box{left, heading, kMapWidth - left - kMapRight, kMapHeight};
  if (can_be_dots(map, box)) {
    Svg svg(kMapWidth, heading + kMapHeight + 48, map.title);
    draw_heading(svg, map.title, map.remark, 16);
    draw_dots(svg, map, box);
    return svg.finish();
  }
  const CellGrid grid = counted(map);
  const LimitLine limit = limit_line(grid);
  box = box_of_cells(grid, box);
  const int n_rows = words_of(limit).remark.empty() ? 2 : 3;  // of the key
  box.y += n_rows * kKeyRow;
  Svg svg(kMapWidth, box.bottom() + 48, map.title);
  draw_heading(svg, map.title, map.remark, 16);
  const double key = box.y - 12 - (n_rows - 1) * kKeyRow;
  svg.text({16, key - kKeyRow}, counts_text(map), {kLabelSize, kFaint});
  draw_share_key(svg, {16, key});
  draw_limit_key(svg, limit, {16, key + kKeyRow});
  draw_cells(svg, with_fitted_names(grid, box), limit, box);
  return svg.finish();
}

}  // namespace faultsim::figure
