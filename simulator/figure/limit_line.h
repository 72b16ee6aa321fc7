#pragma once

#include <string>
#include <utility>
#include <vector>

#include "simulator/figure/outcome_cells.h"
#include "simulator/figure/svg.h"

/// The limit in a map of cases that are counted in cells. Inside of the module.
namespace faultsim::figure {

/// The edges between cells in which nothing slides, nor may, and cells in which something does or
/// may. Cells without cases, and safe ones of too few, have none: nobody knows.
struct LimitLine {
  long needed = 1;  ///< decided cases from which on a cell in which nothing slides is a safe one.
  /// Their ends, in columns from the left and rows from below: the cell at (i, j) reaches from
  /// (i, j) to (i + 1, j + 1).
  std::vector<std::pair<Point, Point>> edges;
  long n_safe = 0, n_unsafe = 0;  ///< cells.
  long fewest = 0;                ///< decided cases of a safe cell; 0 = there is none.
};

/// A cell is safe where `needed` cases (few_cases) or more are decided and none of all slides, is
/// undecided or ended early, as such a one may slide. It is unsafe with one of these, however few
/// others.
LimitLine limit_line(const CellGrid& grid);

/// What the line says, or why there is none: a sentence, and one of remarks or "".
struct LimitWords {
  std::string sentence, remark;
};
LimitWords words_of(const LimitLine& limit);

}  // namespace faultsim::figure
