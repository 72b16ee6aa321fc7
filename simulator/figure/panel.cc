#include "simulator/figure/panel.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"

namespace faultsim::figure {
namespace {

/// The part of a segment within a box (Liang and Barsky 1984); false where there is none.
bool clip(const Box& box, Point& a, Point& b) {
  double first = 0, last = 1;
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double steps[] = {-dx, dx, -dy, dy};
  const double room[] = {a.x - box.x, box.right() - a.x, a.y - box.y, box.bottom() - a.y};
  for (std::size_t k = 0; k < 4; ++k) {
    if (steps[k] == 0) {
      if (room[k] < 0) return false;
      continue;
    }
    const double t = room[k] / steps[k];
    steps[k] < 0 ? first = std::max(first, t) : last = std::min(last, t);
  }
  if (first > last) return false;
  const Point from = a;  // an end that lies within keeps its bits: the next piece begins there
  if (first > 0) a = {from.x + first * dx, from.y + first * dy};
  if (last < 1) b = {from.x + last * dx, from.y + last * dy};
  return true;
}

/// A share a rounding beyond an end is that end: a χ of 1 + 1e-9 is on the frame of an axis to 1.
double snapped(double share) {
  constexpr double kRounding = 1e-6;
  if (share < 0 && share > -kRounding) return 0;
  return share > 1 && share < 1 + kRounding ? 1 : share;
}

}  // namespace

Panel::Panel(Svg& svg, const Box& box, Axis x, Axis y, const PanelSides& sides)
    : svg_(svg), box_(box), x_(std::move(x)), y_(std::move(y)) {
  draw_x(sides);
  draw_y(sides);
  frame();
}

void Panel::draw_x(const PanelSides& sides) {
  for (const Tick& tick : x_.ticks) {
    const double x = box_.x + box_.width * x_.share(tick.value);
    svg_.line({x, box_.y}, {x, box_.bottom()}, {kGrid, 1});
    if (!sides.x_labels) continue;
    svg_.text({x, sides.x_on_top ? box_.y - 6 : box_.bottom() + 15}, tick.label,
              {kTickSize, kFaint, Anchor::middle});
  }
  if (!sides.x_labels) return;
  svg_.text({box_.x + box_.width / 2, sides.x_on_top ? box_.y - 22 : box_.bottom() + 33}, x_.label,
            {kLabelSize, kInk, Anchor::middle});
}

void Panel::draw_y(const PanelSides& sides) {
  double widest = 0;
  for (const Tick& tick : y_.ticks) {
    const double y = box_.bottom() - box_.height * y_.share(tick.value);
    svg_.line({box_.x, y}, {box_.right(), y}, {kGrid, 1});
    if (!sides.y_labels) continue;
    svg_.text({box_.x - 6, y + 4}, tick.label, {kTickSize, kFaint, Anchor::end});
    widest = std::max(widest, text_width(tick.label, kTickSize));
  }
  if (!sides.y_labels) return;
  svg_.text({box_.x - widest - 16, box_.y + box_.height / 2}, y_.label,
            {.size = kLabelSize, .anchor = Anchor::middle, .rotation = -90});
}

void Panel::frame() { svg_.rect(box_, "none", {kFrame, 1}); }

Point Panel::at(double x, double y) const {
  return {box_.x + box_.width * snapped(x_.share(x)),
          box_.bottom() - box_.height * snapped(y_.share(y))};
}

bool Panel::holds(double x, double y) const {
  const auto inside = [](double share) { return share >= -1e-9 && share <= 1 + 1e-9; };
  return inside(x_.share(x)) && inside(y_.share(y));
}

void Panel::curve(const std::vector<double>& x, const std::vector<double>& y,
                  const Stroke& stroke) {
  std::vector<Point> piece;
  const auto end_piece = [&] {
    svg_.polyline(piece, stroke);
    piece.clear();
  };
  for (std::size_t k = 1; k < std::min(x.size(), y.size()); ++k) {
    const bool there = std::isfinite(x[k - 1]) && std::isfinite(y[k - 1]) && std::isfinite(x[k]) &&
                       std::isfinite(y[k]);
    Point a = there ? at(x[k - 1], y[k - 1]) : Point(), b = there ? at(x[k], y[k]) : Point();
    const Point whole = b;
    if (!there || !clip(box_, a, b)) {
      end_piece();
      continue;
    }
    const bool goes_on = !piece.empty() && piece.back().x == a.x && piece.back().y == a.y;
    if (!goes_on) {
      end_piece();
      piece.push_back(a);
    }
    piece.push_back(b);
    if (b.x != whole.x || b.y != whole.y) end_piece();
  }
  end_piece();
}

void Panel::line_at_x(double x, const Stroke& stroke) {
  const double at = box_.x + box_.width * x_.share(x);
  if (at >= box_.x && at <= box_.right()) svg_.line({at, box_.y}, {at, box_.bottom()}, stroke);
}

void Panel::line_at_y(double y, const Stroke& stroke) {
  const double at = box_.bottom() - box_.height * y_.share(y);
  if (at >= box_.y && at <= box_.bottom()) svg_.line({box_.x, at}, {box_.right(), at}, stroke);
}

void Panel::band_in_x(double from, double to, const std::string& fill) {
  const auto [low, high] = std::minmax({x_.share(from), x_.share(to)});  // values, no references
  const double left = std::clamp(low, 0.0, 1.0), right = std::clamp(high, 0.0, 1.0);
  svg_.rect({box_.x + box_.width * left, box_.y, box_.width * (right - left), box_.height}, fill);
}

double draw_heading(Svg& svg, const std::string& title, const std::string& remark, double x) {
  const double room = svg.width() - x - 10;
  svg.text({x, 22}, fitted(title, room, kTitleSize), {.size = kTitleSize, .bold = true});
  if (remark.empty()) return 30;
  svg.text({x, 40}, fitted(remark, room, kLabelSize), {kLabelSize, kFaint});
  return 48;
}

void draw_end_labels(Svg& svg, const std::vector<EndLabel>& labels, const Box& box) {
  std::vector wanted = mapped(labels, [&](const EndLabel& label) { return label.end.y; });
  const std::vector<double> placed = spread(wanted, 15, box.y + 5, box.bottom() - 5);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const Point place{box.right() + 16, placed[k]};
    svg.line({labels[k].end.x + 2, labels[k].end.y}, {place.x - 3, place.y},
             {fault_stroke(labels[k].colour).colour, 0.75});
    svg.text({place.x, place.y + 4}, fitted(labels[k].text, svg.width() - place.x - 2, kLabelSize),
             {.size = kLabelSize, .colour = fault_ink(labels[k].colour), .bold = true});
  }
}

void draw_chi_scale(Svg& svg, Point place, double width) {
  constexpr double kHeight = 10, kTop = 1.06;  // beyond 1: the dark red that slipping has
  constexpr int kParts = 53;
  svg.text({place.x - 8, place.y + kHeight}, "χ", {kLabelSize, kInk, Anchor::end});
  for (int k = 0; k < kParts; ++k) {
    const double chi = kTop * (k + 0.5) / kParts;
    const double from = width * k / kParts;  // each to the end: nothing shines through between them
    svg.rect({place.x + from, place.y, width - from, kHeight}, chi_colour(chi));
  }
  svg.rect({place.x, place.y, width, kHeight}, "none", {kFrame, 0.75});
  for (const auto& [chi, label] : {std::pair(0.0, "0"), {0.4, "0.4"}, {0.8, "0.8"}, {1.0, "1"}}) {
    svg.text({place.x + width * chi / kTop, place.y + kHeight + 13}, label,
             {kTickSize, kFaint, Anchor::middle});
  }
}

}  // namespace faultsim::figure
