#pragma once

#include "simulator/condensation/creep_ladder.h"
#include "simulator/contact/contact.h"
#include "simulator/loading/step_solver.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// Load steps in elastic rock: contact on the condensed operator, and nothing else.
class ElasticSteps final : public StepSolver {
 public:
  /// @param bulk  whose factor gives displacements; may be null. @pre all outlive this.
  ElasticSteps(const FaultOperator& op, CreepLadder* bulk, const StepSetting& setting);

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override;
  Eigen::Matrix3Xd displacement(const StepLoads& loads, const ContactState& state) override;

 private:
  const FaultOperator& op_;
  CreepLadder* bulk_;
  const CaseLoads& case_loads_;
  ContactSolver contact_;
  Eigen::VectorXd locked_;  ///< t_L of the last equilibrium, Pa.
};

}  // namespace faultsim
