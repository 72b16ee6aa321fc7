#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/flow/whole_cells.h"
#include "simulator/plan/plan.h"

namespace faultsim {

/// A cell of a mesh that lies in a compartment.
struct CellOfRegion {
  int cell = 0;
  int region = 0;
  double fraction = 1;  ///< share of its volume in the compartment.
};

/// A flow result in the cells of compartments.
struct MappedLoad {
  FlowMapping mapping = {};
  Eigen::MatrixXd change =
      {};  ///< in the compartment's part of a cell, Pa or K, n_cells x n_reports.
  Eigen::VectorXd means = {};  ///< of it at the last report, before integrals were kept.
  std::vector<IntegralBalance> balance = {};  ///< per compartment; none of IntegralRule::mapped.
};

/// What acts, wherever it is asked for. @pre the load is given.
/// @throws InputError as map_flow() and keep_integrals() do.
MappedLoad map_load(const FlowLoad& load, const Mesh& mesh, const std::vector<CellOfRegion>& cells,
                    const std::vector<std::string>& region_names, bool half_domain);

}  // namespace faultsim
