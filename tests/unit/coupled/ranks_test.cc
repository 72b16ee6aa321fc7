// Alone, and by mpirun on several processes (CMakeLists.txt): there each solves its part, and then
// the whole by itself.
#include "simulator/coupled/ranks.h"

#include <gtest/gtest.h>

#include <map>

#include "simulator/coupled/box_study.h"
#include "simulator/coupled/coupled_contact.h"
#include "tests/unit/condensation/junction_problem.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

const Ranks& job() {
  static const Ranks ranks = Ranks::of_the_job();
  return ranks;
}

TEST(Ranks, AddUpAndGatherInTheirOrder) {
  const int n = job().size(), r = job().rank();
  Eigen::VectorXd values(2);
  values << r + 1, 0.1;
  job().sum(values);
  EXPECT_EQ(values[0], n * (n + 1) / 2);
  double tenths = 0;
  for (int k = 0; k < n; ++k) tenths += 0.1;
  EXPECT_EQ(values[1], tenths) << "one after the other";
  EXPECT_EQ(job().sum(2.0), 2 * n);
  EXPECT_EQ(job().largest(r == n - 1 ? 7 : 3), 7);
  const std::vector<int> all = job().gathered(std::vector<int>(r + 1, r));
  std::vector<int> expected;
  for (int k = 0; k < n; ++k) expected.insert(expected.end(), k + 1, k);
  EXPECT_EQ(all, expected);
}

/// A value for component c of the node at x.
double at(const Eigen::Vector3d& x, int c) {
  return std::sin(3.1 * x.x() + c) + std::cos(2.3 * x.y() - c) + std::sin(x.z());
}

struct Example {
  explicit Example(BulkProblem given, LoosePieces loose = LoosePieces::refused)
      : problem(std::move(given)), divided(problem, loose, job()), whole(problem, loose) {}

  /// A vector over the own dofs, the same field on any number of ranks.
  Eigen::VectorXd field(const TwoSidedBulk& bulk) const {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(bulk.n_own());
    for (int i = 0; i < static_cast<int>(problem.mesh.nodes.size()); ++i) {
      for (int c = 0; c < 3; ++c) {
        const int row = bulk.dof(i, c) - bulk.first_own();
        if (bulk.dof(i, c) >= 0 && row >= 0 && row < bulk.n_own())
          u[row] = at(problem.mesh.nodes[i], c) * (1 + 0.1 * (i % 7));
      }
    }
    return u;
  }
  /// Of all mesh nodes.
  static Eigen::Matrix3Xd nodal(const TwoSidedBulk& bulk, const Eigen::VectorXd& u) {
    return bulk.nodal_displacement(u);
  }

  BulkProblem problem;
  TwoSidedBulk divided, whole;
};

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(Ranks, ShareTheRowsEvenlyAndKeepFaultNodesTogether) {
  const Example example(box_study(4), LoosePieces::held_by_faults);
  const TwoSidedBulk& bulk = example.divided;
  EXPECT_EQ(bulk.n_displacements(), example.whole.n_displacements());
  const double fair = static_cast<double>(bulk.n_displacements()) / job().size();
  EXPECT_NEAR(bulk.n_own(), fair, 0.25 * fair);
  EXPECT_EQ(job().sum(bulk.n_own()), bulk.n_displacements());
  for (const TwoSidedNode& node : bulk.fault_nodes()) {
    for (const JumpTerm& term : node.terms) {
      for (const int dof : term.dof)
        EXPECT_TRUE(dof < 0 || bulk.ranges().owner_of(dof) == node.owner) << dof;
    }
  }
}

void expect_same_bulk(const Example& example) {
  const TwoSidedBulk &divided = example.divided, &whole = example.whole;
  const Eigen::VectorXd u = example.field(divided), v = example.field(whole);
  const auto nodal = [](const TwoSidedBulk& bulk, const Eigen::VectorXd& x) {
    return Example::nodal(bulk, x);
  };
  ASSERT_EQ(nodal(divided, u), nodal(whole, v));
  const Eigen::VectorXd forces = divided.times_stiffness(u);
  EXPECT_LT(difference(nodal(divided, forces), nodal(whole, whole.times_stiffness(v))), 1e-13);
  EXPECT_LT(difference(nodal(divided, divided.diagonal()), nodal(whole, whole.diagonal())), 1e-13);
  for (int k = 0; k < whole.n_loads(); ++k) {
    const Eigen::VectorXd a = divided.load(k);
    EXPECT_LT(difference(nodal(divided, a), nodal(whole, whole.load(k))), 1e-13) << k;
  }
  Eigen::MatrixXd gram = divided.rigid_motions().transpose() * divided.rigid_motions();
  job().sum(Eigen::Map<Eigen::VectorXd>(gram.data(), gram.size()));
  EXPECT_LT(difference(gram, Eigen::MatrixXd::Identity(6, 6)), 1e-12);
}

TEST(Ranks, HaveTheRowsOfTheWholeMatrix) {
  expect_same_bulk(Example(test::mixed_problem()));
  expect_same_bulk(Example(test::junction_problem()));
}

/// Iterations of the two, and how far the displacements are from each other.
struct Solved {
  int n_divided, n_whole;
  double difference;
};

