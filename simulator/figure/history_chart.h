#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/axis.h"
#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// A line of a chart.
struct Curve {
  std::string name;
  std::size_t colour = 0;                   ///< of fault_stroke.
  std::vector<double> values;               ///< NaN = no value there: the line is broken.
  std::vector<double> low = {}, high = {};  ///< bounds of the values, as thin lines; empty = none.
  std::vector<double> before = {};  ///< what the values were before a change, as a thin, paler line
                                    ///< at places of its own (of the chart); empty = none.
};
/// A horizontal line to compare with.
struct Level {
  double value = 0;
  std::string name;
};
/// Quantities of one unit against time.
struct HistoryPanel {
  std::string label;  ///< quantity and unit.
  std::vector<Curve> curves;
  std::vector<Level> levels = {};
  std::vector<double> always = {};  ///< what the axis holds whatever the values.
  double height = 200;              ///< px.
  double headroom = 0;              ///< share of the axis that is left above its last tick.
};
struct StageSpan {
  std::string name;
  double from = 0, to = 0;  ///< in the unit of the time axis.
};
/// Something that happens at a time: a mark over the panels with a short word.
struct TimeMark {
  double time = 0;
  std::string word;
};
/// Panels above each other with one time axis; stages are shaded in turn and named above.
struct HistoryChart {
  std::string title, remark;
  std::string time_label;        ///< "time, years".
  std::vector<Tick> ticks = {};  ///< of time; empty = round numbers.
  std::vector<double> time;
  std::vector<StageSpan> stages;
  std::vector<TimeMark> marks;
  std::vector<HistoryPanel> panels;
  std::optional<double> cursor;  ///< a time that other charts show; a page may move the line, which
                                 ///< has the attributes data-cursor and data-x (of time 0, of 1).
  std::vector<double> time_before = {};  ///< of Curve::before.
};
std::string draw(const HistoryChart& chart);

}  // namespace faultsim::figure
