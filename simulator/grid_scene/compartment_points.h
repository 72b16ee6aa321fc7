#pragma once

#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// Parts of the map with pressures of their own.
struct ModelCompartment {
  std::string name;
  int source = -1;                         ///< into GridStructure::compartments.
  Eigen::Vector2d inside = {0, 0};         ///< in its largest part.
  std::vector<Eigen::Vector2d> also = {};  ///< in its other parts, the larger first.
};

/// Each part of the map that the lines of the model bound belongs to the compartment of the grid
/// that has most columns in it, and is named by the middle of a column, as far from all lines as
/// can be. Compartments that have most columns nowhere are joined to those that have, parts without
/// room are left out: said in remarks, with the number of columns that are in no compartment.
std::vector<ModelCompartment> model_compartments(const corner_point::CornerPointGrid& grid,
                                                 const corner_point::GridStructure& structure,
                                                 const ModelLines& lines, Remarks& remarks);

}  // namespace faultsim::grid_scene
