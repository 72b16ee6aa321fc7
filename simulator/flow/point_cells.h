#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/table_reader.h"
#include "simulator/flow/flow_field.h"

namespace faultsim {

/// The columns of a table of points that say where they are: the centre of a cell, depth downwards,
/// and its size.
inline constexpr std::array<const char*, 6> kPlaceColumns{"x", "y", "depth", "dx", "dy", "dz"};
inline constexpr std::size_t kDepthColumn = 2, kFirstSizeColumn = 3;

/// Columns that say which cell of its grid a point is, in whole numbers.
inline constexpr std::array<const char*, 3> kIndexColumns{"i", "j", "k"};
using CellIndex = std::array<int, 3>;  ///< i, j, k.

/// Points of a table. Two of them never have the same place.
struct TablePoints {
  using Place = std::array<double, 6>;  ///< as kPlaceColumns, m; 0 where there is no such column.
  std::array<bool, 6> has_column = {};  ///< x and y are there.
  std::vector<Place> places;
  std::vector<CellIndex> indices;  ///< of each; empty: not known. None twice.
  std::vector<int> lines;          ///< of the table, where each stands first.
};

/// The cells that points stand for.
struct PointCells {
  std::vector<FlowCell> cells;
  std::vector<std::size_t>
      point;  ///< of each cell; a point may have several, which do not overlap.
  std::vector<std::string> notes;  ///< as FlowField::notes.
};

/// With i, j, k and depths, and where points follow each other down sloping lines, cells are
/// hexahedra between the centres beside them (indexed_columns(), followed_columns(),
/// cells_of_columns()), dx and dy are not used but across a single row, and dz is the thickness.
/// That is not so where dx, dy and dz are there and boxes of these sizes do not lie over each
/// other. Else sizes that are given are taken, and others found:
///
///   x, y   of a regular grid along x and y (regular_cells()), else of one with uneven lines
///          (uneven_cells()), if at least a quarter of its places has points; else every column of
///          points (of the same x and y) has the area that is nearer to it than to any other
///          (nearest_areas()), as prisms;
///   depth  within each column of points, regular or uneven; without depths of points a value
///          holds at all depths.
///
/// What cannot be told is refused with the line where that is seen: a single value of a coordinate,
/// points on one line in the plan, no two points above each other. Then there are no cells.
///
/// @param points  of those with i, j, k each triple once.
PointCells point_cells(const TablePoints& points, TableReader& reader);

}  // namespace faultsim
