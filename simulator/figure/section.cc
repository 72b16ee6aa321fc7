#include "simulator/figure/section.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr const char* kRockColours[] = {"#eef0ea", "#e4e8f1", "#eee9e4", "#e6ece6"};

/// What names of layers take beside the frame, px.
double room_for_names(const Section& section) {
  double widest = 0;
  for (const Section::Rock& rock : section.rocks)
    if (!rock.is_reservoir) widest = std::max(widest, text_width(rock.name, kTickSize));
  return std::min(widest, 0.35 * section.width) + 12;
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
    svg.polygon({a, panel.at(right, top), panel.at(inside(rock.to_base), base),
                 panel.at(inside(rock.from_base), base)},
                rock.is_reservoir ? kReservoir : kRockColours[layer++ % std::size(kRockColours)],
                rock.is_reservoir ? Stroke{"#b08900", 1} : Stroke{"none", 0});
    if (box.height < 14) continue;
    if (section.marked && !rock.is_reservoir) {  // beside the frame, where no fault is in the way
      svg.text({panel.box().right() + 6, box.y + box.height / 2 + 4}, rock.name,
               {kTickSize, kFaint});
      continue;
    }
    const double x = rock.is_reservoir ? box.x + box.width / 2 : box.x + 8;
    const Anchor anchor = rock.is_reservoir ? Anchor::middle : Anchor::start;
    const double middle = box.y + box.height / 2 + 4;  // where a thin one has its name, too
    const double y = rock.is_reservoir ? middle : std::min(box.y + 16, middle);
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
  Svg svg(section.width, heading + box.height + (section.marked ? 40 : 86), section.title);
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
  draw_chi_scale(svg, {std::max(box.right() - 250, box.x + 30), box.bottom() + 52}, 240);
  return svg.finish();
}

}  // namespace faultsim::figure
