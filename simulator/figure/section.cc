#include "simulator/figure/section.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr const char* kRockColours[] = {"#eef0ea", "#e4e8f1", "#eee9e4", "#e6ece6"};

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

void draw_faults(Svg& svg, const Panel& panel, const Section& section) {
  for (std::size_t f = 0; f < section.faults.size(); ++f) {
    const Section::FaultLine& fault = section.faults[f];
    std::vector points = mapped(fault.points, [&](const Point& p) { return panel.at(p.x, p.y); });
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
  constexpr double kLeft = 70, kPlot = 770, kMost = 440;
  const double across = section.to - section.from, deep = section.base - section.top;
  // To scale: one length of pixel for both directions.
  const double scale = std::min(kPlot / across, kMost / deep);
  const double heading = section.remark.empty() ? 38 : 56;
  const Box box{kLeft, heading, across * scale, deep * scale};
  Svg svg(kLeft + kPlot + 20, heading + box.height + 86, section.title);
  draw_heading(svg, section.title, section.remark, 16);
  Panel panel(svg, box, axis_between("across the faults, m", section.from, section.to, 8),
              axis_between("depth, m", section.base, section.top, 6));
  draw_rocks(svg, panel, section);
  draw_faults(svg, panel, section);
  panel.frame();
  draw_chi_scale(svg, {std::max(box.right() - 250, box.x + 30), box.bottom() + 52}, 240);
  return svg.finish();
}

}  // namespace faultsim::figure
