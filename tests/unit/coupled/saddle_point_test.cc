#include "simulator/coupled/saddle_point.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "simulator/common/errors.h"
#include "simulator/condensation/condensation.h"
#include "simulator/coupled/coupled_solver.h"
#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;

/// A g of every multiplier, from the displacements of both sides.
Eigen::VectorXd areas_times_jumps(const TwoSidedBulk& bulk, const Eigen::VectorXd& u) {
  std::vector<double> values;
  for (const TwoSidedNode& node : bulk.fault_nodes()) {
    Eigen::Vector3d jump = Eigen::Vector3d::Zero();
    for (const JumpTerm& term : node.terms) {
      for (std::size_t c = 0; c < 3; ++c)
        if (term.dof[c] >= 0) jump[static_cast<int>(c)] += term.factor * u[term.dof[c]];
    }
    for (int c = 0; c < 3; ++c) {
      if (node.may_jump(c)) values.push_back(node.area * node.frame.col(c).dot(jump));
    }
  }
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<int>(values.size()));
}

/// Values per dof of an operator in the order of multipliers.
Eigen::VectorXd node_by_node(const FaultOperator& op, const Eigen::VectorXd& values) {
  std::vector<int> dofs;
  for (const auto& node : op.geometry.nodes)
    for (const int dof : node.dof)
      if (dof >= 0) dofs.push_back(dof);
  return values(dofs);
}

TEST(SaddlePoint, ConstraintsAreAreasTimesJumpsAndOrthogonal) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  ASSERT_GT(j.n_multipliers(), 30);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(j.n_displacements());
  const Eigen::VectorXd expected = areas_times_jumps(example.bulk, u);
  ASSERT_EQ(expected.size(), j.n_multipliers());
  EXPECT_LT((j.constraint.transpose() * u - expected).norm(), 1e-12 * expected.norm());
  Eigen::MatrixXd gram = Eigen::MatrixXd(j.constraint).transpose() * Eigen::MatrixXd(j.constraint);
  EXPECT_LT((gram.diagonal() - j.gram()).norm(), 1e-12 * j.gram().norm());
  const double size = gram.diagonal().minCoeff();
  gram.diagonal().setZero();
  EXPECT_LT(gram.cwiseAbs().maxCoeff(), 1e-12 * size);
}

TEST(SaddlePoint, IsSymmetricWhereAllStick) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  EXPECT_TRUE(j.symmetric);
  EXPECT_EQ((j.coupling - j.constraint).norm(), 0);
  const SparseMatrix transposed = j.leading().transpose();
  EXPECT_EQ((j.leading() - transposed).norm(), 0);
}

