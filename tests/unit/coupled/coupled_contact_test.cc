#include "simulator/coupled/coupled_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "tests/unit/coupled/coupled_problem.h"

namespace faultsim {
namespace {

using test::CoupledExample;

/// The same history on both paths: condensed operator and ContactSolver, both sides and
/// multipliers.
class TwoPaths {
 public:
  TwoPaths(CoulombLaw law, bool cumulated, const SolverChoice& solver,
           BulkProblem problem = test::mixed_problem())
      : example_(std::move(problem)), op_(test::condense(example_.problem)) {
    const int n = static_cast<int>(op_.geometry.nodes.size());
    law.slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
    laws_.assign(n, law);
    CoupledContactOptions options;
    options.solver = solver;
    options.traction_tolerance = 1e-11;
    coupled_ = std::make_unique<CoupledContact>(example_.bulk, laws_, options);
    condensed_ =
        std::make_unique<ContactSolver>(op_, laws_, ContactOptions{.traction_tolerance = 1e-11});
    background_ = Eigen::VectorXd::Zero(op_.geometry.n_dofs);
    for (int k = 0; k < n; ++k) {
      const std::array<int, 3>& dof = op_.geometry.nodes[k].dof;
      background_[dof[0]] = -4e6 - 1e6 * std::sin(k);
      if (dof[1] >= 0) background_[dof[1]] = 0.4e6;
      if (dof[2] >= 0) background_[dof[2]] = 1.2e6;
    }
    state_ = initial_state(op_);
    state_.traction = background_;
    other_ = state_;
    u_ = Eigen::VectorXd::Zero(example_.bulk.n_displacements());
    before_ = background_;
  }

