// A load step in the form u = W r + q that contact solvers share: the two tiny problems whose
// answers are known, our steps in that form, and the steps that have none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "simulator/common/errors.h"
#include "tests/unit/contact/cone_fixture.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

/// Three-dimensional, one contact; the answer is known to twelve digits.
FrictionalContactProblem one_contact() {
  FrictionalContactProblem problem;
  problem.w.resize(3, 3);
  problem.w << 15, -1, -2, -1, 14, 1, -2, 1, 16;
  problem.q = Eigen::Vector3d(-1, 2, 3);
  problem.friction = Eigen::VectorXd::Constant(1, 0.1);
  return problem;
}

/// Three contacts that do not know each other.
FrictionalContactProblem three_contacts() {
  FrictionalContactProblem problem;
  problem.w = Eigen::MatrixXd::Identity(9, 9);
  problem.q = Eigen::Vector3d(-1, 1, 3).replicate(3, 1);
  problem.friction = Eigen::VectorXd::Constant(3, 0.1);
  return problem;
}

FrictionalContactSolution solve(const FrictionalContactProblem& problem) {
  const ConeStep given = cone_step(problem);
  ContactState end = given.step.start;
  const ContactReport report =
      ContactSolver(given.op, given.laws, {}).solve_step(given.step.before, given.step.after, end);
  EXPECT_EQ(report.outcome, Outcome::converged) << report.reason;
  return cone_solution(end);
}

TEST(TinyConeProblem, OneSlippingContactHasTheKnownAnswer) {
  const FrictionalContactProblem problem = one_contact();
  const FrictionalContactSolution solution = solve(problem);
  EXPECT_NEAR(solution.r.norm(), 0.0660233441967, 1e-12);
  EXPECT_NEAR(solution.u.norm(), 3.35274260167, 1e-10);
  EXPECT_NEAR(solution.r[0], 0.0656956828977, 1e-12);
  EXPECT_LT(natural_map_error(problem, solution), 1e-12);
  EXPECT_LT(equilibrium_error(problem, solution), 1e-12);
}

TEST(TinyConeProblem, ThreeContactsOnTheUnitMatrixHaveTheKnownAnswer) {
  const FrictionalContactProblem problem = three_contacts();
  const FrictionalContactSolution solution = solve(problem);
  EXPECT_NEAR(solution.u.norm(), 5.30402049429, 1e-10);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(solution.r[3 * k], 1, 1e-12);
    EXPECT_NEAR(solution.r[3 * k + 1], -0.1 * 1 / std::sqrt(10.0), 1e-12);
    EXPECT_NEAR(solution.r[3 * k + 2], -0.1 * 3 / std::sqrt(10.0), 1e-12);
  }
  EXPECT_LT(natural_map_error(problem, solution), 1e-13);
}

TEST(FrictionCone, ProjectsByTheThreeCases) {
  const Eigen::Vector3d inside(2, 0.5, 0), polar(-1, 0.3, 0.4), outside(1, 3, 4);
  EXPECT_EQ(project_on_friction_cone(inside, 0.5), inside);
  EXPECT_EQ(project_on_friction_cone(polar, 0.5), Eigen::VectorXd(Eigen::Vector3d(0, 0, 0)));
  // μ = 0.5: the nearest point of the ray along (1, 0.5) to (1, 5) is 2.8 (1, 0.5).
  EXPECT_LT((project_on_friction_cone(outside, 0.5) - Eigen::Vector3d(2.8, 0.84, 1.12)).norm(),
            1e-15);
  EXPECT_EQ(project_on_friction_cone(Eigen::Vector2d(2, -7), 0),
            Eigen::VectorXd(Eigen::Vector2d(2, 0)));
}

TEST(NaturalMapError, IsZeroForSolutionsOnly) {
  FrictionalContactProblem problem = three_contacts();
  problem.friction = Eigen::Vector3d(0.5, 0.5, 0.5);
  FrictionalContactSolution s{Eigen::VectorXd::Zero(9), Eigen::VectorXd::Zero(9)};
  s.r.segment(0, 3) << 2, 0.6, 0.8;    // sticks at the limit
  s.u.segment(3, 3) << 3, 1, 1;        // open
  s.r.segment(6, 3) << 2, -0.6, -0.8;  // slips against the force
  s.u.segment(6, 3) << 0, 0.3, 0.4;
  EXPECT_LT(natural_map_error(problem, s), 1e-15);
  const auto error_with = [&](int component, double du, double dr) {
    FrictionalContactSolution wrong = s;
    wrong.u[component] += du;
    wrong.r[component] += dr;
    return natural_map_error(problem, wrong);
  };
  EXPECT_NEAR(error_with(0, 0.1, 0), 0.2 / std::sqrt(5.0), 1e-15);  // gap under pressure
  EXPECT_NEAR(error_with(0, -0.1, 0), 0.1, 1e-15);                  // penetration
  EXPECT_GT(error_with(1, 0, 0.1), 0.05);                           // beyond the limit
  EXPECT_NEAR(error_with(3, 0, 0.1), 0.1, 1e-15);                   // open, yet pressed
  EXPECT_GT(error_with(6, 0, 0.1), 0.02);                           // slips below the limit
  s.u.segment(6, 3) << 0, -0.3, -0.4;                               // along the force
  EXPECT_GT(natural_map_error(problem, s), 0.1);
}

