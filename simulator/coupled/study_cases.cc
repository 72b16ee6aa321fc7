#include "simulator/coupled/study_cases.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {
namespace {

/// Parallel faults in the middle of a box, strike along y; lengths in m.
struct ParallelFaults {
  int n_faults = 0, cells_along_strike = 0, cells_down = 0;
  double length = 0, height = 0, spacing = 0, dip = 0;  ///< dip in rad from vertical
  std::array<double, 3> from, to;                       ///< the box
  double normal = 0, growth = 1, largest = 0;           ///< of the cells beside the faults
};

ParallelFaults faults_of(StudyCase which) {
  const double dip = 20 * std::numbers::pi / 180;
  switch (which) {
    case StudyCase::cuts15:
      return {15, 62, 62, 620, 620, 10, 0, {-80, -310, -620}, {90, 310, 0}, 10, 1, 10};
    case StudyCase::field_a:
      return {3,   44,  32, 4400, 1600, 1000, dip, {-3000, -3500, -3000}, {3000, 3500, 0},
              200, 1.4, 600};
    case StudyCase::field_b:
      return {2,  24,  21, 2400, 1050, 1000, dip, {-2500, -2500, -2500}, {2500, 2500, 0},
              80, 1.6, 800};
    case StudyCase::field_c:
      return {5,  60,  44, 6000, 2200, 1500, dip, {-7500, -7000, -4000}, {7500, 7000, 0},
              50, 1.4, 600};
    case StudyCase::box:
      break;
  }
  FAULTSIM_DEMAND(false, "the box has a study of its own");
}

BoxMeshSpec spec_of(const ParallelFaults& faults) {
  BoxMeshSpec spec{};
  spec.from = faults.from;
  spec.to = faults.to;
  spec.layer_materials = {0};
  for (int k = 0; k < faults.n_faults; ++k) {
    const double x = (k - (faults.n_faults - 1) / 2.0) * faults.spacing;
    spec.fault_names.push_back(concat("fault ", k + 1));
    spec.patches.push_back({.center = {x, 0, faults.from[2] / 2},
                            .strike = 0,
                            .dip_from_vertical = faults.dip,
                            .length = faults.length,
                            .width = faults.height / std::cos(faults.dip)});
  }
  spec.sizes = {.strike = faults.length / faults.cells_along_strike,
                .dip = faults.height / faults.cells_down,
                .normal = faults.normal,
                .growth = faults.growth,
                .largest = faults.largest};
  return spec;
}

/// How far a node is from the middle of its fault: 0 there, 1 at the ends.
std::vector<double> distances_from_middle(const Mesh& mesh, const FaultSurface& fault) {
  Eigen::AlignedBox3d bounds;
  for (const FaultNode& node : fault.nodes) bounds.extend(mesh.nodes[node.minus_node]);
  const Eigen::Vector3d half = bounds.sizes().cwiseMax(1e-9) / 2;
  std::vector<double> distances;
  for (const FaultNode& node : fault.nodes) {
    distances.push_back(
        (mesh.nodes[node.minus_node] - bounds.center()).cwiseQuotient(half).cwiseAbs().maxCoeff());
  }
  return distances;
}

/// Slip as of a crack, largest in the middle. @param distance  0 … 1, from there to its end.
NodeLinearisation slipping(double distance) {
  CoulombLaw law;
  law.cohesion = 1e5;
  law.static_friction_angle = 0.5;
  law.dynamic_friction_angle = 0.45;
  law.slip_weakening_distance = 0.05;
  SlippingPoint point;
  point.normal_traction = -3e6;
  point.slip_increment = 1e-2 * std::sqrt(1.01 - distance * distance) * Eigen::Vector2d(0.6, 0.8);
  NodeLinearisation node;
  node.state = FaultState::slip;
  node.tangent = slip_tangent(NodeLaw(law), point);
  return node;
}

}  // namespace

BulkProblem study_case(StudyCase which) {
  BulkProblem problem;
  problem.mesh = make_mesh(spec_of(faults_of(which)));
  problem.materials = {{10e9, 0.25}};
  problem.conditions = {
      {Side::z_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}};
  LoadCase load;
  load.key.kind = LoadKey::Kind::boundary;
  load.stress_groups = {Side::z_max};
  load.stress(2, 2) = -1e6;
  load.stress(0, 2) = load.stress(2, 0) = 0.5e6;
  problem.loads = {load};
  return problem;
}

std::vector<NodeLinearisation> stage_of(const Mesh& mesh, FaultStage stage) {
  constexpr double kSlips = 0.7, kOpen = 0.35;
  std::vector<NodeLinearisation> nodes;
  for (const FaultSurface& fault : mesh.faults) {
    for (const double distance : distances_from_middle(mesh, fault)) {
      nodes.emplace_back();
      if (stage == FaultStage::stick || distance > kSlips) continue;
      if (stage == FaultStage::open && distance <= kOpen) {
        nodes.back().state = FaultState::open;
      } else {
        nodes.back() = slipping(distance / kSlips);
      }
    }
  }
  return nodes;
}

}  // namespace faultsim
