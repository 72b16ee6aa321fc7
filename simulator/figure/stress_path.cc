#include "simulator/figure/stress_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/ranges.h"
#include "simulator/figure/panel.h"

namespace faultsim::figure {
namespace {

constexpr double kPathWidth = 760, kPathLeft = 64, kPathPlot = 660, kPathHeight = 380;
constexpr const char* kStrength = "#b0003a";

/// One scale for both axes, so that circles are round and angles are true; from 0, or lower where
/// something is in tension.
std::pair<Axis, Axis> stress_axes(const StressPath& path) {
  std::vector<double> normal = path.normal, shear = path.shear;
  if (path.before) {
    normal.insert(normal.end(), path.before->normal.begin(), path.before->normal.end());
    shear.insert(shear.end(), path.before->shear.begin(), path.before->shear.end());
  }
  if (path.circle) {
    normal.insert(normal.end(), {path.circle->largest, path.circle->smallest});
    shear.push_back((path.circle->largest - path.circle->smallest) / 2);
  }
  const Axis n = axis_over("", normal, {0});
  const Axis t = axis_over("", shear, {0});
  const double low_n = n.from, low_t = t.from;
  const double unit = std::max((n.to - low_n) / kPathPlot, (t.to - low_t) * 1.12 / kPathHeight);
  return {axis_between("effective normal stress σ'ₙ, MPa (compression positive)", low_n,
                       low_n + unit * kPathPlot, 8),
          axis_between("shear stress |τ|, MPa", low_t, low_t + unit * kPathHeight, 6)};
}

/// Where along a line, as a share of it, its name is farthest from the path.
double place_of_name(const Panel& panel, const StressPath& path, Point a, Point b) {
  double best = 0.5, farthest = -1;
  for (const double share : {0.15, 0.3, 0.45, 0.6, 0.75, 0.85}) {
    const Point at{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
    double nearest = INFINITY;
    for (std::size_t k = 0; k < path.normal.size(); ++k) {
      const Point p = panel.at(path.normal[k], path.shear[k]);
      nearest = std::min(nearest, std::hypot(p.x - at.x, p.y - at.y));
    }
    if (nearest <= farthest) continue;
    best = share;
    farthest = nearest;
  }
  return best;
}

void draw_strength(Svg& svg, Panel& panel, const StressPath& path, double slope,
                   const std::string& word, const Stroke& stroke) {
  const double cohesion = path.cohesion;
  const double end = panel.x().to;
  panel.curve({0, end}, {cohesion, cohesion + slope * end}, stroke);
  const double up = std::min(end, slope > 0 ? (panel.y().to - cohesion) / slope : end);
  const Point a = panel.at(0, cohesion), b = panel.at(up, cohesion + slope * up);
  const double angle = std::atan2(b.y - a.y, b.x - a.x);
  const double at = place_of_name(panel, path, a, b);
  svg.text(
      {a.x + at * (b.x - a.x) + 7 * std::sin(angle), a.y + at * (b.y - a.y) - 7 * std::cos(angle)},
      word,
      {.size = kLabelSize, .colour = stroke.colour, .rotation = angle * 180 / std::numbers::pi});
}

void draw_circle(Panel& panel, const StressPath::Circle& circle) {
  constexpr int kParts = 90;
  const double centre = (circle.largest + circle.smallest) / 2;
  const double radius = (circle.largest - circle.smallest) / 2;
  std::vector<double> x, y;
  for (int k = 0; k <= kParts; ++k) {
    const double angle = std::numbers::pi * k / kParts;
    x.push_back(centre + radius * std::cos(angle));
    y.push_back(radius * std::sin(angle));
  }
  panel.curve(x, y, {kFaint, 1.25});
}

void draw_before(Svg& svg, Panel& panel, const StressPath& path) {
  const StressPath::Before& before = *path.before;
  if (before.cohesion != path.cohesion || before.friction != path.friction) {
    const double end = panel.x().to;
    panel.curve({0, end}, {before.cohesion, before.cohesion + before.friction * end},
                {paler(kStrength), 1});
  }
  const Stroke stroke = before_stroke(0);
  panel.curve(before.normal, before.shear, stroke);
  for (std::size_t k = 0; k < before.normal.size(); ++k)
    svg.circle(panel.at(before.normal[k], before.shear[k]), 1.5, stroke.colour);
}

void draw_path(Svg& svg, Panel& panel, const StressPath& path) {
  const Stroke stroke = fault_stroke(0, 2);
  panel.curve(path.normal, path.shear, stroke);
  for (std::size_t k = 0; k < path.normal.size(); ++k) {
    svg.circle(panel.at(path.normal[k], path.shear[k]), 2.2, stroke.colour);
  }
  std::vector wanted = mapped(path.marks, [&](const StressPath::Mark& mark) {
    return panel.at(path.normal[mark.step], path.shear[mark.step]).y;
  });
  const std::vector<double> placed =
      spread(wanted, 15, panel.box().y + 10, panel.box().bottom() - 10);
  double right = 0;
  for (std::size_t k = 0; k < path.normal.size(); ++k) {
    right = std::max(right, panel.at(path.normal[k], path.shear[k]).x);
  }
  for (std::size_t k = 0; k < path.marks.size(); ++k) {
    const StressPath::Mark& mark = path.marks[k];
    const Point place = panel.at(path.normal[mark.step], path.shear[mark.step]);
    svg.circle(place, 4.5, "#ffffff", {stroke.colour, 2});
    const double room = panel.box().right() - right - 24;
    const bool is_right = room > text_width(mark.word, kTickSize);
    const double x = is_right ? right + 20 : place.x - 20;
    svg.line({place.x + (is_right ? 5 : -5), place.y}, {x - (is_right ? 3 : -3), placed[k]},
             {kFaint, 0.75});
    const double wide = text_width(mark.word, kTickSize);
    svg.rect({is_right ? x - 1 : x - wide, placed[k] - 6, wide + 1, 13}, "#ffffff");
    svg.text({x, placed[k] + 4}, mark.word,
             {kTickSize, kInk, is_right ? Anchor::start : Anchor::end});
  }
}

}  // namespace

std::string draw(const StressPath& path) {
  const double heading = path.remark.empty() ? 40 : 58;
  Svg svg(kPathWidth, heading + kPathHeight + 50, path.title);
  draw_heading(svg, path.title, path.remark, 16);
  auto [normal, shear] = stress_axes(path);
  Panel panel(svg, {kPathLeft, heading, kPathPlot, kPathHeight}, std::move(normal),
              std::move(shear));
  if (path.circle) draw_circle(panel, *path.circle);
  if (path.before) draw_before(svg, panel, path);
  draw_strength(svg, panel, path, path.friction, "strength", {kStrength, 1.75});
  if (path.weakened) {
    draw_strength(svg, panel, path, *path.weakened, "weakened", {kStrength, 1.25, "6 3"});
  }
  draw_path(svg, panel, path);
  panel.frame();
  return svg.finish();
}

}  // namespace faultsim::figure
