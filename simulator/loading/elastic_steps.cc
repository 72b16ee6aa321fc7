#include "simulator/loading/elastic_steps.h"

#include "simulator/common/errors.h"
#include "simulator/loading/case_contact.h"

namespace faultsim {

ElasticSteps::ElasticSteps(const FaultOperator& op, CreepLadder* bulk, const StepSetting& setting)
    : op_(op),
      bulk_(bulk),
      case_loads_(setting.loads),
      contact_(op, setting.laws, contact_options(setting.scene.numerics), setting.watch),
      locked_(Eigen::VectorXd::Zero(op.geometry.n_dofs)) {}

SolvedStep ElasticSteps::advance(const LoadStep&, const StepLoads& loads, ContactState& state) {
  SolvedStep solved;
  solved.contact = contact_.solve_step(locked_, loads.locked, state);
  if (in_equilibrium(solved.contact.outcome)) locked_ = loads.locked;
  return solved;
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

}  // namespace faultsim