TEST(SaddlePoint, RigidMotionsNeedNoForce) {
  for (int motion = 0; motion < 6; ++motion) {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    if (motion < 3) {
      translation[motion] = 1;
    } else {
      const int a = (motion + 1) % 3, b = (motion + 2) % 3;
      gradient(b, a) = 0.1;
      gradient(a, b) = -0.1;
    }
    BulkProblem problem = test::mixed_problem();
    problem.conditions = test::affine(translation, gradient);
    problem.loads = {test::displacement_case()};
    const TwoSidedBulk bulk(problem);
    Eigen::VectorXd u(bulk.n_displacements());
    for (int i = 0; i < static_cast<int>(problem.mesh.nodes.size()); ++i) {
      for (int c = 0; c < 3; ++c) {
        u[bulk.dof(i, c)] = translation[c] + gradient.row(c).dot(problem.mesh.nodes[i]);
      }
    }
    const Eigen::VectorXd force = bulk.stiffness() * u;
    EXPECT_LT((force - bulk.load(0)).norm(), 1e-12 * bulk.stiffness().diagonal().mean() * u.norm());
    const Eigen::MatrixXd motions = bulk.rigid_motions();
    EXPECT_LT((u - motions * (motions.transpose() * u)).norm(), 1e-12 * u.norm()) << motion;
    EXPECT_LT((motions.transpose() * motions - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-12);
  }
}

void expect_condensed_where_all_stick(const CoupledExample& example) {
  SilentMonitor monitor;
  CondensedBulk condensed(example.problem, monitor);
  const FaultOperator op = condensed.condense();
  const SaddlePoint& j = example.stick;
  ASSERT_EQ(j.n_multipliers(), op.geometry.n_dofs);
  CoupledSolver solver(j, {.leading = LeadingKind::exact, .schur = SchurKind::lsc});
  for (int k = 0; k < static_cast<int>(example.problem.loads.size()); ++k) {
    Eigen::VectorXd u, traction;
    const CoupledReport report = solver.solve(
        example.bulk.load(k), Eigen::VectorXd::Zero(j.n_multipliers()), 1e-12, 200, u, traction);
    ASSERT_TRUE(report.converged);
    const Eigen::VectorXd locked = node_by_node(op, op.loads.traction.col(k));
    EXPECT_LT((traction - locked).norm(), 1e-9 * locked.norm()) << k;
    std::vector<double> factors(example.problem.loads.size(), 0);
    factors[k] = 1;
    const Eigen::Matrix3Xd expected =
        condensed.displacement(factors, Eigen::VectorXd::Zero(op.geometry.n_dofs));
    EXPECT_LT((example.bulk.nodal_displacement(u) - expected).cwiseAbs().maxCoeff(),
              1e-9 * expected.cwiseAbs().maxCoeff())
        << k;
  }
}

TEST(SaddlePoint, WhereAllStickIsTheCondensedSolution) {
  const CoupledExample example;
  const DofMap dofs(example.problem.mesh, example.problem.conditions, 4);
  ASSERT_FALSE(dofs.locked_positions().empty());
  expect_condensed_where_all_stick(example);
  expect_condensed_where_all_stick(CoupledExample(test::junction_problem()));
}

/// t = L − A⁻¹ H g with t_T = D g_T + d t_N where a node slips, t = 0 where it is open and g = 0
/// elsewhere: the same linear problem, condensed. Unknowns (g, t), dense.
Eigen::VectorXd condensed_tractions(const FaultOperator& op, int load,
                                    const std::vector<NodeLinearisation>& nodes) {
  const int n = op.geometry.n_dofs;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * n);
  m.topLeftCorner(n, n) = op.geometry.dof_area.cwiseInverse().asDiagonal() * op.h();
  m.topRightCorner(n, n).setIdentity();
  right.head(n) = op.loads.traction.col(load);
  for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
    const auto& dof = op.geometry.nodes[k].dof;
    for (int c = 0; c < 3; ++c) {
      if (dof[c] < 0) continue;
      const int row = n + dof[c];
      if (nodes[k].state == FaultState::open) {
        m(row, row) = 1;
      } else if (nodes[k].state == FaultState::slip && c > 0) {
        m(row, row) = 1;
        m(row, n + dof[0]) = -nodes[k].tangent.d_normal[c - 1];
        for (int b = 1; b < 3; ++b) {
          if (dof[b] >= 0) m(row, dof[b]) = -nodes[k].tangent.d_slip(c - 1, b - 1);
        }
      } else {
        m(row, dof[c]) = 1;
      }
    }
  }
  return m.partialPivLu().solve(right).tail(n);
}

