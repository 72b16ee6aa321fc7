#include "simulator/coupled/box_study.h"

#include <numbers>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {

BulkProblem box_study(int cells_per_metre) {
  FAULTSIM_DEMAND(cells_per_metre >= 2 && cells_per_metre % 2 == 0, "1/h = ", cells_per_metre);
  const double h = 1.0 / cells_per_metre;
  BoxMeshSpec spec{};
  spec.from = {0, 0, 0};
  spec.to = {5, 2, 1};
  spec.layer_materials = {0};
  // Nodes on a patch's rim are not split, so it goes on outside the box where the cut is open.
  spec.fault_names = {"cut"};
  spec.patches.push_back({.center = {1.5, 1, 0.5},
                          .strike = 0,
                          .dip_from_vertical = std::numbers::pi / 2,
                          .length = 4,
                          .width = 5});
  spec.sizes = {.strike = h, .dip = h, .normal = h, .growth = 1.2, .fine_margin = 10, .largest = h};
  spec.plane_strain = false;
  BulkProblem problem;
  problem.mesh = make_mesh(spec);
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

}  // namespace faultsim
