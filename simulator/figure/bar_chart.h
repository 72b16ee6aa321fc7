#pragma once

#include <string>
#include <vector>

#include "simulator/figure/axis.h"
#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// A value with bounds; NaN where there is none.
struct Bounded {
  double value = 0, low = 0, high = 0;
};
/// A row of a bar chart: a bar and, below it, perhaps a second one.
struct BarRow {
  std::string name;
  Bounded first;
  std::vector<Bounded> second = {};  ///< none or one.
};
/// Horizontal bars from 0 with their bounds as lines, one block of rows per heading.
struct BarChart {
  std::string title, remark;
  std::string label;                    ///< of the axis.
  std::string first_name, second_name;  ///< what the bars of a row are; "" = not said.
  struct Block {
    std::string name;
    std::vector<BarRow> rows;
  };
  std::vector<Block> blocks;
  std::vector<double> always = {0, 1};  ///< what the axis holds.
};
std::string draw(const BarChart& chart);

/// Values with bounds at places along an axis, or one above the other where they have names only.
struct IntervalChart {
  std::string title, remark;
  std::string label;  ///< of the values.
  struct Row {
    std::string name;
    Bounded value;
    std::string note;  ///< at the right end: "412 of 1,440".
  };
  std::vector<Row> rows;
};
std::string draw(const IntervalChart& chart);

}  // namespace faultsim::figure