Solved solve_both(const Example& example, const SolverChoice& choice) {
  const auto solve = [&](const TwoSidedBulk& bulk, Eigen::VectorXd& u) {
    const SaddlePoint j = make_saddle_point(bulk);
    Eigen::VectorXd lambda;
    CoupledSolver solver(j, choice);
    const CoupledReport report =
        solver.solve(bulk.load(0), Eigen::VectorXd::Zero(j.n_multipliers()), 1e-9, 300, u, lambda);
    EXPECT_TRUE(report.converged);
    return static_cast<int>(report.residuals.size()) - 1;
  };
  Solved solved{};
  Eigen::VectorXd u, v;
  solved.n_divided = solve(example.divided, u);
  solved.n_whole = solve(example.whole, v);
  solved.difference =
      difference(example.divided.nodal_displacement(u), example.whole.nodal_displacement(v));
  return solved;
}

TEST(Ranks, SolveWhatOneSolvesInAsManyIterations) {
  const Example example(box_study(8), LoosePieces::held_by_faults);
  for (const LeadingKind leading : {LeadingKind::amg, LeadingKind::amg_by_component}) {
    for (const SchurKind schur : {SchurKind::rac, SchurKind::lsc}) {
      SCOPED_TRACE(std::string(to_string(leading)) + " " + to_string(schur));
      const Solved solved = solve_both(example, {leading, schur});
      EXPECT_NEAR(solved.n_divided, solved.n_whole, 1);
      EXPECT_LT(solved.difference, 1e-7);
      if (job().rank() == 0)
        std::cout << to_string(leading) << " " << to_string(schur) << ": " << solved.n_whole
                  << " iterations alone, " << solved.n_divided << " on " << job().size() << "\n";
    }
  }
}

TEST(Ranks, RefuseWhatNeedsTheWholeMatrix) {
  const Example example(test::mixed_problem());
  const SaddlePoint j = make_saddle_point(example.divided);
  for (const SolverChoice& choice :
       {SolverChoice{LeadingKind::fsai, SchurKind::bds}, {LeadingKind::exact, SchurKind::rac}}) {
    if (job().size() == 1) {
      EXPECT_NO_THROW(CoupledSolver(j, choice));
    } else {
      EXPECT_THROW(CoupledSolver(j, choice), InputError);
    }
  }
}

/// Depletion that makes faults slip, fluid on the faults that opens some of them, and back.
struct History {
  History(const BulkProblem& problem, const TwoSidedBulk& bulk) {
    const FaultOperator op = test::condense(problem);
    const int n = static_cast<int>(op.geometry.nodes.size());
    CoulombLaw law;
    law.static_friction_angle = law.dynamic_friction_angle = 0.4;
    CoupledContactOptions options;
    options.solver = {LeadingKind::amg_by_component, SchurKind::rac};
    options.traction_tolerance = 1e-9;
    const CoupledContact contact(bulk, ContactLaws(n, law), options);
    Eigen::VectorXd background = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    for (int k = 0; k < n; ++k) {
      const std::array<int, 3>& dof = op.geometry.nodes[k].dof;
      background[dof[0]] = -4e6 - 1e6 * std::sin(k);
      if (dof[1] >= 0) background[dof[1]] = 0.4e6;
      if (dof[2] >= 0) background[dof[2]] = 1.2e6;
    }
    state = initial_state(op);
    state.traction = background;
    u = Eigen::VectorXd::Zero(bulk.n_own());
    const auto step = [&](const std::vector<double>& factors, double overpressure) {
      CoupledLoad load{factors, background};
      for (const OperatorNode& node : op.geometry.nodes)
        load.background[node.dof[0]] += overpressure;
      const CoupledStepReport report = contact.advance(load, state, u);
      EXPECT_TRUE(report.converged) << report.reason;
      for (const FaultState s : state.state) ++seen[s];
    };
    step({-1e6, 0.01, 0.1, -0.2e6}, 0);
    step({-9e6, 0.02, 0.6, -4e6}, 2e6);
    step({-9e6, 0, 0.8, -4e6}, 4.2e6);
    step({-5e6, 0.02, 0.3, -1e6}, 1e6);
  }
  ContactState state;
  Eigen::VectorXd u;
  std::map<FaultState, int> seen;
};

TEST(Ranks, FindTheStickSlipAndOpenNodesThatOneFinds) {
  const Example example(test::mixed_problem());
  const History divided(example.problem, example.divided), whole(example.problem, example.whole);
  for (const FaultState s : {FaultState::stick, FaultState::slip, FaultState::open})
    EXPECT_GE(divided.seen.contains(s) ? divided.seen.at(s) : 0, 7);
  EXPECT_EQ(divided.state.state, whole.state.state);
  EXPECT_LT(difference(divided.state.traction, whole.state.traction), 1e-6);
  EXPECT_LT(difference(divided.state.jump, whole.state.jump), 1e-6);
  EXPECT_LT(difference(example.divided.nodal_displacement(divided.u),
                       example.whole.nodal_displacement(whole.u)),
            1e-6);
}

}  // namespace
}  // namespace faultsim
