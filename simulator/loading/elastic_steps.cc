#include "simulator/common/errors.h"
#include "simulator/condensation/creep_ladder.h"
#include "simulator/loading/case_contact.h"
#include "simulator/loading/step_solver.h"

namespace faultsim {

namespace {

class ElasticSteps final : public StepSolver {
 public:
  ElasticSteps(const FaultOperator& op, CreepLadder* bulk, const StepSetting& setting)
      : op_(op),
        bulk_(bulk),
        case_loads_(setting.loads),
        laws_(setting.laws),
        options_(contact_options(setting.scene.numerics)),
        watch_(setting.watch),
        contact_(op, laws_, options_, watch_),
        locked_(Eigen::VectorXd::Zero(op.geometry.n_dofs)) {}

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  std::optional<ContactReport> part_of_step(const Eigen::VectorXd& before,
                                            const Eigen::VectorXd& after,
                                            ContactState& state) override;
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override;
  Eigen::Matrix3Xd displacement(const StepLoads& loads, const ContactState& state) override;

 private:
  const FaultOperator& op_;
  CreepLadder* bulk_;
  const CaseLoads& case_loads_;
  const ContactLaws& laws_;
  ContactOptions options_;
  ContactWatch watch_;
  ContactSolver contact_;
  /// Of parts of steps: what a solver has learnt shows in the last digits of the steps that follow.
  std::unique_ptr<ContactSolver> of_parts_;
  Eigen::VectorXd locked_;  ///< t_L of the last equilibrium, Pa.
};

SolvedStep ElasticSteps::advance(const LoadStep&, const StepLoads& loads, ContactState& state) {
  SolvedStep solved;
  solved.contact = contact_.solve_step(locked_, loads.locked, state);
  if (in_equilibrium(solved.contact.outcome)) locked_ = loads.locked;
  return solved;
}

std::optional<ContactReport> ElasticSteps::part_of_step(const Eigen::VectorXd& before,
                                                        const Eigen::VectorXd& after,
                                                        ContactState& state) {
  if (!of_parts_) of_parts_ = std::make_unique<ContactSolver>(op_, laws_, options_, watch_);
  return of_parts_->solve_step(before, after, state);
}

Eigen::VectorXd ElasticSteps::observed(const StepLoads& loads, const ContactState& state) const {
  const Eigen::Map<const Eigen::VectorXd> factors(loads.factors.data(), std::ssize(loads.factors));
  Eigen::VectorXd u = op_.observed.per_load * factors + op_.observed.per_jump * state.jump;
  if (loads.observed.size() > 0) u += loads.observed;
  return u;
}

Eigen::Matrix3Xd ElasticSteps::displacement(const StepLoads& loads, const ContactState& state) {
  FAULTSIM_DEMAND(bulk_ != nullptr, "displacements of a bulk that was not kept");
  CondensedBulk& bulk = bulk_->bulk(0);
  const Eigen::VectorXd forces = case_loads_.forces_at(loads.time, op_.n_unknowns);
  if (forces.size() == 0) return bulk.displacement(loads.factors, state.jump);
  return bulk.displacement(bulk.forward(forces), loads.factors, state.jump);
}

}  // namespace

MakeStepSolver elastic_steps(const FaultOperator& op, CreepLadder* bulk) {
  return [&op, bulk](const StepSetting& setting) {
    return std::make_unique<ElasticSteps>(op, bulk, setting);
  };
}

}  // namespace faultsim
