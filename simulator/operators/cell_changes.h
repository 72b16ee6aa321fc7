#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/flow/flow_mapping.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// What pressures and temperatures do in the cells of a mesh, for pictures: in the part of a cell
/// that is in a compartment, as it acts there; 0 in cells of none. Of flow results the means that
/// act (mapped_load.h, nearest cells included), of histories those of the compartment.
class CellChanges {
 public:
  /// @pre scene and mesh outlive this. Throws InputError as map_load() does.
  CellChanges(const Scene& scene, const Mesh& mesh, bool half_domain);

  /// Δp since the initial state, Pa, or ΔT, K, per cell of the mesh.
  Eigen::VectorXd pressure(double time) const;
  Eigen::VectorXd temperature(double time) const;
  /// Whether the scene has compartments, and whether any temperature changes.
  bool has_pressure() const;
  bool has_temperature() const;

 private:
  /// A field in the cells of compartments.
  struct OfCells {
    const FlowLoad* load = nullptr;  ///< null: there is no such field.
    Eigen::MatrixXd change = {};     ///< n_cells_ x n_reports.
  };
  OfCells mapped_onto_cells(const FlowLoad& load, bool half_domain) const;
  /// A value per compartment, and one per cell in compartments, spread over the mesh.
  Eigen::VectorXd of_regions(const std::vector<double>& change) const;
  Eigen::VectorXd all_cells(const OfCells& field, double time) const;

  const Scene& scene_;
  const Mesh& mesh_;
  std::vector<int> cells_;  ///< of the mesh that are in compartments.
  OfCells pressure_, temperature_;
};

}  // namespace faultsim