void expect_condensed_with_slip_and_opening(const CoupledExample& example) {
  const std::vector<NodeLinearisation> nodes = example.some_move();
  std::vector<NodeLinearisation> may_move;  // the operator leaves out nodes that stay closed
  for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
    if (example.bulk.fault_nodes()[k].may_jump(0)) may_move.push_back(nodes[k]);
  }
  const SaddlePoint j = make_saddle_point(example.bulk, nodes);
  EXPECT_FALSE(j.symmetric);
  ASSERT_LT(j.n_multipliers(), example.stick.n_multipliers());
  const FaultOperator op = test::condense(example.problem);
  CoupledSolver solver(j, {.leading = LeadingKind::exact, .schur = SchurKind::exact});
  Eigen::VectorXd u, lambda;
  const CoupledReport report = solver.solve(
      example.bulk.load(1), Eigen::VectorXd::Zero(j.n_multipliers()), 1e-12, 50, u, lambda);
  ASSERT_TRUE(report.converged);
  ASSERT_EQ(may_move.size(), op.geometry.nodes.size());
  const Eigen::VectorXd expected = condensed_tractions(op, 1, may_move);
  int n_slip = 0, multiplier = 0;
  for (int k = 0; k < static_cast<int>(may_move.size()); ++k) {
    n_slip += may_move[k].state == FaultState::slip;
    const int n_held = may_move[k].state == FaultState::stick  ? 3
                       : may_move[k].state == FaultState::slip ? 1
                                                               : 0;
    for (int c = 0; c < n_held; ++c) {
      const int dof = op.geometry.nodes[k].dof[c];
      if (dof < 0) continue;
      ASSERT_LT(multiplier, lambda.size());
      EXPECT_NEAR(lambda[multiplier++], expected[dof], 1e-8 * expected.cwiseAbs().maxCoeff());
    }
  }
  EXPECT_EQ(multiplier, lambda.size());
  EXPECT_GT(n_slip, 5);
}

TEST(SaddlePoint, WithSlipAndOpeningIsTheCondensedSolution) {
  expect_condensed_with_slip_and_opening(CoupledExample());
  expect_condensed_with_slip_and_opening(CoupledExample(test::junction_problem()));
}

TEST(SaddlePoint, EAndFAreTheDerivativesOfTheForceOfASlippingNode) {
  const CoupledExample example;
  const std::vector<TwoSidedNode>& fault_nodes = example.bulk.fault_nodes();
  int slipping = 0;
  while (!fault_nodes[slipping].may_jump(1)) ++slipping;
  const TwoSidedNode& node = fault_nodes[slipping];
  ASSERT_EQ(node.terms.size(), 2);
  const JumpTerm &minus = node.terms[0], &plus = node.terms[1];
  ASSERT_EQ(minus.factor, -1);
  ASSERT_EQ(plus.factor, 1);
  CoulombLaw law;
  law.static_friction_angle = 0.6;
  law.dynamic_friction_angle = 0.3;
  law.slip_weakening_distance = 0.05;
  const auto shear_of = [&](const Eigen::VectorXd& u) {  // g_T of the node
    Eigen::Vector2d slip(0, 0);
    for (int c = 0; c < 3; ++c) {
      slip += (u[plus.dof[c]] - u[minus.dof[c]]) * node.frame.row(c).tail<2>().transpose();
    }
    return slip;
  };
  const auto point_of = [&](const Eigen::VectorXd& u, double normal) {
    SlippingPoint point;
    point.normal_traction = normal;
    point.slip_increment = shear_of(u);
    point.before.slip = {0.002, 0.001};
    return point;
  };
  // The force K u + C_N t_N + C_T t*_T on all dofs.
  const auto force = [&](const Eigen::VectorXd& u, double normal) {
    Eigen::VectorXd f = example.bulk.stiffness() * u;
    const Eigen::Vector2d shear = slip_tangent(NodeLaw(law), point_of(u, normal)).traction;
    const Eigen::Vector3d t = node.frame * Eigen::Vector3d(normal, shear[0], shear[1]);
    for (int c = 0; c < 3; ++c) {
      f[plus.dof[c]] += node.area * t[c];
      f[minus.dof[c]] -= node.area * t[c];
    }
    return f;
  };
  Eigen::VectorXd u = Eigen::VectorXd::Zero(example.bulk.n_displacements());
  for (int c = 0; c < 3; ++c) u[plus.dof[c]] = 0.01 * (c + 1);
  const double normal = -3e6;
  std::vector<NodeLinearisation> nodes(fault_nodes.size());
  nodes[slipping] = {FaultState::slip, slip_tangent(NodeLaw(law), point_of(u, normal))};
  const SaddlePoint j = make_saddle_point(example.bulk, nodes);
  const int column = j.node_begin[slipping];
  ASSERT_EQ(j.node_begin[slipping + 1], column + 1);

  const double dt = 1e2;
  const Eigen::VectorXd by_traction = (force(u, normal + dt) - force(u, normal - dt)) / (2 * dt);
  const Eigen::VectorXd coupling = j.coupling.col(column);
  EXPECT_LT((by_traction - coupling).norm(), 1e-7 * coupling.norm());
  EXPECT_GT((coupling - Eigen::VectorXd(j.constraint.col(column))).norm(), 0.1 * coupling.norm())
      << "F is there";
  for (const int dof : {plus.dof[0], plus.dof[1], minus.dof[2]}) {
    const double du = 1e-6;
    const Eigen::VectorXd step = du * Eigen::VectorXd::Unit(u.size(), dof);
    const Eigen::VectorXd by_u = (force(u + step, normal) - force(u - step, normal)) / (2 * du);
    const Eigen::VectorXd expected = j.leading().col(dof);
    const Eigen::VectorXd bulk_alone = example.bulk.stiffness().col(dof);
    EXPECT_LT((by_u - expected).norm(), 1e-6 * (expected - bulk_alone).norm()) << dof;
  }
}

