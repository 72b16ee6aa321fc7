#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "simulator/loads/load_source.h"

namespace faultsim {

/// What fields of pressure and temperature, cell by cell, do to closed faults: at its reports, and
/// linear in between; before the first and after the last as at that one.
struct FieldHistory final : LoadSource {
  std::vector<double> time = {};  ///< s since the scene's start, strictly increasing, at least one.
  /// Σ_c P_c s_c, Pa, n_dofs x n_reports: the rock's part of the locked traction.
  Eigen::MatrixXd locked = {};
  /// Σ_c O_c s_c, m, n_rows x n_reports: what observed points move by with closed faults; empty
  /// where points are observed otherwise.
  Eigen::MatrixXd observed = {};
  /// Δp of each region: the mean over its volume, Pa, n_regions x n_reports.
  Eigen::MatrixXd region_change = {};
  /// ΔT of each region likewise, K; empty without a field of temperatures.
  Eigen::MatrixXd region_heating = {};
  /// Δp_f by the faults' rules from the cells beside each node, Pa, n_nodes x n_reports.
  Eigen::MatrixXd fault_pressure = {};
  /// By how much Δp of the cells beside a node, weighted by area and the share in the region,
  /// differs from region_change of the region there (side_regions), Pa, n_nodes x n_reports; 0
  /// where none is.
  Eigen::MatrixXd beside_minus = {}, beside_plus = {};
  /// s_c, Pa, n_cells x n_reports, and the nodal forces of s_c = 1 Pa, N, of each cell; both empty
  /// unless the bulk is there.
  Eigen::MatrixXd stress = {};
  std::vector<std::vector<std::pair<int, double>>> cell_forces = {};

  void add(double at, StepLoads& loads) const override;
  bool has_forces() const override { return !cell_forces.empty(); }
  void add_forces(double at, Eigen::VectorXd& forces) const override;
};

/// The column at a time of a table with a column per report (n x n_reports).
/// @param time  s, strictly increasing, of the columns.
Eigen::VectorXd at_time(const std::vector<double>& time, const Eigen::MatrixXd& table, double at);

}  // namespace faultsim
