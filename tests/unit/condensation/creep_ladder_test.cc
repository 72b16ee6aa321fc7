#include "simulator/condensation/creep_ladder.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

using Eigen::Index;

constexpr double kElastic = std::numeric_limits<double>::infinity();
constexpr double kTau = 1e17 / (40e9 / 2.6);  // of material 1, s
constexpr MaxwellScheme kExponential = MaxwellScheme::exponential;

/// Two kinds of salt; `mixed_problem` has everything else.
BulkProblem viscous_problem() {
  BulkProblem problem = test::mixed_problem();
  problem.viscosity = {4e17, 1e17};
  return problem;
}

CreepLadder ladder_of(const BulkProblem& problem, const std::vector<double>& durations,
                      MaxwellScheme scheme = kExponential) {
  SilentMonitor monitor;
  return CreepLadder(std::make_shared<const BulkProblem>(problem), durations, scheme, monitor);
}

Eigen::VectorXd random_jump(const FaultOperator& op, unsigned seed) {
  std::srand(seed);
  return 1e-4 * Eigen::VectorXd::Random(op.geometry.n_dofs);
}
const std::vector<double> kLoads = {-3e6, 0.4, 0.7, 2e6};

/// The dense system of a step, assembled for its shear factors.
struct DenseStep {
  Eigen::MatrixXd k;
  Eigen::VectorXd f;
  int n_bulk;

  DenseStep(const BulkProblem& problem, const DofMap& dofs, const std::vector<double>& factors,
            double duration) {
    std::vector<ElasticMaterial> materials = problem.materials;
    for (std::size_t m = 0; m < materials.size(); ++m) {
      const double x = duration * shear_modulus(materials[m]) / problem.viscosity[m];
      if (x > 0) materials[m].shear_factor = (1 - std::exp(-x)) / x;
    }
    const SparseMatrix lower =
        assemble_stiffness(problem.mesh, materials, dofs, problem.mean_dilatation);
    k = Eigen::MatrixXd(lower);
    k = Eigen::MatrixXd(k.selfadjointView<Eigen::Lower>());
    f = factors[0] * pressure_load(problem.mesh, dofs, 0) +
        factors[1] * stress_load(problem.mesh, dofs, problem.loads[1].stress_groups,
                                 problem.loads[1].stress) +
        factors[2] * displacement_load(problem.mesh, materials, dofs, 2, problem.mean_dilatation) +
        factors[3] * pressure_load(problem.mesh, dofs, 1);
    n_bulk = dofs.n_bulk();
  }
  /// x = (r, g) and A Δt of a step with the jumps given.
  Eigen::VectorXd unknowns(const Eigen::VectorXd& jump) const {
    Eigen::VectorXd x(k.rows());
    const Index n_jump = jump.size();
    x.tail(n_jump) = jump;
    x.head(n_bulk) = k.topLeftCorner(n_bulk, n_bulk)
                         .ldlt()
                         .solve(f.head(n_bulk) - k.topRightCorner(n_bulk, n_jump) * jump);
    return x;
  }
  Eigen::VectorXd fault_forces(const Eigen::VectorXd& x) const {
    return (f - k * x).tail(x.size() - n_bulk);
  }
};

TEST(CreepLadder, FirstRungIsTheElasticOperator) {
  const BulkProblem problem = viscous_problem();
  const CreepLadder ladder = ladder_of(problem, {kTau, 0.1 * kTau});
  EXPECT_EQ(ladder.n_rungs(), 3);
  EXPECT_EQ(ladder.duration(0), 0);
  EXPECT_EQ(ladder.duration(2), 0.1 * kTau);
  BulkProblem elastic = problem;
  elastic.viscosity.clear();
  const FaultOperator op = test::condense(elastic);
  EXPECT_EQ(Eigen::MatrixXd(op.h()), Eigen::MatrixXd(ladder.op(0).h()));
  EXPECT_EQ(op.loads.traction, ladder.op(0).loads.traction);
  EXPECT_GT((op.h() - ladder.op(1).h()).norm(), 0.1 * op.h().norm());
}