TEST(SlipTangent, DerivativesAreThoseOfTheTraction) {
  for (const bool cumulated : {false, true}) {
    for (const WeakeningLaw weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
      CoulombLaw law;
      law.weakening = weakening;
      law.cohesion = 1e5;
      law.static_friction_angle = 0.6;
      law.dynamic_friction_angle = 0.3;
      law.slip_weakening_distance = 0.05;
      law.slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
      SlippingPoint point{.normal_traction = -4e6,
                          .slip_increment = {0.012, -0.007},
                          .before = {.slip = {0.004, 0.005}, .path = 0.01},
                          .traction_direction = {0, 0}};
      const SlipTangent at = slip_tangent(NodeLaw(law), point);
      for (int c = 0; c < 2; ++c) {
        const double step = 1e-7;
        SlippingPoint more = point, less = point;
        more.slip_increment[c] += step;
        less.slip_increment[c] -= step;
        const Eigen::Vector2d difference = (slip_tangent(NodeLaw(law), more).traction -
                                            slip_tangent(NodeLaw(law), less).traction) /
                                           (2 * step);
        EXPECT_LT((difference - at.d_slip.col(c)).norm(), 1e-6 * at.d_slip.norm());
      }
      SlippingPoint more = point;
      more.normal_traction += 10;
      const Eigen::Vector2d difference =
          (slip_tangent(NodeLaw(law), more).traction - at.traction) / 10;
      EXPECT_LT((difference - at.d_normal).norm(), 1e-7);
      EXPECT_LT(at.d_normal.dot(point.slip_increment), 0) << "compression strengthens";
    }
  }
}

TEST(SlipTangent, OfANodeJustSetToSlipFollowsItsTraction) {
  CoulombLaw law;
  law.static_friction_angle = law.dynamic_friction_angle = 0.5;
  SlippingPoint point;
  point.normal_traction = -1e6;
  point.traction_direction = {0.6, 0.8};
  const SlipTangent at = slip_tangent(NodeLaw(law), point);
  EXPECT_NEAR((at.traction - 1e6 * std::tan(0.5) * point.traction_direction).norm(), 0, 1e-6);
  EXPECT_EQ(at.d_slip.norm(), 0);
}

TEST(TwoSidedBulk, RefusesAPieceThatNothingHolds) {
  const std::array<int, 3> n = {4, 2, 2};
  BulkProblem problem;
  problem.mesh = test::make_box(n, {40, 20, 20}, {test::through(2, n)});
  problem.materials = {{11e9, 0.15}};
  problem.conditions = test::rollers({Side::x_min, Side::y_min, Side::y_max, Side::z_min});
  try {
    const TwoSidedBulk bulk(problem);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a piece of 8 cells that the faults cut loose can "
                                                 "move along x"));
    EXPECT_THAT(error.what(), testing::HasSubstr("use the condensed path"));
  }
}

}  // namespace
}  // namespace faultsim
