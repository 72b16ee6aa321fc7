#pragma once

#include <string>
#include <vector>

#include "simulator/corner_point/column_map.h"
#include "simulator/grid_scene/model_lines.h"

/// How the faults of a model dip, by the pillars of the grid that they were drawn from.
namespace faultsim::grid_scene {

/// A pillar of a fault: where it is at the depth of traces, and how it goes on across the fault.
struct FaultPillar {
  Eigen::Vector2d at;    ///< m, at the reference height.
  double lean;           ///< m to the right of the trace for each m downwards.
  Eigen::Vector2d top;   ///< m, at the reservoir's top.
  Eigen::Vector2d base;  ///< m, at its base.
  double top_z, base_z;  ///< of these.
};

/// The pillars of a fault of the structure, in order.
std::vector<FaultPillar> fault_pillars(const corner_point::ColumnMap& map,
                                       const corner_point::Fault& fault, double reference_z);

/// Dips along a fault: the mean lean of the pillars near each place, by a bell of half-width
/// `reach`; the trace gets points at most a reach apart. One lean, the pillars' median, without a
/// reach and where pillars are not nearer to the fault by a twentieth with more.
void take_dips(const std::vector<FaultPillar>& pillars, double reach, double reference_z,
               ModelFault& fault);

/// m: how far pillars are from the fault at the top and the base of the reservoir, on average.
double mean_distance(const std::vector<FaultPillar>& pillars, const ModelFault& fault,
                     double reference_z);

/// "F1 dips by 42 to 57 degrees along its trace, means over 200 m; its pillars by 31 to 79, ...".
/// @param reach  of take_dips.
std::string dips_text(const std::vector<FaultPillar>& pillars, const ModelFault& fault,
                      double reach, double reference_z);

}  // namespace faultsim::grid_scene
