#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "simulator/figure/axis.h"
#include "simulator/figure/outcome_map.h"

/// How the cases of an outcome map are told apart: one by one, or counted in cells. Inside of the
/// module.
namespace faultsim::figure {

/// How a side of the map is divided: a column for each of its few values, whatever their distances,
/// or equal parts of a range.
struct MapSide {
  Axis axis;
  std::vector<double> levels = {};  ///< the values, ascending; empty = equal parts.
  int n = 1;                        ///< columns or rows.

  bool has_parts() const { return levels.empty(); }
  /// Which column a value is in. @pre it is finite.
  int cell_of(double value) const;
  /// Where a value is along the axis, in the axis' unit: of levels between their numbers 0, 1, ….
  double place_of(double value) const;
};

/// A side with a column for each value, where these are few, else a range whose number of equal
/// parts, n, is the caller's to choose. @param words  names of 0, 1, …; empty = the values are
/// numbers.
MapSide side_of(const std::string& label, const std::vector<double>& values,
                const std::vector<std::string>& words);

struct MapCell {
  std::array<long, kCaseClasses> counts = {};

  long of(CaseClass kind) const { return counts[static_cast<std::size_t>(kind)]; }
  long n_undecided() const { return of(CaseClass::undecided); }
  long n_early() const { return of(CaseClass::ended_early); }
  long n_slide() const { return of(CaseClass::slides) + of(CaseClass::event); }
  long n_decided() const { return of(CaseClass::holds) + n_slide(); }
  /// Without those that ended early, of which nothing is known.
  long n_known() const { return n_decided() + n_undecided(); }
};

/// The cells of a map, row by row from the lowest.
struct CellGrid {
  MapSide x, y;
  std::vector<MapCell> cells;

  const MapCell& at(int i, int j) const {
    return cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(x.n) +
                 static_cast<std::size_t>(i)];
  }
};

/// The cases of a map in cells: a side of many values has so many parts that a cell has some ten
/// cases, and a number has room in it.
CellGrid counted(const OutcomeMap& map);

/// Fewer cases than these say little of a cell: 5 where it is a range of values, as one case more
/// would change its share by 20 % or more; 1 where it is one value of each parameter.
long few_cases(const CellGrid& grid);

/// "25", "0", "100", or "25–75" where the cells of meshes leave cases undecided: the share that
/// slides, in percent, if none and if all of these do. 0 and 100 are none and all: what rounds to
/// them is 1 and 99. Of fewer known cases than `few` their number: "1 of 3", "0–2 of 4". "" where
/// nothing is known.
std::string share_text(const MapCell& cell, long few = 1);

/// Whether marks of this radius around the points would lie over each other.
bool would_overlap(std::vector<Point> points, double radius);

}  // namespace faultsim::figure
