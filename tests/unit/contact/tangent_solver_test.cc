#include "simulator/contact/tangent_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <set>

#include "tests/unit/contact/contact_fixture.h"

namespace faultsim {
namespace {

constexpr int kManyNodes = 240;  // two shear dofs each: far more than are solved for directly

/// Tangents of sliding nodes with directions of slip, friction and curvature drawn at random.
struct Tangents {
  explicit Tangents(unsigned seed) : engine(seed) {
    set_h(op, 1e8 * half_space_matrix(op, 1, 0.2));
    for (const int k : {3, 100}) open.insert(k);
  }

  std::vector<TangentUnknown> unknowns(const std::vector<int>& nodes) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<TangentUnknown> result;
    for (const int k : nodes) {
      const auto dof = op.geometry.nodes[static_cast<std::size_t>(k)].dof;
      if (open.count(k) > 0) {
        for (int c = 0; c < 3; ++c) {
          TangentUnknown unknown{k, c, dof[static_cast<std::size_t>(c)], {0, 0, 0}, {0, 0}};
          unknown.weight[static_cast<std::size_t>(c)] = -1;
          result.push_back(unknown);
        }
        continue;
      }
      const Eigen::Vector2d m = Eigen::Vector2d(1, 0.3 * uniform(engine)).normalized();
      const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - m * m.transpose();
      const double ratio = 0.5 + 0.4 * uniform(engine);
      const Eigen::Matrix2d shear = Eigen::Matrix2d::Identity() - ratio * across;
      for (int c = 1; c < 3; ++c) {
        TangentUnknown unknown{k, c, dof[static_cast<std::size_t>(c)], {}, {}};
        unknown.weight = {-0.5 * m[c - 1], -shear(c - 1, 0), -shear(c - 1, 1)};
        unknown.own = {-ratio * 1e8 * across(c - 1, 0), -ratio * 1e8 * across(c - 1, 1)};
        result.push_back(unknown);
      }
    }
    return result;
  }

  /// T by its definition in the header.
  Eigen::MatrixXd matrix(const std::vector<TangentUnknown>& unknowns) const {
    const auto n = static_cast<Eigen::Index>(unknowns.size());
    Eigen::MatrixXd t = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index u = 0; u < n; ++u) {
      for (Eigen::Index v = 0; v < n; ++v) {
        const TangentUnknown& row = unknowns[static_cast<std::size_t>(u)];
        const TangentUnknown& column = unknowns[static_cast<std::size_t>(v)];
        for (std::size_t c = 0; c < 3; ++c) {
          t(u, v) +=
              row.weight[c] *
              op.h()(op.geometry.nodes[static_cast<std::size_t>(row.node)].dof[c], column.dof);
        }
        if (row.node == column.node && column.component > 0) {
          t(u, v) += row.own[static_cast<std::size_t>(column.component - 1)];
        }
      }
    }
    return t;
  }

  std::mt19937 engine;
  FaultOperator op = make_operator(kManyNodes, 2, Eigen::VectorXd::Ones(kManyNodes));
  const ContactLaws laws = same_law(op, {});
  std::set<int> open;
};

std::vector<int> range(int from, int to) {
  std::vector<int> nodes;
  for (int k = from; k < to; ++k) nodes.push_back(k);
  return nodes;
}

Eigen::VectorXd right_side(std::size_t n, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 1e6);
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(n), [&] { return normal(engine); });
}

struct Solved {
  double error;  ///< |b − T x| / |b|
  int krylov;
};

Solved solve(const Tangents& given, TangentSolver& solver,
             const std::vector<TangentUnknown>& unknowns, double share) {
  const Eigen::VectorXd right = right_side(unknowns.size(), 5);
  Eigen::VectorXd x;
  const TangentReport report = solver.solve(unknowns, right, share * right.norm(), x);
  EXPECT_TRUE(report.solved);
  return {(right - given.matrix(unknowns) * x).norm() / right.norm(), report.krylov};
}