/// A fault of n nodes that slips here and opens there when its load is the returned one.
Eigen::VectorXd random_load(const FaultOperator& op, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd load(op.geometry.n_dofs);
  for (const OperatorNode& node : op.geometry.nodes) {
    for (const int dof : node.dof) {
      if (dof >= 0) load[dof] = 5e6 * uniform(random);
    }
    load[node.dof[0]] = -2e6 + 8e6 * uniform(random);
  }
  return load;
}

/// Solves two load steps; the second starts with slip and gaps.
struct SecondStep {
  SecondStep(FaultOperator given, double friction) : op(std::move(given)) {
    const double angle = std::atan(friction);
    laws = same_law(op, {WeakeningLaw::angle, 0, angle, angle, 1});
    step.start = initial_state(op);
    step.before = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    step.after = random_load(op, 1);
    ContactSolver solver(op, laws, {});
    EXPECT_EQ(solver.solve_step(step.before, step.after, step.start).outcome, Outcome::converged);
    step.before = step.after;
    step.after = 0.7 * step.before + 0.5 * random_load(op, 2);
    end = step.start;
    ContactOptions whole;
    whole.max_step_cuts = 0;
    ContactSolver again(op, laws, whole);
    EXPECT_EQ(again.solve_step(step.before, step.after, end).outcome, Outcome::converged);
  }
  int count(FaultState state) const {
    return static_cast<int>(std::count(end.state.begin(), end.state.end(), state));
  }
  FaultOperator op;
  ContactLaws laws;
  LoadStepProblem step;
  ContactState end;
};

FaultOperator fault(int n_nodes, int n_shear) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.5, 2);
  Eigen::VectorXd area(n_nodes);
  for (double& a : area) a = 100 * uniform(random);
  FaultOperator op = make_operator(n_nodes, n_shear, area);
  set_h(op, 10 * half_space_matrix(op, 6e9, 0.1));
  return op;
}

TEST(ExportedStep, IsSolvedByOurSolutionInTwoAndThreeDimensions) {
  for (const int n_shear : {1, 2}) {
    const SecondStep second(fault(40, n_shear), 0.5);
    ASSERT_GT(second.count(FaultState::slip), 3);
    ASSERT_GT(second.count(FaultState::open), 3);
    ASSERT_GT(second.count(FaultState::stick), 3);
    const FrictionalContactProblem problem =
        frictional_contact_problem(second.op, second.laws, second.step);
    const FrictionalContactSolution solution =
        frictional_contact_solution(second.op, problem, second.step, second.end);
    EXPECT_EQ(problem.dimension, 1 + n_shear);
    EXPECT_LT(equilibrium_error(problem, solution), 1e-12 * problem.q.norm());
    EXPECT_LT(natural_map_error(problem, solution), 1e-8 * problem.q.norm());
    // Solved again from W, q and μ alone.
    const FrictionalContactSolution again = solve(problem);
    EXPECT_LT((again.u - solution.u).norm(), 1e-8 * solution.u.norm());
    EXPECT_LT((again.r - solution.r).norm(), 1e-8 * solution.r.norm());
  }
}

TEST(ExportedStep, IsScaledByPowersOfTenThatItTells) {
  const SecondStep second(fault(10, 2), 0.5);
  const FrictionalContactProblem problem =
      frictional_contact_problem(second.op, second.laws, second.step);
  const double flexibility = problem.w.diagonal().mean();
  EXPECT_TRUE(flexibility > 0.3 && flexibility < 3.2) << flexibility;
  const double largest = problem.q.lpNorm<Eigen::Infinity>();
  EXPECT_TRUE(largest > 0.3 && largest < 3.2) << largest;
  // W in m/N times H in N/m.
  const Eigen::MatrixXd w = problem.w * (problem.displacement_unit / problem.force_unit);
  EXPECT_LT((w * second.op.h() - Eigen::MatrixXd::Identity(30, 30)).norm(), 1e-11);
}

