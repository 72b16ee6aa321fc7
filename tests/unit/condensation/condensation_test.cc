#include "simulator/condensation/condensation.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <cmath>

#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

using test::condense;
using test::make_box;

Eigen::MatrixXd dense_stiffness(const BulkProblem& problem, const DofMap& dofs) {
  const SparseMatrix k =
      assemble_stiffness(problem.mesh, problem.materials, dofs, problem.mean_dilatation);
  const Eigen::MatrixXd full = Eigen::MatrixXd(k).selfadjointView<Eigen::Lower>();
  return full;
}

TEST(CondensedBulk, HIsTheDenseSchurComplement) {
  const BulkProblem problem = test::mixed_problem();
  const FaultOperator op = condense(problem);
  const DofMap dofs(problem.mesh, problem.conditions, 4);
  const Eigen::MatrixXd k = dense_stiffness(problem, dofs);
  const int n_r = dofs.n_bulk(), n_g = dofs.n_jump();
  ASSERT_GT(n_g, 40);
  const Eigen::LLT<Eigen::MatrixXd> k_rr(k.topLeftCorner(n_r, n_r));
  const Eigen::MatrixXd k_gr = k.bottomLeftCorner(n_g, n_r);
  const Eigen::MatrixXd h = k.bottomRightCorner(n_g, n_g) - k_gr * k_rr.solve(k_gr.transpose());
  EXPECT_LT((op.h() - h).norm(), 1e-12 * h.norm());
  EXPECT_EQ(Eigen::MatrixXd(op.h()), Eigen::MatrixXd(op.h().transpose()));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(op.h()).eigenvalues()[0], 0);
  const Eigen::VectorXd f = pressure_load(problem.mesh, dofs, 0);
  const Eigen::VectorXd load = f.tail(n_g) - k_gr * k_rr.solve(f.head(n_r));
  EXPECT_LT((op.loads.traction.col(0).cwiseProduct(op.geometry.dof_area) - load).norm(),
            1e-11 * load.norm());
}

// The same problem with both copies of each node independent and multipliers A Δt on the jumps:
// [[K, Cᵀ], [C, 0]] (u, A Δt) = (f, g), with C u the jump in the local frame.
TEST(CondensedBulk, AgreesWithTheSaddlePointSystem) {
  const std::array<int, 3> n = {5, 4, 4};
  BulkProblem problem;
  problem.mesh =
      make_box(n, {50, 40, 40}, {{2, 1, 4, 1, 3}, {4, 0, 3, 0, 3}}, test::shear_to_dip(65));
  test::distort(problem.mesh, 10, 0.05);
  test::set_region(problem.mesh, 0, 0.7, [](const auto& x) { return x.z() < -15; });
  problem.materials = {{11e9, 0.15}};
  // The second fault reaches y_min and z_min, which are free, so that every node has three jumps.
  problem.conditions = {
      {Side::x_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}};
  problem.loads = {test::pressure_case(0)};
  SilentMonitor monitor;
  CondensedBulk bulk(problem, monitor);
  const FaultOperator op = bulk.condense();

  const Mesh open = test::without_faults(problem.mesh);
  const DofMap dofs(open, problem.conditions, 1);
  const SparseMatrix k = assemble_stiffness(open, problem.materials, dofs, true);
  const int n_u = dofs.n_unknowns(), n_g = op.geometry.n_dofs;
  std::vector<Eigen::Triplet<double, long>> entries;
  for (long j = 0; j < k.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(k, j); it; ++it) {
      entries.emplace_back(it.row(), it.col(), it.value());
      if (it.row() != it.col()) entries.emplace_back(it.col(), it.row(), it.value());
    }
  }
  std::size_t index = 0;
  for (const FaultSurface& fault : problem.mesh.faults) {
    for (const FaultNode& node : fault.nodes) {
      const std::array<Eigen::Vector3d, 3> axes = {node.normal, node.strike, node.dip};
      for (std::size_t c = 0; c < 3; ++c) {
        const int row = n_u + op.geometry.nodes[index].dof[c];
        for (int i = 0; i < 3; ++i) {
          for (const auto& [of, sign] : {std::pair(node.plus_node, 1), {node.minus_node, -1}}) {
            const int column = dofs.terms(of, i)[0].unknown;
            entries.emplace_back(row, column, sign * axes[c][i] * k.coeff(0, 0));
            entries.emplace_back(column, row, sign * axes[c][i] * k.coeff(0, 0));
          }
        }
      }
      ++index;
    }
  }
  SparseMatrix saddle(n_u + n_g, n_u + n_g);
  saddle.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseMatrix<double> system = saddle.cast<double>();
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(system);
  ASSERT_EQ(lu.info(), Eigen::Success);

  const Eigen::VectorXd g = 1e-3 * Eigen::VectorXd::Random(n_g);
  const double factor = -20e6;
  Eigen::VectorXd right(n_u + n_g);
  right << factor * pressure_load(open, dofs, 0), k.coeff(0, 0) * g;
  const Eigen::VectorXd solution = lu.solve(right);
  const Eigen::VectorXd traction =
      (k.coeff(0, 0) * solution.tail(n_g)).cwiseQuotient(op.geometry.dof_area);
  const Eigen::VectorXd condensed =
      factor * op.loads.traction.col(0) - (op.h() * g).cwiseQuotient(op.geometry.dof_area);
  EXPECT_LT((condensed - traction).norm(), 1e-10 * traction.norm());
  const Eigen::Matrix3Xd u = bulk.displacement({factor}, g);
  const Eigen::Matrix3Xd u_saddle = nodal_displacement(open, dofs, solution.head(n_u), {});
  EXPECT_LT((u - u_saddle).norm(), 1e-10 * u_saddle.norm());
}

