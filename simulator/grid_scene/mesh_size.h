#pragma once

#include "simulator/corner_point/column_map.h"
#include "simulator/grid_scene/model_lines.h"

namespace faultsim::grid_scene {

/// The longer side of the grid's cells: the median over active columns, m.
double median_cell(const corner_point::ColumnMap& map);

/// The size of cells for outlines, m: the same, but at most one and a half of their shorter side.
/// Half of a long cell would smooth the ends of a narrow map away.
double outline_cell(const corner_point::ColumnMap& map);

/// Of the reservoir, m: that of the compartments, weighted by their areas.
double mean_thickness(const corner_point::GridStructure& structure);

/// Cells of the model, as scenes say it: `growth` m larger per m away from faults, at most
/// `largest`.
struct MeshGrading {
  double growth = 0.2;
  double largest = 1000;
};
MeshGrading grading_of(const corner_point::GridStructure& structure, const ModelLines& lines);

/// Tetrahedra of a model, to a factor of some 1.5: along lines of length L cells of size h that
/// grow by g make 2 L / (c g h) triangles of the map, c h² each, and over each stand prisms of
/// three.
double estimated_cells(const corner_point::GridStructure& structure, const ModelLines& lines,
                       double strike);

/// Half a cell of the grid beside the faults, or as much more as n_cells wants, up to 1.5 cells:
/// larger ones could not tell faults apart.
double chosen_strike(const corner_point::GridStructure& structure, const ModelLines& lines,
                     double cell, const LineOptions& options, Remarks& remarks);

}  // namespace faultsim::grid_scene
