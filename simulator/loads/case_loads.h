#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/loads/field_history.h"
#include "simulator/loads/history.h"
#include "simulator/loads/initial_traction.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Changes of pressure since the start, at one time.
struct PressureChanges {
  std::vector<double> pressure_change;    ///< Δp per region, Pa; of a field its mean.
  Eigen::VectorXd fault_pressure_change;  ///< Δp_f, n_nodes, Pa.
  /// By how much Δp beside each node differs from its region's, minus and plus side (see
  /// side_regions), n_nodes x 2, Pa; empty without a field of pressures.
  Eigen::MatrixX2d beside = {};
};
/// Linear from one time to another. @param share  of the way, 0 to 1.
PressureChanges between(const PressureChanges& before, const PressureChanges& after, double share);

/// The loads of a case at one time: what the faults would carry if they stayed closed.
struct StepLoads : PressureChanges {
  std::vector<double> factors;  ///< c_k, per operator load.
  /// t_L = t'_0 + Σ c_k L_k + Σ_c P_c b_c Δp_c + α_f Δp_f n, n_dofs, Pa; without the sum where the
  /// operator is not condensed and has no L: what the faults would carry if the rock were rigid.
  Eigen::VectorXd locked;
  Eigen::VectorXd observed;  ///< of a field: what observed points move by, m; empty without one.
};

/// The loads of a case as functions of time, on an (elastic) operator.
class CaseLoads {
 public:
  /// @pre scene and op outlive this. Throws InputError as initial_traction() does.
  /// @param noise  relative disturbance of every locked traction, to see what it does; 0 = none.
  /// @param field  what a field of pressures adds to the compartments' (its fault pressure too),
  /// outlives this; nullptr = none.
  CaseLoads(const Scene& scene, const FaultOperator& op, double noise = 0,
            const FieldHistory* field = nullptr);
  StepLoads at(double time) const;
  /// Throws InputError where a prescribed fault pressure falls below zero in that step.
  void check_fault_pressure(const LoadStep& step, const StepLoads& loads) const;

 private:
  const Scene& scene_;
  const FaultOperator& op_;
  LoadFactors load_factors_;
  InitialTraction initial_;
  double noise_;
  const FieldHistory* field_;
};

}  // namespace faultsim
