#include "simulator/coupled/schur.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <set>

#include "simulator/coupled/augmented.h"
#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;
using test::dense_schur;
using test::matrix_of;

constexpr FsaiOptions kSchurFsai{.steps = 5, .step_size = 2, .tolerance = 0.01};

Eigen::MatrixXd inverse_by(SchurKind kind, const SaddlePoint& j) {
  const auto schur = schur_complement(kind, j, kSchurFsai);
  return matrix_of(schur, j.n_multipliers());
}

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(Schur, ExactIsTheInverse) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    EXPECT_LT(relative_difference(inverse_by(SchurKind::exact, j), dense_schur(j).inverse()), 1e-8);
  }
}

TEST(Schur, LscIsItsDefinition) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const Eigen::MatrixXd c = j.constraint;
    const Eigen::MatrixXd gram = (c.transpose() * c).inverse();
    const Eigen::MatrixXd expected =
        gram * c.transpose() * Eigen::MatrixXd(j.leading()) * Eigen::MatrixXd(j.coupling) * gram;
    EXPECT_LT(relative_difference(inverse_by(SchurKind::lsc, j), expected), 1e-12);
  }
}

TEST(Schur, LscHasNoEigenvalueBelowOne) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Eigen::MatrixXd s = dense_schur(j);
  const Eigen::MatrixXd approximation = inverse_by(SchurKind::lsc, j).inverse();
  // S v = μ S_LSC v
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      (s + s.transpose()) / 2, (approximation + approximation.transpose()) / 2);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 1 - 1e-9);
  EXPECT_GT(eigen.eigenvalues().maxCoeff(), 1.2) << "or the bound would say nothing";
}

/// K + E restricted to the dofs of all cells that touch either side of a node, from the mesh.
Eigen::MatrixXd block_from_cells(const CoupledExample& example, const FaultNode& node,
                                 const SaddlePoint& j, int first, int last) {
  const Mesh& mesh = example.problem.mesh;
  std::set<int> dofs;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const std::span<const int> cell = mesh.cells[k];
    const bool touches = std::any_of(cell.begin(), cell.end(), [&](int corner) {
      return corner == node.minus_node || corner == node.plus_node;
    });
    if (!touches) continue;
    for (const int corner : cell) {
      for (int c = 0; c < 3; ++c) {
        const int dof = example.bulk.dof(corner, c);
        if (!example.bulk.is_prescribed(dof)) dofs.insert(dof);
      }
    }
  }
  const std::vector<int> list(dofs.begin(), dofs.end());
  const int n = static_cast<int>(list.size());
  Eigen::MatrixXd k(n, n), c(n, last - first), coupling(n, last - first);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) k(a, b) = j.leading().coeff(list[a], list[b]);
    for (int m = first; m < last; ++m) {
      c(a, m - first) = j.constraint.coeff(list[a], m);
      coupling(a, m - first) = j.coupling.coeff(list[a], m);
    }
  }
  return c.transpose() * k.partialPivLu().solve(coupling);
}

TEST(Schur, BdsIsItsDefinition) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(j.n_multipliers(), j.n_multipliers());
    int k = 0;
    for (const FaultSurface& fault : example.problem.mesh.faults) {
      for (const FaultNode& node : fault.nodes) {
        const int first = j.node_begin[k], last = j.node_begin[k + 1];
        ++k;
        if (last == first) continue;
        expected.block(first, first, last - first, last - first) =
            block_from_cells(example, node, j, first, last);
      }
    }
    EXPECT_LT(relative_difference(inverse_by(SchurKind::bds, j), expected.inverse()), 1e-9);
  }
}

TEST(Schur, FsaiDirectIsItsDefinition) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const Eigen::MatrixXd g = fsai_factor(*j.symmetric_leading(), kSchurFsai);
    const Eigen::MatrixXd s =
        Eigen::MatrixXd(j.constraint).transpose() * g.transpose() * g * Eigen::MatrixXd(j.coupling);
    EXPECT_LT(relative_difference(inverse_by(SchurKind::fsai_direct, j), s.inverse()), 1e-9);
  }
}

TEST(Schur, FsaiTwiceIsItsDefinition) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const Eigen::MatrixXd gc = Eigen::MatrixXd(fsai_factor(*j.symmetric_leading(), kSchurFsai)) *
                               Eigen::MatrixXd(j.constraint);
    const SparseMatrix s = Eigen::MatrixXd(gc.transpose() * gc).sparseView();
    const Eigen::MatrixXd g = fsai_factor(s, kSchurFsai);
    EXPECT_LT(relative_difference(inverse_by(SchurKind::fsai_fsai, j), g.transpose() * g), 1e-9);
  }
}

