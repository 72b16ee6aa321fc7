#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulator/flow/flow_field.h"
#include "simulator/grid_scene/compartment_points.h"
#include "simulator/grid_scene/layer_table.h"
#include "simulator/grid_scene/model_lines.h"
#include "simulator/grid_scene/surface_points.h"

namespace faultsim::grid_scene {

struct GridSceneOptions {
  LineOptions lines;
  SurfaceOptions surfaces;
  std::string stem;         ///< of the scene's file: its tables are called STEM-reservoir.csv, ...
  std::string source;       ///< what the scene is made from, for its comment: "FIELD.EGRID".
  std::string field_file;   ///< pressures, as the scene names them; "" = none.
  std::string layers_text;  ///< a table of layers (layer_table.h); "" = assumed ones.
  std::string layers_name;  ///< of its file.
};

/// A file beside the scene.
struct SceneTable {
  std::string name;  ///< without a folder.
  std::string text;
};

/// What `faultsim init from-grid` writes.
struct GridScene {
  nlohmann::ordered_json scene;
  std::vector<SceneTable> tables;
  ModelLines lines;
  std::vector<ModelSurface> surfaces;
  std::vector<ModelCompartment> compartments;
  Remarks remarks;  ///< every choice, with the option or the key that changes it where one does.
};

/// The scene of a grid: pure, equal input gives equal text.
/// @param pressures  of the grid's restart files; null: none are there.
/// @throws InputError: a table of layers that does not fit, a reservoir at the surface or at the
/// base of the model, an active map that is nowhere two columns wide.
GridScene grid_scene(const corner_point::CornerPointGrid& grid,
                     const corner_point::GridStructure& structure, const GridSceneOptions& options,
                     const FlowField* pressures);

/// JSON as people edit it: what fits on a line of 100 columns stands on one.
std::string scene_text(const nlohmann::ordered_json& scene);

}  // namespace faultsim::grid_scene
