#pragma once

#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// A surface of the reservoir over the active map, as the CSV of a scene has it.
struct ModelSurface {
  std::string name;  ///< of the layer below it.
  int layer = -1;    ///< k of the grid whose top it is; −1: the reservoir's top; n_k: its base.
  std::vector<Eigen::Vector3d> points;  ///< m, z up.
  /// m, > 0, per point: below the surface above, on the pillar of the model through the same
  /// point of the first surface, where `points` lie. Empty of the first one.
  std::vector<double> thickness;
};

struct SurfaceOptions {
  int every = 0;  ///< also the top of every so many layers of the grid; 0: none.
  /// m, of a layer of the model; 0: a fifth of a cell at the faults, or half the reservoir's mean
  /// thickness where that is less, but 0.06 of a cell.
  double least_layer = 0;
  double beside_fault = 1;  ///< m from a trace to the points of its sides.
};

/// Points of the reservoir's top and base, and of layers between, on either side of the model's
/// faults by themselves.
///
/// A pillar of the grid on a fault has a point for each side of it, on the line of the model's
/// fault at its depth and a little to its side; all depths of a pillar go on there by the mean
/// slope of both sides, so that it keeps its throw. Other pillars keep their place; those that the
/// straightened fault would put on the wrong side are left out, of all surfaces. The surfaces below
/// the first hang from its points: each is as much deeper as the grid's is where the model's pillar
/// through the point meets the plane of its own columns, on a fault at the same place along its
/// side, so that surfaces cannot cross between points. Where the reservoir is thinner than a layer
/// may be, its base lies deeper; layers of the grid thinner than that are no layers of the model.
/// Said in remarks.
std::vector<ModelSurface> model_surfaces(const corner_point::CornerPointGrid& grid,
                                         const corner_point::GridStructure& structure,
                                         const ModelLines& lines, const SurfaceOptions& options,
                                         Remarks& remarks);

}  // namespace faultsim::grid_scene
