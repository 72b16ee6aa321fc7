#pragma once

#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// A part of the map with pressures of its own.
struct ModelCompartment {
  std::string name;
  int source = -1;  ///< into GridStructure::compartments.
  Eigen::Vector2d inside = {0, 0};
};

/// For each compartment of the grid the middle of one of its columns, as far from all lines as can
/// be. Those that the lines of the model do not part are joined, those without room are left out:
/// said in remarks.
std::vector<ModelCompartment> model_compartments(const corner_point::CornerPointGrid& grid,
                                                 const corner_point::GridStructure& structure,
                                                 const ModelLines& lines, Remarks& remarks);

}  // namespace faultsim::grid_scene
