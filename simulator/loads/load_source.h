#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

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
  double time = 0;                         ///< s.
  std::vector<double> temperature_change;  ///< ΔT per region, K, of a field its mean; or empty.
  std::vector<double> factors;             ///< c_k, per operator load.
  /// t_L = t'_0 + Σ c_k L_k + Σ_c P_c s_c + α_f Δp_f n, n_dofs, Pa; without the sums where the
  /// operator is not condensed and has no L: what the faults would carry if the rock were rigid.
  Eigen::VectorXd locked;
  /// Of that the part of forces that are no load of the operator, see LoadSource::add_forces(), Pa;
  /// empty without any.
  Eigen::VectorXd locked_by_forces = {};
  Eigen::VectorXd observed = {};  ///< what observed points move by under those, m; or empty.
};

/// Something that acts on the faults of a case from outside. What a scene's loads have in common is
/// that they are known before the faults move; so they add up, whatever solves the steps.
class LoadSource {
 public:
  virtual ~LoadSource() = default;
  /// Adds its part at a time to the loads, which have the scene's initial state and the parts of
  /// the sources before; not α_f Δp_f n, which follows from all of them.
  /// @param time  s since the scene's start.
  virtual void add(double time, StepLoads& loads) const = 0;
  /// Whether it exerts forces on the bulk that are no load of the operator.
  virtual bool has_forces() const { return false; }
  /// Adds those at a time, N, in the unknowns of the bulk. @pre the bulk was prepared for it.
  virtual void add_forces(double /*time*/, Eigen::VectorXd& /*forces*/) const {}
};
using LoadSources = std::vector<std::shared_ptr<const LoadSource>>;

}  // namespace faultsim
