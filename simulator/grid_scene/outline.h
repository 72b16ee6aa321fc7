#pragma once

#include "simulator/corner_point/column_map.h"
#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// The edge of the active map in straight pieces: closed lines, without their first point again,
/// the active columns to the left (on the map); those around holes as well. No middle of an edge of
/// the grid is farther from them than half a cell, but where corners would be sharper than 50
/// degrees or pieces shorter than a cell. Columns that stick out alone, and holes and parts of a
/// few columns, are smoothed away; how many is appended to remarks, with a warning where more than
/// three of a hundred active columns lie outside.
/// @param cell         m, a cell of the grid: outline_cell().
/// @param reference_z  m, for pillars where nothing is active.
std::vector<Polyline> active_outlines(const corner_point::ColumnMap& map, double cell,
                                      double reference_z, Remarks& remarks);

/// The convex hull, counter-clockwise.
Polyline hull_of(Polyline points);

/// Whether a place is inside of an odd number of them.
bool is_within(const std::vector<Polyline>& outlines, const Eigen::Vector2d& at);

/// A closed line with its first point again.
Polyline closed(Polyline outline);

}  // namespace faultsim::grid_scene
