#pragma once

#include <Eigen/Core>

#include "simulator/loads/history.h"
#include "simulator/loads/initial_traction.h"
#include "simulator/loads/load_source.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The loads of a case as functions of time, on an (elastic) operator: the initial state, the loads
/// of the operator and the faults' pressure rules, which any scene has, and further sources.
class CaseLoads {
 public:
  /// @pre scene and op outlive this. Throws InputError as initial_traction() does.
  /// @param further  in this order; those of the scene's flow results are among them.
  /// @param noise  relative disturbance of every locked traction, to see what it does; 0 = none.
  CaseLoads(const Scene& scene, const FaultOperator& op, const LoadSources& further = {},
            double noise = 0);
  /// What acts at a time, s.
  StepLoads at(double time) const;
  /// What the forces that are no load of the operator grow by from one time to another, N; empty
  /// where there are none. @param n_unknowns  of the bulk.
  Eigen::VectorXd forces(double from, double to, Eigen::Index n_unknowns) const;
  /// All of them at a time, as forces().
  Eigen::VectorXd forces_at(double time, Eigen::Index n_unknowns) const;
  /// Throws InputError where a prescribed fault pressure falls below zero in that step.
  void check_fault_pressure(const LoadStep& step, const StepLoads& loads) const;

 private:
  const Scene& scene_;
  const FaultOperator& op_;
  LoadFactors load_factors_;
  InitialTraction initial_;
  LoadSources sources_;
  bool has_forces_;
  double noise_;
};

}  // namespace faultsim
