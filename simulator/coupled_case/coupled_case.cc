#include "simulator/coupled_case/coupled_case.h"

#include <algorithm>
#include <array>
#include <utility>

#include "simulator/condensation/fault_geometry.h"
#include "simulator/contact/step_cutter.h"
#include "simulator/coupled/coupled_contact.h"
#include "simulator/plan/combinations.h"

namespace faultsim {
namespace {

/// What `faults` says of a case; its bulk is not condensed.
FaultOperator uncondensed(const Scene& scene, const Plan& plan, const BulkProblem& problem) {
  FaultOperator op;
  const DofMap dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size()));
  op.geometry = fault_geometry(problem.mesh, problem.materials, dofs, problem.half_domain);
  take_fault_names(scene, op);
  for (const LoadCase& load : problem.loads) op.loads.keys.push_back(load.key);
  op.loads.traction.resize(op.geometry.n_dofs, 0);
  for (const auto& [name, point] : problem.observation_points) {
    const int node = observed_node(problem.mesh, point);
    for (int c = 0; c < 3; ++c)
      op.observed.rows.push_back({concat(name, ".", "xyz"[c]), problem.mesh.nodes[node]});
  }
  for (const int row : mirrored_rows(scene, plan.half_domain)) {
    for (int c = -1; c < 2; ++c) op.observed.rows[row + c].position.y() *= -1;
  }
  op.n_unknowns = dofs.n_unknowns();
  return op;
}

}  // namespace

std::vector<Problem> unsupported_by_coupled(const Scene& scene, const Plan& plan) {
  return unsupported(scene, plan, std::array{Feature::coupled_path});
}

bool takes_columns(const Scene& scene, const Plan& plan) {
  return std::ranges::any_of(features_of(scene, plan), [](Feature feature) {
    return feature == Feature::weakening || feature == Feature::cohesion_loss;
  });
}

std::string parts_warning(const CaseResult& result) {
  std::string steps;
  for (const StepResult& step : result.steps) {
    if (step.counts.sub_steps < 2) continue;
    steps += concat(steps.empty() ? "" : ", ", step.step, " (", step.counts.sub_steps, " parts)");
  }
  if (steps.empty()) return steps;
  return concat(
      "load steps were cut because Newton's method did not converge over the whole: ", steps,
      "; slip depends on the path, so it may differ slightly from that of the condensed path");
}

struct CoupledCase::Impl final {
  Impl(const SceneBulk& of, const SolverChoice& choice, const Ranks& ranks)
      : scene(of.scene()),
        solver(choice),
        shared(of.problem()),
        problem(*shared),
        faults(uncondensed(scene, of.plan(), problem)),
        bulk(problem,
             choice.schur == SchurKind::rac ? LoosePieces::held_by_faults : LoosePieces::refused,
             ranks),
        mirrored(mirrored_rows(scene, of.plan().half_domain)) {}

  const Scene& scene;
  SolverChoice solver;
  std::shared_ptr<const BulkProblem> shared;
  const BulkProblem& problem;
  FaultOperator faults;
  TwoSidedBulk bulk;
  std::vector<int> mirrored;  ///< rows of observations.
};

namespace {

CoupledContactOptions options_of(const SolverChoice& solver, const StepSetting& setting,
                                 const StopToken& stop) {
  CoupledContactOptions options;
  options.solver = solver;
  options.traction_tolerance = setting.scene.numerics.traction_tolerance;
  options.stop = stop;
  return options;
}

/// What a run of a case asks of Newton's method on both sides of the faults.
class CoupledSteps final : public StepSolver {
 public:
  /// @pre all arguments outlive this.
  CoupledSteps(const TwoSidedBulk& bulk, const BulkProblem& problem, const FaultOperator& faults,
               const std::vector<int>& mirrored, const SolverChoice& solver,
               const StepSetting& setting, const StopToken& stop)
      : bulk_(bulk),
        problem_(problem),
        faults_(faults),
        mirrored_(mirrored),
        options_(options_of(solver, setting, stop)),
        contact_(bulk, setting.laws, options_),
        max_cuts_(setting.scene.numerics.max_step_cuts),
        tried_(setting.watch.tried),
        u_(Eigen::VectorXd::Zero(bulk.n_own())) {
    at_.factors.assign(problem.loads.size(), 0);
    at_.background = Eigen::VectorXd::Zero(faults.geometry.n_dofs);
    FAULTSIM_DEMAND(contact_.n_dofs() == faults.geometry.n_dofs, contact_.n_dofs(), " and ",
                    faults.geometry.n_dofs);
  }

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override;
  Eigen::Matrix3Xd displacement(const StepLoads&, const ContactState&) override {
    return displacement_;
  }
  void describe(CaseResult& result) const override;

 private:
  CoupledLoad between(const CoupledLoad& to, double share) const;
  bool try_part(double from, double to, const CoupledLoad& load, ContactState& state,
                Eigen::VectorXd& u, SolvedStep& solved);