/// Three steps of different rungs, with loads and jumps, against dense solves of
/// K(Δt) Δx = Δf + (1 − decay) Pᵀ∫ε(v):s, where the history is kept by CreepCells.
TEST(CreepLadder, StepsAreThoseOfTheDenseSystem) {
  const BulkProblem problem = viscous_problem();
  const std::vector<double> durations = {kTau, 0.1 * kTau};
  CreepLadder ladder = ladder_of(problem, durations);
  const DofMap dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size()));
  const CreepCells cells(problem.mesh, problem.materials, problem.viscosity, dofs);
  CreepStress stress = cells.at_rest();
  Eigen::Matrix3Xd displacement =
      Eigen::Matrix3Xd::Zero(3, static_cast<Index>(problem.mesh.nodes.size()));
  BulkState state = ladder.at_rest();
  unsigned seed = 1;
  for (const int rung : {0, 2, 1, 2}) {
    const double duration = ladder.duration(rung);
    const Eigen::VectorXd jump = random_jump(ladder.op(rung), seed++);
    std::vector<double> factors = kLoads;
    if (rung == 1) factors = {0, 0, 0, 0};
    std::vector<MaxwellStep> steps;
    DenseStep dense(problem, dofs, factors, duration);
    for (std::size_t i = 0; i < cells.materials().size(); ++i) {
      const auto m = static_cast<std::size_t>(cells.materials()[i]);
      steps.push_back(maxwell_step(shear_modulus(problem.materials[m]), problem.viscosity[m],
                                   duration, kExponential));
      dense.f +=
          (1 - std::exp(-duration * shear_modulus(problem.materials[m]) / problem.viscosity[m])) *
          stress.force.col(static_cast<Index>(i));
    }
    const Eigen::VectorXd x = dense.unknowns(jump);
    const Eigen::Matrix3Xd u = nodal_displacement(problem.mesh, dofs, x, factors);
    cells.advance(u, steps, stress);
    displacement += u;

    CreepLadder::History history = ladder.history(rung, state);
    const FaultOperator& op = ladder.op(rung);
    const Eigen::Map<const Eigen::VectorXd> load(factors.data(), 4);
    const Eigen::VectorXd traction = history.traction + op.loads.traction * load -
                                     (op.h() * jump).cwiseQuotient(op.geometry.dof_area);
    const Eigen::VectorXd expected = dense.fault_forces(x).cwiseQuotient(op.geometry.dof_area);
    EXPECT_LT((traction - expected).norm(), 1e-10 * expected.norm()) << "rung " << rung;
    if (rung == 1) {
      EXPECT_GT(history.traction.norm(), 1e-2 * expected.norm());
    }
    ladder.advance(rung, std::move(history), factors, jump, state);
    EXPECT_LT((state.displacement - displacement).norm(), 1e-10 * displacement.norm());
    EXPECT_LT((state.stress.deviator - stress.deviator).norm(), 1e-10 * stress.deviator.norm());
    EXPECT_LT((state.stress.force - stress.force).norm(), 1e-10 * stress.force.norm());
  }
  const Eigen::VectorXd observed = ladder.observed(state);
  ASSERT_EQ(observed.size(), 9);
  for (std::size_t i = 0; i < 3; ++i) {
    const int node = observed_node(problem.mesh, problem.observation_points[i].second);
    EXPECT_EQ(observed.segment<3>(3 * static_cast<Index>(i)), state.displacement.col(node));
  }
}

/// A body whose sides all move: uniform strain, so that eight short steps are one long one. With
/// the wrong rung's decay or stiffness they are not.
TEST(CreepLadder, ManyShortRungsAreOneLongOneInUniformStrain) {
  BulkProblem problem;
  problem.mesh = test::make_box({4, 3, 3}, {40, 30, 30}, {{2, 1, 3, 0, 2}}, test::shear_to_dip(65));
  test::distort(problem.mesh, 10, 0.1);
  problem.materials = {{40e9, 0.3}};
  problem.viscosity = {1e17};
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.7, 0.2, 0.9, -0.4, 1.6;
  problem.conditions = test::affine(Eigen::Vector3d::Zero(), 1e-4 * gradient);
  LoadCase load;
  load.key.kind = LoadKey::Kind::boundary;
  load.displacement = true;
  problem.loads = {load};
  CreepLadder ladder = ladder_of(problem, {2 * kTau, 0.25 * kTau});
  const Eigen::VectorXd closed = Eigen::VectorXd::Zero(ladder.op(0).geometry.n_dofs);
  const auto march = [&](const std::vector<std::pair<int, double>>& steps) {
    BulkState state = ladder.at_rest();
    Eigen::VectorXd traction = closed;
    for (const auto& [rung, factor] : steps) {
      CreepLadder::History history = ladder.history(rung, state);
      traction += history.traction + factor * ladder.op(rung).loads.traction.col(0);
      ladder.advance(rung, std::move(history), {factor}, closed, state);
    }
    return std::pair(std::move(state), traction);
  };
  const auto [whole, whole_traction] = march({{0, 1}, {1, 0.8}});
  std::vector<std::pair<int, double>> parts = {{0, 1}};
  for (int i = 0; i < 8; ++i) parts.emplace_back(2, 0.1);
  const auto [sum, sum_traction] = march(parts);
  EXPECT_LT((whole.stress.deviator - sum.stress.deviator).norm(),
            1e-12 * whole.stress.deviator.norm());
  EXPECT_LT((whole.displacement - sum.displacement).norm(), 1e-12 * whole.displacement.norm());
  EXPECT_LT((whole_traction - sum_traction).norm(), 1e-11 * whole_traction.norm());
}