  /// One load step; `overpressure` on every fault node.
  void step(const std::vector<double>& factors, double overpressure) {
    CoupledLoad load{factors, background_};
    Eigen::VectorXd locked = background_;
    for (const OperatorNode& node : op_.geometry.nodes)
      load.background[node.dof[0]] += overpressure;
    locked = load.background + op_.loads.traction * Eigen::Map<const Eigen::VectorXd>(
                                                        factors.data(), std::ssize(factors));
    const ContactReport condensed = condensed_->solve_step(before_, locked, other_);
    ASSERT_EQ(condensed.outcome, Outcome::converged) << condensed.reason;
    ASSERT_EQ(condensed.counts.sub_steps, 1) << "or the paths would differ";
    before_ = locked;
    report = coupled_->advance(load, state_, u_);
    ASSERT_TRUE(report.converged) << report.reason;
    const double traction = other_.traction.cwiseAbs().maxCoeff();
    const double jump = std::max(other_.jump.cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((state_.traction - other_.traction).cwiseAbs().maxCoeff(), 1e-8 * traction);
    EXPECT_LT((state_.jump - other_.jump).cwiseAbs().maxCoeff(), 1e-8 * jump);
    EXPECT_LT((state_.slip_path - other_.slip_path).cwiseAbs().maxCoeff(), 1e-8 * jump);
    EXPECT_EQ(state_.state, other_.state);
    EXPECT_EQ(state_.cohesion_lost, other_.cohesion_lost);
    for (const FaultState s : state_.state) ++seen[static_cast<int>(s)];
  }

  /// Depletion that makes faults slip, fluid on the fault that opens some of it, and back.
  void history() {
    step({-1e6, 0.01, 0.1, -0.2e6}, 0);
    step({-6e6, 0.03, 0.3, -2e6}, 0);
    step({-9e6, 0.02, 0.6, -4e6}, 2e6);
    step({-9e6, 0, 0.8, -4e6}, 4.2e6);
    step({-5e6, 0.02, 0.3, -1e6}, 1e6);
    step({-12e6, 0.05, -0.3, -6e6}, 0);
  }

  std::array<int, 3> seen{};  ///< nodes and steps in stick, slip and open.
  CoupledStepReport report;

 private:
  CoupledExample example_;
  FaultOperator op_;
  ContactLaws laws_;
  std::unique_ptr<CoupledContact> coupled_;
  std::unique_ptr<ContactSolver> condensed_;
  ContactState state_, other_;
  Eigen::VectorXd background_, before_, u_;
};

void expect_all_states(const TwoPaths& paths, int at_least) {
  for (int s = 0; s < 3; ++s) EXPECT_GE(paths.seen[s], at_least) << s;
}

CoulombLaw friction(double static_angle, double dynamic_angle, double cohesion) {
  CoulombLaw law;
  law.static_friction_angle = static_angle;
  law.dynamic_friction_angle = dynamic_angle;
  law.cohesion = cohesion;
  law.slip_weakening_distance = 0.1;
  return law;
}

TEST(CoupledContact, IsTheCondensedPathOverAHistoryWithStickSlipAndOpening) {
  TwoPaths paths(friction(0.4, 0.4, 0), false, {LeadingKind::exact, SchurKind::lsc});
  paths.history();
  expect_all_states(paths, 20);
}

TEST(CoupledContact, KnowsAStepWithoutSlipFromThoseBefore) {
  TwoPaths paths(friction(1.2, 1.2, 50e6), false, {LeadingKind::amg, SchurKind::rac});
  const auto iterations = [&paths] {
    int sum = 0;
    for (const int n : paths.report.linear.krylov_iterations) sum += n;
    return sum;
  };
  paths.step({-1e6, 0, 0, 0}, 0);
  const int unknown = iterations();
  paths.step({-1e6, 0, 0, -1e6}, 0);
  EXPECT_GT(iterations(), unknown / 2) << "another load";
  paths.step({-3e6, 0, 0, 2e6}, 0);
  EXPECT_EQ(paths.report.newton_iterations(), 1);
  EXPECT_LT(iterations(), unknown / 2);
  EXPECT_EQ(paths.seen[1] + paths.seen[2], 0) << "or nothing was linear";
}

TEST(CoupledContact, IsTheCondensedPathWhereStrengthFallsWithSlip) {
  for (const bool cumulated : {false, true}) {
    TwoPaths paths(friction(0.45, 0.3, 0.2e6), cumulated, {LeadingKind::exact, SchurKind::bds});
    paths.history();
    expect_all_states(paths, 20);
  }
}

TEST(CoupledContact, FindsTheSameWithEveryPreconditioner) {
  for (const LeadingKind leading : enumerators<LeadingKind>()) {
    for (const SchurKind schur : enumerators<SchurKind>()) {
      SCOPED_TRACE(std::string(to_string(leading)) + " " + to_string(schur));
      TwoPaths paths(friction(0.4, 0.4, 0), false, {leading, schur});
      paths.step({-6e6, 0.03, 0.3, -2e6}, 0);
      paths.step({-9e6, 0, 0.8, -4e6}, 4.2e6);
      expect_all_states(paths, 7);
    }
  }
}

TEST(CoupledContact, IsTheCondensedPathOnTetrahedraWhereAFaultEndsAtAnother) {
  for (const auto& [leading, schur] :
       {std::pair(LeadingKind::exact, SchurKind::bds), std::pair(LeadingKind::amg, SchurKind::lsc),
        std::pair(LeadingKind::amg_by_component, SchurKind::rac)}) {
    SCOPED_TRACE(std::string(to_string(leading)) + " " + to_string(schur));
    TwoPaths paths(friction(0.4, 0.4, 0), false, {leading, schur}, test::junction_problem());
    paths.step({-10e6, 0, 0}, 0);
    paths.step({-10e6, 2e6, 2e6}, 0);
    paths.step({-10e6, 2e6, 3e6}, 3e6);
    paths.step({-4e6, 1e6, 1e6}, 1e6);
    expect_all_states(paths, 5);
  }
}

TEST(CoupledContact, SaysSoWhenItDoesNotConverge) {
  const CoupledExample example;
  const int n = example.stick.n_multipliers();
  int n_nodes = 0;
  for (const TwoSidedNode& node : example.bulk.fault_nodes()) n_nodes += node.may_jump(0);
  const ContactLaws laws(n_nodes, friction(0.4, 0.4, 0));
  CoupledContactOptions options;
  options.max_newton_iterations = 1;
  const CoupledContact contact(example.bulk, laws, options);
  const Eigen::VectorXd background = Eigen::VectorXd::Zero(n);
  ContactState state = initial_state(test::condense(example.problem));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(example.bulk.n_displacements());
  const CoupledStepReport report = contact.advance({{-1e6, 0.1, 0.1, 0}, background}, state, u);
  EXPECT_FALSE(report.converged);
  EXPECT_THAT(report.reason, testing::HasSubstr("keeps changing after 1 iterations"));
  EXPECT_EQ(u.norm() + state.jump.norm(), 0) << "left as it was";
}

}  // namespace
}  // namespace faultsim