  const TwoSidedBulk& bulk_;
  const BulkProblem& problem_;
  const FaultOperator& faults_;
  const std::vector<int>& mirrored_;
  CoupledContactOptions options_;
  CoupledContact contact_;
  int max_cuts_;
  bool may_cut_ = true;  ///< after a failure: a smaller step may help.
  std::function<void(const SubStepTrace&)> tried_;
  CoupledLoad at_;     ///< of the last equilibrium,
  Eigen::VectorXd u_;  ///< its displacements as unknowns
  Eigen::Matrix3Xd displacement_;
};

/// Loads are linear within a step.
CoupledLoad CoupledSteps::between(const CoupledLoad& to, double share) const {
  if (share == 1) return to;
  CoupledLoad load;
  for (std::size_t k = 0; k < to.factors.size(); ++k)
    load.factors.push_back((1 - share) * at_.factors[k] + share * to.factors[k]);
  load.background = (1 - share) * at_.background + share * to.background;
  return load;
}

/// @returns whether there is equilibrium at the end of that part of the load step; if not,
/// solved.contact.reason says why.
bool CoupledSteps::try_part(double from, double to, const CoupledLoad& load, ContactState& state,
                            Eigen::VectorXd& u, SolvedStep& solved) {
  const CoupledStepReport part = contact_.advance(load, state, u);
  StepCoupled& linear = *solved.linear;
  linear.krylov_iterations.insert(linear.krylov_iterations.end(),
                                  part.linear.krylov_iterations.begin(),
                                  part.linear.krylov_iterations.end());
  linear.setup_seconds += part.linear.setup_seconds;
  linear.solve_seconds += part.linear.solve_seconds;
  SolveCounts& counts = solved.contact.counts;
  (part.converged ? counts.newton_iterations : counts.wasted_newton_iterations) +=
      part.newton_iterations();
  counts.active_set_passes += part.newton.passes;
  if (part.converged) {
    ++counts.sub_steps;
  } else {
    may_cut_ = part.newton.end != SearchEnd::no_progress;  // a linear system stays as hard
    solved.contact.reason = concat(part.reason, " (load ", from, " to ", to, " of the step)");
  }
  if (tried_) {
    tried_({.from = from,
            .to = to,
            .n_nodes = static_cast<int>(faults_.geometry.nodes.size()),
            .searches = {{"coupled", part.newton}},
            .verdict = part.converged ? "accepted" : "failed"});
  }
  return part.converged;
}

SolvedStep CoupledSteps::advance(const LoadStep&, const StepLoads& loads, ContactState& state) {
  const CoupledLoad to{loads.factors, loads.locked};
  SolvedStep solved;
  solved.linear.emplace();
  solved.is_elastic = false;
  ContactState next = state;
  Eigen::VectorXd u = u_;
  const auto part = [&](double from, double end) {
    return may_cut_ && try_part(from, end, between(to, end), next, u, solved);
  };
  may_cut_ = true;
  const double unit = std::ldexp(1.0, -max_cuts_);
  const bool arrived =
      part(0, 1) ||
      walk_in_parts(
          max_cuts_, [&](int from, int width) { return part(from * unit, (from + width) * unit); },
          [](int) { return false; });
  if (!arrived) {
    solved.contact.outcome = Outcome::unconverged;
    return solved;
  }
  solved.contact.outcome = Outcome::converged;
  solved.contact.reason.clear();
  state = std::move(next);
  u_ = std::move(u);
  at_ = to;
  displacement_ = bulk_.nodal_displacement(u_);
  return solved;
}

void CoupledSteps::describe(CaseResult& result) const {
  CaseCoupled& of = result.coupled.emplace();
  of.leading = to_string(options_.solver.leading);
  of.schur = to_string(options_.solver.schur);
  of.n_displacements = bulk_.n_displacements();
  of.n_multipliers = contact_.n_dofs();
}

Eigen::VectorXd CoupledSteps::observed(const StepLoads&, const ContactState&) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(faults_.observed.rows.size()));
  int row = 0;
  for (const auto& [name, point] : problem_.observation_points) {
    values.segment<3>(row) = displacement_.col(observed_node(problem_.mesh, point));
    row += 3;
  }
  for (const int turned : mirrored_) values[turned] *= -1;
  return values;
}

}  // namespace

CoupledCase::CoupledCase(const SceneBulk& scene, const SolverChoice& solver,
                         const RunContext& context, const Ranks& ranks) {
  require_runs_on_ranks(solver, ranks.size());
  std::vector<Problem> problems = unsupported_by_coupled(scene.scene(), scene.plan());
  if (!problems.empty()) throw InputError("scene", std::move(problems));
  context.progress(0.0, "meshing and assembling");
  if (takes_columns(scene.scene(), scene.plan())) {
    if (ranks.size() > 1)
      throw InputError("coupled path",
                       "faults that weaken, or lose cohesion by slip, need columns of H, which are "
                       "made in one process",
                       "start it without mpirun");
    solved_ = std::make_unique<SolvedCase>(scene, solver, context);
    return;
  }
  impl_ = std::make_unique<Impl>(scene, solver, ranks);
}

CoupledCase::~CoupledCase() = default;

const FaultOperator& CoupledCase::faults() const {
  return solved_ ? solved_->faults() : impl_->faults;
}
const Mesh& CoupledCase::mesh() const { return solved_ ? solved_->mesh() : impl_->problem.mesh; }

CaseResult CoupledCase::run(const RunContext& context, const CaseProbe& probe) {
  if (solved_) return solved_->run(context, probe);
  Impl& self = *impl_;
  const auto steps = [&self, &context](const StepSetting& setting) {
    return std::make_unique<CoupledSteps>(self.bulk, self.problem, self.faults, self.mirrored,
                                          self.solver, setting, context.stop);
  };
  RunContext walk = context;
  if (self.bulk.ranks().size() > 1) walk.stop = {};  // asked where all ranks ask, and only there
  CaseResult result = run_case(self.scene, self.faults, steps, walk, probe);
  if (std::string text = parts_warning(result); !text.empty()) result.warnings.push_back(text);
  return result;
}

}  // namespace faultsim
