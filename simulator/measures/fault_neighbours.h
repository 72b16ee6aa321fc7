#pragma once

#include <vector>

#include "simulator/loads/case_loads.h"
#include "simulator/loads/history.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Which pressure regions lie beside the faults, and their pressures at places on them.
class FaultNeighbours {
 public:
  /// @pre scene and op outlive this.
  FaultNeighbours(const Scene& scene, const FaultOperator& op);

  /// Of a field of pressures those of its cells beside the place, else of the compartments there.
  /// @param node  into FaultGeometry::nodes.
  /// @param depth  m, of the place: where absolute pressures are taken.
  SidePressures at(int node, double depth, const PressureChanges& now) const;
  /// Δp of the most depleted of the regions that touch the fault, Pa; of all regions where none
  /// does; 0 without regions.
  double lowest(int fault, const std::vector<double>& change) const;
  double depth(int node) const;
  /// The open node of the fault with the largest gap in a jump vector; -1 = none is open.
  int widest_gap(int fault, const Eigen::VectorXd& jump,
                 const std::vector<FaultState>& state) const;

 private:
  int nearest(int node, int SideRegions::*side) const;

  const Scene& scene_;
  const FaultGeometry& geometry_;
  std::vector<SideRegions> touching_;       ///< per node.
  std::vector<std::vector<int>> of_fault_;  ///< regions that touch each fault.
};

}  // namespace faultsim
