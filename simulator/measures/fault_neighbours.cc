#include "simulator/measures/fault_neighbours.h"

#include <algorithm>
#include <limits>

#include "simulator/loads/history.h"
#include "simulator/scene/initial_state.h"

namespace faultsim {

FaultNeighbours::FaultNeighbours(const Scene& scene, const FaultOperator& op)
    : scene_(scene), geometry_(op.geometry), touching_(op.geometry.nodes.size()) {
  const LoadFactors loads(scene, op);
  const std::vector<int>& region = loads.region_of_load();
  for (const OperatorFault& fault : geometry_.faults) {
    std::vector<int> regions;
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      double most_minus = 0, most_plus = 0;  // of the area beside the node that is in the region
      for (const PressurePair& pair : geometry_.nodes[k].pressure) {
        const double minus = pair.weight * pair.minus_fraction;
        const double plus = pair.weight * pair.plus_fraction;
        if (pair.minus_region >= 0 && minus > most_minus) {
          most_minus = minus;
          touching_[k].minus = region[pair.minus_region];
        }
        if (pair.plus_region >= 0 && plus > most_plus) {
          most_plus = plus;
          touching_[k].plus = region[pair.plus_region];
        }
      }
      for (const int one : {touching_[k].minus, touching_[k].plus}) {
        if (one >= 0 && std::count(regions.begin(), regions.end(), one) == 0)
          regions.push_back(one);
      }
    }
    of_fault_.push_back(std::move(regions));
  }
}

double FaultNeighbours::depth(int node) const { return -geometry_.nodes[node].position.z(); }

/// The region of that side at the node, else at the nearest node of its fault that has one.
int FaultNeighbours::nearest(int node, int Sides::*side) const {
  if (touching_[node].*side >= 0) return touching_[node].*side;
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
      found = touching_[k].*side;
    }
  }
  return found;
}

SidePressures FaultNeighbours::at(int node, double depth, const std::vector<double>& change,
                                  const Eigen::VectorXd& in_fault) const {
  SidePressures sides;
  sides.change_in_fault = in_fault[node];
  const auto fill = [&](int region, std::string& name, std::optional<double>& relative,
                        std::optional<double>& absolute) {
    if (region < 0) return;
    name = scene_.pressure[region].region;
    relative = change[region];
    absolute = initial_region_pressure(scene_, region, depth) + change[region];
  };
  fill(nearest(node, &Sides::minus), sides.region_minus, sides.change_minus, sides.absolute_minus);
  fill(nearest(node, &Sides::plus), sides.region_plus, sides.change_plus, sides.absolute_plus);
  return sides;
}

double FaultNeighbours::lowest(int fault, const std::vector<double>& change) const {
  if (change.empty()) return 0;
  const std::vector<int>& own = of_fault_[fault];
  if (own.empty()) return *std::min_element(change.begin(), change.end());
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
