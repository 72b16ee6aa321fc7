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

  /// Which column a value is in. @pre it is finite.
  int cell_of(double value) const;
  /// Where a value is along the axis, in the axis' unit: of levels between their numbers 0, 1, ….
  double place_of(double value) const;
};

/// A side with a column for each value, where these are few, else with as many equal parts as
/// `cases` are worth. @param words  names of 0, 1, …; empty = the values are numbers.
MapSide side_of(const std::string& label, const std::vector<double>& values,
                const std::vector<std::string>& words, int most_parts);

struct MapCell {
  std::array<long, kCaseClasses> counts = {};

  long of(CaseClass kind) const { return counts[static_cast<std::size_t>(kind)]; }
  long n_undecided() const { return of(CaseClass::undecided); }
  long n_slide() const { return of(CaseClass::slides) + of(CaseClass::event); }
  long n_decided() const { return of(CaseClass::holds) + n_slide(); }
  /// Without those that ended early, of which nothing is known.
  long n_known() const { return n_decided() + n_undecided(); }
};

/// "25", "0", "100", or "25–75" where the cells of meshes leave cases undecided: the share that
/// slides, in percent, if none and if all of these do. 0 and 100 are none and all: what rounds to
/// them is 1 and
/// 99. "" where nothing is known.
std::string share_text(const MapCell& cell);

/// Whether marks of this radius around the points would lie over each other.
bool would_overlap(std::vector<Point> points, double radius);

}  // namespace faultsim::figure
