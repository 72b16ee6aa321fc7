#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/corner_point/grid_structure.h"

/// From the structure of a flow grid to a scene: what is written there, and why. Lengths in m, z up
/// (negative below the datum), x and y on the map of the grid.
namespace faultsim::grid_scene {

using Polyline = std::vector<Eigen::Vector2d>;

/// How an end of a trace is called in a scene.
enum class LineEnd { rock, fault };

/// A fault of the model: straight pieces of a trace, and how it dips.
struct ModelFault {
  std::string name;
  int source = -1;  ///< into GridStructure::faults.
  Polyline trace;   ///< at ModelLines::reference_z, first to last.
  LineEnd first_end = LineEnd::rock, last_end = LineEnd::rock;
  /// m to the right of the trace for each m downwards, tan of dip_from_vertical: one for all of it,
  /// or one per point of the trace, linear between.
  std::vector<double> leans = {0};
  double top = 0, bottom = 0;  ///< z where it ends.

  double lean_at(std::size_t point) const { return leans[leans.size() == 1 ? 0 : point]; }
  /// Its line at a height, each point moved across it, m.
  Polyline at(double z, double reference_z) const;
};

/// A line of the model that is no fault.
struct ModelDivider {
  std::string name;
  Polyline line;
};

/// Lines of the map that fit together: ready for horizons::meeting_lines.
struct ModelLines {
  Eigen::Vector2d low = {0, 0}, high = {0, 0};  ///< of the box in the map.
  double reference_z = 0;                       ///< where lines are drawn.
  double base = 0;                              ///< z of the model's base; its top is z = 0.
  double strike = 0;                            ///< m, size of cells at the faults.
  std::vector<ModelFault> faults;               ///< in order of priority.
  std::vector<ModelDivider> dividers;           ///< around active cells, and on from tips.
  std::vector<Polyline> outlines;               ///< closed, without their first point again; active
                                                ///< cells lie to the left.
};

using Remarks = std::vector<corner_point::StructureRemark>;

/// What of lines may be chosen.
struct LineOptions {
  double margin = 0;          ///< m around the active map; 0: twice the depth, 5 km at least.
  double base_depth = 0;      ///< m; 0: twice the depth of the reservoir, to 500 m.
  double overshoot = 150;     ///< m that faults reach above and below the reservoir beside them.
  double tip_reach = 1;       ///< cells of the grid by which traces go on at tips.
  double least_edge_run = 2;  ///< cells of the grid by which faults go on beyond the active map.
  double strike = 0;          ///< m; 0: chosen by n_cells.
  double n_cells = 100'000;   ///< tetrahedra, about.
};

}  // namespace faultsim::grid_scene
