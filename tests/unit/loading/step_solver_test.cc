// Another way to solve a load step joins a case as one class: projected Gauss–Seidel, node by node,
// which shares nothing with Newton's method.
#include "simulator/loading/step_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

/// Coulomb with constant friction in plane strain: each node in turn is brought to rest on the
/// others until nothing moves.
class GaussSeidelSteps final : public StepSolver {
 public:
  GaussSeidelSteps(const FaultOperator& op, const ContactLaws& laws) : op_(op), laws_(laws) {}

  SolvedStep advance(const LoadStep&, const StepLoads& loads, ContactState& state) override {
    const Eigen::VectorXd start = state.jump;
    state.traction = loads.locked - (op_.h() * start).cwiseQuotient(op_.geometry.dof_area);
    SolvedStep solved;
    for (double moved = 1; moved > 1e-14; ++solved.contact.counts.newton_iterations) {
      moved = 0;
      for (std::size_t k = 0; k < op_.geometry.nodes.size(); ++k) {
        const int n = op_.geometry.nodes[k].dof[0], t = op_.geometry.nodes[k].dof[2];
        const double gap = std::max(0.0, state.jump[n] + state.traction[n] / stiffness(n));
        moved = std::max(moved, move(n, gap, state));
        const double limit = laws_[k].cohesion - std::min(0.0, state.traction[n]) *
                                                     std::tan(laws_[k].static_friction_angle);
        const double held = state.traction[t] + stiffness(t) * (state.jump[t] - start[t]);
        const double excess = std::max(0.0, std::abs(held) - limit) * (held < 0 ? -1 : 1);
        moved = std::max(moved, move(t, start[t] + excess / stiffness(t), state));
        state.state[k] = gap > 0       ? FaultState::open
                         : excess != 0 ? FaultState::slip
                                       : FaultState::stick;
      }
    }
    solved.contact.outcome = Outcome::converged;
    return solved;
  }
  Eigen::VectorXd observed(const StepLoads&, const ContactState&) const override { return {}; }
  Eigen::Matrix3Xd displacement(const StepLoads&, const ContactState&) override { return {}; }

 private:
  double stiffness(int dof) const {
    return op_.compliance->diagonal(dof) / op_.geometry.dof_area[dof];
  }
  double move(int dof, double to, ContactState& state) const {
    const double by = to - state.jump[dof];
    if (by != 0) state.traction -= by * op_.h().col(dof).cwiseQuotient(op_.geometry.dof_area);
    state.jump[dof] = to;
    return std::abs(by);
  }

  const FaultOperator& op_;
  const ContactLaws& laws_;
};

TEST(StepSolver, AnotherOneRunsACase) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/verification/v5_slipping_fault.json");
  set_value(document, "/mesh/dip", "10 m");
  set_value(document, "/stages/0/steps", "3");
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const FaultOperator op = *prepare_operator(scene, make_plan(scene, problems), {}, false).op;
  const CaseResult newton = run_case(scene, op, elastic_steps(op, nullptr), {});
  const CaseResult seidel = run_case(
      scene, op,
      [&](const StepSetting& of) { return std::make_unique<GaussSeidelSteps>(op, of.laws); }, {});
  ASSERT_EQ(newton.outcome, Outcome::converged) << newton.reason;
  EXPECT_GT(newton.steps.back().n_slip, 3);
  ASSERT_EQ(seidel.steps.size(), newton.steps.size());
  for (std::size_t i = 0; i < newton.steps.size(); ++i) {
    const FaultMetrics &a = newton.steps[i].faults[0], &b = seidel.steps[i].faults[0];
    EXPECT_NEAR(b.max_slip, a.max_slip, 1e-9);
    EXPECT_NEAR(b.chi_bar, a.chi_bar, 1e-6);
    EXPECT_EQ(seidel.steps[i].n_slip, newton.steps[i].n_slip);
  }
}

}  // namespace
}  // namespace faultsim
