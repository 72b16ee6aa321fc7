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

/// Points of a table. Two of them never have the same place.
struct TablePoints {
  using Place = std::array<double, 6>;  ///< as kPlaceColumns, m; 0 where there is no such column.
  std::array<bool, 6> has_column = {};  ///< x and y are there.
  std::vector<Place> places;
  std::vector<int> lines;  ///< of the table, where each stands first.
};

/// The cells that points stand for.
struct PointCells {
  std::vector<FlowCell> cells;
  std::vector<std::size_t>
      point;  ///< of each cell; a point may have several, which do not overlap.
  std::vector<std::string> notes;  ///< as FlowField::notes.
};

/// Sizes that are given are taken, and others found:
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
PointCells point_cells(const TablePoints& points, TableReader& reader);

}  // namespace faultsim
