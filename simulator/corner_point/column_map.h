#pragma once

#include <array>
#include <vector>

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// The grid as a map: columns, pillars, and the pillar edges between columns.
///
/// Columns of the reservoir are those that have an active cell, and holes: up to 8 inactive columns
/// next to each other that such columns enclose, where the grid has cells between the heights of
/// these. A fault goes on through a hole, and so do horizons.
///
/// A pillar edge has a number: 2 · pillar of smaller i or j, + 1 where it runs along j.
class ColumnMap {
 public:
  explicit ColumnMap(const CornerPointGrid& grid);

  const CornerPointGrid& grid() const { return *grid_; }
  /// Whether it is one of the reservoir's; −1 is none.
  bool is_inside(int column) const { return column >= 0 && is_inside_[column] != 0; }
  int n_pillars() const { return (grid_->size[0] + 1) * (grid_->size[1] + 1); }
  /// Pillars that an edge joins, by its number.
  std::array<int, 2> pillars_of(int edge) const;
  /// The edge between two neighbouring pillars.
  int edge_between(int from, int to) const;
  /// The edge between two neighbouring columns; −1 where they are none.
  int edge_between_columns(int column, int other) const;
  /// Columns left and right of who goes from one pillar to its neighbour; −1: outside of the grid.
  std::array<int, 2> sides(int from, int to) const;
  /// Columns around a pillar, in turn; −1: outside of the grid.
  std::array<int, 4> columns_around(int pillar) const;
  /// Columns that share a side with a column, 2 to 4.
  std::vector<int> columns_beside(int column) const;
  /// Pillars beside a pillar, 2 to 4.
  std::vector<int> neighbours(int pillar) const;
  /// Whether a column beside the pillar is none of the reservoir's.
  bool is_at_edge(int pillar) const;
  /// Where a column's corner is that lies on this pillar.
  CornerPlace corner_at(int column, int pillar) const;
  /// The layer of a column's uppermost and lowest active cell, k, in a hole of those around it; the
  /// column is inside.
  int top_layer(int column) const { return layers_[column][0]; }
  int base_layer(int column) const { return layers_[column][1]; }
  /// The offset across the edge from one pillar to its neighbour, both of whose columns are inside.
  FaultEdge measured(int from, int to) const;

 private:
  int column_or_none(int i, int j) const;
  std::array<int, 2> place_of_pillar(int pillar) const;
  std::vector<int> layers_to_compare(int left, int right) const;
  void take_in_holes();
  void take_in(const std::vector<int>& hole, const std::vector<int>& around);

  const CornerPointGrid* grid_;
  std::vector<char> is_inside_;             ///< per column.
  std::vector<std::array<int, 2>> layers_;  ///< per column, uppermost and lowest active one.
  bool is_left_handed_ = false;             ///< i, j on the map.
};

}  // namespace faultsim::corner_point
