#pragma once

#include "simulator/elasticity/bulk_problem.h"
#include "tests/unit/mesh/cut_body.h"

namespace faultsim::test {

/// A cube of tetrahedra that a fault A cuts from the top down, and a fault B that ends at A; on
/// both sides of B the rock loses pressure unevenly, its side is pulled and pushed along.
inline BulkProblem junction_problem() {
  constexpr int kCubes = 4;
  const auto below_rim = [](const Eigen::Vector3d& x) { return x.z() > 1; };
  UncutMesh body = body_of(
      made_of(kCubes, 3), kCubes,
      {{"A", {1, 0, 0}, 2, below_rim},
       {"B", {0, 1, 0}, 2, [=](const Eigen::Vector3d& x) { return below_rim(x) && x.x() > 2; }}});
  distort(body, kCubes, 0.12);
  for (std::size_t cell = 0; cell < body.n_cells(); ++cell) {
    const Eigen::Vector3d& x = body.nodes[static_cast<std::size_t>(body.corners[4 * cell])];
    const bool inside = x.x() >= 2 && x.y() >= 2 && x.z() >= 1;
    body.region[cell] = inside ? 0 : -1;
    body.region_fraction[cell] = inside ? 1 : 0;
  }
  for (Eigen::Vector3d& x : body.nodes) x = 100 * x - Eigen::Vector3d(0, 0, 400);
  BulkProblem problem;
  problem.mesh = cut(body, "");
  problem.materials = {{12e9, 0.2}};
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  Eigen::Matrix3d none = Eigen::Matrix3d::Zero(), pull = none, shear = none;
  pull(0, 0) = 1;
  shear(0, 1) = shear(1, 0) = 1;
  problem.conditions = {{Side::z_min, {true, true, true}, zero, none, -1}};
  LoadCase pressure, sideways, tension;
  pressure.region = 0;
  sideways.stress_groups = {Side::x_max};
  sideways.stress = shear;
  tension.stress_groups = {Side::x_max};
  tension.stress = pull;
  problem.loads = {pressure, sideways, tension};
  return problem;
}

}  // namespace faultsim::test
