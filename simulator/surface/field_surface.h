#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/operators/field_loads.h"
#include "simulator/surface/operator_surface.h"

namespace faultsim {

/// A flow result on the operators of a surface (docs/model.md, 12): its loads are more columns L
/// that are interpolated,
///
///   Σ_c P_c s_c = Σ_k s_k(scene) C_k(θ),     C_k(θ) = C_k,0 + Σ_i w_i(θ) (C_k,i − C_k,0),
///
/// a column per report and strength s_k: the Biot coefficient of a material, and its 3 K α_T. So
/// samples of these share the columns, as samples of moduli, dips and offsets do. What is of the
/// mesh alone (means over compartments, pressures beside faults) is that of a case's own mesh.
class FieldSurface {
 public:
  /// Asks for the influence of cells at every node and check point of the surface: from the cache,
  /// else each is factorised. Throws as prepare_influence() and field_loads() do.
  /// @param scene  with the flow result. @pre surface is of its family, and outlives this.
  FieldSurface(const OperatorSurface& surface, const Scene& scene, const CachePolicy& cache,
               const RunContext& context);

  /// The loads in a scene of the family with the same flow result.
  /// @param op    the surface's at that scene.
  /// @param bulk  the exact one there, for forces: FieldCells::bulk.
  FieldLoads at(const Scene& scene, const Plan& plan, const FaultOperator& op,
                CreepLadder* bulk = nullptr) const;
  /// The largest relative error of a column at the check points, and of its observations.
  double traction_error() const { return traction_error_; }
  double observation_error() const { return observation_error_; }

 private:
  /// What may be sampled without new columns.
  struct Strength {
    std::size_t material;
    bool is_thermal;  ///< 3 K α_T; else the Biot coefficient.
  };
  /// Locked tractions and observations of all strengths, a column per strength and report.
  struct Columns {
    Eigen::MatrixXd locked, observed;
  };
  Columns exact_at(const Scene& scene, const CachePolicy& cache, const RunContext& context) const;
  Columns interpolated(const Eigen::VectorXd& weights) const;

  const OperatorSurface& surface_;
  std::vector<Strength> strengths_;
  std::vector<Columns> nodes_;  ///< the centre, then differences to it.
  double traction_error_ = 0, observation_error_ = 0;
};

}  // namespace faultsim
