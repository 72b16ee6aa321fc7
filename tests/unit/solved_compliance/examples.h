#pragma once

#include <memory>

#include "simulator/solved_compliance/solved_compliance.h"
#include "simulator/solved_compliance/solved_operator.h"
#include "tests/unit/condensation/junction_problem.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim::test {

/// A block that nothing but its fault holds along x.
inline BulkProblem loose_problem() {
  const std::array<int, 3> n = {4, 2, 2};
  BulkProblem problem;
  problem.mesh = make_box(n, {40, 20, 20}, {through(3, n)});
  problem.materials = {{11e9, 0.15}};
  problem.conditions = rollers({Side::x_min, Side::y_min, Side::y_max, Side::z_min});
  problem.loads = {stress_case(-1e6 * Eigen::Matrix3d::Identity(), {Side::x_max})};
  return problem;
}

/// Something of everything; faults that meet, in tetrahedra; a loose block; plane strain.
inline std::vector<BulkProblem> all_problems() {
  BulkProblem plane;
  plane.mesh = make_box({10, 1, 8}, {100, 10, 80}, {{4, 0, 1, 2, 7}}, shear_to_dip(75));
  make_plane_strain(plane.mesh, 10);
  plane.materials = {{11e9, 0.15}};
  plane.conditions = rollers({Side::x_min, Side::z_min});
  plane.loads = {stress_case(-1e6 * Eigen::Matrix3d::Identity(), {Side::x_max})};
  plane.observation_points = {{"top", {50, 0, 0}}};
  return {mixed_problem(), junction_problem(), loose_problem(), plane};
}

inline std::shared_ptr<const StuckBulk> stuck(const BulkProblem& problem,
                                              LeadingKind leading = LeadingKind::amg) {
  return std::make_shared<const StuckBulk>(std::make_shared<const BulkProblem>(problem),
                                           SolverChoice{.leading = leading});
}

}  // namespace faultsim::test
