#pragma once

#include <string>
#include <vector>

#include "simulator/figure/axis.h"
#include "simulator/figure/palette.h"
#include "simulator/figure/svg.h"

namespace faultsim::figure {

struct PanelSides {
  bool x_labels = true;   ///< tick labels and the axis label below.
  bool y_labels = true;   ///< the same to the left.
  bool x_on_top = false;  ///< above instead of below.
};

/// A rectangle of a drawing with an axis along its bottom and one along its left side. What is
/// drawn through it is in the axes' units and cut off at its edges.
class Panel {
 public:
  /// Draws grid, frame, ticks and labels. @pre svg outlives this.
  Panel(Svg& svg, const Box& box, Axis x, Axis y, const PanelSides& sides = {});

  const Box& box() const { return box_; }
  const Axis& x() const { return x_; }
  const Axis& y() const { return y_; }
  Point at(double x, double y) const;
  bool holds(double x, double y) const;

  /// Pieces of the line through the points that lie within; broken where one is not finite.
  void curve(const std::vector<double>& x, const std::vector<double>& y, const Stroke& stroke);
  /// From edge to edge; nothing where the value lies outside.
  void line_at_x(double x, const Stroke& stroke);
  void line_at_y(double y, const Stroke& stroke);
  void band_in_x(double from, double to, const std::string& fill);
  /// The frame again, over what was drawn since.
  void frame();

 private:
  void draw_x(const PanelSides& sides);
  void draw_y(const PanelSides& sides);

  Svg& svg_;
  Box box_;
  Axis x_, y_;
};

/// Title and a line of remarks at the top left; returns the height that they take, px.
double draw_heading(Svg& svg, const std::string& title, const std::string& remark, double x);

/// Names at the right of the places where their lines end, moved apart, with a thin line to the
/// end.
struct EndLabel {
  std::string text;
  Point end;
  std::size_t colour = 0;  ///< of fault_stroke.
};
void draw_end_labels(Svg& svg, const std::vector<EndLabel>& labels, const Box& box);

/// Scale of chi_colour in a box, 0 to 1 with its two changes of hue, with "χ" before it.
void draw_chi_scale(Svg& svg, Point place, double width);

}  // namespace faultsim::figure