TEST(ExportedStep, GivesAMissingComponentARowOfItsOwnInWhichNothingMoves) {
  FaultOperator op = fault(12, 2);
  // The first node loses its motion along strike: its dof goes, the later ones move up.
  const Eigen::Index n = op.geometry.n_dofs - 1;
  Eigen::MatrixXd h(n, n);
  const auto old = [](Eigen::Index i) { return i < 1 ? i : i + 1; };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) h(i, j) = op.h()(old(i), old(j));
  }
  const Eigen::VectorXd area = op.geometry.dof_area;
  op.geometry.dof_area.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) op.geometry.dof_area[i] = area[old(i)];
  for (OperatorNode& node : op.geometry.nodes) {
    for (int& dof : node.dof) dof -= dof > 1 ? 1 : 0;
  }
  op.geometry.nodes[0].dof[1] = -1;
  op.geometry.n_dofs = static_cast<int>(n);
  set_h(op, h);

  const SecondStep second(op, 0.3);
  const FrictionalContactProblem problem =
      frictional_contact_problem(second.op, second.laws, second.step);
  ASSERT_EQ(problem.dimension, 3);
  EXPECT_EQ(problem.w(1, 1), problem.w(0, 0));
  EXPECT_EQ(problem.w.row(1).norm(), problem.w(1, 1));
  EXPECT_EQ(problem.q[1], 0);
  const FrictionalContactSolution solution =
      frictional_contact_solution(second.op, problem, second.step, second.end);
  EXPECT_LT(natural_map_error(problem, solution), 1e-8 * problem.q.norm());
  EXPECT_LT(equilibrium_error(problem, solution), 1e-12 * problem.q.norm());
  const FrictionalContactSolution again = solve(problem);  // free to use the component
  EXPECT_LT(std::abs(again.u[1]), 1e-12);
  EXPECT_LT(std::abs(again.r[1]), 1e-12);
  EXPECT_LT((again.u - solution.u).norm(), 1e-8 * solution.u.norm());
}

TEST(FrozenLaws, AreTheSameLawsWithoutCohesionAndWeakening) {
  const FaultOperator op = spring_slider(1, 2);
  const ContactLaws laws = same_law(op, {WeakeningLaw::angle, 0, 0.5, 0.5, 1});
  const ContactLaws frozen = frozen_laws(op, laws, initial_state(op), Weakening::refuse);
  EXPECT_DOUBLE_EQ(frozen[0].static_friction_angle, 0.5);
  EXPECT_DOUBLE_EQ(frozen[0].dynamic_friction_angle, 0.5);
}

std::string refusal(const FaultOperator& op, const ContactLaws& laws, const ContactState& start) {
  try {
    frozen_laws(op, laws, start, Weakening::refuse);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FrozenLaws, RefuseCohesionThatIsAtWork) {
  const FaultOperator op = spring_slider(1, 2);
  const ContactLaws laws = same_law(op, {WeakeningLaw::angle, 1e6, 0.5, 0.5, 1});
  ContactState start = initial_state(op);
  EXPECT_THAT(
      refusal(op, laws, start),
      HasSubstr("cohesion acts in the step at 1 of 1 nodes (first: fault 'main' at "
                "x = 0 m, y = 0 m, depth = 2000 m), but a friction cone has no cohesion; set the "
                "cohesion to 0"));
  start.cohesion_lost[0] = 1;  // gone
  EXPECT_EQ(refusal(op, laws, start), "accepted");
  EXPECT_EQ(frozen_laws(op, laws, start, Weakening::refuse)[0].cohesion, 0);
}

TEST(FrozenLaws, FreezeTheFrictionOfTheStartOfTheStep) {
  const FaultOperator op = spring_slider(1, 2);
  ContactLaws laws =
      same_law(op, {WeakeningLaw::coefficient, 0, std::atan(0.6), std::atan(0.4), 2});
  ContactState start = initial_state(op);
  start.jump.tail<2>() << 0.3, 0.4;  // slip 0.5: a quarter of the way
  start.slip_path[0] = 1;            // path 1: half of it
  EXPECT_THAT(refusal(op, laws, start), HasSubstr("friction may weaken within the step"));
  const auto friction = [&] {
    return std::tan(frozen_laws(op, laws, start, Weakening::freeze)[0].dynamic_friction_angle);
  };
  EXPECT_NEAR(friction(), 0.55, 1e-15);
  laws[0].slip_measure = SlipMeasure::cumulated;
  EXPECT_NEAR(friction(), 0.5, 1e-15);
  // Once the path is beyond d_c it cannot change any more; the slip could come back.
  start.slip_path[0] = 2;
  EXPECT_EQ(refusal(op, laws, start), "accepted");
  EXPECT_NEAR(friction(), 0.4, 1e-15);
  laws[0].slip_measure = SlipMeasure::current;
  start.jump.tail<2>() << 3, 4;
  EXPECT_THAT(refusal(op, laws, start), HasSubstr("freeze the strength"));
}

}  // namespace
}  // namespace faultsim
