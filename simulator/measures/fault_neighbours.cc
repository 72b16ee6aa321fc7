#include "simulator/measures/fault_neighbours.h"

#include <algorithm>
#include <limits>

#include "simulator/common/ranges.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/loads/history.h"

namespace faultsim {

FaultNeighbours::FaultNeighbours(const Scene& scene, const FaultOperator& op)
    : scene_(scene),
      geometry_(op.geometry),
      touching_(side_regions(op.geometry, LoadFactors(scene, op).region_of_load())) {
  for (const OperatorFault& fault : geometry_.faults) {
    std::vector<int> regions;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      for (const int one : {touching_[k].minus, touching_[k].plus}) {
        if (one >= 0 && !contains(regions, one)) regions.push_back(one);
      }
    }
    of_fault_.push_back(std::move(regions));
  }
}

double FaultNeighbours::depth(int node) const { return -geometry_.nodes[node].position.z(); }

/// The node itself where it touches a region on that side, else the nearest one of its fault that
/// does; -1 = none does.
int FaultNeighbours::nearest(int node, int SideRegions::*side) const {
  if (touching_[node].*side >= 0) return node;
  int found = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const OperatorFault& fault : geometry_.faults) {
    if (node < fault.first_node || node >= fault.first_node + fault.n_nodes) continue;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      if (touching_[k].*side < 0) continue;
      const double distance =
          (geometry_.nodes[k].position - geometry_.nodes[node].position).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      found = k;
    }
  }
  return found;
}

SidePressures FaultNeighbours::at(int node, double depth, const PressureChanges& now) const {
  SidePressures sides;
  sides.change_in_fault = now.fault_pressure_change[node];
  const auto fill = [&](int SideRegions::*side, Eigen::Index column, std::string& name,
                        std::optional<double>& relative, std::optional<double>& absolute) {
    const int beside = nearest(node, side);
    if (beside < 0) return;
    const int region = touching_[beside].*side;
    name = scene_.pressure[region].region;
    relative = now.pressure_change[region];
    if (now.beside.rows() > 0) *relative += now.beside(beside, column);
    absolute = initial_region_pressure(scene_, region, depth) + *relative;
  };
  fill(&SideRegions::minus, 0, sides.region_minus, sides.change_minus, sides.absolute_minus);
  fill(&SideRegions::plus, 1, sides.region_plus, sides.change_plus, sides.absolute_plus);
  return sides;
}

double FaultNeighbours::lowest(int fault, const std::vector<double>& change) const {
  if (change.empty()) return 0;
  const std::vector<int>& own = of_fault_[fault];
  if (own.empty()) return *std::ranges::min_element(change);
  double lowest = change[own.front()];
  for (const int region : own) lowest = std::min(lowest, change[region]);
  return lowest;
}

int FaultNeighbours::widest_gap(int fault, const Eigen::VectorXd& jump,
                                const std::vector<FaultState>& state) const {
  const OperatorFault& one = geometry_.faults[fault];
  int widest = -1;
  for (int k = one.first_node; k < one.first_node + one.n_nodes; ++k) {
    if (state[k] != FaultState::open) continue;
    const auto gap = [&](int node) { return jump[geometry_.nodes[node].dof[0]]; };
    if (widest < 0 || gap(k) > gap(widest)) widest = k;
  }
  return widest;
}

}  // namespace faultsim
