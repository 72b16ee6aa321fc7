#include "simulator/flow/cell_columns.h"

#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {

CellColumn column_of(std::vector<CellCentre> cells) {
  FAULTSIM_DEMAND(!cells.empty(), "a column without cells");
  CellColumn column{.cells = std::move(cells)};
  const double n = static_cast<double>(column.cells.size());
  // Seen from the first one, so that what repeats exactly costs no digits.
  const CellCentre& first = column.cells.front();
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double depth = 0;
  for (const CellCentre& cell : column.cells) {
    at += (cell.at - first.at) / n;
    depth += (cell.depth - first.depth) / n;
  }
  double squares = 0;
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  for (const CellCentre& cell : column.cells) {
    const double down = cell.depth - first.depth - depth;
    squares += down * down;
    products += down * (cell.at - first.at - at);
  }
  column.axis.at = first.at + at;
  column.axis.depth = first.depth + depth;
  if (squares > 0) column.axis.lean = products / squares;
  return column;
}

CommonDepth common_depth(const CellColumn& column, const CellColumn& other) {
  CommonDepth sum;
  double n = 0;
  auto own = column.cells.begin();
  auto theirs = other.cells.begin();
  while (own != column.cells.end() && theirs != other.cells.end()) {
    if (own->layer < theirs->layer) {
      ++own;
    } else if (own->layer > theirs->layer) {
      ++theirs;
    } else {
      sum.own += own++->depth;
      sum.other += theirs++->depth;
      ++n;
    }
  }
  if (n > 0) sum = {sum.own / n, sum.other / n, true};
  return sum;
}

}  // namespace faultsim
