#include "simulator/measures/slip_events.h"

#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

/// Shear components of a dof vector at a node; removed ones are 0.
Eigen::Vector2d shear_at(const OperatorNode& node, const Eigen::VectorXd& values) {
  return {node.dof[1] >= 0 ? values[node.dof[1]] : 0, node.dof[2] >= 0 ? values[node.dof[2]] : 0};
}

/// Longest run of the nodes down dip, m.
double longest_run(const FaultGeometry& geometry, const std::vector<char>& inside) {
  double longest = 0;
  for (const OperatorFault& fault : geometry.faults) {
    for (const Profile& profile : fault.profiles) {
      double run = 0;
      for (std::size_t i = 0; i < profile.samples.size(); ++i) {
        run = inside[profile.samples[i].node[0]] ? run + profile.share(i) : 0;
        longest = std::max(longest, run);
      }
    }
  }
  return longest;
}

/// Weighted by area, m. @pre the nucleus has nodes.
Eigen::Vector3d nucleus_centre(const FaultGeometry& geometry, const ContactJump& jump) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double area = 0;
  for (const int k : jump.nucleus) {
    const OperatorNode& node = geometry.nodes[k];
    moment += node.area * node.position;
    area += node.area;
  }
  return moment / area;
}

void place_nucleus(const FaultOperator& op, const ContactJump& jump, SlipEvent& event) {
  if (jump.nucleus.empty()) return;
  std::vector<char> inside(op.geometry.nodes.size(), 0);
  for (const int k : jump.nucleus) inside[k] = 1;
  event.depth = -nucleus_centre(op.geometry, jump).z();
  event.nucleation_length = longest_run(op.geometry, inside);
  for (const OperatorFault& fault : op.geometry.faults) {
    const int k = jump.nucleus.front() - fault.first_node;
    if (k >= 0 && k < fault.n_nodes) event.fault = fault.name;
  }
}

}  // namespace

int nucleus_node(const FaultGeometry& geometry, const ContactJump& jump) {
  if (jump.nucleus.empty()) return -1;
  const Eigen::Vector3d centre = nucleus_centre(geometry, jump);
  const auto distance = [&](int node) {
    return (geometry.nodes[node].position - centre).squaredNorm();
  };
  return *std::ranges::min_element(jump.nucleus,
                                   [&](int a, int b) { return distance(a) < distance(b); });
}

double nucleation_ratio(const OperatorNode& node, const NodeLaw& law, bool plane_strain,
                        double normal_traction) {
  if (!law.weakens()) return 0;
  const double rate = -law.strength(normal_traction, {0, 0}, 0, {}).d_measure;
  const double g = node.effective_shear_modulus;
  const double down_dip = node.edge_dip / nucleation_length(g / (1 - node.poisson_ratio), rate);
  const double along = plane_strain ? 0 : node.edge_strike / nucleation_length(g, rate);
  return std::max(down_dip, along);
}

SlipEvent measure_event(const FaultOperator& op, const ContactLaws& laws, const ContactJump& jump) {
  SlipEvent event;
  event.load_factor_before = jump.load_before;
  event.load_factor_after = jump.load_after;
  place_nucleus(op, jump, event);
  const double multiplicity = op.geometry.half_domain ? 2 : 1;
  double weighted_drop = 0, ratio = 0;
  for (std::size_t k = 0; k < op.geometry.nodes.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const Eigen::Vector2d slip = shear_at(node, jump.jump_after) - shear_at(node, jump.jump_before);
    const double length = slip.norm();
    if (length == 0) continue;
    const double area = multiplicity * node.area;
    event.slipped_area += area;
    event.max_slip = std::max(event.max_slip, length);
    event.potency += area * length;
    event.moment += area * node.effective_shear_modulus * length;
    const Eigen::Vector2d drop =
        shear_at(node, jump.traction_before) - shear_at(node, jump.traction_after);
    weighted_drop += area * drop.dot(slip);
    ratio = std::max(ratio, nucleation_ratio(node, NodeLaw(laws[k]), op.geometry.plane_strain,
                                             jump.traction_before[node.dof[0]]));
  }
  if (event.slipped_area > 0) event.mean_slip = event.potency / event.slipped_area;
  if (event.potency > 0) event.stress_drop = weighted_drop / event.potency;
  if (!op.geometry.plane_strain) event.magnitude = moment_magnitude(event.moment);
  event.resolved = ratio <= 1.0 / 3.0;
  event.duration = jump.duration;
  event.negative_pivots = jump.negative_pivots;
  event.n_lost_cohesion = jump.n_lost_cohesion;
  event.residual_before = jump.residual_before;
  event.residual_after = jump.residual_after;
  event.energy_released = multiplicity * jump.released;
  event.energy_dissipated = multiplicity * jump.dissipated;
  constexpr double kEquilibrium = 10;  // a step is accepted at 4, judged at a slightly other load
  event.evidence_holds = (jump.negative_pivots > 0 || jump.n_lost_cohesion > 0) &&
                         jump.dissipated >= 0 && jump.released >= jump.dissipated * (1 - 1e-9) &&
                         jump.residual_before <= kEquilibrium &&
                         jump.residual_after <= kEquilibrium;
  return event;
}

}  // namespace faultsim
