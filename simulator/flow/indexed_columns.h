#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "simulator/flow/cell_columns.h"

namespace faultsim {

/// A cell's centre and its column's i and j; its layer is k.
struct IndexedCell {
  CellCentre centre;
  int i = 0, j = 0;
};

/// A corner of the cell of a point on the map, the one towards a direction from its centre.
using PlanCorner =
    std::function<Eigen::Vector2d(std::size_t point, const Eigen::Vector2d& towards)>;

/// The grid of cells that are known by their i, j and k, which count in either direction. Columns
/// are those of the same i and j. A pillar lies between up to four columns:
///
///   pillar(z) = mean over columns of axis(z) ± ½ step_i ± ½ step_j,
///
/// step half of what the next and the previous column along i or j are apart at that depth, or what
/// the one of them is that is there. That is of third order in the cells' width where pillars are
/// smooth.
/// @param corner  where it is known; else empty.
/// @param width   how long cells are across a single row along i or j, m; 0: not known.
/// @return no columns where they are a single row and the width is not known.
ColumnGrid indexed_columns(const std::vector<IndexedCell>& cells,
                           const std::array<double, 2>& width, const PlanCorner& corner = {});

}  // namespace faultsim