TEST(CondensedBulk, ObservationRowsEqualTheDisplacementField) {
  const BulkProblem problem = test::mixed_problem();
  SilentMonitor monitor;
  CondensedBulk bulk(problem, monitor);
  const FaultOperator op = bulk.condense();
  ASSERT_EQ(op.observed.rows.size(), 9u);
  EXPECT_EQ(op.observed.rows[0].name, "top.x");
  EXPECT_EQ(op.observed.rows[8].name, "corner.z");
  const std::vector<double> factors = {-20e6, 0.7, 3, -5e6};
  const Eigen::VectorXd g = 1e-3 * Eigen::VectorXd::Random(op.geometry.n_dofs);
  const Eigen::Matrix3Xd u = bulk.displacement(factors, g);
  const Eigen::VectorXd observed =
      op.observed.per_load * Eigen::Map<const Eigen::VectorXd>(factors.data(), 4) +
      op.observed.per_jump * g;
  for (std::size_t row = 0; row < 9; ++row) {
    // The nodes of a fault share a place: one of them must match.
    double best = 1;
    for (std::size_t i = 0; i < problem.mesh.nodes.size(); ++i) {
      if (problem.mesh.nodes[i] != op.observed.rows[row].position) continue;
      const double value = u(static_cast<Eigen::Index>(row % 3), static_cast<Eigen::Index>(i));
      best = std::min(best, std::abs(value - observed[static_cast<Eigen::Index>(row)]));
    }
    EXPECT_LT(best, 1e-12 * u.norm()) << op.observed.rows[row].name;
  }
  EXPECT_EQ(op.observed.per_load(6, 2), -1e-3 + 1e-5 * (op.observed.rows[6].position.sum()))
      << "a prescribed component";
}

TEST(CondensedBulk, SwappingTheSidesChangesSignsOnly) {
  BulkProblem problem = test::mixed_problem();
  const FaultOperator op = condense(problem);
  test::swap_sides(problem.mesh);
  const FaultOperator swapped = condense(problem);
  // n and strike turn round and so does the jump: g_n and g_strike stay, g_dip changes its sign.
  Eigen::VectorXd sign = Eigen::VectorXd::Ones(op.geometry.n_dofs);
  for (const OperatorNode& node : op.geometry.nodes) {
    if (node.dof[2] >= 0) sign[node.dof[2]] = -1;
  }
  const Eigen::MatrixXd back = sign.asDiagonal() * swapped.h() * sign.asDiagonal();
  EXPECT_LT((back - op.h()).norm(), 1e-13 * op.h().norm());
  EXPECT_LT((sign.asDiagonal() * swapped.loads.traction - op.loads.traction).norm(),
            1e-11 * op.loads.traction.norm());
  const PressurePair& pair = op.geometry.nodes[5].pressure.front();
  const PressurePair& other = swapped.geometry.nodes[5].pressure.front();
  EXPECT_EQ(pair.minus_region, other.plus_region);
  EXPECT_EQ(pair.plus_fraction, other.minus_fraction);
}

