#pragma once

#include "simulator/corner_point/structure_finder.h"
#include "simulator/grid_scene/grid_scene.h"
#include "tests/unit/corner_point/made_grid.h"

namespace faultsim::grid_scene {

/// The scene of a made grid, and what it was made from.
struct MadeScene {
  corner_point::CornerPointGrid grid;
  corner_point::GridStructure structure;
  GridScene made;
};

inline MadeScene scene_of(const corner_point::CornerPointGrid& grid,
                          const corner_point::StructureOptions& structure_options = {},
                          GridSceneOptions options = {}, const FlowField* pressures = nullptr) {
  options.stem = "field";
  options.source = "FIELD.EGRID";
  options.field_file = "FIELD.EGRID";
  MadeScene all{grid, recognise_structure(grid, structure_options), {}};
  all.made = grid_scene(all.grid, all.structure, options, pressures);
  return all;
}

/// A throw of 60 m along an oblique line from edge to edge; pillars lean to the east.
inline corner_point::MadeGrid grid_of_a_fault(double lean) {
  return {.size = {30, 24, 3},
          .lean = {lean, 0},
          .faults = {{{900, -200}, {2100, 2200}, [](double) { return 60.0; }}}};
}

inline bool says(const Remarks& remarks, const std::string& text) {
  for (const corner_point::StructureRemark& remark : remarks) {
    if (remark.text.find(text) != std::string::npos) return true;
  }
  return false;
}

}  // namespace faultsim::grid_scene
