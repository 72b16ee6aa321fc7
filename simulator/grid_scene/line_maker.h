#pragma once

#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// Faults and outlines of a grid as lines that fit together: traces end at others, cross the
/// outline at an angle and end a little outside of it, go on at tips; what cannot be drawn is left
/// out. Every choice is appended to remarks.
ModelLines model_lines(const corner_point::CornerPointGrid& grid,
                       const corner_point::GridStructure& structure, const LineOptions& options,
                       Remarks& remarks);

}  // namespace faultsim::grid_scene
