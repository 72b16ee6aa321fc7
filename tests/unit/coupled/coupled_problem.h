#pragma once

#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "simulator/coupled/saddle_point.h"
#include "tests/unit/condensation/junction_problem.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim::test {

/// The all-stick Jacobian of a problem, of condensation's with something of everything if none is
/// given.
struct CoupledExample {
  explicit CoupledExample(BulkProblem given = mixed_problem())
      : problem(std::move(given)), bulk(problem), stick(make_saddle_point(bulk)) {}

  /// Every third node slips, every seventh is open.
  std::vector<NodeLinearisation> some_move() const {
    std::vector<NodeLinearisation> nodes(bulk.fault_nodes().size());
    for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
      if (k % 7 == 3) nodes[k].state = FaultState::open;
      if (k % 3 != 1 || k % 7 == 3) continue;
      nodes[k].state = FaultState::slip;
      CoulombLaw law;
      law.cohesion = 1e5;
      law.static_friction_angle = 0.5;
      law.dynamic_friction_angle = 0.2;
      law.slip_weakening_distance = 0.02;
      SlippingPoint point;
      point.normal_traction = -2e6;
      point.slip_increment = 1e-2 * Eigen::Vector2d(std::cos(k), std::sin(k));
      point.before.slip = {1e-3, -2e-3};
      nodes[k].tangent = slip_tangent(NodeLaw(law), point);
    }
    return nodes;
  }

  /// The Jacobian with all in stick, and with slip and opening.
  std::vector<SaddlePoint> both() const { return {stick, make_saddle_point(bulk, some_move())}; }

  BulkProblem problem;
  TwoSidedBulk bulk;
  SaddlePoint stick;
};

/// S = Cᵀ (K + E)⁻¹ (C − F) by dense algebra.
inline Eigen::MatrixXd dense_schur(const SaddlePoint& j) {
  return Eigen::MatrixXd(j.constraint).transpose() *
         Eigen::MatrixXd(j.leading()).partialPivLu().solve(Eigen::MatrixXd(j.coupling));
}

/// The matrix of a linear map, column by column.
template <typename Map>
Eigen::MatrixXd matrix_of(const Map& map, int n) {
  Eigen::MatrixXd matrix(n, n);
  Eigen::VectorXd column;
  for (int i = 0; i < n; ++i) {
    map(Eigen::VectorXd::Unit(n, i), column);
    matrix.col(i) = column;
  }
  return matrix;
}

}  // namespace faultsim::test
