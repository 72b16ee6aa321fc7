#pragma once

#include <cstddef>
#include <vector>

#include "simulator/flow/cell_columns.h"
#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Hexahedra and the point that each belongs to.
struct ColumnCells {
  std::vector<FlowCell> cells;
  std::vector<std::size_t> point;  ///< a point may have several, and one without thickness none.
};

/// The cells of a grid's columns. Corners lie on the pillars:
///
///   z = mean over columns of (b + g · (pillar(z) − axis(b))),
///
/// b the depth of a border of cells on a column's axis and g the dip of the column. The mean is
/// taken over the columns around the pillar whose planes meet there (kMeets): so neighbours share
/// their faces, and beside a fault each side keeps its own depth. That is exact where surfaces are
/// planes, and of third order in the cells' width where they are smooth. O(n).
/// @pre set_borders() and find_dips().
ColumnCells cells_of_columns(const ColumnGrid& grid);

}  // namespace faultsim
