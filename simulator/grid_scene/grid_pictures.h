#pragma once

#include <string>

#include "simulator/grid_scene/grid_scene.h"

namespace faultsim::grid_scene {

/// The map as SVG: the active map, pillars of faults and the straight traces with their largest
/// throw, dividers, compartments by name.
std::string map_picture(const corner_point::GridStructure& structure, const GridScene& made);

/// A section as SVG, to scale, across the longest fault where its throw is largest: the grid's
/// active columns, points of the model's surfaces near the section, the model's faults. Without a
/// fault, from west to east through the middle.
std::string section_picture(const corner_point::CornerPointGrid& grid,
                            const corner_point::GridStructure& structure, const GridScene& made);

}  // namespace faultsim::grid_scene
