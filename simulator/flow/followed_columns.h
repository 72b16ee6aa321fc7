#pragma once

#include <vector>

#include "simulator/flow/cell_columns.h"

namespace faultsim {

/// Columns of sloping pillars, found from the centres of their cells alone. Two cells are of one
/// column if each is the nearest one above or below the other, and if they are less far apart on
/// the map than a third of the columns' spacing. Layers are counted from the top of each column.
///
/// Columns have the areas that are nearer to them than to any other (nearest_areas()), each at the
/// depth of the plane through those around it: there those of both sides of a fault lie beside each
/// other. The corners of these areas are the pillars, which lean as the columns around them.
/// @param centres  their layers mean nothing.
/// @return no columns where they have fewer than 4/3 cells in the mean.
ColumnGrid followed_columns(const std::vector<CellCentre>& centres);

}  // namespace faultsim
