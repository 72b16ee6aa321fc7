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

}  // namespace faultsim
