#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/initial_state/fault_pressure.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// One load step to be solved; step 0 is the initial equilibrium at t = 0.
struct LoadStep {
  int step = 0;
  std::string stage;
  double time = 0;  ///< s.
};

/// Step 0, then every step of every stage at its end time: step_ends() of
/// initial_state/load_times.h.
std::vector<LoadStep> load_steps(const Scene& scene);
/// True for step 0 and for the last step of each stage. @pre i < steps.size().
bool is_stage_end(const std::vector<LoadStep>& steps, std::size_t i);

/// Δp of each region at time t, Pa: scale · history(t − lag), 0 before the history starts.
std::vector<double> pressure_changes(const Scene& scene, double time);

/// ΔT of each region at time t, K: 0 at t = 0.
std::vector<double> temperature_changes(const Scene& scene, double time);

/// The factors c_k of the operator's loads at a time: b Δp + 3 K α_T ΔT for pressure loads, the
/// table's value for boundary loads. Keys that the scene does not know are our bug (InternalError).
class LoadFactors {
 public:
  LoadFactors(const Scene& scene, const FaultOperator& op);
  /// @param pressure_change  per region, Pa.
  std::vector<double> at(double time, const std::vector<double>& pressure_change) const;
  /// Region of each pressure load, so that PressurePair indices can be turned into regions.
  const std::vector<int>& region_of_load() const { return region_of_load_; }

 private:
  const Scene& scene_;
  const std::vector<LoadKey>& keys_;
  std::vector<int> region_of_load_;  // −1 for boundary loads
};

/// The pressure region that a fault node touches on each side; -1 = none.
struct SideRegions {
  int minus = -1, plus = -1;
};

/// Per node the regions with the largest area beside it: over the pairs of neighbouring cells, area
/// times the share of the cell in the region.
/// @param region_of_load  of LoadFactors.
std::vector<SideRegions> side_regions(const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load);

/// Whether a prescribed change reaches any node of the fault: its window, or the cells beside it.
bool prescribed_pressure_acts(const Scene& scene, const FaultGeometry& geometry, std::size_t fault);

/// What blocks with an overpressure of their own add to the initial pressure in the faults, Pa
/// (n_nodes): per pair of neighbouring cells by the fault's rule from what they have beyond the
/// column, then the area-weighted mean. 0 for the rules prescribed and none, whose faults keep the
/// pressure of the column.
Eigen::VectorXd initial_pressure_excess(const Scene& scene, const FaultGeometry& geometry,
                                        const std::vector<int>& region_of_load);

/// Where a node is in the table of its fault: depth or distance down dip from the centre of the
/// patch, and distance along strike from that centre (field: y), m.
struct TablePlace {
  double dip = 0, strike = 0;
};
TablePlace place_in_table(const Scene& scene, std::size_t fault, const OperatorNode& node);

/// Δp_f of every fault node at a time, Pa (n_nodes): per pair of neighbouring cells by the fault's
/// rule, then the area-weighted mean (docs/model.md, section 5). A prescribed change without a
/// table is reached linearly over the first stage and held.
Eigen::VectorXd fault_pressure_change(const Scene& scene, const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load, double time,
                                      const std::vector<double>& pressure_change);

}  // namespace faultsim
