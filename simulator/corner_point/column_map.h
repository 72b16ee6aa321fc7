#pragma once

#include <array>
#include <vector>

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// The grid as a map: columns, pillars, and the pillar edges between columns.
///
/// A pillar edge has a number: 2 · pillar of smaller i or j, + 1 where it runs along j.
class ColumnMap {
 public:
  explicit ColumnMap(const CornerPointGrid& grid);

  const CornerPointGrid& grid() const { return *grid_; }
  bool is_active(int column) const { return column >= 0 && is_active_[column] != 0; }
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
  /// Pillars beside a pillar, 2 to 4.
  std::vector<int> neighbours(int pillar) const;
  /// Whether an inactive column or none is beside the pillar.
  bool is_at_edge(int pillar) const;
  /// Where a column's corner is that lies on this pillar.
  CornerPlace corner_at(int column, int pillar) const;
  /// The layer of a column's uppermost and lowest active cell, k; the column is active.
  int top_layer(int column) const;
  int base_layer(int column) const;
  /// The offset across the edge from one pillar to its neighbour, both of whose columns are active.
  FaultEdge measured(int from, int to) const;

 private:
  int column_or_none(int i, int j) const;
  std::array<int, 2> place_of_pillar(int pillar) const;
  std::vector<int> layers_to_compare(int left, int right) const;

  const CornerPointGrid* grid_;
  std::vector<char> is_active_;  ///< per column.
  bool is_left_handed_ = false;  ///< i, j on the map.
};

}  // namespace faultsim::corner_point
