#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace faultsim {

/// How far cells reach along an axis.
struct CellReach {
  std::vector<std::array<double, 2>> reach;  ///< [low, high] of each centre, m.
  std::string what;      ///< "" = told; else why not: "goes from 0 m to 100 m and ...".
  std::size_t cell = 0;  ///< one where that is seen.
};

/// The reach of cells of which only the centres are known: half way to the neighbours of the same
/// line, and as far on the other side at its ends, where all neighbours are equally far from each
/// other, to 1 %. So the cells of a line tile it. Cells with the same centre are one.
/// @param line  number of the line of each cell: all cells of one layer share the lines of x and y,
///              cells above each other one of depth. A line may have a single centre, if others
///              have more.
/// @param at    centre of each cell along the axis, m.
CellReach regular_cells(const std::vector<int>& line, const std::vector<double>& at);

/// The reach of cells whose centres are not equally far from each other, line by line. The first of
/// these that a line allows:
///
///   side by side  every centre is the middle of its cell, and the cells tile the line. Where
///                 several sizes do that, the one whose borders are nearest to half way between
///                 centres (least sum of distances): the true ones where more than half of all
///                 neighbours are alike;
///   with holes    all gaps are whole multiples of the smallest, to 1 %, and more than half equal
///                 it: cells of that size;
///   half way      each cell reaches half way to its neighbours, and as far on the other side at
///                 the ends.
///
/// A line with a single centre takes the median gap of all. @pre some line has two centres.
/// Arguments as above.
std::vector<std::array<double, 2>> uneven_cells(const std::vector<int>& line,
                                                const std::vector<double>& at);

/// The reach of cells of one line that lie side by side, as uneven_cells() finds it, where there
/// are no holes between them.
/// @param centre  at least two, ascending.
std::vector<std::array<double, 2>> touching_cells(const std::vector<double>& centre);

}  // namespace faultsim