TEST(TangentSolver, FactorisesWhatIsSmallToRoundOff) {
  Tangents given(1);
  ContactProblem problem(given.op, given.laws);
  TangentSolver solver(problem);
  const Solved solved = solve(given, solver, given.unknowns(range(0, 60)), 1e-2);
  EXPECT_EQ(solved.krylov, -1);
  EXPECT_LT(solved.error, 1e-12);
}

// As where strength falls with slip; the second time with the factor of tangents a little
// different.
TEST(TangentSolver, GoesToRoundOffWhereNoResidualIsGranted) {
  Tangents given(6);
  ContactProblem problem(given.op, given.laws);
  TangentSolver solver(problem);
  std::vector<TangentUnknown> unknowns = given.unknowns(range(0, 150));
  const Solved first = solve(given, solver, unknowns, 0);
  EXPECT_EQ(first.krylov, -1);
  EXPECT_LT(first.error, 1e-11);
  for (std::size_t i = 20; i < 60; ++i) unknowns[i].weight[0] *= 0.99;
  const Solved second = solve(given, solver, unknowns, 0);
  EXPECT_GT(second.krylov, 0);
  EXPECT_LT(second.error, 1e-11);
}

// Nodes join, open ones among them, directions turn, most come to rest, and all move again: each
// system is solved as far as asked, and the factor that is kept is worth its while.
TEST(TangentSolver, SolvesAsFarAsAskedWhateverJoinedAndLeft) {
  Tangents given(2);
  ContactProblem problem(given.op, given.laws);
  TangentSolver solver(problem);
  const std::vector<std::vector<int>> sets = {range(20, 120), range(20, 120), range(0, 130),
                                              range(10, 200), range(90, 200), range(40, 240),
                                              range(0, 240)};
  for (const std::vector<int>& nodes : sets) {
    for (const double share : {1e-2, 1e-4}) {
      const Solved solved = solve(given, solver, given.unknowns(nodes), share);
      EXPECT_LT(solved.error, 1.5 * share) << nodes.size();
      EXPECT_GE(solved.krylov, 0) << nodes.size();
      EXPECT_LE(solved.krylov, 20) << nodes.size();
    }
  }
}

// Slip across its direction is what the factor leaves to GMRES.
TEST(TangentSolver, NeedsFewIterationsWithTheFactorOfTheSameTangent) {
  Tangents given(3);
  ContactProblem problem(given.op, given.laws);
  TangentSolver solver(problem);
  // The second half joins by a border of the factor of the first.
  const std::vector<TangentUnknown> all = given.unknowns(range(0, 200));
  const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
  solve(given, solver, {all.begin(), all.begin() + half}, 1e-4);
  EXPECT_LE(solve(given, solver, all, 1e-4).krylov, 10);
}

TEST(TangentSolver, ForgetsAllWhenItIsCleared) {
  Tangents given(4);
  ContactProblem problem(given.op, given.laws);
  TangentSolver used(problem), fresh(problem);
  const std::vector<TangentUnknown> before = given.unknowns(range(0, 150));
  const std::vector<TangentUnknown> now = given.unknowns(range(30, 220));
  const Eigen::VectorXd right = right_side(now.size(), 8);
  Eigen::VectorXd x, expected;
  solve(given, used, before, 1e-3);
  used.clear();
  used.solve(now, right, 1e-3 * right.norm(), x);
  fresh.solve(now, right, 1e-3 * right.norm(), expected);
  EXPECT_EQ(x, expected);
}

TEST(TangentSolver, SaysThatATangentIsSingular) {
  Tangents given(5);
  ContactProblem problem(given.op, given.laws);
  TangentSolver solver(problem);
  std::vector<TangentUnknown> unknowns = given.unknowns(range(0, 150));
  unknowns[200].weight = {0, 0, 0};
  unknowns[200].own = {0, 0};
  Eigen::VectorXd x;
  EXPECT_FALSE(solver.solve(unknowns, right_side(unknowns.size(), 1), 1, x).solved);
}

}  // namespace
}  // namespace faultsim
