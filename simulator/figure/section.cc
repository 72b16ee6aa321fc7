#include "simulator/figure/section.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kWordsHeight = 15;  // px, of a line below a scale
constexpr const char* kRockColours[] = {"#eef0ea", "#e4e8f1", "#eee9e4", "#e6ece6"};

/// What names of layers take beside the frame, px.
double room_for_names(const Section& section) {
  double widest = 0;
  for (const Section::Rock& rock : section.rocks)
    if (!rock.is_reservoir) widest = std::max(widest, text_width(rock.name, kTickSize));
  return std::min(widest, 0.35 * section.width) + 12;
}

/// One line across a piece of four corners.
void draw_hatch(Svg& svg, const std::vector<Point>& corners) {
  svg.line(corners[3], corners[1], {kInk, 0.6});
}

/// The pieces of a reservoir, over lines where a value is not known.
void draw_pieces(Svg& svg, const Panel& panel, const Section::Rock& rock,
                 const FaceColours& colours) {
  const auto corners = [&](const Section::Rock::Piece& piece) {
    return mapped(piece.corners, [&](const Point& p) { return panel.at(p.x, p.y); });
  };
  for (const Section::Rock::Piece& piece : rock.pieces)
    if (!std::isfinite(piece.value)) draw_hatch(svg, corners(piece));
  const std::vector<std::string> parts = part_colours(colours, kPaintedParts);
  svg.begin_group({{"data-painted", rock.name}});
  for (const Section::Rock::Piece& piece : rock.pieces) {
    const auto part = part_of(colours, piece.value, kPaintedParts);
    const std::string fill = part ? parts[*part] : "none";
    svg.polygon(corners(piece), fill, {fill, 0.8});  // the seams between pieces are closed
  }
  svg.end_group();
}

void draw_rocks(Svg& svg, const Panel& panel, const Section& section) {
  std::size_t layer = 0;
  for (const Section::Rock& rock : section.rocks) {
    const double top = std::max(rock.top, section.top), base = std::min(rock.base, section.base);
    const auto inside = [&](double x) { return std::clamp(x, section.from, section.to); };
    const double left = inside(rock.from), right = inside(rock.to);
    if (left >= right || top >= base) continue;
    const Point a = panel.at(left, top), b = panel.at(right, base);
    const Box box{a.x, a.y, b.x - a.x, b.y - a.y};
    const std::vector<Point> outline = {a, panel.at(right, top),
                                        panel.at(inside(rock.to_base), base),
                                        panel.at(inside(rock.from_base), base)};
    const Stroke edge = rock.is_reservoir ? Stroke{"#b08900", 1} : Stroke{"none", 0};
    svg.polygon(outline,
                rock.is_reservoir ? kReservoir : kRockColours[layer++ % std::size(kRockColours)],
                edge);
    const bool is_painted = section.painted && !rock.pieces.empty();
    if (is_painted) {
      draw_pieces(svg, panel, rock, section.painted->colours);
      svg.polygon(outline, "none", edge);  // which the pieces lie over
    }
    if (box.height < 14 && !is_painted) continue;
    if (section.marked && !rock.is_reservoir) {  // beside the frame, where no fault is in the way
      svg.text({panel.box().right() + 6, box.y + box.height / 2 + 4}, rock.name,
               {kTickSize, kFaint});
      continue;
    }
    const double x = rock.is_reservoir ? box.x + box.width / 2 : box.x + 8;
    const Anchor anchor = rock.is_reservoir ? Anchor::middle : Anchor::start;
    const double middle = box.y + box.height / 2 + 4;  // where a thin one has its name, too
    const double y = is_painted          ? box.y - 6   // words could not be read on all colours
                     : rock.is_reservoir ? middle
                                         : std::min(box.y + 16, middle);
    const std::string words = rock.note.empty() ? rock.name : rock.name + ", " + rock.note;
    svg.begin_group({{"data-rock", rock.name}});
    svg.text({x, y}, fitted(words, box.width - 10, kLabelSize), {kLabelSize, kInk, anchor});
    svg.end_group();
  }
}

std::vector<Point> points_of(const Panel& panel, const Section::FaultLine& fault) {
  return mapped(fault.points, [&](const Point& p) { return panel.at(p.x, p.y); });
}

