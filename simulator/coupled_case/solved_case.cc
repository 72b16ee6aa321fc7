#include "simulator/coupled_case/solved_case.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "simulator/common/machine.h"
#include "simulator/common/text.h"
#include "simulator/solved_compliance/solved_operator.h"

namespace faultsim {
namespace {

/// Of what there is once the bulk stands: contact has its own matrices of what moves.
double room_for_columns() {
  constexpr double kShare = 0.5;
  return kShare * available_memory().value_or(std::numeric_limits<double>::infinity());
}

FaultOperator operator_of(const SceneBulk& of, const StuckBulk& bulk,
                          std::shared_ptr<const Compliance> compliance, const RunContext& context) {
  FaultOperator op = solved_operator(bulk, std::move(compliance), context);
  take_fault_names(of.scene(), op);
  for (const int row : mirrored_rows(of.scene(), of.plan().half_domain)) {
    for (int c = -1; c < 2; ++c) op.observed.rows[row + c].position.y() *= -1;
    op.observed.per_load.row(row) *= -1;
    op.observed.per_jump.row(row) *= -1;
  }
  return op;
}

/// Contact's own steps, with what their solves took, and looked at from outside.
class SolvedSteps final : public StepSolver {
 public:
  /// @pre all arguments outlive this.
  SolvedSteps(const StuckBulk& bulk, SolvedCompliance& compliance, const FaultOperator& op,
              const SolverChoice& solver, const StepSetting& setting)
      : bulk_(bulk),
        compliance_(compliance),
        op_(op),
        solver_(solver),
        tolerance_(setting.scene.numerics.traction_tolerance),
        contact_(elastic_steps(op, nullptr)(setting)) {}

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  std::optional<ContactReport> part_of_step(const Eigen::VectorXd& before,
                                            const Eigen::VectorXd& after,
                                            ContactState& state) override {
    try {
      return contact_->part_of_step(before, after, state);
    } catch (const Unsolved&) {  // an onset is then as wide as it is by now
      return std::nullopt;
    }
  }
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override {
    return contact_->observed(loads, state);
  }
  Eigen::Matrix3Xd displacement(const StepLoads& loads, const ContactState& state) override {
    return solved_displacement(bulk_, loads.factors, state.jump);
  }
  void describe(CaseResult& result) const override;

 private:
  SolvedStep solve(const LoadStep& step, const StepLoads& loads, ContactState& state);
  std::string astray(const StepLoads& loads, const ContactState& state) const;

  const StuckBulk& bulk_;
  SolvedCompliance& compliance_;
  const FaultOperator& op_;
  SolverChoice solver_;
  double tolerance_;
  std::unique_ptr<StepSolver> contact_;
};

/// A system that is not solved is an answer of the step, whose state is then as it was.
SolvedStep SolvedSteps::solve(const LoadStep& step, const StepLoads& loads, ContactState& state) {
  ContactState next = state;
  SolvedStep solved;
  std::string wrong;
  try {
    solved = contact_->advance(step, loads, next);
    if (!in_equilibrium(solved.contact.outcome)) return solved;
    wrong = astray(loads, next);
  } catch (const Unsolved& error) {
    wrong = error.what();
  }
  if (wrong.empty()) {
    state = std::move(next);
  } else {
    solved.contact.outcome = Outcome::unconverged;
    solved.contact.reason = std::move(wrong);
    solved.contact.jumps.clear();
  }
  return solved;
}

SolvedStep SolvedSteps::advance(const LoadStep& step, const StepLoads& loads, ContactState& state) {
  const StuckBulk::Work before = bulk_.work();
  compliance_.begin_step();
  SolvedStep solved = solve(step, loads, state);
  const StuckBulk::Work& after = bulk_.work();
  StepCoupled& linear = solved.linear.emplace();
  linear.krylov_iterations.assign(after.iterations.begin() + std::ssize(before.iterations),
                                  after.iterations.end());
  linear.solve_seconds = after.solve_seconds - before.solve_seconds;
  return solved;
}

/// What is wrong with the tractions, by one solve with all jumps; empty: nothing.
std::string SolvedSteps::astray(const StepLoads& loads, const ContactState& state) const {
  constexpr double kLowest = 1e-3;  // of the highest level, as in the judgement of a step
  constexpr double kMargin = 10;
  if (state.jump.size() == 0) return {};
  const Eigen::VectorXd forces = compliance_.product(state.jump).forces;
  const Eigen::VectorXd afresh = loads.locked - forces.cwiseQuotient(op_.geometry.dof_area);
  const Eigen::VectorXd level = loads.locked.cwiseAbs().cwiseMax(state.traction.cwiseAbs());
  const double floor = kLowest * level.maxCoeff();
  for (const OperatorNode& node : op_.geometry.nodes) {
    double off = 0, its_level = floor;
    for (const int dof : node.dof) {
      if (dof < 0) continue;
      off = std::max(off, std::abs(afresh[dof] - state.traction[dof]));
      its_level = std::max(its_level, level[dof]);
    }
    if (off <= kMargin * tolerance_ * its_level) continue;
    return concat(
        "the tractions of solved columns are off by ", formatted("%.2g Pa", off), " at (",
        formatted("%.6g, %.6g, %.6g", node.position.x(), node.position.y(), node.position.z()),
        ") m, by a solve with all jumps");
  }
  return {};
}

void SolvedSteps::describe(CaseResult& result) const {
  CaseCoupled& of = result.coupled.emplace();
  of.leading = to_string(solver_.leading);
  of.schur = "columns";
  of.n_displacements = bulk_.dofs().n_bulk();
  of.n_multipliers = bulk_.dofs().n_jump();
  of.setup_seconds = bulk_.work().setup_seconds;
}

}  // namespace

struct SolvedCase::Impl {
  Impl(const SceneBulk& of, const SolverChoice& choice, const SolvedCaseOptions& options,
       const RunContext& context)
      : scene(of.scene()),
        solver(choice),
        bulk(std::make_shared<const StuckBulk>(of.problem(), choice, options.tolerance)),
        compliance(std::make_shared<SolvedCompliance>(
            bulk, options.column_bytes ? *options.column_bytes : room_for_columns())),
        op(operator_of(of, *bulk, compliance, context)) {}

  const Scene& scene;
  SolverChoice solver;
  std::shared_ptr<const StuckBulk> bulk;
  std::shared_ptr<SolvedCompliance> compliance;
  FaultOperator op;
};

SolvedCase::SolvedCase(const SceneBulk& scene, const SolverChoice& solver,
                       const RunContext& context, const SolvedCaseOptions& options)
    : impl_(std::make_unique<Impl>(scene, solver, options, context)) {}
SolvedCase::~SolvedCase() = default;

const FaultOperator& SolvedCase::faults() const { return impl_->op; }
const Mesh& SolvedCase::mesh() const { return impl_->bulk->problem().mesh; }
const SolvedCompliance& SolvedCase::compliance() const { return *impl_->compliance; }

CaseResult SolvedCase::run(const RunContext& context, const CaseProbe& probe) {
  Impl& self = *impl_;
  self.bulk->heed(context.stop);
  const auto steps = [&self](const StepSetting& setting) {
    return std::make_unique<SolvedSteps>(*self.bulk, *self.compliance, self.op, self.solver,
                                         setting);
  };
  CaseResult result = run_case(self.scene, self.op, steps, context, probe);
  self.bulk->heed({});  // the flag is the caller's
  return result;
}

}  // namespace faultsim