/// Eliminating u or λ from [[K + E, C], [Cᵀ, −D⁻¹]] must give the same inverse.
TEST(Augmented, IsTheJacobianWithSpringsInSeries) {
  const CoupledExample example;
  for (const SaddlePoint& j : example.both()) {
    const Eigen::VectorXd springs = augmenting_springs(j);
    ASSERT_GT(springs.minCoeff(), 0);
    const int n_u = j.n_displacements(), n_l = j.n_multipliers();
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n_u + n_l, n_u + n_l);
    whole.topLeftCorner(n_u, n_u) = j.leading();
    whole.topRightCorner(n_u, n_l) = j.constraint;
    whole.bottomLeftCorner(n_l, n_u) = Eigen::MatrixXd(j.constraint).transpose();
    whole.bottomRightCorner(n_l, n_l).diagonal() = -springs.cwiseInverse();
    const Eigen::VectorXd u = Eigen::VectorXd::Random(n_u);
    const Eigen::VectorXd lambda = Eigen::VectorXd::Random(n_l) * j.leading().norm();
    Eigen::VectorXd x(n_u + n_l);
    x << u, lambda;
    const Eigen::VectorXd r = whole * x;
    Eigen::VectorXd found;
    direct_solver(augmented(j, springs).leading(), j.symmetric)(
        r.head(n_u) + j.constraint * springs.cwiseProduct(r.tail(n_l)), found);
    EXPECT_LT((found - u).norm(), 1e-7 * u.norm());
  }
}

/// What AMG sees on the solver's own matrix is the symmetric part of S_u, K x stays K x, and what
/// is taken away leaves no trace.
TEST(Augmented, IsBorrowedFromTheBulkAndGivenBack) {
  const CoupledExample example;
  const SaddlePoint& stick = example.stick;
  const Eigen::MatrixXd k = stick.leading();
  for (const SaddlePoint& j : example.both()) {
    const Eigen::VectorXd springs = augmenting_springs(j);
    const Eigen::MatrixXd s_u = augmented(j, springs).leading();
    EngineMatrix& engine = example.bulk.engine();
    const Eigen::MatrixXd before =
        matrix_of([&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y = engine.times(x); },
                  j.n_displacements());
    EXPECT_LT(relative_difference(before, k), 1e-14);
    const auto added = std::make_shared<const SparseMatrix>(added_to_bulk(j, springs));
    EXPECT_LT(relative_difference(k + Eigen::MatrixXd(*added), (s_u + s_u.transpose()) / 2), 1e-14);
    engine.with(added);
    const Eigen::VectorXd x = Eigen::VectorXd::Random(j.n_displacements());
    EXPECT_LT(relative_difference(engine.times(x), k * x), 1e-13);
    EXPECT_EQ(engine.diagonal(), k.diagonal());
    EXPECT_EQ(augmenting_springs(j), springs);
    engine.with(nullptr);
    EXPECT_EQ(matrix_of([&](const Eigen::VectorXd& v, Eigen::VectorXd& y) { y = engine.times(v); },
                        j.n_displacements()),
              before);
  }
}

/// What multigrid is made for, however strong the friction with which faults slip.
TEST(Augmented, IsPositiveDefiniteWhereFaultsSlip) {
  const CoupledExample example;
  std::vector<NodeLinearisation> all(example.bulk.fault_nodes().size());
  for (NodeLinearisation& node : all) {
    node.state = FaultState::slip;
    node.tangent.d_normal = {0, -3};
  }
  const SaddlePoint j = make_saddle_point(example.bulk, all);
  ASSERT_FALSE(j.symmetric);
  const SparseMatrix s_u = example.bulk.stiffness() + added_to_bulk(j, augmenting_springs(j));
  EXPECT_EQ(Eigen::SimplicialLLT<SparseMatrix>(s_u).info(), Eigen::Success);
}

TEST(Augmented, SpringsAreAsStiffAsTheCellsAtTheNode) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Eigen::VectorXd springs = augmenting_springs(j);
  for (int k = 0; k < j.n_multipliers(); ++k) {
    const Eigen::VectorXd c = Eigen::VectorXd(j.constraint.col(k));
    double square = 0;
    for (int a = 0; a < c.size(); ++a) {
      for (int b = 0; b < c.size(); ++b) {
        if (c[a] != 0 && c[b] != 0) square += std::pow(j.leading().coeff(a, b), 2);
      }
    }
    EXPECT_NEAR(springs[k] * c.squaredNorm() / std::sqrt(square), 1, 1e-12);
  }
}

TEST(Schur, MoreStepsOfFsaiComeCloserToS) {
  const CoupledExample example;
  const SaddlePoint& j = example.stick;
  const Eigen::MatrixXd s = dense_schur(j);
  const auto error = [&](int steps) {
    const FsaiOptions fsai{.steps = steps, .step_size = 3, .tolerance = 1e-6};
    const auto schur = schur_complement(SchurKind::fsai_direct, j, fsai);
    const Eigen::MatrixXd product = matrix_of(schur, j.n_multipliers()) * s;
    return (product - Eigen::MatrixXd::Identity(s.rows(), s.cols())).norm();
  };
  const double few = error(2), more = error(10), most = error(40);
  EXPECT_LT(more, 0.8 * few);
  EXPECT_LT(most, 0.5 * more);
}

}  // namespace
}  // namespace faultsim