/// Faults without χ: the marked one over the others, whose names stand where there is room.
void draw_places(Svg& svg, const Panel& panel, const Section& section) {
  const Section::FaultLine& marked = section.faults.at(*section.marked);
  const std::vector<Point> line = points_of(panel, marked);
  const Point top{line.front().x, line.front().y - 6};
  const double half = text_width(marked.name, kLabelSize) / 2 + 5;
  double free_from = -1e9;  // px
  for (std::size_t f = 0; f < section.faults.size(); ++f) {
    if (f == *section.marked) continue;
    const Section::FaultLine& fault = section.faults[f];
    const std::vector<Point> points = points_of(panel, fault);
    svg.polyline(points, {kInk, 1.5, "5 3"});
    const double x = points.front().x, reach = text_width(fault.name, kTickSize) / 2 + 2;
    if (x - reach < free_from || std::abs(x - top.x) < half + reach) continue;
    svg.text({x, points.front().y - 6}, fault.name, {kTickSize, kFaint, Anchor::middle});
    free_from = x + reach;
  }
  svg.polyline(line, {kInk, 4.5});
  svg.rect({top.x - half, top.y - 12, 2 * half, 16}, kInk);
  svg.text(top, marked.name,
           {.size = kLabelSize, .colour = "#ffffff", .anchor = Anchor::middle, .bold = true});
}

void draw_faults(Svg& svg, const Panel& panel, const Section& section) {
  for (std::size_t f = 0; f < section.faults.size(); ++f) {
    const Section::FaultLine& fault = section.faults[f];
    const std::vector<Point> points = points_of(panel, fault);
    svg.polyline(points, {kFaultEdge, 8});  // a dark edge, on which pale colours stand out too
    svg.begin_group({{"data-fault", std::to_string(f)}});
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const double chi = fault.chi.empty() ? 0 : fault.chi[std::min(k, fault.chi.size() - 1)];
      svg.line(points[k], points[k + 1], {chi_colour(chi), 5.5});
    }
    svg.end_group();
    if (points.empty()) continue;
    svg.text({points.front().x, points.front().y - 8}, fault.name,
             {.size = kLabelSize, .anchor = Anchor::middle, .bold = true});
  }
}

/// The scale of what is painted, below that of χ, and the words to it.
void draw_painted_scale(Svg& svg, const Section::Painted& painted, Point place, double width,
                        double left) {
  svg.begin_group({{"data-scale", ""}});
  const bool has_scale = !painted.colours.label.empty();
  if (has_scale) draw_scale(svg, painted.colours, place, width, kPaintedParts);
  double y = place.y + 42;
  for (const std::string& words : painted.words) {
    svg.text({left, y}, fitted(words, svg.width() - left - 10, kTickSize), {kTickSize, kFaint});
    y += kWordsHeight;
  }
  svg.end_group();
}

}  // namespace

std::string draw(const Section& section) {
  constexpr double kLeft = 70, kMost = 440;
  const double right = section.marked ? room_for_names(section) : 20;
  const double plot = section.width - kLeft - right;
  const double across = section.to - section.from, deep = section.base - section.top;
  // To scale: one length of pixel for both directions, but for the stretch.
  const double scale = std::min(plot / across, kMost / deep / section.stretch);
  const double heading = section.marked ? 8 : section.remark.empty() ? 38 : 56;
  const Box box{kLeft, heading, across * scale, deep * scale * section.stretch};
  const auto& painted = section.painted;
  const double key = painted ? 52 + kWordsHeight * static_cast<double>(painted->words.size()) : 0;
  Svg svg(section.width, heading + box.height + (section.marked ? 40 : 86 + key), section.title);
  if (!section.marked) draw_heading(svg, section.title, section.remark, 16);
  Panel panel(
      svg, box,
      axis_between("across the faults, m", section.from, section.to, section.marked ? 4 : 8),
      axis_between("depth, m", section.base, section.top, section.marked ? 4 : 6));
  draw_rocks(svg, panel, section);
  if (section.marked) {
    draw_places(svg, panel, section);
    panel.frame();
    return svg.finish();
  }
  draw_faults(svg, panel, section);
  panel.frame();
  const Point scale_at{std::max(box.right() - 250, box.x + 30), box.bottom() + 52};
  draw_chi_scale(svg, scale_at, 240);
  if (painted) draw_painted_scale(svg, *painted, {scale_at.x, scale_at.y + 36}, 240, box.x);
  return svg.finish();
}

}  // namespace faultsim::figure