TEST(CondensedBulk, TwoBuildsHaveTheSameBits) {
  const BulkProblem problem = test::mixed_problem();
  const FaultOperator first = condense(problem);
  BulkProblem fewer = problem;
  fewer.observation_points.pop_back();
  const FaultOperator second = condense(fewer);
  EXPECT_EQ(Eigen::MatrixXd(first.h()), Eigen::MatrixXd(second.h()));
  EXPECT_EQ(first.loads.traction, second.loads.traction);
  EXPECT_EQ(first.observed.per_jump.topRows(6), second.observed.per_jump);
  EXPECT_EQ(first.observed.per_load.topRows(6), second.observed.per_load);
}

TEST(CondensedBulk, ReportsWhatItIsMadeOf) {
  const BulkProblem problem = test::mixed_problem();
  const FaultOperator op = condense(problem);
  EXPECT_EQ(op.fingerprint, "");
  ASSERT_EQ(op.loads.keys.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(op.loads.keys[k], problem.loads[k].key);
  EXPECT_EQ(op.n_unknowns, DofMap(problem.mesh, problem.conditions, 4).n_unknowns());
  EXPECT_GT(op.factor_bytes, 8.0 * op.n_unknowns);
  EXPECT_GT(op.build_seconds, 0);
  EXPECT_THAT(op.blas, testing::HasSubstr("1 thread"));
  ASSERT_EQ(op.geometry.faults.size(), 2u);
  EXPECT_EQ(op.geometry.faults[1].first_node, op.geometry.faults[0].n_nodes);
  EXPECT_EQ(op.geometry.n_dofs, op.h().rows());
  for (const OperatorNode& node : op.geometry.nodes) {
    double weight = 0;
    for (const PressurePair& pair : node.pressure) weight += pair.weight;
    EXPECT_NEAR(weight, 1, 1e-14);
    EXPECT_GT(node.area, 0);
  }
}

TEST(FaultGeometry, MeansOverTheFacesAroundANode) {
  const std::array<int, 3> n = {2, 2, 2};
  BulkProblem problem;
  problem.mesh = make_box(n, {20, 6, 8}, {test::through(1, n)});
  problem.materials = {{11e9, 0.1}, {40e9, 0.3}};
  Mesh& mesh = problem.mesh;
  // Plus side: stiff above. Pressure: region 3 below on the minus side, half filled where y < 3.
  for (std::size_t cell = 0; cell < 8; ++cell) {
    const Eigen::Vector3d x = mesh.nodes[static_cast<std::size_t>(mesh.cells[cell][0])];
    if (x.x() == 10 && x.z() == -4) mesh.material[cell] = 1;
    if (x.x() == 10 || x.z() == -4) continue;
    mesh.region[cell] = 3;
    mesh.region_fraction[cell] = x.y() == 0 ? 0.5 : 1;
  }
  problem.conditions =
      test::rollers({Side::y_min, Side::y_max, Side::z_min, Side::x_min, Side::x_max});
  const FaultOperator op = condense(problem);
  const OperatorNode& centre = op.geometry.nodes[4];
  EXPECT_EQ(centre.position, Eigen::Vector3d(10, 3, -4));
  EXPECT_DOUBLE_EQ(centre.area, 12);
  const double g1 = 5e9, g2 = 40e9 / 2.6;
  EXPECT_NEAR(centre.effective_shear_modulus, 0.5 * (g1 + 2 * g1 * g2 / (g1 + g2)), 1);
  EXPECT_NEAR(centre.poisson_ratio, 0.5 * (0.1 + 0.2), 1e-15);
  EXPECT_DOUBLE_EQ(centre.edge_strike, 3);
  EXPECT_DOUBLE_EQ(centre.edge_dip, 4);
  ASSERT_EQ(centre.pressure.size(), 3u);
  double none = 0, half = 0, whole = 0;
  for (const PressurePair& pair : centre.pressure) {
    EXPECT_EQ(pair.plus_region, -1);
    EXPECT_EQ(pair.minus_region, pair.minus_fraction > 0 ? 3 : -1);
    (pair.minus_fraction == 0 ? none : pair.minus_fraction == 0.5 ? half : whole) += pair.weight;
  }
  EXPECT_DOUBLE_EQ(none, 0.5);
  EXPECT_DOUBLE_EQ(half, 0.25);
  EXPECT_DOUBLE_EQ(whole, 0.25);
  EXPECT_EQ(centre.dof[0] >= 0 && centre.dof[1] >= 0 && centre.dof[2] >= 0, true);
  EXPECT_EQ(op.geometry.nodes[3].dof[1] >= 0, true);
  EXPECT_EQ(op.geometry.nodes[0].dof[1], -1) << "y_max holds strike";
}

}  // namespace
}  // namespace faultsim