TEST(CreepLadder, NothingComesOfNothing) {
  CreepLadder ladder = ladder_of(viscous_problem(), {kTau});
  const Eigen::VectorXd closed = Eigen::VectorXd::Zero(ladder.op(0).geometry.n_dofs);
  BulkState state = ladder.at_rest();
  for (const int rung : {0, 1, 1}) {
    CreepLadder::History history = ladder.history(rung, state);
    EXPECT_TRUE(history.traction.isZero(0));
    ladder.advance(rung, std::move(history), {0, 0, 0, 0}, closed, state);
  }
  EXPECT_TRUE(state.displacement.isZero(0));
  EXPECT_TRUE(state.stress.deviator.isZero(0));
  // An elastic step has no history, whatever the salt remembers.
  ladder.advance(0, ladder.history(0, state), kLoads, random_jump(ladder.op(0), 3), state);
  EXPECT_TRUE(ladder.history(0, state).traction.isZero(0));
  EXPECT_FALSE(ladder.history(1, state).traction.isZero(0));
}

/// Rock that does not creep among salt that does: only the salt has cells and a share in the step.
TEST(CreepLadder, RockKeepsItsStiffness) {
  BulkProblem problem = viscous_problem();
  problem.viscosity = {kElastic, kElastic};
  const CreepLadder rigid = ladder_of(problem, {kTau});
  EXPECT_EQ(Eigen::MatrixXd(rigid.op(0).h()), Eigen::MatrixXd(rigid.op(1).h()));
  problem.viscosity = {kElastic, 1e17};
  const CreepLadder ladder = ladder_of(problem, {kTau});
  EXPECT_GT((ladder.op(0).h() - ladder.op(1).h()).norm(), 1e-3 * ladder.op(0).h().norm());
}

TEST(CreepLadder, GivesTheSameBitsWhateverRanBefore) {
  const BulkProblem problem = viscous_problem();
  CreepLadder ladder = ladder_of(problem, {kTau, 0.1 * kTau});
  const auto march = [](CreepLadder& on, double scale, unsigned seed) {
    BulkState state = on.at_rest();
    Eigen::VectorXd traction;
    for (const int rung : {0, 1, 2, 1}) {
      std::vector<double> factors = kLoads;
      for (double& factor : factors) factor *= scale;
      CreepLadder::History history = on.history(rung, state);
      traction = history.traction;
      on.advance(rung, std::move(history), factors, scale * random_jump(on.op(0), seed), state);
    }
    return std::pair(traction, std::move(state));
  };
  const auto [first, first_state] = march(ladder, 1, 5);
  march(ladder, -17, 6);
  const auto [again, again_state] = march(ladder, 1, 5);
  EXPECT_EQ(first, again);
  EXPECT_EQ(first_state.displacement, again_state.displacement);
  EXPECT_EQ(first_state.stress.deviator, again_state.stress.deviator);
  CreepLadder other = ladder_of(problem, {kTau, 0.1 * kTau});
  EXPECT_EQ(march(other, 1, 5).first, first);
}

/// From a step that is elastic to one in which salt is a liquid: H stays symmetric and positive
/// definite, weakens as steps grow longer, and numbers stay numbers.
TEST(CreepLadder, TakesStepsFromInstantaneousToLiquid) {
  BulkProblem problem = viscous_problem();
  problem.viscosity = {kElastic, 1e17};
  CreepLadder ladder = ladder_of(problem, {1e6 * kTau, 1e3 * kTau, kTau, 1e-3 * kTau, 1e-6 * kTau});
  const Eigen::MatrixXd elastic = ladder.op(0).h();
  double last = 0;
  for (int rung = 1; rung < ladder.n_rungs(); ++rung) {
    const Eigen::MatrixXd h = ladder.op(rung).h();
    EXPECT_EQ(h, h.transpose());
    EXPECT_EQ(h.llt().info(), Eigen::Success);
    EXPECT_GT(h.trace(), last) << "shorter steps are stiffer";
    last = h.trace();
    BulkState state = ladder.at_rest();
    const Eigen::VectorXd jump = random_jump(ladder.op(0), 9);
    // without the shear on the free top, which a liquid could only answer by flowing for ever
    ladder.advance(0, ladder.history(0, state), {-3e6, 0, 0.7, 2e6}, jump, state);
    const double start = state.stress.deviator.norm();
    for (int i = 0; i < 50; ++i) {
      ladder.advance(rung, ladder.history(rung, state), {0, 0, 0, 0}, 0 * jump, state);
    }
    EXPECT_TRUE(state.displacement.allFinite());
    EXPECT_TRUE(state.stress.deviator.allFinite());
    if (ladder.duration(rung) > 100 * kTau) {
      EXPECT_LT(state.stress.deviator.norm(), 1e-4 * start) << ladder.duration(rung) / kTau;
    }
  }
  EXPECT_LT((elastic - Eigen::MatrixXd(ladder.op(5).h())).norm(), 1e-6 * elastic.norm());
}

}  // namespace
}  // namespace faultsim
