#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/bar_chart.h"
#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// What a piece of a bar is filled with: colours fall in lightness and have textures of their own,
/// so that they are told apart in grey.
enum class RangeFill {
  good,       ///< pale green, plain.
  between,    ///< orange, lines to one side.
  bad,        ///< red, crossed lines.
  plain,      ///< grey, plain.
  undecided,  ///< white, lines to the other side.
};

/// Ranges along one axis, a row for each name; small, for a page of paper.
struct RangeBars {
  std::string title;
  std::string label;   ///< of the axis.
  double width = 690;  ///< px.
  struct Range {
    double from = 0, to = 0;
    RangeFill fill = RangeFill::plain;
  };
  struct Row {
    std::string name;
    std::vector<Range> ranges;
    std::optional<Bounded> bounds = {};  ///< a line with ends over the ranges, and a dot.
    std::string note = {};               ///< at the right end.
  };
  std::vector<Row> rows;
  /// A dashed line over all rows, its word above them.
  struct Mark {
    double at = 0;
    std::string word;
  };
  std::vector<Mark> marks = {};
  std::optional<Axis> axis = {};  ///< none: over all that is drawn.
  /// What fills mean, above the rows; "" = not told. In the order of RangeFill.
  std::vector<std::string> key = {};
};
/// The colour and the texture in a box. @pre width and height > 0.
void draw_fill(Svg& svg, const Box& box, RangeFill fill);
std::string draw(const RangeBars& bars);
/// One row without its name and note, for a cell of a table; px.
std::string draw_alone(const RangeBars::Row& row, const Axis& axis, double width, double height);
/// A small piece of a fill, to stand before the word that it means.
std::string draw_swatch(RangeFill fill);

}  // namespace faultsim::figure
